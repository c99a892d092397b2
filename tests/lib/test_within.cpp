// SPDX-License-Identifier: Apache-2.0
// Queries within a distance against brute force over all faces.
#include <catch2/catch.hpp>
#include <cchip/device.hpp>
#include <cchip/distance.hpp>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cchip/scene.hpp>
#include <cmath>
#include <iostream>
#include <limits>

#include "bvh_meshes.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip::testing;
using cchip_test::PoseClass;
using cchip_test::random_pose;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

CollisionRequest all_within(double d) {
  CollisionRequest request = {CollisionRequest::Contacts::all};
  request.within = d;
  return request;
}

/// Pairs of faces that are at most d apart; `test distance: faces*` tests what decides them.
std::vector<Contact> brute_force(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b, double d) {
  const PosedDistances distances(pose_a, pose_b);
  std::vector<Contact> found;
  for (std::uint32_t i = 0; i < a.faces.size(); ++i) {
    for (std::uint32_t k = 0; k < b.faces.size(); ++k) {
      if (distances.within(a.primitive(i), b.primitive(k), d).hit) found.push_back({i, k, std::nullopt});
    }
  }
  return found;
}

/// The same for the distance itself.
DistanceBounds least_distance(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b) {
  const PosedDistances distances(pose_a, pose_b);
  DistanceBounds least;
  least.lower = least.upper = infinity;
  for (std::uint32_t i = 0; i < a.faces.size(); ++i) {
    for (std::uint32_t k = 0; k < b.faces.size(); ++k) {
      const Primitive p = a.primitive(i);
      const Primitive q = b.primitive(k);
      if (distances.bounds(p, q).lower > least.upper) continue;
      const DistanceBounds here = distances.tight_bounds(p, q);
      least.lower = std::min(least.lower, here.lower);
      least.upper = std::min(least.upper, here.upper);
    }
  }
  return least;
}

/// All devices without a simulator, each instruction set of the CPU.
std::vector<std::unique_ptr<Device>> all_devices() {
  std::vector<std::unique_ptr<Device>> devices;
  for (const std::string& target : cpu_targets()) devices.push_back(open_cpu_device({2, target}));
  for (const std::string& name : device_names()) {
    if (name != "cpu") devices.push_back(open_device(name));
  }
  return devices;
}

std::vector<Mesh> meshes_of(std::mt19937_64& random) {
  Mesh plate;  // on a grid
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) {
      const Vec3d p = Vec3d(i, k, 0) * 0.25;
      add_face(plate, {p, p + Vec3d(0.25, 0, 0), p + Vec3d(0.25, 0.25, 0), p + Vec3d(0, 0.25, 0)});
    }
  }
  Mesh tiny = make_torus(1, 0.4, 4, 3);
  for (Vec3d& v : tiny.vertices) v *= 1e-3;
  return {make_torus(1, 0.4, 8, 5),
          noisy(make_torus(1, 0.4, 6, 4, Kind::quad), 0.05, random),
          make_gear(0.8, 1.2, 0.3, 0.5, 3, 1),
          soup(20, false, random),
          plate,
          tiny,
          make_box({0, 0, 0}, {1, 1, 1})};
}

}  // namespace

TEST_CASE("within: first and all contacts are those of brute force", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 40);
  const std::vector<Mesh> meshes = meshes_of(random);
  std::vector<Object> objects(meshes.begin(), meshes.end());
  const auto devices = all_devices();
  int queries = 0;
  int hits = 0;
  int only_near = 0;
  for (int round = 0; round < 12; ++round) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      for (std::size_t k = 0; k < meshes.size(); ++k) {
        const PoseClass c = cchip_test::pose_classes[random() % std::size(cchip_test::pose_classes)];
        const double range = std::ldexp(4.0, -static_cast<int>(random() % 3));
        const Pose pose_a = random_pose(c, range, random);
        const Pose pose_b = random_pose(random() % 2 == 0 ? c : PoseClass::rigid, range, random);
        const double d = std::array<double, 5>{0, 0x1p-10, 0.25, 1, 3}[random() % 5];
        const std::vector<Contact> expected = brute_force(meshes[i], pose_a, meshes[k], pose_b, d);
        const bool touches = collide(objects[i], pose_a, objects[k], pose_b).hit;
        ++queries;
        hits += !expected.empty();
        only_near += !expected.empty() && !touches;
        for (const auto& device : devices) {
          CAPTURE(device->name(), round, i, k, d, sim::seed_from_environment());
          const CollisionResult found = collide(*device, objects[i], pose_a, objects[k], pose_b, all_within(d));
          REQUIRE(same_faces(found.contacts, expected));
          REQUIRE(found.hit == !expected.empty());
          const CollisionResult first = within(*device, objects[i], pose_a, objects[k], pose_b, d);
          REQUIRE(first.hit == found.hit);
          REQUIRE(first.contacts.size() == (found.hit ? 1 : 0));
          REQUIRE((!found.hit || std::binary_search(expected.begin(), expected.end(), first.contacts[0])));
          REQUIRE((d != 0 || found.hit == touches));
        }
      }
    }
  }
  std::cout << "queries=" << queries << " hits=" << hits << " near=" << only_near << '\n';
  CHECK(queries == 588);
  CHECK(only_near > 100);
  CHECK(hits < queries * 9 / 10);
}

