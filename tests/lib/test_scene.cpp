// SPDX-License-Identifier: Apache-2.0
// Scenes against all pairs of their objects.
#include <atomic>
#include <catch2/catch.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/device.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/scene.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>
#include <thread>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "bvh_meshes.hpp"
#include "random_poses.hpp"
#include "tree/rounding.hpp"

using namespace cchip;
using namespace cchip::testing;
using cchip_test::random_pose;
using Id = Scene::Id;

namespace {

/// From a corner at the origin to `size`.
Mesh box(const Vec3d& size) { return make_box(Vec3d::Zero(), size); }

Pose at(double x, double y, double z) { return make_pose({x, y, z}, {0, 0, 0}); }

using Pairs = std::vector<std::pair<Id, Id>>;

Pairs ids_of(const std::vector<Scene::Pair>& found) {
  Pairs pairs;
  for (const Scene::Pair& pair : found) pairs.emplace_back(pair.a, pair.b);
  return pairs;
}

std::vector<Id> ids_of(const std::vector<Scene::Hit>& found) {
  std::vector<Id> ids;
  for (const Scene::Hit& hit : found) ids.push_back(hit.id);
  return ids;
}

void check_same(const CollisionResult& x, const CollisionResult& y) {
  CHECK(x.hit == y.hit);
  CHECK(x.relation == y.relation);
  CHECK(x.contacts == y.contacts);
}

/// Every pair of the scene, one by one.
std::vector<Scene::Pair> all_pairs(const Scene& scene, Device& device, const CollisionRequest& request) {
  std::vector<Scene::Pair> found;
  const std::vector<Id> ids = scene.ids();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t k = i + 1; k < ids.size(); ++k) {
      CollisionResult result =
          collide(device, scene.object(ids[i]), scene.pose(ids[i]), scene.object(ids[k]), scene.pose(ids[k]), request);
      if (result.hit) found.push_back({ids[i], ids[k], std::move(result)});
    }
  }
  return found;
}

void check_scene(const Scene& scene, Device& device) {
  const CollisionRequest all = {CollisionRequest::Contacts::all};
  const std::vector<Scene::Pair> expected = all_pairs(scene, device, all);
  const std::vector<Scene::Pair> found = scene.contacts(device, all);
  CHECK(ids_of(found) == ids_of(expected));
  if (found.size() != expected.size()) return;
  for (std::size_t i = 0; i < found.size(); ++i) check_same(found[i].result, expected[i].result);

  const std::optional<Scene::Pair> one = scene.find_contact(device);
  CHECK(one.has_value() == !expected.empty());
  for (const Id id : scene.ids()) {
    std::vector<Id> others;
    for (const Scene::Pair& pair : expected) {
      if (pair.a == id) others.push_back(pair.b);
      if (pair.b == id) others.push_back(pair.a);
    }
    std::sort(others.begin(), others.end());
    CHECK(ids_of(scene.contacts(device, id)) == others);
    CHECK(scene.find_contact(device, id).has_value() == !others.empty());
  }
}

/// Every pair whose boxes overlap, one by one.
Pairs all_overlaps(const Scene& scene) {
  Pairs pairs;
  const std::vector<Id> ids = scene.ids();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t k = i + 1; k < ids.size(); ++k) {
      const WorldBox& p = scene.box(ids[i]);
      const WorldBox& q = scene.box(ids[k]);
      bool meet = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (p.least[axis] > q.greatest[axis] || q.least[axis] > p.greatest[axis]) meet = false;
      }
      if (meet) pairs.emplace_back(ids[i], ids[k]);
    }
  }
  return pairs;
}

}  // namespace

TEST_CASE("scene: what all pairs give, in poses of every class", "[lib][scene]") {
  const std::uint64_t seed = sim::seed_from_environment();
  std::cout << "CCHIP_SEED=" << seed << '\n';
  std::mt19937_64 random(seed);
  const std::string name = GENERATE(from_range(device_names()));
  const auto device = open_device(name);
  const std::vector<Object> objects = {Object(make_torus(1, 0.4, 5, 4)), Object(box({1, 0.5, 0.25})),
                                       Object(make_torus(1e-3, 4e-4, 4, 3)), Object(box({40, 40, 0.5})),
                                       Object(noisy(make_torus(1, 0.4, 4, 3, Kind::quad), 0.05, random))};
  std::size_t contacts = 0;
  std::size_t candidates = 0;
  for (int round = 0; round < (name == "cpu" ? 40 : 6); ++round) {
    Scene scene;
    const std::size_t count = 5 + random() % 30;
    const double range = std::ldexp(1.0, static_cast<int>(random() % 4));
    for (std::size_t i = 0; i < count; ++i) {
      const auto pose_class = cchip_test::pose_classes[random() % std::size(cchip_test::pose_classes)];
      scene.add(objects[random() % objects.size()], random_pose(pose_class, range, random));
    }
    check_scene(scene, *device);
    contacts += scene.contacts(*device).size();
    candidates += scene.candidates().size();
    // Moved and removed, at random.
    for (const Id id : scene.ids()) {
      if (random() % 4 == 0) {
        scene.remove(id);
      } else if (random() % 2 == 0) {
        scene.set_pose(id, random_pose(cchip_test::PoseClass::rigid, range, random));
      }
    }
    check_scene(scene, *device);
  }
  CHECK(contacts > (name == "cpu" ? 40 : 5));
  CHECK(candidates >= contacts);
}

