// SPDX-License-Identifier: Apache-2.0
// Contact for contact with CGAL: vertices under poses by its exact constructions, its predicates for triangles.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/device.hpp>
#include <cchip/mesh_file.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <iostream>
#include <random>

using namespace cchip;

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;

/// The mesh without faces of zero area, which CGAL's predicates do not accept.
Mesh without_degenerate(Mesh mesh) {
  const auto is_flat = [&mesh](const Mesh::Face& face) {
    const auto point = [&](std::size_t i) {
      const Vec3d& p = mesh.vertices[face.vertex[i]];
      return Kernel::Point_3(p.x(), p.y(), p.z());
    };
    return CGAL::collinear(point(0), point(1), point(2));
  };
  mesh.file_face.clear();  // faces have the numbers that they get here
  mesh.faces.erase(std::remove_if(mesh.faces.begin(), mesh.faces.end(), is_flat), mesh.faces.end());
  return mesh;
}

std::vector<Kernel::Triangle_3> placed(const Mesh& mesh, const Pose& pose) {
  std::vector<Kernel::Point_3> points;
  for (const Vec3d& v : mesh.vertices) {
    std::array<Kernel::FT, 3> at;
    for (int k = 0; k < 3; ++k) {
      Kernel::FT sum(pose.translation()[k]);
      for (int j = 0; j < 3; ++j) sum += Kernel::FT(pose.linear()(k, j)) * Kernel::FT(v[j]);
      at[static_cast<std::size_t>(k)] = sum;
    }
    points.emplace_back(at[0], at[1], at[2]);
  }
  std::vector<Kernel::Triangle_3> triangles;
  for (const Mesh::Face& f : mesh.faces)
    triangles.emplace_back(points[f.vertex[0]], points[f.vertex[1]], points[f.vertex[2]]);
  return triangles;
}

std::vector<Contact> cgal_contacts(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b) {
  const std::vector<Kernel::Triangle_3> triangles_a = placed(a, pose_a);
  const std::vector<Kernel::Triangle_3> triangles_b = placed(b, pose_b);
  using NumberedBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
  const auto boxes = [](const std::vector<Kernel::Triangle_3>& triangles) {
    std::vector<NumberedBox> result;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      result.emplace_back(triangles[i].bbox(), static_cast<std::uint32_t>(i));
    }
    return result;
  };
  std::vector<NumberedBox> boxes_a = boxes(triangles_a);
  std::vector<NumberedBox> boxes_b = boxes(triangles_b);
  std::vector<Contact> contacts;
  CGAL::box_intersection_d(boxes_a.begin(), boxes_a.end(), boxes_b.begin(), boxes_b.end(),
                           [&](const NumberedBox& p, const NumberedBox& q) {
                             if (CGAL::do_intersect(triangles_a[p.info()], triangles_b[q.info()])) {
                               contacts.push_back({p.info(), q.info()});
                             }
                           });
  std::sort(contacts.begin(), contacts.end());
  return contacts;
}

Mesh model(const std::string& path) {
  return without_degenerate(load_mesh(std::string(CCHIP_TEST_MODELS) + "/" + path));
}

double radius(const Mesh& mesh) {
  double greatest = 0;
  for (const Vec3d& v : mesh.vertices) greatest = std::max(greatest, v.norm());
  return greatest;
}

/// Poses from apart to deep, rigid, sheared and mirrored, and the same place.
void compare(const std::vector<std::pair<Mesh, Mesh>>& pairs, int poses) {
  std::mt19937_64 random(sim::seed_from_environment());
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double range) {
    const double x = unit(random);
    const double y = unit(random);
    return Vec3d(range * x, range * y, range * unit(random));
  };
  const auto device = open_device("cpu");
  int done = 0;
  int hits = 0;
  std::size_t contacts = 0;
  CollisionStats total;
  for (int i = 0; i < poses; ++i) {
    const auto& [a, b] = pairs[static_cast<std::size_t>(i) % pairs.size()];
    const Object object_a(a);
    const Object object_b(b);
    Pose pose_a(make_pose(vector(1), vector(180)));
    Pose pose_b(make_pose(pose_a.translation() + vector((radius(a) + radius(b)) * 0.6), vector(180)));
    if (i % 5 == 1) pose_b.linear().col(0) += unit(random) * pose_b.linear().col(1);
    if (i % 5 == 2) pose_a.linear().col(2) *= -1;
    if (i % 7 == 3) pose_b = pose_a;
    const CollisionRequest all = {CollisionRequest::Contacts::all};
    const CollisionResult ours = collide(*device, object_a, pose_a, object_b, pose_b, all);
    const std::vector<Contact> theirs = cgal_contacts(a, pose_a, b, pose_b);
    ++done;
    hits += ours.hit;
    contacts += theirs.size();
    total += ours.stats;
    CAPTURE(i, a.name, b.name, ours.contacts.size(), theirs.size());
    CHECK((ours.contacts == theirs));
  }
  std::cout << "poses=" << done << " hits=" << hits << " contacts=" << contacts << " pairs=" << total.pairs
            << " open=" << total.open << '\n';
  CHECK(hits > poses / 4);
  CHECK(contacts > 1000);
}

}  // namespace

TEST_CASE("CGAL finds the same contacts", "[ref][cgal]") {
  compare({{make_sphere(1, 23, 0.02), make_sphere(1, 24, 0.02, 2)},
           {model("OFF/Wuson.off"), make_gear(1.25, 1.5, 0.5, 0.5, 36, 6)},
           {make_torus(1, 0.25, 96, 48), make_gear(1.25, 1.5, 0.5, 0.5, 36, 6)}},
          10);
}

TEST_CASE("CGAL finds the same contacts of larger meshes in 50 poses", "[.long]") {
  compare({{make_sphere(1, 50, 0.02), make_sphere(1, 50, 0.02, 2)},
           {make_sphere(1, 71, 0.005), make_torus(1, 0.25, 192, 96)},
           {model("OBJ/spider.obj"), make_sphere(50, 30, 0.05)},
           {model("OFF/Wuson.off"), model("OFF/Wuson.off")}},
          50);
}
