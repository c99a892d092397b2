// SPDX-License-Identifier: Apache-2.0
// self_contacts() beside CGAL: its intersections of two triangles, exactly constructed, and its self_intersections().
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cchip/collide.hpp>
#include <cchip/internal/exact/intersection.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

using namespace cchip;

namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Exact::Point_3 exact(const Vec3d& v) { return {v.x(), v.y(), v.z()}; }

bool is_collapsed(const Mesh& mesh, const Mesh::Face& face) {
  const auto point = [&](std::size_t i) { return exact(mesh.vertices[face.vertex[i]]); };
  return CGAL::collinear(point(0), point(1), point(2));
}

/// More than the one vertex or the one edge that they have in common? Of triangles that are not collapsed.
bool share_more(const Primitive& a, const Primitive& b) {
  std::vector<Exact::Point_3> common;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (a.v[i] == b.v[k]) common.push_back(exact(a.v[i]));
    }
  }
  if (common.size() == 3) return true;
  const auto shared = CGAL::intersection(Exact::Triangle_3(exact(a.v[0]), exact(a.v[1]), exact(a.v[2])),
                                         Exact::Triangle_3(exact(b.v[0]), exact(b.v[1]), exact(b.v[2])));
  if (!shared) return false;
  if (common.empty()) return true;
  if (common.size() == 1) return boost::get<Exact::Point_3>(&*shared) == nullptr;
  const auto* const segment = boost::get<Exact::Segment_3>(&*shared);
  const Exact::Segment_3 edge(common[0], common[1]);
  return segment == nullptr || (*segment != edge && *segment != edge.opposite());
}

Pairs ours(const Mesh& mesh) {
  Pairs pairs;
  for (const Contact& contact : self_contacts(Object(mesh))) pairs.emplace_back(contact.face_a, contact.face_b);
  return pairs;
}

Mesh mesh_of(const std::vector<Primitive>& faces) {
  Mesh mesh;
  for (const Primitive& face : faces) {
    mesh.faces.emplace_back().kind = face.kind;
    for (std::size_t i = 0; i < face.vertex_count(); ++i) {
      mesh.faces.back().vertex[i] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(face.v[i]);
    }
  }
  return mesh;
}

Primitive triangle(const Vec3d& u, const Vec3d& v, const Vec3d& w) {
  Primitive p;
  p.v = {u, v, w, u};
  return p;
}

Primitive quad(const Vec3d& u, const Vec3d& v, const Vec3d& w, const Vec3d& x) {
  Primitive p;
  p.kind = Kind::quad;
  p.v = {u, v, w, x};
  return p;
}

/// More than the one vertex or the one edge that they have in common? Of any faces with small whole numbers: all
/// corners of what two hulls share lie on the edge, or do not by far more than they were rounded.
bool hulls_share_more(const Primitive& a, const Primitive& b) {
  std::vector<Vec3d> common;
  for (std::size_t i = 0; i < a.vertex_count(); ++i) {
    const bool known = std::find(common.begin(), common.end(), a.v[i]) != common.end();
    const auto end = b.v.begin() + static_cast<int>(b.vertex_count());
    if (!known && std::find(b.v.begin(), end, a.v[i]) != end) common.push_back(a.v[i]);
  }
  if (common.size() > 2) return true;
  const auto shared = exact_intersection(a, Pose::Identity(), b, Pose::Identity());
  if (!shared) return false;
  if (common.empty()) return true;
  const Vec3d edge = common.back() - common.front();
  return std::any_of(shared->points.begin(), shared->points.end(), [&](const Vec3d& p) {
    const double along = common.size() == 1 ? 0 : (p - common[0]).dot(edge) / edge.squaredNorm();
    return (p - common[0] - std::clamp(along, 0.0, 1.0) * edge).norm() > 1e-6;
  });
}