TEST_CASE("scene: objects of any magnitude", "[lib][scene]") {
  std::mt19937_64 random(3);
  const auto device = open_device("cpu");
  for (const int exponent : {-1070, -1000, -500, -60, 60, 400, 900}) {
    Mesh torus = make_torus(1, 0.4, 5, 4);
    for (Vec3d& v : torus.vertices) v *= std::ldexp(1.0, exponent);
    const Object object(torus);
    Scene scene;
    for (int i = 0; i < 12; ++i) {
      const double scale = std::ldexp(1.0, std::clamp(-exponent, -490, 490));
      Pose pose = random_pose(cchip_test::PoseClass::affine, 2, random);
      pose.linear() *= scale;
      pose.translation() *= std::ldexp(1.0, std::clamp(exponent + std::clamp(-exponent, -490, 490), -1060, 490));
      scene.add(object, pose);
    }
    CAPTURE(exponent);
    check_scene(scene, *device);
  }
}

TEST_CASE("scene: the box of an object holds all its vertices, and little else", "[lib][scene]") {
  std::mt19937_64 random(5);
  for (int round = 0; round < 200; ++round) {
    Mesh torus = make_torus(1, 0.4, 5, 4);
    const double scale = std::ldexp(1.0, static_cast<int>(random() % 2000) - 1050);
    for (Vec3d& v : torus.vertices) v = (v + random_vector(random, 10)) * scale;
    const auto pose_class = cchip_test::pose_classes[random() % std::size(cchip_test::pose_classes)];
    Pose pose = random_pose(pose_class, 3, random);
    pose.linear() *= std::ldexp(1.0, static_cast<int>(random() % 900) - 450);
    Scene scene;
    const WorldBox box = scene.box(scene.add(Object(torus), pose));
    for (const Vec3d& v : torus.vertices) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        bvh::Interval at = pose(i, 3);
        for (Eigen::Index k = 0; k < 3; ++k) at = at + bvh::Interval(pose(i, k)) * v[k];
        const auto axis = static_cast<std::size_t>(i);
        if (box.least[axis] <= at.least && at.greatest <= box.greatest[axis]) continue;
        CAPTURE(round, static_cast<int>(pose_class), scale, pose.matrix(), v, i);
        FAIL("a vertex may lie outside of the box");
      }
    }
  }
  Scene scene;
  const WorldBox cube = scene.box(scene.add(Object(box({1, 1, 1})), at(1, 2, 3)));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(cube.least[axis] > static_cast<double>(axis) + 0.999);
    CHECK(cube.greatest[axis] < static_cast<double>(axis) + 2.001);
  }
}

