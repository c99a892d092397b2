// SPDX-License-Identifier: Apache-2.0
// The bounds on rounding that make the CPU device exact: enough, and each of them needed.
//
// Queries in which the objects only just touch: the pose of B is the last one in doubles, on a line away from A, in
// which the plain search, which shares no arithmetic with the others but exact predicates, finds a contact. Spindles
// that point at each other touch where bounding planes are as tight as they can be: their tips lie on a direction of
// the volumes of both.
#include <catch2/catch.hpp>
#include <cchip/mesh/shapes.hpp>
#include <cchip/sim/seed.hpp>
#include <cmath>
#include <cstdio>
#include <random>

#include "device/search.hpp"

using namespace cchip;

namespace {

struct Case {
  const char* name;
  bool spindles;    ///< or uneven spheres
  double size_b;    ///< A has size 1
  double distance;  ///< of both from the origin
  int count;
};
constexpr Case cases[] = {{"spheres", false, 1, 1, 40},
                          {"spheres far from the origin", false, 1, 1e13, 30},
                          {"spheres, 100 : 1", false, 0.01, 1, 30},
                          {"spheres, 1000000 : 1", false, 1e-6, 1, 20},
                          {"spindles", true, 1, 1, 300},
                          {"spindles, 10 : 9", true, 0.9, 1, 300},
                          {"spindles, 100 : 1", true, 0.01, 1, 60},
                          {"spindles, 100000 : 1", true, 1e-5, 1, 60}};

/// Tips at +-size along the direction, a ring of half that radius around the middle.
Mesh make_spindle(const Vec3d& direction, double size) {
  Mesh mesh;
  const Vec3d along = size * direction.normalized();
  const Vec3d u = 0.5 * along.unitOrthogonal() * size;
  const Vec3d v = along.cross(u) / size;
  constexpr std::uint32_t sides = 7;
  mesh.vertices = {along, -along};
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 6.283185307179586 * i / sides;
    mesh.vertices.push_back(std::cos(angle) * u + std::sin(angle) * v);
    for (std::uint32_t tip : {0U, 1U}) {
      mesh.faces.push_back({Kind::tri, {tip, 2 + i, 2 + (i + 1) % sides, 0}});
    }
  }
  return mesh;
}

/// The middle of the mesh away from its origin, so that placing it takes sums that round.
Mesh shifted(Mesh mesh, const Vec3d& by) {
  for (Vec3d& v : mesh.vertices) v += by;
  return mesh;
}

/// What only just touches.
struct Touching {
  Pose a;
  Pose b;
};

bool hits(Search& search, const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b) {
  CollisionResult result;
  search.run({&a, &pose_a, &b, &pose_b}, {}, result);
  return result.hit;
}

Vec3d random_vector(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

/// \param along spindles: the direction of both
std::vector<Touching> make_touching(const Case& c, const Object& a, const Object& b, const Vec3d& along,
                                    std::mt19937_64& random) {
  const auto plain = make_plain_search();
  std::uniform_real_distribution<double> degrees(0, 360);
  std::vector<Touching> all;
  while (all.size() < static_cast<std::size_t>(c.count)) {
    const Vec3d place = c.distance * random_vector(random).normalized();
    Touching t;
    t.a = make_pose(place, 360 * random_vector(random));
    Pose turn(make_pose(Vec3d::Zero(), Vec3d(degrees(random), degrees(random), degrees(random))));
    // Outward from a vertex of A, where the surface of a small B crosses A's; or along the spindles.
    Vec3d from = t.a.linear() * a.mesh().vertices[random() % a.mesh().vertices.size()];
    if (c.spindles) {
      turn.linear() = t.a.linear() * Eigen::AngleAxisd(degrees(random), along.normalized()).toRotationMatrix();
      from = t.a.linear() * (1 + 0.9 * c.size_b) * along.normalized();
    }
    const Vec3d direction = from.normalized();
    const auto at = [&](double distance) {
      Pose pose = turn;
      pose.translation() = place + distance * direction;
      return pose;
    };
    double in = from.norm();
    double out = in + 4 * c.size_b;
    if (!hits(*plain, a, t.a, b, at(in)) || hits(*plain, a, t.a, b, at(out))) continue;
    for (int step = 0; step < 60; ++step) {
      const double middle = (in + out) / 2;
      (hits(*plain, a, t.a, b, at(middle)) ? in : out) = middle;
    }
    t.b = at(in);
    all.push_back(t);
  }
  return all;
}

}  // namespace

