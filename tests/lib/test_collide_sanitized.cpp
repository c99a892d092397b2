// SPDX-License-Identifier: Apache-2.0
// Answers of all instruction sets, of single queries and of batches, in a program that watches memory and arithmetic.
#include <catch2/catch.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <random>

#include "random_poses.hpp"

using namespace cchip;
using cchip_test::PoseClass;
using cchip_test::random_pose;

TEST_CASE("CPU device: every instruction set gives the answers of the plain search", "[lib][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Object objects[] = {Object(make_torus(2, 0.7, 24, 12)), Object(make_gear(1.4, 2, 0.6, 0.8, 12, 2)),
                            Object(make_sphere(0.001, 6, 0.0001)), Object(make_torus(1e4, 3e3, 12, 8))};
  std::vector<PosePair> poses;
  for (const PoseClass c : {PoseClass::rigid, PoseClass::quarter_turns, PoseClass::shear, PoseClass::flat}) {
    for (int i = 0; i < 12; ++i) poses.push_back({random_pose(c, 1, random), random_pose(c, 2, random)});
  }
  std::vector<CollisionQuery> queries;
  for (const Object& a : objects) {
    for (const Object& b : objects) {
      for (const PosePair& pose : poses) queries.push_back({&a, &pose.a, &b, &pose.b});
    }
  }
  CollisionRequest all;
  all.contacts = CollisionRequest::Contacts::all;
  all.max_contacts = 2000;
  const auto plain = open_cpu_device({1, "plain"});
  const std::vector<CollisionResult> expected = collide(*plain, queries);
  const std::vector<CollisionResult> contacts = collide(*plain, queries, all);
  for (const std::string& target : cpu_targets()) {
    INFO(target);
    const auto device = open_cpu_device({2, target});
    const std::vector<CollisionResult> first = collide(*device, queries);
    const std::vector<CollisionResult> every = collide(*device, queries, all);
    std::size_t hits = 0;
    CollisionResult result;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      hits += first[i].hit;
      REQUIRE(first[i].hit == expected[i].hit);
      REQUIRE(every[i].contacts.size() == contacts[i].contacts.size());
      // Which contacts a search finds before there are too many is its own choice.
      if (contacts[i].contacts.size() < all.max_contacts) REQUIRE((every[i].contacts == contacts[i].contacts));
      device->collide(queries[i], {}, result);
      REQUIRE(result.hit == expected[i].hit);
    }
    CHECK(hits > queries.size() / 10);
    CHECK(hits < queries.size());
  }
}