/// Triangles between a few points of a small grid: many share vertices and edges, lie in one plane or coincide.
Mesh tangle(std::mt19937_64& random, bool flat) {
  Mesh mesh;
  const auto coordinate = [&random] { return static_cast<double>(random() % 4); };
  for (int i = 0; i < 9; ++i) {  // some at one position
    const double x = coordinate();
    const double y = coordinate();
    mesh.vertices.emplace_back(x, y, flat ? x / 2 + y : coordinate());
  }
  while (mesh.faces.size() < 12) {
    Mesh::Face face;
    for (std::size_t k = 0; k < 3; ++k) face.vertex[k] = static_cast<std::uint32_t>(random() % mesh.vertices.size());
    if (!is_collapsed(mesh, face)) {
      mesh.faces.push_back(face);
    } else if (random() % 1000 == 0) {
      return tangle(random, flat);  // perhaps all points lie on a line
    }
  }
  // Numbers that doubles do not hold exactly, which keeps planes only nearly.
  if (random() % 4 == 0) {
    for (Vec3d& v : mesh.vertices) v *= 0.1;
  }
  return mesh;
}

}  // namespace

TEST_CASE("self-contacts: those of CGAL's exact intersections of triangles", "[ref][cgal]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::array<std::array<int, 2>, 4> seen = {};  // by vertices in common, by the answer
  for (int round = 0; round < 200; ++round) {
    const Mesh mesh = tangle(random, round % 4 == 0);
    Pairs expected;
    for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
      for (std::uint32_t k = i + 1; k < mesh.faces.size(); ++k) {
        const Primitive a = mesh.primitive(i);
        const Primitive b = mesh.primitive(k);
        const bool more = share_more(a, b);
        if (more) expected.emplace_back(i, k);
        std::size_t common = 0;
        for (std::size_t v = 0; v < 9; ++v) common += a.v[v / 3] == b.v[v % 3] ? 1 : 0;
        ++seen[common][more ? 1 : 0];
      }
    }
    CAPTURE(round);
    REQUIRE(ours(mesh) == expected);
  }
  for (const auto& [no, yes] : {std::pair(seen[0][0], seen[0][1]), std::pair(seen[1][0], seen[1][1]),
                                std::pair(seen[2][0], seen[2][1]), std::pair(100, seen[3][1])}) {
    CHECK(no >= 100);
    CHECK(yes >= 100);
  }
}

TEST_CASE("self-contacts: those of CGAL's self_intersections", "[ref][cgal]") {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
  std::mt19937_64 random(sim::seed_from_environment());
  std::uniform_real_distribution<double> unit(-1, 1);
  int meshes = 0;
  std::size_t pairs = 0;
  for (int round = 0; round < 60; ++round) {
    Mesh mesh = round % 2 == 0 ? make_sphere(1, 3) : make_torus(1, 0.4, 10, 7);
    const double range = 0.02 * (round / 3);
    const double step = round % 3 == 0 ? 0.125 : 0x1p-40;
    for (Vec3d& v : mesh.vertices) {
      for (Eigen::Index k = 0; k < 3; ++k) v[k] = std::round((v[k] + range * unit(random)) / step) * step;
    }
    std::set<std::array<double, 3>> positions;
    for (const Vec3d& v : mesh.vertices) positions.insert({v.x(), v.y(), v.z()});
    // CGAL takes vertices of different numbers for different ones, and no collapsed faces.
    if (positions.size() != mesh.vertices.size()) continue;
    if (std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const Mesh::Face& f) { return is_collapsed(mesh, f); })) {
      continue;
    }
    SurfaceMesh surface;
    for (const Vec3d& v : mesh.vertices) surface.add_vertex({v.x(), v.y(), v.z()});
    for (const Mesh::Face& f : mesh.faces) {
      const auto vertex = [&f](std::size_t k) { return SurfaceMesh::Vertex_index(f.vertex[k]); };
      REQUIRE(surface.add_face(vertex(0), vertex(1), vertex(2)) != SurfaceMesh::null_face());
    }
    std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> found;
    CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(found));
    Pairs expected;
    for (const auto& [f, g] : found) expected.push_back(std::minmax<std::uint32_t>({f.idx(), g.idx()}));
    std::sort(expected.begin(), expected.end());
    CAPTURE(round);
    REQUIRE(ours(mesh) == expected);
    ++meshes;
    pairs += expected.size();
  }
  CHECK(meshes >= 40);
  CHECK(pairs >= 500);
}