TEST_CASE("scene: candidates are all pairs of boxes that overlap, while objects come, move and go", "[lib][scene]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const std::vector<Object> objects = {Object(box({1, 1, 1})), Object(box({0.5, 2, 0.01})),
                                       Object(make_torus(1, 0.4, 6, 5)), Object(box({3, 3, 0}))};
  std::size_t overlaps = 0;
  std::size_t pairs = 0;
  for (int kind = 0; kind < 6; ++kind) {
    Scene scene;
    const auto pose = [&] {
      Vec3d place = random_vector(random, 8);
      if (kind == 1) place = place.array().round().matrix();                          // flush boxes, equal middles
      if (kind == 2) place *= std::ldexp(1.0, static_cast<int>(random() % 60) - 50);  // crowded, and strays
      if (kind == 3) place = Vec3d(3 * place.x(), 0, 0);                              // in a line
      if (kind == 4 && random() % 8 == 0) place *= 0x1p490;                           // far away
      if (kind == 5) place = Vec3d(0.25, 0.25, 0.25);                                 // all in one place
      Pose result = make_pose(place, kind == 1 ? Vec3d(0, 0, 0) : random_vector(random, 180));
      if (kind == 2 && random() % 16 == 0) result.linear() *= 100;  // a box around many
      return result;
    };
    std::vector<Id> ids;
    for (int step = 0; step < 40; ++step) {
      const std::size_t added = step == 0 ? 60 : random() % 12;
      for (std::size_t i = 0; i < added; ++i) ids.push_back(scene.add(objects[random() % objects.size()], pose()));
      for (std::size_t i = random() % 12; i > 0 && !ids.empty(); --i) {
        const std::size_t k = random() % ids.size();
        scene.remove(ids[k]);
        ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(k));
      }
      if (step == 20) {  // and all of them go
        for (const Id id : ids) scene.remove(id);
        ids.clear();
      }
      for (std::size_t i = random() % 20; i > 0 && !ids.empty(); --i)
        scene.set_pose(ids[random() % ids.size()], pose());
      REQUIRE(scene.ids() == ids);
      const Pairs expected = all_overlaps(scene);
      pairs += ids.size() * (ids.size() - std::min<std::size_t>(1, ids.size())) / 2;
      overlaps += expected.size();
      CAPTURE(kind, step);
      REQUIRE(scene.candidates() == expected);
    }
  }
  CHECK(overlaps > pairs / 20);
  CHECK(overlaps < pairs / 2);
}

TEST_CASE("scene: candidates after steps of any length of any share of the objects", "[lib][scene]") {
  std::mt19937_64 random(sim::seed_from_environment());
  Mesh huge = make_box(-Vec3d::Ones(), Vec3d::Ones());
  for (Vec3d& v : huge.vertices) v *= 0x1p900;
  const std::vector<Object> objects = {Object(box({1, 1, 1})),           Object(box({0.5, 2, 0})),
                                       Object(make_torus(1, 0.4, 6, 5)), Object(box({1e-6, 1e-6, 1e-6})),
                                       Object(box({30, 30, 0.1})),       Object(huge)};
  std::size_t unbounded = 0;
  std::size_t appeared = 0;
  std::size_t vanished = 0;
  for (int round = 0; round < 60; ++round) {
    Scene scene;
    CHECK(scene.candidates().empty());
    // The last two, which meet many, are rare; with a scale the last one has no bounds.
    const auto any_object = [&] { return objects[random() % 16 == 0 ? 4 + random() % 2 : random() % 4]; };
    const std::size_t count = 1 + random() % 120;
    for (std::size_t i = 0; i < count; ++i) {
      scene.add(any_object(), make_pose(random_vector(random, 5), random_vector(random, 180)));
    }
    const std::size_t one_in = std::size_t{1} << (random() % 8);
    const double length = std::ldexp(1.0, -static_cast<int>(random() % 12));
    Pairs before = all_overlaps(scene);
    for (int step = 0; step < 30; ++step) {
      for (const Id id : scene.ids()) {
        if (random() % one_in != 0) continue;
        Pose pose = scene.pose(id);
        switch (random() % 16) {
          case 0:
            pose.translation() = random_vector(random, 5);
            break;
          case 1:
            pose.linear() *= 2;
            break;
          case 2:
            pose.linear() *= pose.linear().norm() < 0x1p400 ? 0x1p100 : 0x1p-450;
            break;
          case 3:
            pose = scene.pose(scene.ids().front());
            break;  // equal boxes
          default:
            pose.translation() += random_vector(random, length);
        }
        scene.set_pose(id, pose);
        if (random() % 32 == 0) scene.remove(id);
        if (random() % 32 == 0) scene.add(any_object(), pose);
      }
      if (step % 4 == 3) continue;  // changes pile up
      const Pairs expected = all_overlaps(scene);
      CAPTURE(round, step, one_in, length);
      REQUIRE(scene.candidates() == expected);
      REQUIRE(scene.candidates() == expected);
      Pairs difference;
      std::set_difference(expected.begin(), expected.end(), before.begin(), before.end(),
                          std::back_inserter(difference));
      appeared += difference.size();
      difference.clear();
      std::set_difference(before.begin(), before.end(), expected.begin(), expected.end(),
                          std::back_inserter(difference));
      vanished += difference.size();
      before = expected;
    }
    for (const Id id : scene.ids()) unbounded += std::isinf(scene.box(id).least[0]) ? 1 : 0;
    while (scene.size() > 0) {  // one by one, and what is left is as before
      const std::vector<Id> ids = scene.ids();
      scene.remove(ids[random() % ids.size()]);
      if (scene.size() % 8 == 0) REQUIRE(scene.candidates() == all_overlaps(scene));
    }
  }
  CHECK(unbounded > 0);
  CHECK(appeared > 1000);
  CHECK(vanished > 1000);
}