TEST_CASE("CPU device: bounds on rounding are enough, and none can be left out", "[ref][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  struct Mutant {
    const char* name;
    double Margins::*bound;
    std::size_t missed = 0;
  };
  Mutant mutants[] = {{"narrow", &Margins::narrow},
                      {"wide", &Margins::wide},
                      {"vertex", &Margins::vertex},
                      {"relation", &Margins::relation}};
  const std::string target = simd_targets().front();
  for (const Case& c : cases) {
    const Vec3d along(random() % 2 == 0 ? 1 : 0, random() % 2 == 0 ? 1 : 0, 1);
    const Vec3d shift(0.3, 0.2, 0.1);
    const Object a(c.spindles ? make_spindle(along, 1) : shifted(make_sphere(1, 12, 0.1, 1), shift));
    const Object b(c.spindles ? make_spindle(along, c.size_b) : make_sphere(c.size_b, 10, 0.1 * c.size_b, 2));
    const std::vector<Touching> queries = make_touching(c, a, b, along, random);
    const auto missed = [&](const std::string& name, const Margins& margins) {
      const auto search = make_simd_search(name, margins);
      std::size_t count = 0;
      for (const Touching& t : queries) {
        count += hits(*search, a, t.a, b, t.b) ? 0U : 1U;
        count += hits(*search, b, t.b, a, t.a) ? 0U : 1U;
      }
      return count;
    };
    for (const std::string& name : simd_targets()) {
      INFO(c.name << ", " << name);
      CHECK(missed(name, {}) == 0);
    }
    for (Mutant& mutant : mutants) {
      Margins margins;
      margins.*mutant.bound = 0;
      mutant.missed += missed(target, margins);
    }
  }
  for (const Mutant& mutant : mutants) {
    INFO("without the bound '" << mutant.name << "'");
    CHECK(mutant.missed > 0);
    std::printf("without the bound '%s': %zu hits missed\n", mutant.name, mutant.missed);
  }
}

TEST_CASE("CPU device: normals so short that products with them underflow separate nothing", "[ref][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double size) {
    const double x = unit(random);
    const double y = unit(random);
    return Vec3d(size * x, size * y, size * unit(random));
  };
  // In the middle of the fixed object lies a face whose normal is about 2^-149, the least number in single precision.
  // A corner of it is the origin, through which the plate goes.
  const auto with_tiny_face = [&](Kind kind) {
    Mesh mesh;
    mesh.vertices = {{1, 0, 0}, {1, 0.1, 0}, {1, 0, 0.1}, {-1, 0, 0}, {-1, -0.1, 0}, {-1, 0, -0.1}, {0, 0, 0}};
    const double size = std::ldexp(1 + std::abs(unit(random)), -90 + static_cast<int>(random() % 4));
    for (int i = 0; i < 3; ++i) mesh.vertices.push_back(vector(size));
    mesh.faces = {
        {Kind::tri, {0, 1, 2, 0}}, {Kind::tri, {3, 4, 5, 3}}, {kind, {6, 7, 8, kind == Kind::quad ? 9U : 6U}}};
    return mesh;
  };
  const auto plate = [](double size) {
    Mesh mesh;
    mesh.vertices = {{-size, -size, 0}, {3 * size, -size, 0}, {-size, 3 * size, 0}};
    mesh.faces = {{Kind::tri, {0, 1, 2, 0}}};
    return mesh;
  };
  for (const std::string& name : simd_targets()) {
    const auto search = make_simd_search(name);
    std::size_t missed = 0;
    for (int i = 0; i < 400; ++i) {
      const Object fixed(with_tiny_face(i % 2 == 0 ? Kind::tri : Kind::quad));
      const Object small(plate(i % 4 < 2 ? 0.001 : 0.2));
      const Pose turned = make_pose(Vec3d::Zero(), 360 * random_vector(random));
      missed += hits(*search, fixed, Pose::Identity(), small, turned) ? 0U : 1U;
    }
    INFO(name);
    CHECK(missed == 0);
  }
}
