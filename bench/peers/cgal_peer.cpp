// SPDX-License-Identifier: Apache-2.0
// CGAL's exact answer for meshes in motion. The poses are applied in doubles, so it is exact for the rounded mesh.
#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/version.h>

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "peer.hpp"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
/// Each primitive holds its triangle, the faster of CGAL's ways.
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Surface, CGAL::Default, CGAL::Tag_true, CGAL::Tag_true>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
using Detection = CGAL::Rigid_triangle_mesh_collision_detection<Surface, CGAL::Default, CGAL::Default, Tree>;

struct Body {
  Surface surface;
  Tree tree;
};

/// Made at the first query about two bodies: CGAL answers about the meshes of one such object.
std::map<std::pair<const Body*, const Body*>, Detection> detections;

/// Faces without area are left out: CGAL's predicates do not accept them.
void* make(const double* vertices, size_t vertex_count, const uint32_t* triangles, size_t triangle_count) {
  std::vector<Kernel::Point_3> points;
  for (size_t i = 0; i < vertex_count; ++i) {
    points.emplace_back(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]);
  }
  std::vector<std::array<size_t, 3>> faces;
  for (size_t i = 0; i < triangle_count; ++i) {
    const std::array<size_t, 3> face = {triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]};
    if (!CGAL::collinear(points[face[0]], points[face[1]], points[face[2]])) faces.push_back(face);
  }
  CGAL::Polygon_mesh_processing::orient_polygon_soup(points, faces);  // doubles vertices that no manifold has
  auto* body = new Body;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, faces, body->surface);
  body->tree.insert(CGAL::faces(body->surface).first, CGAL::faces(body->surface).second, body->surface);
  body->tree.build();
  return body;
}

void destroy(void* mesh) {
  auto* body = static_cast<Body*>(mesh);
  for (auto i = detections.begin(); i != detections.end();) {
    i = i->first.first == body || i->first.second == body ? detections.erase(i) : std::next(i);
  }
  delete body;
}

Detection& detection(const Body* a, const Body* b) {
  const auto [found, is_new] = detections.try_emplace({a, b});
  if (is_new) {
    for (const Body* body : {a, b}) {
      found->second.add_mesh(body->tree, body->surface, CGAL::parameters::apply_per_connected_component(false));
    }
  }
  return found->second;
}

int hit(void* a, const double* pose_a, void* b, const double* pose_b) {
  // In A's frame: boxes of an object that is not turned cost CGAL less.
  const auto pose = [](const double* values) {
    Eigen::Isometry3d result;
    result.matrix() = Eigen::Map<const Eigen::Matrix4d>(values);
    return result;
  };
  const Eigen::Isometry3d relative = pose(pose_a).inverse() * pose(pose_b);
  const auto m = [&](int row, int column) { return relative(row, column); };
  Detection& both = detection(static_cast<const Body*>(a), static_cast<const Body*>(b));
  both.set_transformation(1, Kernel::Aff_transformation_3(m(0, 0), m(0, 1), m(0, 2), m(0, 3), m(1, 0), m(1, 1), m(1, 2),
                                                          m(1, 3), m(2, 0), m(2, 1), m(2, 2), m(2, 3)));
  const std::array<size_t, 1> other = {1};
  return both.get_all_intersections(0, other).empty() ? 0 : 1;
}

constexpr CchipPeer peer = {CGAL_VERSION_STR ", Rigid_triangle_mesh_collision_detection, Epick", make, destroy, hit,
                            nullptr};

}  // namespace

extern "C" __attribute__((visibility("default"))) const CchipPeer* cchip_peer() { return &peer; }
