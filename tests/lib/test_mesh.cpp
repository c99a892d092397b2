// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <map>
#include <set>

#include "random_pairs.hpp"

using namespace cchip_test;
using cchip::CandidatePair;
using cchip::Mesh;
using cchip::Vec3d;

namespace {

/// Counts directed edges: a closed, consistently oriented surface has every edge once in each direction.
bool is_closed_and_oriented(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Mesh::Face& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{face.vertex[i], face.vertex[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) return false;
  }
  return !edges.empty();
}

int euler_characteristic(const Mesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::set<std::uint32_t> used;
  for (const Mesh::Face& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges.insert(std::minmax(face.vertex[i], face.vertex[(i + 1) % 3]));
      used.insert(face.vertex[i]);
    }
  }
  CHECK(used.size() == mesh.vertices.size());
  return static_cast<int>(used.size()) - static_cast<int>(edges.size()) + static_cast<int>(mesh.faces.size());
}

/// Signed volume: positive if the fronts face outwards.
double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const cchip::Primitive p = mesh.primitive(i);
    sum += p.v[0].cross(p.v[1]).dot(p.v[2]) / 6;
  }
  return sum;
}

constexpr double pi = 3.14159265358979323846;

/// Random triangles, some of them with coordinates in common so that boxes touch.
Mesh soup(PairSource& source, int faces) {
  Mesh mesh;
  for (int i = 0; i < faces; ++i) {
    const Vec3i centre = source.point();
    for (std::uint32_t k = 0; k < 3; ++k) {
      mesh.vertices.emplace_back((centre + source.point() / 8).cast<double>());
    }
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.faces.push_back({Kind::tri, {first, first + 1, first + 2, 0}});
  }
  return mesh;
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs sweep(const Mesh& a, const Mesh& b) {
  Pairs pairs;
  sweep_box_pairs(a, b, [&](CandidatePair p) { pairs.emplace_back(p.face_a, p.face_b); });
  return pairs;
}

Pairs brute_force(const Mesh& a, const Mesh& b) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < a.faces.size(); ++i) {
    for (std::uint32_t j = 0; j < b.faces.size(); ++j) {
      const cchip::Primitive p = a.primitive(i);
      const cchip::Primitive q = b.primitive(j);
      bool apart = false;
      for (int d = 0; d < 3; ++d) {
        const auto [p_least, p_greatest] = std::minmax({p.v[0][d], p.v[1][d], p.v[2][d]});
        const auto [q_least, q_greatest] = std::minmax({q.v[0][d], q.v[1][d], q.v[2][d]});
        apart = apart || p_greatest < q_least || q_greatest < p_least;
      }
      if (!apart) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

}  // namespace

TEST_CASE("mesh: from arrays and matrices", "[lib][mesh]") {
  const double positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5};
  const std::uint32_t corners[] = {0, 1, 2, 0, 2, 3};
  const Mesh triangles = cchip::make_mesh(positions, 4, corners, 2);
  CHECK(triangles.vertices.size() == 4);
  CHECK(triangles.vertices[3] == Vec3d(0, 1, 0.5));
  REQUIRE(triangles.faces.size() == 2);
  CHECK(triangles.faces[1].kind == cchip::Kind::tri);
  CHECK(triangles.faces[1].vertex == std::array<std::uint32_t, 4>{0, 2, 3, 0});

  const Eigen::MatrixXd vertices = Eigen::Map<const Eigen::Matrix<double, 4, 3, Eigen::RowMajor>>(positions);
  Eigen::MatrixXi quad(1, 4);
  quad << 0, 1, 2, 3;
  const Mesh quads = cchip::make_mesh(vertices, quad);
  CHECK(quads.vertices == triangles.vertices);
  REQUIRE(quads.faces.size() == 1);
  CHECK(quads.faces[0].kind == cchip::Kind::quad);
  CHECK(quads.faces[0].vertex == std::array<std::uint32_t, 4>{0, 1, 2, 3});

  const auto refuses = [](const std::string& message, const auto& action) {
    CHECK_THROWS_MATCHES(action(), std::invalid_argument, Catch::Message(message));
  };
  refuses("vertices have 2 columns; give three, x, y and z, a row for each vertex",
          [&] { cchip::make_mesh(vertices.leftCols(2), quad); });
  refuses("faces have 2 columns; give three for triangles or four for quads, a row for each face",
          [&] { cchip::make_mesh(vertices, quad.leftCols(2)); });
  for (const int wrong : {-1, 4}) {
    quad(0, 2) = wrong;
    refuses("face 0: vertex index " + std::to_string(wrong) + " is out of range (there are 4 vertices, from 0)",
            [&] { cchip::make_mesh(vertices, quad); });
  }
  refuses("vertices are a null pointer; point it to the first one", [&] { cchip::make_mesh(nullptr, 4, corners, 2); });
  refuses("faces are a null pointer; point it to the first one", [&] { cchip::make_mesh(positions, 4, nullptr, 2); });
  refuses("faces have 5 columns; give three for triangles or four for quads, a row for each face",
          [&] { cchip::make_mesh(positions, 4, corners, 1, 5); });
  CHECK(cchip::make_mesh(nullptr, 0, nullptr, 0).faces.empty());
}

