// SPDX-License-Identifier: Apache-2.0
// The model of the chip as a device, against the CPU and against the model's own query.
#include <catch2/catch.hpp>
#include <cchip/device.hpp>
#include <cchip/driver/model_device.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/program/seed.hpp>

#include "answers.hpp"
#include "bvh_meshes.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip::testing;
using cchip_test::PoseClass;
using cchip_test::random_pose;

TEST_CASE("collide: the model and the CPU agree on meshes of more faces", "[ref][collide]") {
  std::mt19937_64 random(sim::seed_from_environment());
  // More objects than the device caches images of.
  std::vector<Object> objects;
  for (int i = 0; i < 3; ++i) {
    objects.emplace_back(noisy(make_torus(2, 0.7, 40, 20), 0.02, random));
    objects.emplace_back(noisy(make_torus(1, 0.4, 30, 16, Kind::quad), 0.01, random));
    objects.emplace_back(make_gear(1.4, 2, 0.6, 0.8, 12, 2));
    objects.emplace_back(soup(200, i == 0, random));
  }
  const auto cpu = open_device("cpu");
  const auto model = open_device("model");
  Tally tally;
  for (int n = 0; n < 300; ++n) {
    const Object& a = objects[random() % objects.size()];
    const Object& b = objects[random() % objects.size()];
    PosePair poses;
    poses.a = random_pose(PoseClass::rigid, 1, random);
    poses.b = random_pose(random() % 8 == 0 ? PoseClass::mirror : PoseClass::rigid, 2.5, random);
    CAPTURE(n);
    CollisionRequest told = all;
    told.relation = true;
    check_answers(*model, a, b, poses, collide(*cpu, a, poses.a, b, poses.b, told).contacts, tally);
  }
  tally.print(*model);
  CHECK(tally.hits > 50);
  CHECK(tally.hits < 290);
}

TEST_CASE("collide: counts of the model are those of the chip's query", "[ref][collide]") {
  const Object a(make_torus(2, 0.7, 40, 20));
  const Object b(make_gear(1.4, 2, 0.6, 0.8, 12, 2));
  const bvh::Image image_a = bvh::make_image(a.mesh(), bvh::build_tree(a.mesh()));
  const bvh::Image image_b = bvh::make_image(b.mesh(), bvh::build_tree(b.mesh()));
  const auto device = open_device("model");
  for (const double x : {0.0, 0.5, 2.5, 10.0}) {
    const Pose pose = make_pose({x, 0.25, 0}, {10, 20, 30});
    auto query = bvh::make_query(image_a.header(), Pose::Identity(), image_b.header(), pose);
    REQUIRE(query);
    query->mode = QueryMode::all;
    const auto expected =
        query->swapped ? model::run_query(*query, image_b, image_a) : model::run_query(*query, image_a, image_b);
    const CollisionResult found = collide(*device, a, Pose::Identity(), b, pose, all);
    CHECK(found.hit == (x < 5));
    CHECK(found.stats.steps == expected.counts.steps);
    CHECK(found.stats.box_tests == expected.counts.box_tests);
    CHECK(found.stats.pairs == expected.counts.primitive_pairs);
    CHECK(found.stats.open == expected.counts.open_pairs);
    CHECK(found.stats.clocks == 0);
  }
}

TEST_CASE("collide: what the chip does not take is answered all the same", "[ref][collide]") {
  const Object gear(make_gear(1.4, 2, 0.6, 0.8, 12, 2));
  const Object small(scaled(make_gear(1.4, 2, 0.6, 0.8, 12, 2), 0x1p-20));  // units too far apart
  const auto cpu = open_device("cpu");
  const auto model = open_device("model");
  Pose at_tooth = Pose::Identity();
  at_tooth.translation() = gear.mesh().vertices.front();
  const auto same = [&](const Object& a, const Object& b, const Pose& pose) {
    const CollisionResult expected = collide(*cpu, a, Pose::Identity(), b, pose, all);
    CHECK(expected.hit);
    CHECK(collide(*model, a, Pose::Identity(), b, pose, all).contacts == expected.contacts);
    CHECK(collide(*model, a, Pose::Identity(), b, pose).hit);
  };
  same(gear, small, at_tooth);
  Pose flat = Pose::Identity();
  flat(2, 2) = 0;
  same(gear, gear, flat);
  // Hundreds of open pairs, none of them certain: the chip gives a FIRST query to its host.
  same(gear, gear, Pose::Identity());
}