TEST_CASE("scene: queries with a distance and without one, while objects move", "[lib][scene]") {
  std::mt19937_64 random(17);
  const auto device = open_device("cpu");
  const Object torus(make_torus(1, 0.4, 5, 4));
  Scene scene;
  for (int i = 0; i < 30; ++i) scene.add(torus, random_pose(cchip_test::PoseClass::rigid, 4, random));
  std::size_t near = 0;
  std::size_t touching = 0;
  for (int step = 0; step < 40; ++step) {
    for (const Id id : scene.ids()) {
      if (random() % 4 != 0) continue;
      Pose pose = scene.pose(id);
      pose.translation() += random_vector(random, 0.3);
      scene.set_pose(id, pose);
    }
    CollisionRequest request;
    if (step % 8 < 5) request.within = step % 2 == 0 ? 0.5 : 0.01;
    const Pairs expected = ids_of(all_pairs(scene, *device, request));
    CAPTURE(step, request.within);
    REQUIRE(ids_of(scene.contacts(*device, request)) == expected);
    REQUIRE(scene.candidates() == all_overlaps(scene));
    (request.within > 0 ? near : touching) += expected.size();
  }
  CHECK(touching > 50);
  CHECK(near > touching);
}

TEST_CASE("scene: groups, filter and ignored pairs count that a query finds, not those of the one before",
          "[lib][scene]") {
  const Object cube(box({1, 1, 1}));
  Scene scene;
  for (int i = 0; i < 3; ++i) scene.add(cube, at(0.25 * i, 0, 0));
  CHECK(scene.candidates() == Pairs{{1, 2}, {1, 3}, {2, 3}});
  scene.set_groups(1, {2, 2});
  CHECK(scene.candidates() == Pairs{{2, 3}});
  scene.set_ignored(2, 3);
  CHECK(scene.candidates().empty());
  scene.set_groups(1, {});
  scene.set_ignored(2, 3, false);
  CHECK(scene.candidates() == Pairs{{1, 2}, {1, 3}, {2, 3}});
  // A filter may ask the scene.
  const Scene copy = scene;
  scene.set_filter(
      [&copy, &scene](Id, Id b) { return copy.candidates().size() == 3 && b == 3 && scene.box(b).least[0] > 0; });
  CHECK(scene.candidates() == Pairs{{1, 3}, {2, 3}});
  std::size_t depth = 0;
  scene.set_filter([&](Id, Id) { return ++depth > 3 || scene.candidates().size() <= 3; });
  CHECK(scene.candidates() == Pairs{{1, 2}, {1, 3}, {2, 3}});
}

TEST_CASE("scene: copies and what was moved from have lives of their own", "[lib][scene]") {
  const Object cube(box({1, 1, 1}));
  Scene scene;
  for (int i = 0; i < 6; ++i) scene.add(cube, at(0.6 * i, 0, 0));
  const Pairs chain = {{1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}};
  Scene early = scene;  // before the first query
  CHECK(scene.candidates() == chain);
  Scene late = scene;
  scene.remove(3);
  scene.set_pose(6, at(0, 0, 0));
  CHECK(scene.candidates() == Pairs{{1, 2}, {1, 6}, {2, 6}, {4, 5}});
  CHECK(early.candidates() == chain);
  CHECK(late.candidates() == chain);
  late = scene;
  CHECK(late.candidates() == scene.candidates());
  late.set_pose(5, at(20, 0, 0));
  CHECK(late.candidates() == Pairs{{1, 2}, {1, 6}, {2, 6}});
  Scene moved = std::move(early);
  CHECK(moved.candidates() == chain);
  early = Scene();
  CHECK(early.candidates().empty());
  Scene other = std::move(moved);
  moved.add(cube);  // NOLINT: that is the test
  moved.add(cube);
  CHECK(moved.candidates().size() == 1);
  const Scene copy_of_empty = Scene();
  CHECK(copy_of_empty.candidates().empty());
  CHECK(other.candidates() == chain);
}

