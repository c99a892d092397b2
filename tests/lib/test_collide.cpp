// SPDX-License-Identifier: Apache-2.0
// Devices against brute force over exact integers.
#include <sys/wait.h>
#include <unistd.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <atomic>
#include <catch2/catch.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/device.hpp>
#include <cchip/gradual_underflow.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/internal/judge/brute_force.hpp>
#include <cchip/program/seed.hpp>
#include <chrono>
#include <iostream>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "answers.hpp"
#include "bvh_meshes.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip::testing;
using cchip_test::PoseClass;
using cchip_test::random_pose;

namespace {

Mesh one_face(const std::vector<Vec3d>& vertices) {
  Mesh mesh;
  add_face(mesh, vertices);
  return mesh;
}

/// Small, so that every pair of faces can be tested by the oracle.
std::vector<Mesh> small_meshes(std::mt19937_64& random) {
  std::vector<Mesh> meshes = {
      make_torus(1, 0.4, 5, 4),
      noisy(make_torus(1, 0.4, 4, 3, Kind::quad), 0.05, random),
      make_torus(1, 0.4, 4, 4, Kind::quad),
      make_gear(0.8, 1.2, 0.3, 0.5, 3, 1),
      soup(12, false, random),
      scaled(soup(12, true, random), 0.25),
      one_face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
      one_face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
      one_face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.25}, {0, 1, 0}}),     // warped
      one_face({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}),        // crosses itself
      one_face({{0, 0, 0}, {1, 0, 0}, {0.25, 0.25, 0}, {0, 1, 0}}),  // dented
      one_face({{0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5}}),             // a segment
      one_face({{0.5, 0.5, 0}, {0.5, 0.5, 0}, {0.5, 0.5, 0}}),       // a point
      scaled(make_torus(1, 0.4, 4, 3), 1e-3),                        // a thousandth of the others
  };
  Mesh plane;  // faces in one plane
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vec3d p = Vec3d(i, k, 0) * 0.5;
      add_face(plane, {p, p + Vec3d(0.5, 0, 0), p + Vec3d(0.5, 0.5, 0), p + Vec3d(0, 0.5, 0)});
    }
  }
  meshes.push_back(plane);
  Mesh many;  // degenerate and coincident faces among others
  for (int i = 0; i < 4; ++i) {
    add_face(many, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    add_face(many, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
    add_face(many, {{0, 0.5, 0}, {0, 0.5, 0}, {0, 0.5, 0}, {0, 0.5, 0}});
  }
  meshes.push_back(many);
  return meshes;
}

/// A test case runs once with each instruction set of the CPU, and with each other device that needs no simulator.
std::unique_ptr<Device> each_device() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> known = cpu_targets();
    for (const std::string& name : device_names()) {
      if (name != "cpu") known.push_back(name);
    }
    return known;
  }();
  const std::string name = GENERATE_REF(from_range(names));
  UNSCOPED_INFO("device " << name);
  const std::vector<std::string> targets = cpu_targets();
  const bool of_cpu = std::find(targets.begin(), targets.end(), name) != targets.end();
  return of_cpu ? open_cpu_device({0, name}) : open_device(name);
}

/// Poses of two objects of a size near 1: apart, near, touching, deep, and the same place.
PosePair random_poses(std::mt19937_64& random) {
  const auto pick = [&random] { return cchip_test::pose_classes[random() % std::size(cchip_test::pose_classes)]; };
  const double range = std::ldexp(1.0, -static_cast<int>(random() % 4));
  const PoseClass c = pick();
  PosePair poses = {random_pose(c, range, random), random_pose(random() % 2 == 0 ? c : pick(), range, random)};
  switch (random() % 6) {
    case 0:
      poses.b = poses.a;
      break;
    case 1:
      poses.b.linear() = poses.a.linear();
      break;
    case 2:
      poses.b.translation() = poses.a.translation() + random_vector(random, range);
      break;
    default:
      break;
  }
  return poses;
}

}  // namespace

TEST_CASE("collide: first and all contacts are those of brute force", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const std::vector<Mesh> meshes = small_meshes(random);
  std::vector<Object> objects;
  for (const Mesh& mesh : meshes) objects.emplace_back(mesh);
  std::vector<std::unique_ptr<Device>> devices;
  for (const std::string& name : device_names()) devices.push_back(open_device(name));
  const int rounds = 48;
  std::vector<Tally> tallies(devices.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      for (std::size_t k = 0; k < meshes.size(); ++k) {
        if (round >= 4 && meshes[i].faces.size() * meshes[k].faces.size() > 300) continue;
        CAPTURE(round, i, k);
        const PosePair poses = random_poses(random);
        const std::vector<Contact> expected = brute_force_contacts(meshes[i], poses.a, meshes[k], poses.b);
        for (std::size_t d = 0; d < devices.size(); ++d) {
          check_answers(*devices[d], objects[i], objects[k], poses, expected, tallies[d]);
        }
      }
    }
  }
  for (std::size_t d = 0; d < devices.size(); ++d) {
    const Tally& tally = tallies[d];
    tally.print(*devices[d]);
    CHECK(tally.queries >= 10000);
    CHECK(tally.hits > tally.queries / 4);
    CHECK(tally.hits < tally.queries * 9 / 10);
    CHECK(tally.stats.open > 0);
    CHECK(tally.first_pairs < tally.stats.pairs);
    for (const std::uint64_t queries : tally.relations) CHECK(queries > 500);
  }
}

