// SPDX-License-Identifier: Apache-2.0
// The bounds on rounding that make the CPU device exact: enough, and each of them needed.
//
// Queries in which the objects only just touch: the pose of B is the last one in doubles, on a line away from A, in
// which the plain search, which shares no arithmetic with the others but exact predicates, finds a contact. Spindles
// that point at each other touch where bounding planes are as tight as they can be: their tips lie on a direction of
// the volumes of both. Bounds of whole objects in doubles are so fine that only what is far from the origin needs their
// margin: spindles for the line of the centres, a corner of a cube in a face of the other one for the edges of boxes.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "bvh_meshes.hpp"
#include "random_poses.hpp"
#include "search/far_test.hpp"
#include "search/relative_pose.hpp"
#include "search/search.hpp"

using namespace cchip;
using cchip_test::pose_classes;
using cchip_test::PoseClass;
using cchip_test::random_pose;

namespace {

enum class Shape { sphere, spindle, cube };

struct Case {
  const char* name;
  Shape shape;
  double size_b;    ///< A has size 1
  double distance;  ///< of both from the origin
  int count;
};
constexpr Case cases[] = {{"spheres", Shape::sphere, 1, 1, 40},
                          {"spheres far from the origin", Shape::sphere, 1, 1e13, 30},
                          {"spheres, 100 : 1", Shape::sphere, 0.01, 1, 30},
                          {"spheres, 1000000 : 1", Shape::sphere, 1e-6, 1, 20},
                          {"spindles", Shape::spindle, 1, 1, 300},
                          {"spindles, 10 : 9", Shape::spindle, 0.9, 1, 300},
                          {"spindles, 100 : 1", Shape::spindle, 0.01, 1, 60},
                          {"spindles, 100000 : 1", Shape::spindle, 1e-5, 1, 60},
                          {"spindles far from the origin", Shape::spindle, 1, 1e13, 300},
                          {"cubes far from the origin", Shape::cube, 1, 1e13, 300}};

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

Mesh make_cube(double size) { return testing::make_box(Vec3d::Constant(-size), Vec3d::Constant(size)); }

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

/// One of each instruction set.
std::vector<std::unique_ptr<Search>> all_simd_searches() {
  std::vector<std::unique_ptr<Search>> searches;
  for (const std::string& name : simd_targets()) searches.push_back(make_simd_search(name));
  return searches;
}

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
    if (c.shape == Shape::spindle) {
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

TEST_CASE("CPU device: bounds on rounding are enough, and none can be left out", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  struct Mutant {
    const char* name;
    double Margins::*bound;
    std::size_t missed = 0;
  };
  Mutant mutants[] = {{"far", &Margins::far},
                      {"narrow", &Margins::narrow},
                      {"wide", &Margins::wide},
                      {"vertex", &Margins::vertex},
                      {"relation", &Margins::relation}};
  const std::string target = simd_targets().front();
  for (const Case& c : cases) {
    const Vec3d along(random() % 2 == 0 ? 1 : 0, random() % 2 == 0 ? 1 : 0, 1);
    const Vec3d shift(0.3, 0.2, 0.1);
    const auto make = [&](bool is_a) {
      const double size = is_a ? 1 : c.size_b;
      if (c.shape == Shape::spindle) return make_spindle(along, size);
      if (c.shape == Shape::cube) return is_a ? shifted(make_cube(size), shift) : make_cube(size);
      return is_a ? shifted(make_sphere(1, 12, 0.1, 1), shift) : make_sphere(size, 10, 0.1 * size, 2);
    };
    const Object a(make(true));
    const Object b(make(false));
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
      const std::size_t count = missed(target, margins);
      mutant.missed += count;
      // Each of the two tests of whole objects needs it.
      if (mutant.bound == &Margins::far && c.distance > 1) {
        INFO(c.name);
        CHECK((count > 0 || c.shape == Shape::sphere));
        std::printf("%s, without the bound 'far': %zu hits missed\n", c.name, count);
      }
    }
  }
  for (const Mutant& mutant : mutants) {
    INFO("without the bound '" << mutant.name << "'");
    CHECK(mutant.missed > 0);
    std::printf("without the bound '%s': %zu hits missed\n", mutant.name, mutant.missed);
  }
}

TEST_CASE("CPU device: no map or size of objects that only just touch passes for apart", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const std::vector<Object> objects = {Object(make_spindle({1, 1, 0}, 1)), Object(make_cube(1)),
                                       Object(shifted(make_sphere(1, 1, 0.1, 1), {5, -3, 2}))};
  const auto plain = make_plain_search();
  const auto search = make_simd_search(simd_targets().front());
  // Beyond 2^+-100 the first look must not decide.
  for (const int exponent : {0, -40, 40, -90, 90, -98, 97, -150, 150, -400, 400}) {
    std::size_t asked = 0;
    std::size_t missed = 0;
    std::size_t wrong = 0;
    std::size_t at_a_look = 0;
    for (const PoseClass class_a : pose_classes) {
      for (const PoseClass class_b : pose_classes) {
        const Object& a = objects[random() % objects.size()];
        const Object& b = objects[random() % objects.size()];
        const auto scaled = [exponent](Pose pose) {
          for (int k = 0; k < 12; ++k) pose.data()[k + k / 3] = std::ldexp(pose.data()[k + k / 3], exponent);
          return pose;
        };
        const Pose pose_a = scaled(random_pose(class_a, 1, random));
        const Pose turn = scaled(random_pose(class_b, 1, random));
        const Vec3d on_a = pose_a * a.mesh().vertices[random() % a.mesh().vertices.size()];
        const Vec3d on_b = turn.linear() * b.mesh().vertices[random() % b.mesh().vertices.size()];
        const Vec3d direction = std::ldexp(20, exponent) * random_vector(random).normalized();
        const auto at = [&](double distance) {
          Pose pose = turn;
          pose.translation() = on_a - on_b + distance * direction;
          return pose;
        };
        double in = 0;
        double out = 1;
        if (!hits(*plain, a, pose_a, b, at(in)) || hits(*plain, a, pose_a, b, at(out))) continue;
        for (int step = 0; step < 60; ++step) {
          const double middle = (in + out) / 2;
          (hits(*plain, a, pose_a, b, at(middle)) ? in : out) = middle;
        }
        const Pose inside = at(in);
        missed += hits(*search, a, pose_a, b, inside) && hits(*search, b, inside, a, pose_a) ? 0U : 1U;
        const Pose outside = at(1);
        CollisionResult result;
        search->run({&a, &pose_a, &b, &outside}, {}, result);
        wrong += result.hit ? 1U : 0U;
        at_a_look += result.stats.steps == 0 ? 1U : 0U;
        ++asked;
      }
    }
    INFO("2^" << exponent << ": " << asked << " pairs of poses, " << at_a_look << " apart at the first look");
    CHECK(asked > 30);
    CHECK(missed == 0);
    CHECK(wrong == 0);
    if (std::abs(exponent) <= 40) CHECK(2 * at_a_look > asked);
    if (std::abs(exponent) > 100) CHECK(at_a_look == 0);
  }
}

TEST_CASE("CPU device: normals so short that products with them underflow separate nothing", "[lib][collide]") {
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

namespace {

/// \returns whether the SIMD search takes the query
bool relates(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b, RelativePose& relation) {
  const CollisionQuery query = {&a, &pose_a, &b, &pose_b};
  return relate(query, centre_line(query), 0, relation);
}

}  // namespace

TEST_CASE("CPU device: maps whose products would leave single precision go to the plain search", "[lib][collide]") {
  const Object cube(make_cube(1));
  Pose half = Pose::Identity();
  half.linear() *= 0.5;
  const auto flattened = [](double factor) {
    Pose pose = Pose::Identity();
    pose(2, 2) = factor;
    return pose;
  };
  // M = diag(1/2, 1/2, 1/2 / factor); its norm is the last entry, but for less than half a unit in the last place.
  RelativePose r;
  CHECK(relates(cube, half, cube, flattened(0x1p-25), r));
  CHECK(r.norm >= 0x1p24);
  CHECK(r.norm < 0x1p24 + 1);
  CHECK(relates(cube, half, cube, flattened(std::nextafter(0x1p-27, 1)), r));
  CHECK(r.norm < 0x1p26);
  CHECK(r.norm > 0x1.fffffp25);
  // The greatest triple product of the search at this bound: two edges of the moved object and a vector between
  // vertices of both, at the greatest distance.
  const double edge = 2.0 * bvh::support_most * r.norm;
  CHECK(edge * edge * (bvh::support_most * (r.norm + 1) + 0x1p40) < std::numeric_limits<float>::max());
  for (const double factor : {0x1p-27, 0x1p-28, 0x1p-42, 0x1p-61}) {
    CAPTURE(factor);
    CHECK_FALSE(relates(cube, half, cube, flattened(factor), r));
    CHECK_FALSE(relates(cube, flattened(factor), cube, half, r));
  }
}

TEST_CASE("CPU device: answers are exact on both sides of the bound on maps", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const std::vector<Object> objects = {Object(make_spindle({1, 1, 0}, 1)), Object(make_cube(1)),
                                       Object(shifted(make_sphere(1, 4, 0.1, 1), {0.5, -0.3, 0.2}))};
  const auto plain = make_plain_search();
  const auto searches = all_simd_searches();
  const auto turn = [&random] {
    return Eigen::AngleAxisd(random_vector(random).norm(), random_vector(random).normalized()).toRotationMatrix();
  };
  CollisionRequest all_contacts{CollisionRequest::Contacts::all};
  all_contacts.relation = true;
  for (const int exponent : {20, 24, 25, 26, 27, 28, 41, 60}) {
    std::size_t asked = 0;
    std::size_t taken = 0;
    std::size_t wrong = 0;
    double greatest = 0;
    for (int i = 0; i < 40; ++i) {
      // Flattened to a plate or drawn to a needle, with and without rotations beside it.
      const Object& flat = objects[random() % objects.size()];
      const Object& other = objects[random() % objects.size()];
      const double least = std::ldexp(1, -exponent);
      Pose pose = Pose::Identity();
      pose.linear() = Vec3d(1, random() % 2 == 0 ? 1 : least, least).asDiagonal();
      if (i % 2 == 0) pose.linear() = turn() * pose.linear() * turn();
      Pose turned = Pose::Identity();
      turned.linear() = (i % 4 < 2 ? Eigen::Matrix3d(turn()) : Eigen::Matrix3d::Identity()) * 0.5;
      const Vec3d on_flat = pose * flat.mesh().vertices[random() % flat.mesh().vertices.size()];
      const Vec3d on_other = turned.linear() * other.mesh().vertices[random() % other.mesh().vertices.size()];
      const Vec3d direction = 8 * random_vector(random).normalized();
      const auto at = [&](double distance) {
        Pose moved = turned;
        moved.translation() = on_flat - on_other + distance * direction;
        return moved;
      };
      double in = 0;
      double out = 1;
      if (!hits(*plain, flat, pose, other, at(in)) || hits(*plain, flat, pose, other, at(out))) continue;
      for (int step = 0; step < 60; ++step) {
        const double middle = (in + out) / 2;
        (hits(*plain, flat, pose, other, at(middle)) ? in : out) = middle;
      }
      ++asked;
      RelativePose relation;
      if (relates(flat, pose, other, at(in), relation)) {
        taken += relation.swapped ? 1U : 0U;  // otherwise the flat one moves, and the map is small
        greatest = std::max(greatest, relation.norm);
        for (const double x : relation.m) wrong += std::isfinite(x) ? 0U : 1U;
      }
      for (const double distance : {0.0, in / 2, in, out}) {
        const Pose there = at(distance);
        for (const bool swapped : {false, true}) {
          const CollisionQuery query =
              swapped ? CollisionQuery{&other, &there, &flat, &pose} : CollisionQuery{&flat, &pose, &other, &there};
          CollisionResult expected;
          plain->run(query, all_contacts, expected);
          for (const auto& search : searches) {
            CollisionResult result;
            search->run(query, all_contacts, result);
            wrong += result.contacts == expected.contacts && result.relation == expected.relation ? 0U : 1U;
            search->run(query, {}, result);
            wrong += result.hit == expected.hit ? 0U : 1U;
          }
        }
      }
    }
    INFO("2^" << exponent << ": " << asked << " pairs of poses, " << taken << " taken");
    CHECK(asked > 10);
    CHECK(wrong == 0);
    CHECK(greatest < 0x1p26);
    if (exponent < 26) CHECK(greatest > std::ldexp(1, exponent - 3));
    if (exponent < 26) CHECK(2 * taken > asked);
    if (exponent > 28) CHECK(taken == 0);
  }
}

namespace {

/// One to four faces with whole coordinates up to `most`; two triangles with a common side make a leaf of their own
/// kind.
Mesh whole_faces(std::size_t kind, int least, int most, std::mt19937_64& random) {
  const auto whole = [&] { return least + static_cast<double>(random() % static_cast<unsigned>(most - least + 1)); };
  const auto point = [&] {
    const double x = whole();
    const double y = whole();
    return Vec3d(x, y, whole());
  };
  Mesh mesh;
  if (kind < 4) {
    for (std::size_t i = 0; i <= kind; ++i) testing::add_face(mesh, {point(), point(), point()});
    return mesh;
  }
  for (int i = 0; i < 4; ++i) mesh.vertices.push_back(point());
  mesh.vertices[3] = mesh.vertices[0] + mesh.vertices[2] - mesh.vertices[1];
  if (kind == 4) mesh.faces = {{Kind::quad, {0, 1, 2, 3}}};
  if (kind == 5) mesh.faces = {{Kind::tri, {0, 1, 2, 0}}, {Kind::tri, {0, 2, 3, 0}}};
  return mesh;
}

}  // namespace

TEST_CASE("CPU device: small objects at the faces of great ones, whole numbers", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const auto plain = make_plain_search();
  const auto searches = all_simd_searches();
  std::array<std::size_t, 2> seen = {0, 0};
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < 720; ++i) {
    const Mesh great_mesh = whole_faces(i % 6, -2, 2, random);
    const Object great(great_mesh);
    const Object small(whole_faces(i / 6 % 6, 0, 3, random));  // most of them to one side of where they are placed
    const double size = std::ldexp(1, -6 - static_cast<int>(random() % 4));
    Pose pose = Pose::Identity();
    if (i % 2 == 1) pose.linear() = make_pose(Vec3d::Zero(), 360 * random_vector(random)).linear();
    pose.linear() *= size;
    // At a corner, on a side or within a face, and a little beside it.
    const Primitive face = great_mesh.primitive(random() % great_mesh.faces.size());
    const Vec3d in = (2 * face.v[0] + face.v[random() % 3] + face.v[random() % 3]) / 4;
    pose.translation() = in + size * whole_faces(0, -2, 2, random).vertices[0];
    if (i % 3 == 0) pose.translation() = in - pose.linear() * small.mesh().vertices[0];
    const bool hit = hits(*plain, great, Pose::Identity(), small, pose);
    ++seen[hit ? 1 : 0];
    for (const auto& search : searches) {
      wrong += hits(*search, great, Pose::Identity(), small, pose) == hit ? 0U : 1U;
      wrong += hits(*search, small, pose, great, Pose::Identity()) == hit ? 0U : 1U;
    }
  }
  CAPTURE(sim::seed_from_environment());
  CHECK(wrong == 0);
  CHECK(seen[0] > 100);
  CHECK(seen[1] > 100);
}

TEST_CASE("CPU device: flat bricks that touch, aside of each other by whole numbers", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const auto searches = all_simd_searches();
  const std::array<Vec3d, 6> halves = {Vec3d(1, 4, 1), Vec3d(4, 1, 1), Vec3d(1, 1, 4),
                                       Vec3d(1, 4, 4), Vec3d(4, 4, 1), Vec3d(1, 2, 4)};
  std::vector<Object> bricks;
  for (const Vec3d& half : halves) bricks.emplace_back(testing::make_box(-half, half));
  const Pose here = Pose::Identity();
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    for (std::size_t k = 0; k < bricks.size(); ++k) {
      const Vec3d sum = halves[i] + halves[k];
      for (int n = 0; n < 9; ++n) {
        // Face against face along one axis; at most to the edges or corners along the others.
        const auto axis = static_cast<Eigen::Index>(n % 3);
        Pose there = Pose::Identity();
        for (Eigen::Index c = 0; c < 3; ++c) {
          there(c, 3) = static_cast<double>(random() % static_cast<unsigned>(2 * sum[c] + 1)) - sum[c];
        }
        there(axis, 3) = n % 2 == 0 ? sum[axis] : -sum[axis];
        Pose beyond = there;
        beyond(axis, 3) *= 1 + 0x1p-40;
        for (const auto& search : searches) {
          wrong += hits(*search, bricks[i], here, bricks[k], there) ? 0U : 1U;
          wrong += hits(*search, bricks[i], here, bricks[k], beyond) ? 1U : 0U;
        }
      }
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("CPU device: small cubes on a plate whose plane is as tight as can be", "[lib][collide]") {
  // The unit is 1 + 2^-40 here, so that the plate lies hardly below 4000 units from the middle.
  Mesh mesh;
  testing::add_face(mesh, {{-9, -9, 4000}, {30, -9, 4000}, {-9, 30, 4000}});
  testing::add_face(mesh, {{-9, -9, -4000}, {-30, -9, -4000}, {-9, -30, -4000}});
  for (const double x : {-1, 1}) {
    testing::add_face(mesh, {{x * 29000, 0, 0}, {x * 28000, 0, 100}, {x * 28000, 100, 0}});
    testing::add_face(mesh, {{0, x * 28000, 0}, {0, x * 27000, 100}, {100, x * 27000, 0}});
  }
  const Object great(mesh);
  const Object cube(make_cube(1));
  for (const std::string& name : simd_targets()) {
    const auto search = make_simd_search(name);
    for (int exponent = -8; exponent <= 8; ++exponent) {
      Pose on = Pose::Identity();
      on.linear() *= std::ldexp(1, exponent);
      on(2, 3) = 4000 + std::ldexp(1, exponent);
      Pose over = on;
      over(2, 3) += std::ldexp(1, exponent - 4);
      CAPTURE(name, exponent);
      CHECK(hits(*search, great, Pose::Identity(), cube, on));
      CHECK(hits(*search, cube, on, great, Pose::Identity()));
      CHECK_FALSE(hits(*search, cube, over, great, Pose::Identity()));
    }
  }
}

TEST_CASE("CPU device: meshes far from their origin, flattened, touch as exactly", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const auto searches = all_simd_searches();
  // Along (1, -1, 0) the map leaves next to nothing of the objects, but not of what placing them costs in doubles. The
  // last column is about as long as the others together.
  constexpr double thin = 1.5 * 0x1p-8;
  Pose map = Pose::Identity();
  map.linear() << (1 + thin) / 2, (1 - thin) / 2, 0, (1 - thin) / 2, (1 + thin) / 2, 0, 0, 0, 2 - 0x1p-5;
  const auto around = [](const Vec3d& c) {
    Mesh mesh;
    const std::array<Vec3d, 2> sides = {Vec3d(0.25, 0.25, 0), Vec3d(0, 0, 0.25)};
    for (const double tip : {-1, 1}) {
      for (const double x : {-1, 1}) {
        testing::add_face(mesh, {c + tip * Vec3d(1, -1, 0), c + x * sides[0], c + sides[1]});
        testing::add_face(mesh, {c + tip * Vec3d(1, -1, 0), c + x * sides[0], c - sides[1]});
      }
    }
    return mesh;
  };
  std::size_t missed = 0;
  for (int i = 0; i < 60; ++i) {
    const auto whole = [&random](double most) { return std::round(most * random_vector(random)[0]); };
    Vec3d centre;
    Vec3d other;
    for (Eigen::Index k = 0; k < 3; ++k) {
      centre[k] = std::ldexp(whole(0x1p50), -6);
      other[k] = centre[k] + whole(8);
    }
    Pose pose_b = map;
    pose_b.translation() = map.linear() * (centre - other) + 2 * thin * Vec3d(1, -1, 0);  // whole numbers: exact
    const Object a(around(centre));
    const Object b(around(other));
    for (const auto& search : searches) missed += hits(*search, a, map, b, pose_b) ? 0U : 1U;
  }
  CHECK(missed == 0);
}

TEST_CASE("CPU device: a corner in the plane of a plate, far off, is not lost", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const auto searches = all_simd_searches();
  const auto on_grid = [](const Vec3d& v) { return Vec3d((v * 1024).array().round() / 1024); };
  for (const bool concentric : {true, false}) {  // or the other object is small
    std::size_t missed = 0;
    for (int asked = 0; asked < 150;) {
      Pose map = make_pose(Vec3d::Zero(), 360 * random_vector(random));
      for (Eigen::Index i = 0; i < 3; ++i) map.linear().col(i) = on_grid(map.linear().col(i));
      const Vec3d corner = on_grid(random_vector(random).normalized());
      const Vec3d p = on_grid(corner + 0.1 * random_vector(random));
      const Vec3d q = on_grid(corner + 0.1 * random_vector(random));
      Vec3d at = map.linear() * corner;
      const double least = at.z() + 0.01;
      if (at.z() < 0.5 || (map.linear() * p).z() < least || (map.linear() * q).z() < least) continue;
      ++asked;
      Mesh corners;
      testing::add_face(corners, {corner, p, q});
      if (concentric) {
        testing::add_face(corners, {-0.99 * corner, -0.99 * p, -0.99 * q});  // beyond the plate there
      } else {
        const Vec3d place = on_grid(random_vector(random).normalized());
        map.linear() *= 0x1p-8;
        map.translation() = place;
        at = place + 0x1p-8 * at;
      }
      // A plate along the axes; the corner is near one of its own, which makes the bounds as small as they can be.
      Mesh plate;
      const Vec3d from = at - Vec3d(0x1p-14, 0x1p-14, 0);
      for (const double side : {1.0, -0.97}) {
        testing::add_face(plate,
                          {side * from, side * (from + Vec3d(0.0625, 0, 0)), side * (from + Vec3d(0, 0.0625, 0))});
      }
      const Object a(plate);
      const Object b(corners);
      for (const auto& search : searches) {
        missed += hits(*search, a, Pose::Identity(), b, map) ? 0U : 1U;
        missed += hits(*search, b, map, a, Pose::Identity()) ? 0U : 1U;
      }
    }
    CAPTURE(concentric);
    CHECK(missed == 0);
  }
}

TEST_CASE("CPU device: cubes of the greatest coordinates under the least maps touch", "[lib][collide]") {
  // The products of the map with a direction of the world are 0 in doubles.
  const Object great(make_cube(0x1p1000));
  const Object cube(make_cube(1));
  Pose least = Pose::Identity();
  least.linear() *= 0x1p-1074;
  Pose small = Pose::Identity();
  small.linear() *= 0x1p-74;
  for (const std::string& name : simd_targets()) {
    const auto search = make_simd_search(name);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Pose there = small;
      there(axis, 3) = 0x1p-73;
      CAPTURE(name, axis);
      CHECK(hits(*search, cube, there, great, least));
      CHECK(hits(*search, great, least, cube, there));
      there(axis, 3) = 0x1.0001p-73;
      CHECK_FALSE(hits(*search, cube, there, great, least));
      CHECK_FALSE(hits(*search, great, least, cube, there));
    }
  }
}

TEST_CASE("CPU device: faces that lie in no double, so small they are", "[lib][collide]") {
  // The centres of the objects in the world underflow, but one map for both changes nothing.
  std::mt19937_64 random(sim::seed_from_environment());
  const auto plain = make_plain_search();
  const auto searches = all_simd_searches();
  std::array<std::size_t, 2> seen = {0, 0};
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    Mesh a = whole_faces(i % 6, 0, 3, random);
    Mesh b = whole_faces(i / 6 % 6, 0, 3, random);
    const bool hit = hits(*plain, Object(a), Pose::Identity(), Object(b), Pose::Identity());
    ++seen[hit ? 1 : 0];
    for (Mesh* mesh : {&a, &b}) {
      for (Vec3d& v : mesh->vertices) v *= 0x1p-980;
    }
    Pose small = Pose::Identity();
    small.linear() *= std::ldexp(1, -20 * static_cast<int>(1 + random() % 9));
    const Object object_a(a);
    const Object object_b(b);
    wrong += hits(*plain, object_a, small, object_b, small) == hit ? 0U : 1U;
    for (const auto& search : searches) wrong += hits(*search, object_a, small, object_b, small) == hit ? 0U : 1U;
  }
  CHECK(wrong == 0);
  CHECK(seen[0] > 20);
  CHECK(seen[1] > 20);
}

TEST_CASE("CPU device: each instruction set has its own name", "[lib][collide]") {
  std::vector<std::string> names = cpu_targets();
  CHECK(names.back() == "plain");
  std::sort(names.begin(), names.end());
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
}