TEST_CASE("scene: several threads ask for what has just moved", "[lib][scene]") {
  std::mt19937_64 random(19);
  const Object torus(make_torus(1, 0.4, 5, 4));
  Scene scene;
  for (int i = 0; i < 80; ++i) scene.add(torus, random_pose(cchip_test::PoseClass::rigid, 4, random));
  const auto one = open_cpu_device({1, {}});
  CollisionRequest near;
  near.within = 0.2;
  for (int step = 0; step < 10; ++step) {
    for (const Id id : scene.ids()) {
      if (random() % 3 == 0) scene.set_pose(id, random_pose(cchip_test::PoseClass::rigid, 4, random));
    }
    const Pairs boxes = all_overlaps(scene);
    const Pairs close = ids_of(all_pairs(scene, *one, near));
    std::atomic<int> right = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&, i] {
        const auto device = open_cpu_device({1, {}});
        const bool same = i % 2 == 0 ? scene.candidates() == boxes : ids_of(scene.contacts(*device, near)) == close;
        const Scene copy = scene;
        right += same && copy.candidates() == boxes ? 1 : 0;
      });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(right == 4);
  }
}

TEST_CASE("scene: boxes that touch exactly, and by a last bit do not", "[lib][scene]") {
  const auto device = open_device("cpu");
  const Object cube(box({1, 1, 1}));
  Scene scene;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int z = 0; z < 3; ++z) scene.add(cube, at(x, y, z));
    }
  }
  // Each cube touches those beside it, along edges and corners too.
  CHECK(scene.contacts(*device).size() == 158);
  CollisionRequest relation;
  relation.relation = true;
  for (const Scene::Pair& pair : scene.contacts(*device, relation)) {
    CHECK(pair.result.relation == Relation::touching);
  }
  Scene two;
  const Id fixed = two.add(cube);
  const Id moved = two.add(cube);
  for (const double scale : {1.0, 3.0, 0.1, 1e-140, 1e140}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        Pose pose = Pose::Identity();
        pose.linear() *= scale;
        two.set_pose(fixed, pose);
        pose.translation()[axis] = sign * scale;
        two.set_pose(moved, pose);
        CAPTURE(scale, axis, sign);
        CHECK(two.contacts(*device).size() == 1);
        pose.translation()[axis] = std::nextafter(sign * scale, sign * std::numeric_limits<double>::infinity());
        two.set_pose(moved, pose);
        CHECK(two.contacts(*device).empty());
      }
    }
  }
}

TEST_CASE("scene: the answer is in the order of ids with any number of threads", "[lib][scene]") {
  std::mt19937_64 random(11);
  const Object torus(make_torus(1, 0.4, 9, 7));
  Scene scene;
  for (int i = 0; i < 200; ++i) scene.add(torus, random_pose(cchip_test::PoseClass::rigid, 5, random));
  const CollisionRequest all = {CollisionRequest::Contacts::all};
  const auto one = open_cpu_device({1, {}});
  const std::vector<Scene::Pair> expected = scene.contacts(*one, all);
  CHECK(expected.size() > 100);
  CHECK(std::is_sorted(expected.begin(), expected.end(), [](const Scene::Pair& x, const Scene::Pair& y) {
    return std::make_pair(x.a, x.b) < std::make_pair(y.a, y.b);
  }));
  for (const unsigned threads : {2U, 5U}) {
    const auto many = open_cpu_device({threads, {}});
    for (int i = 0; i < 3; ++i) {
      const std::vector<Scene::Pair> found = scene.contacts(*many, all);
      REQUIRE(ids_of(found) == ids_of(expected));
      for (std::size_t k = 0; k < found.size(); ++k) check_same(found[k].result, expected[k].result);
    }
  }
}

TEST_CASE("scene: filter, groups and ignored pairs", "[lib][scene]") {
  const auto device = open_device("cpu");
  const Object cube(box({1, 1, 1}));
  Scene scene;
  std::vector<Id> ids;
  for (int i = 0; i < 4; ++i) ids.push_back(scene.add(cube, at(0.25 * i, 0.25 * i, 0.25 * i)));
  REQUIRE(ids == std::vector<Id>{1, 2, 3, 4});
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{1, 2}, {1, 3}, {1, 4}, {2, 3}, {2, 4}, {3, 4}});

  scene.set_ignored(2, 1);
  scene.set_ignored(3, 4);
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{1, 3}, {1, 4}, {2, 3}, {2, 4}});
  CHECK(ids_of(scene.contacts(*device, 2)) == std::vector<Id>{3, 4});
  scene.set_ignored(4, 3, false);
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{1, 3}, {1, 4}, {2, 3}, {2, 4}, {3, 4}});

  scene.set_filter([](Id a, Id b) {
    CHECK(a < b);
    return b != 4;
  });
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{1, 3}, {2, 3}});
  CHECK(scene.candidates() == Pairs{{1, 3}, {2, 3}});
  CHECK(scene.contacts(*device, 4).empty());
  scene.set_filter({});

  // Both masks must agree.
  scene.set_groups(1, {2, 2});
  CHECK(scene.contacts(*device, 1).empty());
  scene.set_groups(3, {3, 2});
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{1, 3}, {2, 4}});
  scene.set_groups(3, {1, 3});
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{2, 3}, {2, 4}, {3, 4}});
  CHECK(scene.groups(3).mask == 3);

  const Pose pose = at(0.1, 0.1, 0.1);
  CHECK(ids_of(scene.contacts(*device, {cube, pose})) == std::vector<Id>{2, 3, 4});
  CHECK(ids_of(scene.contacts(*device, {cube, pose, {2, 2}})) == std::vector<Id>{1});
  CHECK(ids_of(scene.contacts(*device, {cube, pose, {3, 3}})) == std::vector<Id>{1, 2, 3, 4});
}