TEST_CASE("self-contacts: quads and collapsed faces against what their hulls share", "[ref][cgal]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::array<std::array<int, 2>, 3> seen = {};  // by vertices in common, by the answer
  for (int round = 0; round < 70; ++round) {
    std::vector<Vec3d> points(7);  // of a small grid, so that faces are flat, collapsed or tetrahedra
    for (Vec3d& p : points) {
      for (double& x : p) x = static_cast<double>(random() % 3);
    }
    std::vector<Primitive> faces(5);
    for (Primitive& face : faces) {
      face.kind = random() % 4 == 0 ? Kind::tri : Kind::quad;
      for (Vec3d& v : face.v) v = points[random() % points.size()];
    }
    std::vector<Contact> expected;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      for (std::uint32_t k = i + 1; k < faces.size(); ++k) {
        const bool more = hulls_share_more(faces[i], faces[k]);
        if (more) {
          expected.push_back({i, k, exact_relation(faces[i], Pose::Identity(), faces[k], Pose::Identity())});
        }
        std::set<std::array<double, 3>> common;
        for (std::size_t v = 0; v < 16; ++v) {
          const Vec3d& p = faces[i].v[v / 4];
          if (v / 4 < faces[i].vertex_count() && v % 4 < faces[k].vertex_count() && p == faces[k].v[v % 4]) {
            common.insert({p.x(), p.y(), p.z()});
          }
        }
        if (common.size() < 3) ++seen[common.size()][more ? 1 : 0];
      }
    }
    CAPTURE(round);
    REQUIRE(self_contacts(Object(mesh_of(faces))) == expected);
  }
  for (const auto& [no, yes] : seen) {
    CHECK(no >= 3);
    CHECK(yes >= 3);
  }
}

TEST_CASE("self-contacts: a face through a quad near their common vertex", "[ref][cgal]") {
  const Primitive floor = quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
  const auto found = [](const Primitive& a, const Primitive& b) { return self_contacts(Object(mesh_of({a, b}))); };
  const std::vector<Contact> crossing = {{0, 1, Relation::crossing}};
  const std::vector<Contact> none;
  CHECK(found(floor, triangle({0, 0, 0}, {1, 1, -1}, {1, 1, 1})) == crossing);
  CHECK(found(floor, triangle({0, 0, 0}, {1, 1, 1}, {1, 1, 2})) == none);
  // Into a tetrahedron from one of its edges, and away from it.
  const Primitive solid = quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4});
  CHECK(found(solid, triangle({0, 0, 0}, {4, 0, 0}, {1, 1, 1})) == crossing);
  CHECK(found(solid, triangle({0, 0, 0}, {4, 0, 0}, {1, 5, 5})) == crossing);
  CHECK(found(solid, triangle({0, 0, 0}, {4, 0, 0}, {1, -1, 1})) == none);
}

TEST_CASE("self-contacts: neighbours whose products no double holds", "[ref][cgal]") {
  // Over one edge, in one plane and on one side: the second contains the first, 2^700 times as large.
  const Vec3d u(0, 0, 0), v(0, 0x1p-600, 0), w(1, 0, 0x1p-600);
  const Mesh mesh = mesh_of({triangle(u, v, w), triangle(u, v, 0x1p700 * w)});
  CHECK(self_contacts(Object(mesh)) == std::vector<Contact>{{0, 1, Relation::touching}});
  // On the other side they share the edge alone.
  const Mesh apart = mesh_of({triangle(u, v, w), triangle(u, v, -0x1p700 * w)});
  CHECK(self_contacts(Object(apart)).empty());
}