TEST_CASE("within: the last bit of the distance", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 41);
  const Mesh a = make_torus(1, 0.4, 30, 17);  // 1,020 triangles
  const Mesh b = noisy(make_torus(0.8, 0.3, 30, 17), 0.01, random);
  const Object first(a);
  const Object second(b);
  const auto devices = all_devices();
  for (int round = 0; round < 6; ++round) {
    const PoseClass c =
        std::array<PoseClass, 3>{PoseClass::rigid, PoseClass::far_away, PoseClass::affine}[random() % 3];
    const Pose pose_a = random_pose(c, 1, random);
    Pose pose_b = random_pose(c, 1, random);
    pose_b.translation() = pose_a.translation() + (2.5 + round) * random_vector(random, 1).normalized();
    const DistanceBounds least = least_distance(a, pose_a, b, pose_b);
    if (least.upper == 0) continue;
    REQUIRE(least.lower < least.upper);
    for (const auto& device : devices) {
      CAPTURE(device->name(), round, least.lower, least.upper);
      CHECK_FALSE(within(*device, first, pose_a, second, pose_b, least.lower).hit);
      CHECK(within(*device, first, pose_a, second, pose_b, least.upper).hit);
      CHECK(within(*device, second, pose_b, first, pose_a, least.upper).hit);
      CHECK_FALSE(within(*device, second, pose_b, first, pose_a, least.lower).hit);
      CHECK(within(*device, first, pose_a, second, pose_b, 1e30).hit);
      CHECK(within(*device, first, pose_a, second, pose_b, std::numeric_limits<double>::max()).hit);
      // Twice as large, and in a mirror: nothing rounds.
      for (const double x : {2.0, -1.0}) {
        Pose scaled_a = pose_a;
        Pose scaled_b = pose_b;
        Eigen::DiagonalMatrix<double, 3> map(x, x > 0 ? x : 1, x > 0 ? x : 1);
        scaled_a.linear() = map * pose_a.linear();
        scaled_a.translation() = map * pose_a.translation();
        scaled_b.linear() = map * pose_b.linear();
        scaled_b.translation() = map * pose_b.translation();
        CHECK_FALSE(within(*device, first, scaled_a, second, scaled_b, std::abs(x) * least.lower).hit);
        CHECK(within(*device, first, scaled_a, second, scaled_b, std::abs(x) * least.upper).hit);
      }
    }
  }
}

TEST_CASE("within: plates exactly as far apart as asked for, wherever they are", "[lib][distance]") {
  const Object box(make_box({0, 0, 0}, {1, 1, 1}));
  const auto devices = all_devices();
  const double gap = 0x1p-6;
  for (const double shift : {0.0, 1024.0, 0x1p40}) {
    Pose pose_a = Pose::Identity();
    Pose pose_b = Pose::Identity();
    pose_a.translation() = Vec3d(shift, shift, -shift);
    pose_b.translation() = pose_a.translation() + Vec3d(1 + gap, 0.25, 0.25);
    for (const auto& device : devices) {
      CAPTURE(device->name(), shift);
      CHECK(within(*device, box, pose_a, box, pose_b, gap).hit);
      CHECK_FALSE(within(*device, box, pose_a, box, pose_b, std::nextafter(gap, 0.0)).hit);
      // The flush faces, and each with those four beside the other one.
      CHECK(collide(*device, box, pose_a, box, pose_b, all_within(gap)).contacts ==
            brute_force(box.mesh(), pose_a, box.mesh(), pose_b, gap));
      // A corner over a corner: the distance is the root of 14, which no double is.
      Pose away = pose_a;
      away.translation() += Vec3d(2, 3, 4);  // gaps of 1, 2 and 3
      CHECK(within(*device, box, pose_a, box, away, std::sqrt(14.0)).hit == (std::sqrt(14.0L) <= std::sqrt(14.0)));
    }
  }
}