TEST_CASE("collide: a mesh on itself touches in every face", "[lib][collide]") {
  const Object gear(make_gear(1.4, 2, 0.6, 0.8, 12, 2));
  const auto device = each_device();
  std::mt19937_64 random(sim::seed_from_environment());
  for (const PoseClass c : {PoseClass::quarter_turns, PoseClass::rigid, PoseClass::shear, PoseClass::flat}) {
    const Pose pose = random_pose(c, 1, random);
    const CollisionResult result = collide(*device, gear, pose, gear, pose, all);
    std::set<std::uint32_t> on_itself;
    for (const Contact& contact : result.contacts) {
      if (contact.face_a == contact.face_b) on_itself.insert(contact.face_a);
    }
    CHECK(on_itself.size() == gear.mesh().faces.size());
    CHECK(std::is_sorted(result.contacts.begin(), result.contacts.end()));
  }
}

TEST_CASE("collide: objects are surfaces", "[lib][collide]") {
  const Object outer(make_gear(8, 9, 0, 10, 12, 2));
  const Object inner(make_gear(0.5, 1, 0, 1, 12, 2));
  const auto device = each_device();
  CHECK_FALSE(collide(*device, outer, Pose::Identity(), inner, Pose::Identity()).hit);
  Pose moved = Pose::Identity();
  moved.translation().z() = 4.5;  // the inner one's face lies in the outer one's
  CHECK(collide(*device, outer, Pose::Identity(), inner, moved).hit);
  moved.translation().z() = 4.5 - 0x1p-48;
  CHECK_FALSE(collide(*device, outer, Pose::Identity(), inner, moved).hit);
}

TEST_CASE("collide: objects of any magnitude", "[lib][collide]") {
  const auto device = each_device();
  const Mesh torus = make_torus(2, 0.7, 12, 8);
  const Mesh gear = make_gear(1.4, 2, 0.6, 0.8, 12, 2);
  const Pose pose = make_pose({1, 0.5, 0.25}, {20, 30, 40});
  const CollisionResult expected = collide(*device, Object(torus), Pose::Identity(), Object(gear), pose, all);
  REQUIRE(expected.hit);
  for (const int exponent : {-1000, -500, -100, 100, 500, 990}) {
    CAPTURE(exponent);
    const double scale = std::ldexp(1.0, exponent);
    const Object small_torus(scaled(torus, scale));
    const Object small_gear(scaled(gear, scale));
    Pose placed = pose;
    if (std::abs(exponent) <= 100) {  // a translation of the same magnitude
      placed.translation() *= scale;
      CHECK(collide(*device, small_torus, Pose::Identity(), small_gear, placed, all).contacts == expected.contacts);
    }
    if (std::abs(exponent) <= 500) {  // the poses scale back
      Pose back = Pose::Identity();
      back.linear() /= scale;
      placed = pose;
      placed.linear() /= scale;
      CHECK(collide(*device, small_torus, back, small_gear, placed, all).contacts == expected.contacts);
    }
    Pose origin = pose;
    origin.translation().setZero();
    const auto both = [&](const Object& a, const Object& b) {
      return collide(*device, a, Pose::Identity(), b, origin, all).contacts;
    };
    CHECK(both(small_torus, small_gear) == both(Object(torus), Object(gear)));
  }
  // Poses that enlarge one object more than the other, to the same magnitude.
  constexpr int world = 145;
  for (const auto& [a, b] : {std::array{205, 45}, std::array{45, 205}, std::array{-255, 145}, std::array{145, -255}}) {
    CAPTURE(a, b);
    Pose pose_a = Pose::Identity();
    Pose pose_b = pose;
    pose_a.linear() *= std::ldexp(1.0, a);
    pose_b.linear() *= std::ldexp(1.0, b);
    pose_b.translation() *= std::ldexp(1.0, world);
    const Object torus_a(scaled(torus, std::ldexp(1.0, world - a)));
    const Object gear_b(scaled(gear, std::ldexp(1.0, world - b)));
    CHECK(collide(*device, torus_a, pose_a, gear_b, pose_b, all).contacts == expected.contacts);
  }
}

TEST_CASE("collide: faces that were cut count once, by their number in the file", "[lib][collide]") {
  Mesh cut;  // a square of two triangles, another square of two
  add_face(cut, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  add_face(cut, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add_face(cut, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}});
  add_face(cut, {{1, 0, 0}, {2, 1, 0}, {1, 1, 0}});
  cut.file_face = {7, 7, 3, 3};
  const Mesh wall = one_face({{0.25, 0.5, -1}, {1.75, 0.5, -1}, {1.75, 0.5, 1}, {0.25, 0.5, 1}});
  const auto device = each_device();
  const Object a(cut);
  const Object b(wall);
  const CollisionResult result = collide(*device, a, Pose::Identity(), b, Pose::Identity(), all);
  CHECK(result.contacts == std::vector<Contact>{{3, 0}, {7, 0}});
  CHECK(same_faces(brute_force_contacts(cut, Pose::Identity(), wall, Pose::Identity()), result.contacts));
  CHECK(result.stats.pairs == 4);
  CollisionRequest one = all;
  one.max_contacts = 1;
  CHECK(collide(*device, b, Pose::Identity(), a, Pose::Identity(), one).contacts.size() == 1);
}