TEST_CASE("scene: an object that is removed takes its own ignored pairs along and no others", "[lib][scene]") {
  const auto device = open_device("cpu");
  const Object cube(box({1, 1, 1}));
  Scene scene;
  for (int i = 0; i < 4; ++i) scene.add(cube, at(0.25 * i, 0, 0));
  scene.set_ignored(1, 2);
  scene.set_ignored(3, 4);
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{1, 3}, {1, 4}, {2, 3}, {2, 4}});
  scene.remove(1);
  CHECK(scene.candidates() == Pairs{{2, 3}, {2, 4}});  // nothing but the removal has changed since the query before
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{2, 3}, {2, 4}});
  scene.remove(2);
  CHECK(scene.candidates().empty());
  scene.remove(4);  // the second one of its pair
  CHECK(scene.add(cube) == 5);
  CHECK(scene.candidates() == Pairs{{3, 5}});
}

TEST_CASE("scene: the object asked about is A", "[lib][scene]") {
  const auto device = open_device("cpu");
  const Object torus(make_torus(1, 0.4, 9, 7));
  const Object cube(box({1, 1, 1}));
  const CollisionRequest all = {CollisionRequest::Contacts::all};
  Scene scene;
  const Id a = scene.add(torus);
  const Id b = scene.add(cube);
  check_same(scene.contacts(*device, all).at(0).result,
             collide(*device, torus, Pose::Identity(), cube, Pose::Identity(), all));
  for (const Scene::Hit& hit : {scene.contacts(*device, b, all).at(0), *scene.find_contact(*device, b, all)}) {
    CHECK(hit.id == a);
    check_same(hit.result, collide(*device, cube, Pose::Identity(), torus, Pose::Identity(), all));
  }
  const auto hits = scene.contacts(*device, {cube, Pose::Identity()}, all);
  CHECK(ids_of(hits) == std::vector<Id>{a, b});
  check_same(hits[0].result, collide(*device, cube, Pose::Identity(), torus, Pose::Identity(), all));
  CHECK(scene.find_contact(*device, {cube, at(9, 9, 9)}) == std::nullopt);
}

TEST_CASE("scene: ids are never used again", "[lib][scene]") {
  const auto device = open_device("cpu");
  Scene scene;
  const Object cube(box({1, 1, 1}));
  const Id a = scene.add(cube);
  const Id b = scene.add(cube, at(0.5, 0, 0));
  const Id c = scene.add(cube, at(1, 0, 0));
  scene.set_ignored(b, c);
  scene.remove(b);
  CHECK(scene.size() == 2);
  CHECK_FALSE(scene.contains(b));
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{a, c}});
  const Id d = scene.add(cube, at(0.5, 0, 0));
  CHECK(d > c);
  CHECK(scene.ids() == std::vector<Id>{a, c, d});
  CHECK(ids_of(scene.contacts(*device)) == Pairs{{a, c}, {a, d}, {c, d}});
  const Scene copy = scene;
  scene.remove(a);
  scene.remove(c);
  scene.remove(d);
  CHECK(scene.size() == 0);
  CHECK(scene.contacts(*device).empty());
  CHECK(copy.contacts(*device).size() == 3);
  CHECK(scene.add(cube) > d);
}