TEST_CASE("within: scenes and batches", "[lib][distance]") {
  const Object box(make_box({0, 0, 0}, {1, 1, 1}));
  const auto device = open_device("cpu");
  Scene scene;
  std::vector<Scene::Id> ids;
  for (int i = 0; i < 5; ++i) {
    Pose pose = Pose::Identity();
    pose.translation().x() = 1.5 * i;  // gaps of 1/2
    ids.push_back(scene.add(box, pose));
  }
  CollisionRequest request;
  CHECK(scene.contacts(*device, request).empty());
  request.within = std::nextafter(0.5, 0.0);
  CHECK(scene.contacts(*device, request).empty());
  request.within = 0.5;
  CHECK(scene.contacts(*device, request).size() == 4);
  CHECK(scene.contacts(*device, ids[1], request).size() == 2);
  CHECK(scene.contacts(*device, {box, Pose(Eigen::Translation3d(-1.5, 0, 0))}, request).size() == 1);
  request.within = 2;
  CHECK(scene.contacts(*device, request).size() == 4 + 3);
  std::vector<PosePair> poses(100);
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].b.translation().y() = 1 + 0x1p-5 * static_cast<double>(i);
  const std::vector<CollisionResult> results = collide(*device, box, box, poses, request);
  for (std::size_t i = 0; i < poses.size(); ++i) CHECK(results[i].hit == (i <= 64));
}

TEST_CASE("within: requests that make no sense", "[lib][distance]") {
  const Object box(make_box({0, 0, 0}, {1, 1, 1}));
  const auto refuses = [&box](const CollisionRequest& request, const std::string& what) {
    CHECK_THROWS_WITH(collide(box, Pose::Identity(), box, Pose::Identity(), request), Catch::Contains(what));
  };
  CollisionRequest request;
  for (const double d : {-1.0, infinity, std::nan("")}) {
    request.within = d;
    refuses(request, "ask for a distance that is finite and at least 0");
  }
  request.within = 1;
  request.relation = true;
  refuses(request, "faces at a distance neither touch nor cross");
  request.relation = false;
  request.least = Relation::crossing;
  refuses(request, "faces at a distance neither touch nor cross");
}

TEST_CASE("distance: the interval is that of brute force", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 42);
  const std::vector<Mesh> meshes = meshes_of(random);
  std::vector<Object> objects(meshes.begin(), meshes.end());
  int apart = 0;
  int exact = 0;
  for (int round = 0; round < 6; ++round) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      for (std::size_t k = 0; k < meshes.size(); ++k) {
        const PoseClass c = cchip_test::pose_classes[random() % std::size(cchip_test::pose_classes)];
        const Pose pose_a = random_pose(c, 4, random);
        const Pose pose_b = random_pose(random() % 2 == 0 ? c : PoseClass::rigid, 4, random);
        CAPTURE(round, i, k, sim::seed_from_environment());
        const DistanceBounds expected = least_distance(meshes[i], pose_a, meshes[k], pose_b);
        const DistanceResult found = distance(objects[i], pose_a, objects[k], pose_b);
        REQUIRE(found.lower == expected.lower);
        REQUIRE(found.upper == expected.upper);
        REQUIRE((found.upper == 0) == collide(objects[i], pose_a, objects[k], pose_b).hit);
        apart += found.upper > 0;
        exact += found.upper > 0 && found.lower == found.upper;
        // The points are as far apart, and lie on the faces; the coordinates of far objects round more.
        const double size = found.point_a.cwiseAbs().maxCoeff() + found.upper + 4;
        REQUIRE(std::abs((found.point_a - found.point_b).norm() - found.upper) < 1e-12 * size);
        Mesh point;
        add_face(point, {found.point_a, found.point_a, found.point_a});
        Mesh face;
        face.vertices = meshes[i].vertices;
        face.faces = {meshes[i].faces[found.face_a]};
        REQUIRE(least_distance(face, pose_a, point, Pose::Identity()).lower < 1e-12 * size);
        // Swapped, and with an error that the caller allows.
        const DistanceResult swapped = distance(objects[k], pose_b, objects[i], pose_a);
        REQUIRE(swapped.lower == found.lower);
        REQUIRE(swapped.upper == found.upper);
        DistanceRequest rough;
        rough.rel_error = 0.25;
        const DistanceResult near = distance(objects[i], pose_a, objects[k], pose_b, rough);
        REQUIRE(near.lower <= found.upper);
        REQUIRE(near.upper >= found.lower);
        REQUIRE(near.upper - near.lower <= 0.25 * near.upper);
        // A limit below, at and above the distance.
        for (const double limit : {0.5 * found.lower, std::nextafter(found.lower, 0.0), found.upper, 2 * found.upper}) {
          DistanceRequest request;
          request.stop_above = limit;
          const DistanceResult stopped = distance(objects[i], pose_a, objects[k], pose_b, request);
          if (found.lower > limit) {
            REQUIRE(stopped.upper == infinity);
            REQUIRE(stopped.lower == limit);
          } else {
            REQUIRE(stopped.lower == found.lower);
            REQUIRE(stopped.upper == found.upper);
          }
        }
      }
    }
  }
  std::cout << "apart=" << apart << " exact=" << exact << '\n';
  CHECK(apart > 150);
}