TEST_CASE("collide: at most contacts, a face that was cut crosses if one of its parts does", "[lib][collide]") {
  // B touches one half of the square and crosses the other.
  const Mesh b = one_face({{0.5, 0.5, 0}, {0.25, 0.75, -0.5}, {0.25, 0.75, 1}});
  for (const int order : {0, 1, 2}) {
    Mesh a;
    if (order != 1) add_face(a, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
    if (order == 2) add_face(a, {{0.5, 0.5, 0}, {0.4, 0.5, 1}, {0.5, 0.4, 1}});  // another one that touches B
    add_face(a, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    if (order == 1) add_face(a, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
    a.file_face = order == 2 ? std::vector<std::uint32_t>{1, 0, 1} : std::vector<std::uint32_t>{0, 0};
    const Object object_a(a);
    const Object object_b(b);
    for (const std::string& target : cpu_targets()) {
      const auto device = open_cpu_device({1, target});
      for (const std::size_t most : {1, 2, 3}) {
        for (const bool swapped : {false, true}) {
          CAPTURE(order, target, most, swapped);
          CollisionRequest request = all;
          request.relation = true;
          request.max_contacts = most;
          const CollisionResult found =
              swapped ? collide(*device, object_b, Pose::Identity(), object_a, Pose::Identity(), request)
                      : collide(*device, object_a, Pose::Identity(), object_b, Pose::Identity(), request);
          REQUIRE(found.contacts.size() == (order == 2 ? std::min(most, std::size_t{2}) : 1));
          for (const Contact& contact : found.contacts) {
            const bool is_square = (swapped ? contact.face_b : contact.face_a) == (order == 2 ? 1U : 0U);
            CHECK(contact.relation == (is_square ? Relation::crossing : Relation::touching));
          }
          // All contacts are known unless there is one more than were wanted.
          if (order != 2 || most > 1) CHECK(found.relation == Relation::crossing);
        }
      }
    }
  }
}

TEST_CASE("collide: of polygons in many parts, the contacts that a query ends with are some of all", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  CollisionRequest request = all;
  request.relation = true;
  std::array<int, 3> first = {};
  for (int round = 0; round < 200; ++round) {
    const Object a(polygons_in_parts(6, 0, random));
    const Object b(polygons_in_parts(6, round % 5, random));
    for (const std::string& target : cpu_targets()) {
      const auto device = open_cpu_device({1, target});
      const auto ask = [&](CollisionRequest::Contacts contacts, std::size_t most) {
        request.contacts = contacts;
        request.max_contacts = most;
        return collide(*device, a, Pose::Identity(), b, Pose::Identity(), request);
      };
      const CollisionResult expected = ask(CollisionRequest::Contacts::all, 100);
      for (std::size_t most = 0; most <= expected.contacts.size(); ++most) {  // 0: the first one
        const CollisionResult found =
            most == 0 ? ask(CollisionRequest::Contacts::first, 1) : ask(CollisionRequest::Contacts::all, most);
        CAPTURE(round, target, most);
        REQUIRE(found.contacts.size() == std::min(std::max<std::size_t>(most, 1), expected.contacts.size()));
        if (most == 0) {
          REQUIRE(found.relation == expected.relation);  // one that touches is kept only until one crosses
          ++first[static_cast<std::size_t>(found.relation.value())];
        }
        for (const Contact& contact : found.contacts) {
          REQUIRE(std::find(expected.contacts.begin(), expected.contacts.end(), contact) != expected.contacts.end());
        }
      }
    }
  }
  for (const int count : first) CHECK(count > 50);
}

TEST_CASE("collide: the relation is known if there are no more contacts than were wanted", "[lib][collide]") {
  const Object a(one_face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  const Object b(one_face({{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}));
  CollisionRequest request = all;
  request.relation = true;
  request.max_contacts = 1;
  const auto device = each_device();
  const CollisionResult found = collide(*device, a, Pose::Identity(), b, Pose::Identity(), request);
  CHECK(found.contacts == std::vector<Contact>{{0, 0, Relation::touching}});
  CHECK(found.relation == Relation::touching);
}

TEST_CASE("collide: contacts are equal with their relations, or by their faces alone", "[lib][collide]") {
  const Contact touching = {3, 4, Relation::touching};
  const Contact crossing = {3, 4, Relation::crossing};
  CHECK(touching == Contact{3, 4, Relation::touching});
  CHECK(touching != crossing);
  CHECK(touching != Contact{3, 4});
  CHECK(same_faces(touching, crossing));
  CHECK_FALSE(same_faces(touching, Contact{3, 5, Relation::touching}));
  CHECK(same_faces(std::vector<Contact>{touching}, std::vector<Contact>{crossing}));
  CHECK_FALSE(same_faces(std::vector<Contact>{touching}, std::vector<Contact>{}));
}

TEST_CASE("collide: pairs whose crossing took exact arithmetic are counted as open", "[lib][collide]") {
  CollisionRequest request = all;
  // An edge of B goes right through A, so doubles see that they meet. Another one is parallel to an edge of A: whether
  // their cross product, rounded in these poses, is 0 takes exact arithmetic.
  const Pose pose_a = make_pose({0.1, 0.2, 0.3}, {10, 20, 30});
  const Pose pose_b = make_pose({0.11, 0.19, 0.3}, {10, 20, 30});
  const Object a(one_face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  const Object b(one_face({{0.25, 0.25, -1}, {0.25, 0.25, 1}, {1.25, 0.25, -1}}));
  const auto device = open_cpu_device({1, "plain"});
  request.relation = false;
  CHECK(collide(*device, a, pose_a, b, pose_b, request).stats.open == 0);
  request.relation = true;
  const CollisionResult found = collide(*device, a, pose_a, b, pose_b, request);
  CHECK(found.relation == Relation::crossing);
  CHECK(found.stats.open == 1);
  CHECK(found.stats.pairs == 1);
}

TEST_CASE("collide: without a device, from any number of threads", "[lib][collide]") {
  const Object torus(make_torus(1, 0.25, 12, 8));
  const Pose pose = make_pose({0.5, 0, 0}, {10, 20, 30});
  const auto device = open_device("cpu");
  const CollisionResult expected = collide(*device, torus, Pose::Identity(), torus, pose, all);
  std::atomic<int> same = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (int k = 0; k < 10; ++k) {
        same += collide(torus, Pose::Identity(), torus, pose, all).contacts == expected.contacts;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(same == 40);
  CHECK_THROWS_AS(collide(torus, pose, torus, pose, {CollisionRequest::Contacts::all, 0}), std::invalid_argument);
}

TEST_CASE("collide: most contacts", "[lib][collide]") {
  const Object gear(make_gear(1.4, 2, 0.6, 0.8, 12, 2));
  const auto device = each_device();
  const Pose pose = make_pose({0.5, 0, 0}, {10, 20, 30});
  const CollisionResult everything = collide(*device, gear, Pose::Identity(), gear, pose, all);
  REQUIRE(everything.contacts.size() > 20);
  for (const std::size_t most : {std::size_t{1}, std::size_t{7}, everything.contacts.size(), std::size_t{100000}}) {
    CollisionRequest request = all;
    request.max_contacts = most;
    const CollisionResult some = collide(*device, gear, Pose::Identity(), gear, pose, request);
    CHECK(some.hit);
    CHECK(some.contacts.size() == std::min(most, everything.contacts.size()));
    CHECK(std::includes(everything.contacts.begin(), everything.contacts.end(), some.contacts.begin(),
                        some.contacts.end()));
  }
}

TEST_CASE("collide: a batch gives what single queries give", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Object a(make_torus(2, 0.7, 24, 12));
  const Object b(make_gear(1.4, 2, 0.6, 0.8, 12, 2));
  std::vector<PosePair> poses(100);
  for (PosePair& pose : poses) {
    pose.a = random_pose(PoseClass::rigid, 1, random);
    pose.b = random_pose(PoseClass::rigid, 3, random);
  }
  const auto device = each_device();
  for (const CollisionRequest& request : {CollisionRequest{}, all}) {
    const std::vector<CollisionResult> batch = collide(*device, a, b, poses, request);
    REQUIRE(batch.size() == poses.size());
    std::size_t hits = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const CollisionResult single = collide(*device, a, poses[i].a, b, poses[i].b, request);
      hits += single.hit;
      CHECK(batch[i].hit == single.hit);
      CHECK(batch[i].contacts == single.contacts);
      CHECK(batch[i].stats.steps == single.stats.steps);
      CHECK(batch[i].stats.box_tests == single.stats.box_tests);
      CHECK(batch[i].stats.pairs == single.stats.pairs);
      CHECK(batch[i].stats.open == single.stats.open);
    }
    CHECK(hits > 0);
    CHECK(hits < poses.size());
  }
  CHECK(collide(*device, a, b, {}).empty());
}

TEST_CASE("collide: results of a batch come one call at a time, and an exception of the caller ends it",
          "[lib][collide]") {
  const Object a(make_torus(2, 0.7, 24, 12));
  const auto device = each_device();
  const std::vector<PosePair> poses(200);
  std::atomic<int> inside = 0;
  std::set<std::size_t> seen;
  collide(*device, a, a, poses, {}, [&](std::size_t i, const CollisionResult& result) {
    CHECK(++inside == 1);
    CHECK(result.hit);
    seen.insert(i);
    --inside;
  });
  CHECK(seen.size() == poses.size());
  const auto threads = open_cpu_device({4, {}});
  for (int i = 0; i < 10; ++i) {
    int calls = 0;
    const auto stop = [&calls](std::size_t, const CollisionResult&) {
      if (++calls != 3) return;
      // Meanwhile the other threads have results and wait for their turn.
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      throw std::runtime_error("enough");
    };
    CHECK_THROWS_WITH(collide(*threads, a, a, poses, {}, stop), "enough");
    CHECK(calls == 3);
  }
}

TEST_CASE("collide: a batch ends when its result function returns false", "[lib][collide]") {
  const Object torus(make_torus(1, 0.25, 12, 8));
  const std::vector<PosePair> poses(200, {Pose::Identity(), make_pose({0.5, 0, 0}, {0, 0, 0})});
  const auto device = each_device();
  for (const std::size_t most : {std::size_t{1}, std::size_t{7}, std::size_t{199}, std::size_t{200}}) {
    std::size_t taken = 0;
    collide(*device, torus, torus, poses, all, [&](std::size_t, const CollisionResult& result) {
      CHECK(result.hit);
      return ++taken < most;
    });
    CHECK(taken == most);
  }
  // Nothing, or anything that is not bool, continues.
  std::size_t taken = 0;
  const auto count = [&taken](std::size_t, const CollisionResult&) -> int { return ++taken == 0; };
  collide(*device, torus, torus, poses, all, count);
  collide(*device, torus, torus, poses, all, [&taken](std::size_t, const CollisionResult&) { ++taken; });
  CHECK(taken == 2 * poses.size());
}

TEST_CASE("collide: input that makes no sense is refused in one line", "[lib][collide]") {
  const Object a(one_face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  const auto device = each_device();
  Pose bad = Pose::Identity();
  bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(collide(*device, a, Pose::Identity(), a, bad),
                    "pose of B: row 0, column 3 is not finite or beyond 2^500; check it or scale it");
  bad = Pose::Identity();
  bad(1, 0) = 0x1p501;
  CHECK_THROWS_WITH(collide(*device, a, bad, a, Pose::Identity()),
                    "pose of A: row 1, column 0 is not finite or beyond 2^500; check it or scale it");
  int calls = 0;
  CHECK_THROWS_AS(collide(*device, a, a, {PosePair{bad, bad}, PosePair{}, PosePair{}}, {},
                          [&calls](std::size_t, const CollisionResult&) { ++calls; }),
                  std::invalid_argument);
  CHECK(calls <= 2);  // of the queries that are fetched by other threads, or in another order
  CollisionRequest none = all;
  none.max_contacts = 0;
  CHECK_THROWS_AS(collide(*device, a, Pose::Identity(), a, Pose::Identity(), none), std::invalid_argument);
  none = {};
  none.max_contacts = 0;
  CHECK_THROWS_AS(collide(*device, a, Pose::Identity(), a, Pose::Identity(), none), std::invalid_argument);
  none = {};
  none.least = Relation::apart;
  CHECK_THROWS_WITH(collide(*device, a, Pose::Identity(), a, Pose::Identity(), none),
                    "least is apart, and faces that are apart are no contact: give touching or crossing");
  CHECK_THROWS_WITH(Object(Mesh{}), "mesh has no faces");
  CHECK_THROWS_WITH(Object(one_face({{0, 0, 0}, {1, 0, std::numeric_limits<double>::infinity()}, {0, 1, 0}})),
                    Catch::Contains("vertex 1 is not finite"));
  CHECK_THROWS_WITH(open_device("gpu"), Catch::Contains("device gpu is not known: the devices are cpu"));
  CHECK_THROWS_WITH(open_cpu_device({1, "wide"}),
                    Catch::StartsWith("instruction set wide is not known on this computer: there are ") &&
                        Catch::EndsWith(cpu_targets().back()));
  CHECK(device_names().front() == "cpu");
  for (const std::string& name : device_names()) CHECK(open_device(name)->name() == name);
}

TEST_CASE("collide: faces that no mesh can have are refused", "[lib][collide]") {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces = {{Kind::tri, {0, 1, 2, 1000}}};  // the fourth of a triangle is unused
  const Mesh good = mesh;
  const auto check = [&good](const Mesh& bad, const std::string& message) {
    CHECK_THROWS_MATCHES(Object(bad), std::invalid_argument, Catch::Message(message));
    CHECK_THROWS_MATCHES(sweep_box_pairs(bad, good, [](CandidatePair) {}), std::invalid_argument,
                         Catch::Message(message));
    CHECK_THROWS_MATCHES(sweep_box_pairs(good, bad, [](CandidatePair) {}), std::invalid_argument,
                         Catch::Message(message));
  };
  CHECK(Object(good).mesh().faces.size() == 1);
  mesh.faces = {{Kind::tri, {1, 2, 3, 0}}};  // counted from 1, as in an OBJ file
  check(mesh, "face 0: vertex index 3 is out of range (the mesh has 3 vertices)");
  mesh.faces = {{Kind::tri, {0, 1, 2, 0}}, {Kind::quad, {0, 1, 2, 4000000000}}};
  check(mesh, "face 1: vertex index 4000000000 is out of range (the mesh has 3 vertices)");
  mesh.faces = {{static_cast<Kind>(7), {0, 1, 2, 0}}};
  check(mesh, "face 0: its kind is 7, neither triangle (3) nor quad (4)");
  mesh.faces = {{Kind::tri, {0, 1, 2, 0}}, {Kind::tri, {0, 2, 1, 0}}};
  mesh.file_face = {0};
  check(mesh, "face 1: file_face has 1 entries for 2 faces; give one for each face or none");
  mesh.file_face = {0, 0, 0};
  check(mesh, "face 2: file_face has 3 entries for 2 faces; give one for each face or none");
}

TEST_CASE("collide: queries without an object or a pose are refused", "[lib][collide]") {
  const auto device = each_device();
  const Pose here = Pose::Identity();
  const Object a(one_face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  Object gone = Object(a.mesh());
  const Object kept = std::move(gone);
  const auto check = [&](const CollisionQuery& query, const std::string& message) {
    CollisionResult result;
    CHECK_THROWS_MATCHES(device->collide(query, {}, result), std::invalid_argument, Catch::Message(message));
    CHECK_THROWS_MATCHES(collide(*device, std::vector<CollisionQuery>{{&a, &here, &a, &here}, query}),
                         std::invalid_argument, Catch::Message(message));
  };
  check({nullptr, &here, &a, &here}, "query: A is a null pointer; point it to an Object");
  check({&a, &here, nullptr, &here}, "query: B is a null pointer; point it to an Object");
  check({&a, nullptr, &a, &here}, "query: A's pose is a null pointer; point it to a Pose");
  check({&a, &here, &a, nullptr}, "query: B's pose is a null pointer; point it to a Pose");
  check({&a, &here, &gone, &here},  // NOLINT(bugprone-use-after-move)
        "query: B is an Object that was moved from; use the one that it was moved to");
  check({&gone, &here, &a, &here}, "query: A is an Object that was moved from; use the one that it was moved to");
  CHECK(collide(*device, a, here, kept, here).hit);
}

TEST_CASE("collide: a device that is in use says so, and works again after any exception", "[lib][collide]") {
  const Object a(make_torus(2, 0.7, 24, 12));
  const Pose here = Pose::Identity();
  const std::vector<PosePair> poses(40);
  const auto device = each_device();
  const std::string message = std::string("device ") + device->name() +
                              " is in use: open one device per thread, and do not call it from its result function";
  const auto works = [&] {
    CHECK(collide(*device, a, here, a, here).hit);
    CHECK(collide(*device, a, a, poses).size() == poses.size());
  };
  SECTION("from its result function") {
    int refused = 0;
    collide(*device, a, a, poses, {}, [&](std::size_t, const CollisionResult&) {
      CHECK_THROWS_MATCHES(collide(*device, a, here, a, here), std::logic_error, Catch::Message(message));
      CHECK_THROWS_MATCHES(collide(*device, a, a, poses), std::logic_error, Catch::Message(message));
      ++refused;
    });
    CHECK(refused == 40);
    works();
  }
  SECTION("from its result function, which passes the exception on") {
    const auto nested = [&](std::size_t, const CollisionResult&) { collide(*device, a, here, a, here); };
    for (int i = 0; i < 3; ++i) {
      CHECK_THROWS_MATCHES(collide(*device, a, a, poses, {}, nested), std::logic_error, Catch::Message(message));
    }
    works();
  }
  SECTION("from the function that gives the queries") {
    const auto nested = [&](std::size_t) {
      collide(*device, a, here, a, here);
      return CollisionQuery{&a, &here, &a, &here};
    };
    CHECK_THROWS_MATCHES(device->collide(2, nested, {}, [](std::size_t, const CollisionResult&) {}), std::logic_error,
                         Catch::Message(message));
    works();
  }
  SECTION("from another thread") {
    collide(*device, a, a, {PosePair{}}, {}, [&](std::size_t, const CollisionResult&) {
      std::string said;
      std::thread([&] {
        try {
          collide(*device, a, here, a, here);
        } catch (const std::logic_error& error) {
          said = error.what();
        }
      }).join();
      CHECK(said == message);
    });
    works();
  }
  SECTION("after a query that makes no sense") {
    CollisionResult result;
    CHECK_THROWS_AS(device->collide({}, {}, result), std::invalid_argument);
    CHECK_THROWS_AS(collide(*device, std::vector<CollisionQuery>(3)), std::invalid_argument);
    works();
  }
}

TEST_CASE("collide: a device works in a process made by fork, and can be closed there", "[lib][collide]") {
  const Object a(make_torus(2, 0.7, 24, 12));
  const std::vector<PosePair> poses(200);
  auto device = open_cpu_device({3, {}});
  REQUIRE(collide(*device, a, a, poses).size() == poses.size());  // its threads run now
  std::cout << std::flush;
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    alarm(30);  // ends the child if it hangs
    int hits = 0;
    for (int i = 0; i < 3; ++i) {
      for (const CollisionResult& result : collide(*device, a, a, poses)) hits += result.hit;
    }
    device.reset();
    _exit(hits == 600 ? 0 : 1);
  }
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  CHECK(collide(*device, a, a, poses).size() == poses.size());
}

#if defined(__SSE2__)
TEST_CASE("collide: a thread that flushes small numbers to zero is refused", "[lib][collide]") {
  const Mesh mesh = scaled(make_torus(2, 0.7, 6, 5), 1e-150);
  const Object a(mesh);
  const auto device = each_device();
  for (const unsigned bit : {0x8000U, 0x0040U}) {  // flush to zero, denormals are zero
    const unsigned before = _mm_getcsr();
    const auto refused = [&](const auto& work) {
      std::string said = "nothing";
      _mm_setcsr(before | bit);
      try {
        work();
      } catch (const std::runtime_error& error) {
        said = error.what();
      }
      _mm_setcsr(before);
      CHECK_THAT(said, Catch::StartsWith("this thread flushes small numbers to zero"));
      CHECK_THAT(said, Catch::Contains("_mm_setcsr(_mm_getcsr() & ~0x8040U)"));
    };
    CAPTURE(bit);
    refused([] { open_cpu_device({1, {}}); });
    for (const std::string& name : device_names()) refused([&name] { open_device(name); });
    refused([&] { Object{mesh}; });
    refused([&] { a.moved(mesh.vertices); });
    refused([&] { self_contacts(a); });
    refused([&] { collide(*device, a, Pose::Identity(), a, Pose::Identity()); });
    refused([&] { collide(*device, a, a, std::vector<PosePair>(3)); });
    CHECK(collide(*device, a, Pose::Identity(), a, Pose::Identity()).hit);
    _mm_setcsr(before | bit);
    {
      const GradualUnderflow mode;
      CHECK(_mm_getcsr() == before);
      CHECK(collide(*open_cpu_device({1, {}}), Object{mesh}, Pose::Identity(), a, Pose::Identity()).hit);
      const GradualUnderflow again;
    }
    CHECK((_mm_getcsr() & 0x8040U) == bit);
    _mm_setcsr(before);
  }
}
#endif

TEST_CASE("collide: copies of an object are one object", "[lib][collide]") {
  const Object a(one_face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  const Object copy = a;
  CHECK(copy.id() == a.id());
  CHECK(Object(a.mesh()).id() != a.id());
}

TEST_CASE("collide: a hint names the contact but never changes whether there is one", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  // Faces that were cut, too: a hint holds numbers of the file.
  Mesh cut = make_torus(1, 0.4, 9, 7);
  for (std::uint32_t i = 0; i < cut.faces.size(); ++i) cut.file_face.push_back(i / 2);
  const std::vector<Object> objects = {Object(make_torus(1, 0.4, 9, 7)), Object(make_torus(1, 0.4, 8, 6, Kind::quad)),
                                       Object(cut)};
  const std::uint32_t none = CollisionHint::none;
  std::size_t taken = 0;
  std::size_t touched = 0;
  std::size_t stale = 0;
  for (const std::string& target : cpu_targets()) {
    const auto device = open_cpu_device({1, target});
    for (const Object& a : objects) {
      for (const Object& b : objects) {
        for (int i = 0; i < 12; ++i) {
          const Pose pose_a = random_pose(PoseClass::rigid, 0.5, random);
          const Pose pose_b = random_pose(PoseClass::rigid, i % 2 == 0 ? 0.5 : 2.5, random);
          CollisionRequest all = {CollisionRequest::Contacts::all};
          all.relation = true;
          const CollisionResult wanted = collide(*device, a, pose_a, b, pose_b, all);
          for (const bool relation : {false, true}) {
            CollisionRequest first;
            first.relation = relation;
            std::vector<Contact> hints = {{0, 0}, {none, none}, {none - 1, 3}, {3, none - 1}, {none, 0}};
            if (wanted.hit) hints.push_back(wanted.contacts[random() % wanted.contacts.size()]);
            for (const Contact& hint : hints) {
              // The result of the query before is the hint, and is replaced.
              CollisionResult result;
              result.contacts = {hint};
              device->collide({&a, &pose_a, &b, &pose_b, result}, first, result);
              REQUIRE(result.hit == wanted.hit);
              if (relation) REQUIRE(result.relation == wanted.relation);
              if (!result.hit) {
                ++stale;
                continue;
              }
              ++touched;
              const auto named = std::find_if(wanted.contacts.begin(), wanted.contacts.end(),
                                              [&](const Contact& x) { return same_faces(x, result.contacts.front()); });
              REQUIRE(named != wanted.contacts.end());
              const bool is_contact = std::any_of(wanted.contacts.begin(), wanted.contacts.end(),
                                                  [&](const Contact& x) { return same_faces(x, hint); });
              if (!is_contact || relation) continue;
              ++taken;
              CHECK(same_faces(result.contacts.front(), hint));
              CHECK(result.stats.steps == 0);
            }
          }
        }
      }
    }
  }
  CHECK(taken > 20);
  CHECK(touched > 100);
  CHECK(stale > 100);
}

TEST_CASE("collide: of a few faces in a row each is found", "[lib][collide]") {
  // Triangles, quads, and pairs of triangles with a common side; a large face cuts one of them, or goes between two.
  const auto row = [](std::size_t count, int kind) {
    Mesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
      const auto x = 4 * static_cast<double>(i);
      if (kind == 1) {
        add_face(mesh, {{x, 0, 0}, {x + 2, 0, 0}, {x + 2, 1, 0}, {x, 1, 0}});
      } else {
        add_face(mesh, {{x, 0, 0}, {x + 2, 0, 0}, {x, 1, 0}});
        if (kind == 2) add_face(mesh, {{x + 2, 0, 0}, {x + 2, 1, 0}, {x, 1, 0}});
      }
    }
    return mesh;
  };
  for (const std::string& target : cpu_targets()) {
    const auto device = open_cpu_device({1, target});
    for (int kind = 0; kind < 3; ++kind) {
      for (std::size_t count = 1; count <= 5; ++count) {
        const Object faces(row(count, kind));
        for (const bool is_quad : {false, true}) {
          std::vector<Vec3d> cut = {{0, -60, -60}, {0, 60, -60}, {0, 0, 60}};
          if (is_quad) cut = {{0, -60, -60}, {0, 60, -60}, {0, 60, 60}, {0, -60, 60}};
          const Object wall(one_face(cut));
          for (std::size_t i = 0; i < count; ++i) {
            for (const double aside : {1.0, 2.0, 3.0}) {
              const Pose there = make_pose({4 * static_cast<double>(i) + aside, 0, 0}, {0, 0, 0});
              std::vector<Contact> expected;
              const auto number = static_cast<std::uint32_t>(kind == 2 ? 2 * i : i);
              if (aside < 3) expected.push_back({number, 0});
              if (aside < 3 && kind == 2) expected.push_back({number + 1, 0});
              CAPTURE(target, kind, count, is_quad, i, aside);
              CHECK(same_faces(collide(*device, faces, Pose::Identity(), wall, there, all).contacts, expected));
              const CollisionResult first = collide(*device, faces, Pose::Identity(), wall, there);
              CHECK(first.hit == !expected.empty());
              for (Contact& contact : expected) std::swap(contact.face_a, contact.face_b);
              CHECK(same_faces(collide(*device, wall, there, faces, Pose::Identity(), all).contacts, expected));
            }
          }
        }
      }
    }
  }
}

TEST_CASE("collide: only what nearly touches is counted as open", "[lib][collide]") {
  std::mt19937_64 random(7);
  const auto face = [&random](bool is_quad) {
    const Vec3d p = random_vector(random, 1);
    const Vec3d u = random_vector(random, 1);
    const Vec3d v = random_vector(random, 1);
    if (is_quad) return one_face({p, p + u, p + u + v, p + v});
    return one_face({p, p + u, p + v});
  };
  std::vector<std::unique_ptr<Device>> devices;
  for (const std::string& target : cpu_targets()) devices.push_back(open_cpu_device({1, target}));
  std::array<std::size_t, 2> tested = {0, 0};
  for (std::size_t i = 0; i < 120; ++i) {
    const Object a(face(i % 2 == 0));
    const Object b(face(i / 2 % 2 == 0));
    const Pose pose = random_pose(PoseClass::rigid, 0.5, random);
    const bool hit = exact_intersects(a.mesh().primitive(0), Pose::Identity(), b.mesh().primitive(0), pose);
    for (const auto& device : devices) {
      for (const bool everything : {false, true}) {
        const CollisionResult result =
            collide(*device, a, Pose::Identity(), b, pose, everything ? all : CollisionRequest{});
        CAPTURE(i, everything);
        CHECK(result.hit == hit);
        CHECK(result.stats.open == 0);
        CHECK(result.stats.pairs <= 1);
        tested[hit ? 1 : 0] += result.stats.pairs;
      }
    }
  }
  CHECK(tested[0] > 50);
  CHECK(tested[1] > 50);
  // A corner so near to the face that only exact arithmetic tells on which side it is.
  const Object plate(one_face({{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}}));
  const Object corner(one_face({{0, 0, 0}, {0, 0.4, 1}, {0.4, 0, 1}}));
  const Object torus(make_torus(1, 0.4, 6, 4));
  const Pose pose_a = make_pose({0.1, 0.2, 0.3}, {10, 20, 30});
  Pose pose_b = make_pose({0, 0, 0}, {11, 21, 31});
  pose_b.translation() = pose_a * Vec3d(0.1, 0.1, 0);
  for (const auto& device : devices) {
    for (const CollisionRequest& request : {CollisionRequest{}, all}) {
      const CollisionStats one = collide(*device, plate, pose_a, corner, pose_b, request).stats;
      CHECK(one.pairs == 1);
      CHECK(one.open == 1);
      const CollisionStats many = collide(*device, torus, pose_a, torus, pose_b, request).stats;
      CHECK(many.steps > 0);
      CHECK(many.box_tests >= many.steps);
    }
  }
}

TEST_CASE("collide: the same place is the least number, whatever comes behind it", "[lib][collide]") {
  for (const double behind : {-1.0, 1.0}) {
    // The first and the third vertex are one, and so are the others; what follows them differs.
    Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {5, 0, 0},           {0, 0, 0}, {behind, 0, 0},
                     {5, 0, 0}, {-5 * behind, 1, 0}, {5, 0, 0}, {0, 0, 0}};
    mesh.faces = {{Kind::tri, {0, 1, 3, 0}}, {Kind::tri, {2, 4, 5, 0}}, {Kind::tri, {7, 6, 5, 0}}};
    CHECK(Object(mesh).same_place() == std::vector<std::uint32_t>{0, 1, 0, 3, 1, 5, 1, 0});
  }
}