TEST_CASE("scene: targets of many poses and of another scene", "[lib][scene]") {
  // Unit cubes in a row with gaps of 1, and others that reach from 0.5 into the gap: each pair by hand.
  const Object cube(box({1, 1, 1}));
  Scene row;
  for (int i = 0; i < 4; ++i) row.add(cube, at(2 * i, 0, 0), {i == 3 ? 2U : 1U, ~std::uint64_t{0}});
  row.set_filter([](Id, Id) -> bool { throw std::logic_error("not about these"); });
  const std::vector<Pose> poses = {at(9, 9, 9), at(1, 0, 0), at(2.5, 0, 0), at(6, 0, 0)};
  Scene others;
  const Id gone = others.add(cube);
  for (const Pose& pose : poses) others.add(cube, pose);
  others.remove(gone);
  using Of = std::vector<std::pair<Id, std::uint64_t>>;
  const auto both = [](const std::vector<Scene::Hit>& hits) {
    Of all;
    for (const Scene::Hit& hit : hits) all.emplace_back(hit.id, hit.of);
    return all;
  };
  CollisionRequest all;
  all.contacts = CollisionRequest::Contacts::all;
  for (const std::string& name : device_names()) {
    const auto device = open_device(name);
    // Flush at x = 1 and x = 2, across the second, on the fourth; none for the first.
    const std::vector<Scene::Hit> hits = row.contacts(*device, {cube, poses}, all);
    CHECK(both(hits) == Of{{1, 1}, {2, 1}, {2, 2}, {4, 3}});
    for (const Scene::Hit& hit : hits) {
      check_same(hit.result, collide(*device, cube, poses[hit.of], cube, row.pose(hit.id), all));
    }
    CHECK(both(row.contacts(*device, {cube, poses, {1, 1}})) == Of{{1, 1}, {2, 1}, {2, 2}});
    CHECK(row.contacts(*device, {cube, std::vector<Pose>{}}).empty());
    // The ids of the other scene are 2, 3, 4 and 5: one was removed.
    CHECK(both(row.contacts(*device, others, all)) == Of{{1, 3}, {2, 3}, {2, 4}, {4, 5}});
    CHECK(both(others.contacts(*device, row, all)) == Of{{3, 1}, {3, 2}, {4, 2}, {5, 4}});
    check_same(others.contacts(*device, row, all).at(0).result,
               collide(*device, cube, row.pose(1), cube, others.pose(3), all));
    others.set_groups(5, {1, 1});
    CHECK(both(row.contacts(*device, others)) == Of{{1, 3}, {2, 3}, {2, 4}});
    others.set_groups(5, {});
    CHECK(row.find_contact(*device, others).has_value());
    CHECK(row.find_contact(*device, {cube, {at(9, 0, 0), at(0, 9, 0)}}) == std::nullopt);
    CHECK_THROWS_WITH(row.contacts(*device, row),
                      "scene: the target is the scene itself; leave it out, which asks for the pairs of the scene");
    CHECK_THROWS_WITH(row.contacts(*device, {cube, {at(0, 0, 0), at(std::nan(""), 0, 0)}}),
                      Catch::StartsWith("pose of the object: number 1: row 0, column 3 is not finite"));
  }
}

TEST_CASE("scene: stops when it is told to", "[lib][scene]") {
  const auto device = open_cpu_device({3, {}});
  const Object cube(box({1, 1, 1}));
  Scene scene;
  for (int i = 0; i < 60; ++i) scene.add(cube, at(0.01 * i, 0.01 * i, 0.01 * i));
  for (const std::size_t most : {std::size_t{1}, std::size_t{5}}) {
    std::size_t taken = 0;
    scene.for_each_contact(*device, [&](const Scene::Pair& pair) {
      CHECK(pair.a < pair.b);
      return ++taken < most;
    });
    CHECK(taken == most);
    taken = 0;
    scene.for_each_contact(*device, 7, [&](const Scene::Hit&) { return ++taken < most; });
    CHECK(taken == most);
    taken = 0;
    scene.for_each_contact(*device, {cube, Pose::Identity()}, [&](const Scene::Hit&) { return ++taken < most; });
    CHECK(taken == most);
  }
  struct Mine {};
  CHECK_THROWS_AS(scene.for_each_contact(*device, [](const Scene::Pair&) -> bool { throw Mine(); }), Mine);
  scene.set_filter([](Id, Id) -> bool { throw Mine(); });
  CHECK_THROWS_AS(scene.contacts(*device), Mine);
  scene.set_filter({});
  CHECK(scene.contacts(*device).size() == 60 * 59 / 2);
}