TEST_CASE("mesh: torus is closed, faces outwards, has one hole", "[lib][mesh]") {
  const Mesh torus = cchip::make_torus(3, 1, 48, 24);
  CHECK(torus.faces.size() == 2 * 48 * 24);
  CHECK(is_closed_and_oriented(torus));
  CHECK(euler_characteristic(torus) == 0);
  CHECK(volume(torus) == Approx(2 * pi * pi * 3).epsilon(0.03));
  for (const Vec3d& p : torus.vertices) {
    const double from_ring = std::hypot(std::hypot(p.x(), p.y()) - 3, p.z());
    REQUIRE(from_ring == Approx(1));
  }
}

TEST_CASE("mesh: sphere is closed, faces outwards, repeats with its seed", "[lib][mesh]") {
  for (const int cuts : {1, 2, 9}) {
    CAPTURE(cuts);
    const Mesh sphere = cchip::make_sphere(2, cuts);
    CHECK(sphere.faces.size() == static_cast<std::size_t>(20 * cuts * cuts));
    CHECK(sphere.vertices.size() == static_cast<std::size_t>(10 * cuts * cuts + 2));
    CHECK(is_closed_and_oriented(sphere));
    CHECK(euler_characteristic(sphere) == 2);
    for (const Vec3d& p : sphere.vertices) CHECK(p.norm() == Approx(2));
  }
  CHECK(volume(cchip::make_sphere(2, 20)) == Approx(4 * pi / 3 * 8).epsilon(0.01));
  const Mesh noisy = cchip::make_sphere(1, 9, 0.25, 7);
  CHECK(is_closed_and_oriented(noisy));
  const auto [least, greatest] = std::minmax_element(
      noisy.vertices.begin(), noisy.vertices.end(), [](const Vec3d& p, const Vec3d& q) { return p.norm() < q.norm(); });
  CHECK(least->norm() > 0.7499);
  CHECK(least->norm() < 0.76);
  CHECK(greatest->norm() < 1.2501);
  CHECK(greatest->norm() > 1.24);
  CHECK(cchip::make_sphere(1, 9, 0.25, 7).vertices == noisy.vertices);
  CHECK(cchip::make_sphere(1, 9, 0.25, 8).vertices != noisy.vertices);
  CHECK_THROWS_AS(cchip::make_sphere(0, 9), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_sphere(1, 0), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_sphere(1, 9, 1), std::invalid_argument);
}

TEST_CASE("mesh: body is closed, faces outwards, repeats with its seed, has its relief", "[lib][mesh]") {
  const Mesh body = cchip::make_body(20, 0.8, 7);
  CHECK(body.faces.size() == 20 * 20 * 20);
  CHECK(is_closed_and_oriented(body));
  CHECK(euler_characteristic(body) == 2);
  const auto by_norm = [](const Vec3d& p, const Vec3d& q) { return p.norm() < q.norm(); };
  const auto [least, greatest] = std::minmax_element(body.vertices.begin(), body.vertices.end(), by_norm);
  CHECK(least->norm() > 0.2);
  CHECK(least->norm() < 0.8);
  CHECK(greatest->norm() > 1.25);
  CHECK(greatest->norm() < 5);
  CHECK(cchip::make_body(20, 0.8, 7).vertices == body.vertices);
  CHECK(cchip::make_body(20, 0.8, 8).vertices != body.vertices);
  CHECK(cchip::make_body(20, 0, 7).vertices == cchip::make_sphere(1, 20).vertices);
  CHECK_THROWS_AS(cchip::make_body(20, -0.1), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_body(20, 1.1), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_body(0, 0.5), std::invalid_argument);
}

TEST_CASE("mesh: subdivided keeps the surface, normalised its shape", "[lib][mesh]") {
  const Mesh torus = cchip::make_torus(3, 1, 24, 12);
  const Mesh fine = cchip::subdivided(torus);
  CHECK(fine.faces.size() == 4 * torus.faces.size());
  CHECK(is_closed_and_oriented(fine));
  CHECK(euler_characteristic(fine) == 0);
  CHECK(volume(fine) == Approx(volume(torus)));
  const Mesh quads = cchip::subdivided(cchip::make_torus(3, 1, 24, 12, cchip::Kind::quad));
  CHECK(quads.faces.size() == 4 * 24 * 12);
  CHECK(quads.vertices.size() == 4 * 24 * 12);  // as many vertices as faces, so a torus again
  for (const Mesh::Face& face : quads.faces) CHECK(face.kind == cchip::Kind::quad);
  Mesh moved = torus;
  for (Vec3d& v : moved.vertices) v = 7 * v + Vec3d(1, 2, 3);
  moved = cchip::normalised(moved);
  const double size = std::sqrt(8 * 8 + 8 * 8 + 2 * 2);
  for (std::size_t i = 0; i < torus.vertices.size(); ++i) {
    CHECK((moved.vertices[i] - torus.vertices[i] / size).norm() < 1e-6);
  }
  CHECK_THROWS_AS(cchip::normalised(Mesh{}), std::invalid_argument);
}