TEST_CASE("distance: nested surfaces, many pairs as near", "[lib][distance]") {
  std::mt19937_64 random(sim::seed_from_environment() + 47);
  std::uint64_t most_steps = 0;
  for (const double size : {1.05, 1.2, 2.0}) {
    for (const bool is_uneven : {false, true}) {
      Mesh inner = make_sphere(1, 5);
      if (is_uneven) {
        for (Vec3d& v : inner.vertices) v *= 1 + 0.15 * std::sin(5 * v.x()) * std::cos(4 * v.y());
      }
      Mesh outer = inner;
      for (Vec3d& v : outer.vertices) v *= size;
      const Object a(inner);
      const Object b(outer);
      for (const bool is_turned : {false, true}) {
        Pose pose = random_pose(PoseClass::rigid, 4, random);
        if (!is_turned) pose.linear().setIdentity();
        CAPTURE(size, is_uneven, is_turned, sim::seed_from_environment());
        const DistanceBounds expected = least_distance(inner, pose, outer, pose);
        const DistanceResult found = distance(a, pose, b, pose);
        REQUIRE(found.lower == expected.lower);
        REQUIRE(found.upper == expected.upper);
        DistanceRequest rough;
        rough.rel_error = 0.01;
        const DistanceResult near = distance(b, pose, a, pose, rough);
        REQUIRE(near.lower <= found.upper);
        REQUIRE(near.upper >= found.lower);
        REQUIRE(near.upper - near.lower <= 0.01 * near.upper);
        most_steps = std::max(most_steps, found.stats.steps);
      }
    }
  }
  CHECK(most_steps > 500);  // long enough that slabs were asked
}