TEST_CASE("scene: what makes no sense is refused in one line, and changes nothing", "[lib][scene]") {
  const auto device = open_device("cpu");
  Object cube(box({1, 1, 1}));
  Scene scene;
  const Id a = scene.add(cube);
  const Id b = scene.add(cube, at(0.5, 0, 0));
  const auto refuses = [&](const std::string& message, const auto& action) {
    CHECK_THROWS_MATCHES(action(), std::invalid_argument, Catch::Message(message));
    CHECK(scene.ids() == std::vector<Id>{a, b});
    CHECK(ids_of(scene.contacts(*device)) == Pairs{{a, b}});
  };
  const Pose pose = at(0.5, 0, 0);
  const std::string unknown = "scene: no object has the id 3: add() has not returned it";
  refuses(unknown, [&] { scene.remove(3); });
  refuses(unknown, [&] { scene.set_pose(3, pose); });
  refuses(unknown, [&] { scene.set_groups(3, {}); });
  refuses(unknown, [&] { scene.set_ignored(1, 3); });
  refuses(unknown, [&] { scene.object(3); });
  refuses(unknown, [&] { scene.pose(3); });
  refuses(unknown, [&] { scene.contacts(*device, 3); });
  refuses("scene: no object has the id 0: add() has not returned it", [&] { scene.remove(0); });
  refuses("scene: object 2 is never tested against itself; give the ids of two objects",
          [&] { scene.set_ignored(2, 2); });
  Pose bad = pose;
  bad(1, 3) = std::numeric_limits<double>::quiet_NaN();
  const std::string where = "row 1, column 3 is not finite or beyond 2^500; check it or scale it";
  refuses("pose of object 2: " + where, [&] { scene.set_pose(b, bad); });
  refuses("pose of the object: " + where, [&] { scene.add(cube, bad); });
  refuses("pose of the object: " + where, [&] { scene.contacts(*device, {cube, bad}); });
  refuses("max_contacts is 0: ask for at least one contact", [&] {
    scene.contacts(*device, {CollisionRequest::Contacts::all, 0});
  });
  const Object moved = std::move(cube);
  const std::string gone = "scene: the object was moved from; use the one that it was moved to";
  refuses(gone, [&] { scene.add(cube); });                        // NOLINT: that is the test
  refuses(gone, [&] { scene.contacts(*device, {cube, pose}); });  // NOLINT
  CHECK(scene.add(moved) == 3);
  scene.remove(3);
  refuses("scene: no object has the id 3: it was removed", [&] { scene.remove(3); });

  // A device in use says so; the scene is as it was.
  scene.for_each_contact(*device, [&](const Scene::Pair&) {
    CHECK_THROWS_AS(scene.contacts(*device), std::logic_error);
    return true;
  });
}

#if defined(__SSE2__)
TEST_CASE("scene: a thread that flushes small numbers to zero changes nothing", "[lib][scene]") {
  const Object cube(box({1, 1, 1}));
  Scene scene;
  const Id a = scene.add(cube);
  const Id b = scene.add(cube, at(5, 0, 0));
  const unsigned before = _mm_getcsr();
  for (const unsigned bit : {0x8000U, 0x0040U}) {
    _mm_setcsr(before | bit);
    CHECK_THROWS_AS(scene.set_pose(b, at(0.5, 0, 0)), std::runtime_error);
    CHECK_THROWS_AS(scene.add(cube), std::runtime_error);
    _mm_setcsr(before);
    CHECK(scene.ids() == std::vector<Id>{a, b});
    CHECK(scene.pose(b).translation() == Vec3d(5, 0, 0));
    CHECK(scene.candidates().empty());
  }
}
#endif

TEST_CASE("scene: queries about many pairs of objects, in any order, each once more", "[lib][scene]") {
  const auto device = open_device("cpu");
  std::vector<Object> objects;
  std::vector<Pose> poses;
  for (int i = 0; i < 24; ++i) {
    objects.emplace_back(box({1 + 0.5 * (i % 3), 1, 1}));
    poses.push_back(at(0.75 * i, 0, 0));
  }
  std::vector<CollisionQuery> queries;
  std::vector<bool> expected;
  for (int twice = 0; twice < 2; ++twice) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      for (std::size_t k = 0; k < objects.size(); ++k) {
        queries.push_back({&objects[i], &poses[i], &objects[k], &poses[k]});
        const std::size_t less = std::min(i, k);
        const double length = 1 + 0.5 * static_cast<double>(less % 3);
        // Surfaces: boxes of one section meet while their intervals do.
        expected.push_back(0.75 * static_cast<double>(std::max(i, k) - less) <= length);
      }
    }
  }
  const std::vector<CollisionResult> results = collide(*device, queries);
  REQUIRE(results.size() == queries.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    CAPTURE(i);
    REQUIRE(results[i].hit == expected[i]);
  }
}