TEST_CASE("mesh: a torus of quads is the torus of triangles before the cut", "[lib][mesh]") {
  const Mesh quads = cchip::make_torus(3, 1, 12, 8, cchip::Kind::quad);
  const Mesh triangles = cchip::make_torus(3, 1, 12, 8);
  CHECK(quads.vertices == triangles.vertices);
  REQUIRE(quads.faces.size() == 12 * 8);
  for (std::size_t i = 0; i < quads.faces.size(); ++i) {
    const auto& q = quads.faces[i].vertex;
    REQUIRE(quads.faces[i].kind == cchip::Kind::quad);
    REQUIRE(triangles.faces[2 * i].vertex == std::array<std::uint32_t, 4>{q[0], q[1], q[2], 0});
    REQUIRE(triangles.faces[2 * i + 1].vertex == std::array<std::uint32_t, 4>{q[0], q[2], q[3], 0});
  }
}

TEST_CASE("mesh: gear is closed, faces outwards", "[lib][mesh]") {
  const Mesh disc = cchip::make_gear(2, 2.5, 0, 1, 12, 3);
  CHECK(disc.faces.size() == 8 * 12 * (3 + 1));
  CHECK(is_closed_and_oriented(disc));
  CHECK(euler_characteristic(disc) == 2);
  const Mesh ring = cchip::make_gear(2, 2.5, 0.8, 1, 24, 6);
  CHECK(ring.faces.size() == 16 * 24 * (6 + 1));
  CHECK(is_closed_and_oriented(ring));
  CHECK(euler_characteristic(ring) == 0);
  for (const Mesh* gear : {&disc, &ring}) {
    CHECK(volume(*gear) > 0.7 * pi * (2 * 2 - 0.8 * 0.8));
    CHECK(volume(*gear) < pi * 2.5 * 2.5);
    double tip = 0;
    for (const Vec3d& p : gear->vertices) {
      tip = std::max(tip, std::hypot(p.x(), p.y()));
      REQUIRE(std::abs(p.z()) <= 0.5);
    }
    CHECK(tip == Approx(2.5));
  }
}

TEST_CASE("mesh: shapes refuse impossible sizes", "[lib][mesh]") {
  CHECK_THROWS_AS(cchip::make_torus(1, 1, 8, 8), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_torus(2, 0, 8, 8), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_torus(2, 1, 2, 8), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_gear(2, 2, 1, 1, 8, 1), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_gear(2, 3, 2, 1, 8, 1), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_gear(2, 3, 1, 0, 8, 1), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_gear(2, 3, 1, 1, 2, 1), std::invalid_argument);
  CHECK_THROWS_AS(cchip::make_gear(2, 3, 1, 1, 8, 0), std::invalid_argument);
}

TEST_CASE("mesh: a pose moves every vertex and nothing else", "[lib][mesh]") {
  const Mesh torus = cchip::make_torus(3, 1, 6, 5);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Vec3d(1, 2, 3)).rotate(Eigen::AngleAxisd(pi / 2, Vec3d::UnitZ()));
  const Mesh moved = transformed(torus, pose);
  REQUIRE(moved.vertices.size() == torus.vertices.size());
  for (std::size_t i = 0; i < moved.vertices.size(); ++i) {
    const Vec3d& p = torus.vertices[i];
    REQUIRE((moved.vertices[i] - Vec3d(1 - p.y(), 2 + p.x(), 3 + p.z())).norm() < 1e-12);
  }
  REQUIRE(moved.faces.size() == torus.faces.size());
  for (std::size_t i = 0; i < moved.faces.size(); ++i) CHECK(moved.faces[i].vertex == torus.faces[i].vertex);
}

TEST_CASE("mesh: sweep finds what brute force finds, each pair once", "[lib][mesh]") {
  for (const int range : {8, 40, 1000}) {
    PairSource source(-range, range, static_cast<std::uint64_t>(range));
    for (int i = 0; i < 10; ++i) {
      const Mesh a = soup(source, 150);
      const Mesh b = soup(source, 20 * i);
      const Pairs in_order = sweep(a, b);
      CHECK(in_order == sweep(a, b));
      Pairs found = in_order;
      std::sort(found.begin(), found.end());
      CHECK(found == brute_force(a, b));
    }
  }
}

TEST_CASE("mesh: sweep takes boxes as closed", "[lib][mesh]") {
  Mesh a;
  a.vertices = {{0, 0, 0}, {1, 0, 1}, {0, 1, 0}};
  a.faces = {{Kind::tri, {0, 1, 2, 0}}};
  Mesh b = a;
  for (Vec3d& p : b.vertices) p += Vec3d(1, 1, 1);
  CHECK(sweep(a, b) == Pairs{{0, 0}});
  for (Vec3d& p : b.vertices) p.x() += 1e-9;
  CHECK(sweep(a, b).empty());
}