TEST_CASE("distance: faces and points are those of each object, not of the other", "[lib][distance]") {
  // Of the second object the last of three faces is the nearest, of the first the only one.
  Mesh one;
  add_face(one, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  for (const double z : {2.0, 0.0}) {
    Mesh three;
    for (const double at : {9.0, 5.0, z}) add_face(three, {{0.25, 0.25, at}, {3, 3, at + 1}, {3, 4, at + 1}});
    const DistanceResult to = distance(Object(one), Pose::Identity(), Object(three), Pose::Identity());
    CAPTURE(z);
    CHECK(to.lower == z);
    CHECK(to.upper == z);
    CHECK(to.face_a == 0);
    CHECK(to.face_b == 2);
    CHECK(to.point_a == Vec3d(0.25, 0.25, 0));
    CHECK(to.point_b == Vec3d(0.25, 0.25, z));
    CHECK(to.stats.pairs == 1);
    const DistanceResult back = distance(Object(three), Pose::Identity(), Object(one), Pose::Identity());
    CHECK(back.lower == z);
    CHECK(back.face_a == 2);
    CHECK(back.face_b == 0);
    CHECK(back.point_a == Vec3d(0.25, 0.25, z));
    CHECK(back.point_b == Vec3d(0.25, 0.25, 0));
  }
}

TEST_CASE("distance: exact at any size, subnormal numbers too, and far below the rounding of coordinates",
          "[lib][distance]") {
  const Pose here = Pose::Identity();
  Mesh corner;
  add_face(corner, {{0, 0, 0}, {-4, 0, 0}, {0, -4, 0}});
  Mesh across;
  add_face(across, {{3, 4, 0}, {8, 4, 0}, {3, 8, 1}});
  for (const int exponent : {-1071, -1040, -700, -520, -340, 0, 340, 500, 700, 996}) {
    CAPTURE(exponent);
    const Object first(scaled(corner, std::ldexp(1, exponent)));
    const Object second(scaled(across, std::ldexp(1, exponent)));
    const DistanceResult found = distance(first, here, second, here);
    CHECK(found.lower == std::ldexp(5, exponent));
    CHECK(found.upper == std::ldexp(5, exponent));
    CHECK(within(first, here, second, here, found.upper).hit);
    CHECK_FALSE(within(first, here, second, here, std::nextafter(found.upper, 0.0)).hit);
    // The same in the world, from poses that enlarge or reduce as far as they may.
    for (const int pose : {500, -510}) {
      if (exponent - pose > 996 || exponent - pose < -1071) continue;
      CAPTURE(pose);
      Pose placed = here;
      placed.linear() *= std::ldexp(1, pose);
      const double own = std::ldexp(1, exponent - pose);
      const DistanceResult same = distance(Object(scaled(corner, own)), placed, Object(scaled(across, own)), placed);
      CHECK(same.lower == found.lower);
      CHECK(same.upper == found.upper);
    }
  }
  // A gap of one unit in the last place, so that no sum of doubles sees it.
  for (const double x : {0x1p52, 0x1p53 - 1}) {
    Mesh a;
    Mesh b;
    add_face(a, {{x, 0, 0}, {x, 1, 0}, {x, 0, 1}});
    add_face(b, {{x + 1, 0, 0}, {x + 1, 1, 0}, {x + 1, 0, 1}});
    CAPTURE(x);
    const Object first(a);
    const Object second(b);
    const DistanceResult found = distance(first, here, second, here);
    CHECK(found.lower == 1);
    CHECK(found.upper == 1);
    CHECK_FALSE(within(first, here, second, here, 0.5).hit);
    const PosedDistances distances(here, here);
    CHECK(distances.tight_bounds(a.primitive(0), b.primitive(0)).lower == 1);
    CHECK(distances.tight_bounds(a.primitive(0), a.primitive(0)).upper == 0);
  }
  // Translations whose difference no double holds.
  Mesh one;
  add_face(one, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const Object point(one);
  const Pose far(Eigen::Translation3d(0x1p53, 0, 0));
  const Pose back(Eigen::Translation3d(-1, 0, 0));
  const DistanceResult found = distance(point, far, point, back);
  CHECK_FALSE(within(point, far, point, back, 0x1p53).hit);
  CHECK(found.lower == 0x1p53);
  CHECK(found.upper == 0x1p53 + 2);
}

TEST_CASE("distance: approximate, stopped and in contact at any size", "[lib][distance]") {
  const Object ball(make_sphere(1, 1));
  DistanceRequest request;
  const auto ask = [&](double scale, double shift) {
    Pose at = Pose::Identity();
    Pose beside = at;
    at.linear() *= scale;
    beside.linear() *= scale;
    beside.translation() = Vec3d(shift, shift / 4, 0) * scale;
    return distance(ball, at, ball, beside, request);
  };
  for (const double error : {0.0, 0.01, 0.5}) {
    request.rel_error = error;
    for (const double shift : {1.0, 3.0}) {
      request.stop_above = infinity;
      const DistanceResult one = ask(1, shift);
      for (const int exponent : {-500, -405, -399, -201, -101, 101, 201, 399, 401, 498}) {
        CAPTURE(error, shift, exponent);
        const double scale = std::ldexp(1, exponent);
        request.stop_above = infinity;
        const DistanceResult found = ask(scale, shift);
        // Lengths of the same query in another unit, so the numbers are the same.
        CHECK(found.lower == one.lower * scale);
        CHECK(found.upper == one.upper * scale);
        CHECK(found.point_a == one.point_a * scale);
        CHECK(found.point_b == one.point_b * scale);
        if (found.upper == 0) continue;
        request.stop_above = one.upper * scale;
        CHECK(ask(scale, shift).upper == found.upper);
        request.stop_above = one.lower * 0.9 * scale;
        const DistanceResult above = ask(scale, shift);
        CHECK(above.upper == infinity);
        CHECK(above.lower == request.stop_above);
      }
    }
  }
}

TEST_CASE("distance: of polygons that were cut, the point is one of the parts that meet", "[lib][distance]") {
  Mesh square;
  add_face(square, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  add_face(square, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  square.file_face = {7, 7};
  Mesh needle;
  add_face(needle, {{0.25, 0.5, 0}, {0.25, 0.5, 1}, {0.25, 0.75, 1}});
  const Object a(square);
  const Object b(needle);
  for (const bool swapped : {false, true}) {
    const DistanceResult found = swapped ? distance(b, Pose::Identity(), a, Pose::Identity())
                                         : distance(a, Pose::Identity(), b, Pose::Identity());
    CHECK(found.upper == 0);
    CHECK((swapped ? found.face_b : found.face_a) == 7);
    CHECK(found.point_a == Vec3d(0.25, 0.5, 0));
    CHECK(found.point_b == Vec3d(0.25, 0.5, 0));
  }
}

TEST_CASE("distance: its numbers count the question before it, too, whether the objects touch", "[lib][distance]") {
  Mesh a;
  Mesh b;  // beside the long edge of a: no direction of the bounding volumes tells them apart
  add_face(a, {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}});
  add_face(b, {{1, 0.625, -1}, {1, 0.625, 1}, {1.125, 0.625, 0}});
  const CollisionStats touch = collide(Object(a), Pose::Identity(), Object(b), Pose::Identity()).stats;
  CHECK(touch.pairs == 1);
  const CollisionStats both = distance(Object(a), Pose::Identity(), Object(b), Pose::Identity()).stats;
  CHECK(both.pairs == 2);
  CHECK(both.steps == touch.steps + 1);
}

TEST_CASE("distance: what is known beforehand", "[lib][distance]") {
  const Object box(make_box({0, 0, 0}, {1, 1, 1}));
  const Object inner(make_box({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}));
  CHECK(distance(box, Pose::Identity(), inner, Pose::Identity()).upper == 0.25);  // surfaces, not volumes
  CHECK(distance(box, Pose::Identity(), inner, Pose::Identity()).lower == 0.25);
  Pose pose = Pose::Identity();
  pose.translation() = Vec3d(4, 5, 1.5);  // corners: 3, 4, 1/2
  const DistanceResult far = distance(box, Pose::Identity(), box, pose);
  const long double lower = far.lower;
  const long double upper = far.upper;
  CHECK(lower * lower < 25.25L);
  CHECK(upper * upper > 25.25L);
  CHECK(far.upper == std::nextafter(far.lower, infinity));
  CHECK(far.point_a == Vec3d(1, 1, 1));
  CHECK(far.point_b == Vec3d(4, 5, 1.5));
  pose.translation() = Vec3d(4, 5, 0.5);  // edges: 3, 4
  CHECK(distance(box, Pose::Identity(), box, pose).lower == 5);
  CHECK(distance(box, Pose::Identity(), box, pose).upper == 5);
  // Beyond the doubles.
  Pose huge = Pose::Identity();
  huge.linear() *= 0x1p500;
  Mesh great;
  add_face(great, {Vec3d(0x1p999, 0, 0), Vec3d(0x1p999, 1, 0), Vec3d(0x1p999, 0, 1)});
  const DistanceResult beyond = distance(box, Pose::Identity(), Object(great), huge);
  CHECK(beyond.upper == infinity);
  CHECK(beyond.lower == std::numeric_limits<double>::max());
  DistanceRequest request;
  for (const double error : {1.0, -0.25, std::nan("")}) {
    request.rel_error = error;
    CHECK_THROWS_WITH(distance(box, pose, box, pose, request), Catch::Contains("rel_error"));
  }
  request = {};
  request.stop_above = -1;
  CHECK_THROWS_WITH(distance(box, pose, box, pose, request), Catch::Contains("stop_above"));
}
