// SPDX-License-Identifier: Apache-2.0
// FCL computes in doubles, so it may err near contact. Where its answer differs from the CPU device's, exact integers
// decide about the faces in question, and the pose is listed.
#include <catch2/catch.hpp>
#include <cchip/device.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <iostream>
#include <random>

#include "ask.hpp"
#include "fcl_model.hpp"

using namespace cchip;
using namespace cchip::testing;

namespace {

struct Body {
  explicit Body(const Mesh& mesh) : object(mesh), model(fcl_model(mesh)) {}
  Object object;
  std::shared_ptr<FclModel> model;
};

struct Count {
  int poses = 0;
  int hits = 0;
  int fcl_missed = 0;
  int fcl_invented = 0;
};

void compare(const Body& a, const Eigen::Isometry3d& pose_a, const Body& b, const Eigen::Isometry3d& pose_b,
             Count& count) {
  static const auto device = open_device("cpu");
  const CollisionResult ours = collide(*device, a.object, pose_a, b.object, pose_b);
  const fcl::CollisionResult<double> theirs = fcl_collide(*a.model, pose_a, *b.model, pose_b);
  ++count.poses;
  count.hits += ours.hit;
  if (ours.hit == theirs.isCollision()) return;
  (ours.hit ? count.fcl_missed : count.fcl_invented) += 1;
  Contact faces;
  if (ours.hit) {
    faces = ours.contacts.front();
  } else {
    faces = {static_cast<std::uint32_t>(theirs.getContact(0).b1), static_cast<std::uint32_t>(theirs.getContact(0).b2)};
  }
  const bool exact = exact_intersects(a.object.mesh().primitive(faces.face_a), Pose(pose_a),
                                      b.object.mesh().primitive(faces.face_b), Pose(pose_b));
  std::cout << "pose " << count.poses << ": " << a.object.mesh().name << " and " << b.object.mesh().name
            << ", FCL says " << theirs.isCollision() << ", exact integers about faces " << faces.face_a << " and "
            << faces.face_b << " say " << exact << '\n';
  CHECK(exact == ours.hit);
}

}  // namespace

TEST_CASE("FCL answers the same, except where it errs", "[ref][fcl]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double range) {
    const double x = unit(random);
    const double y = unit(random);
    return Vec3d(range * x, range * y, range * unit(random));
  };
  const Body torus(make_torus(1, 0.25, 48, 24));
  const Body gear(make_gear(1.25, 1.5, 0.5, 0.5, 24, 4));
  const Body sphere(make_sphere(1, 20, 0.05));
  const std::vector<std::pair<const Body*, const Body*>> pairs = {
      {&torus, &gear}, {&torus, &torus}, {&sphere, &gear}, {&sphere, &sphere}};
  Count general;
  for (int i = 0; i < 1000; ++i) {
    const auto& [a, b] = pairs[static_cast<std::size_t>(i) % pairs.size()];
    compare(*a, make_pose(vector(1), vector(180)), *b, make_pose(vector(1.5), vector(180)), general);
  }
  CHECK(general.hits > 100);
  CHECK(general.hits < 900);
  // The torus' highest ring in or next to the gear's lower face, both turned by the same angles.
  Count close;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Isometry3d turned = make_pose(vector(1), vector(180));
    Eigen::Isometry3d above = turned;
    const double gap = i % 2 == 0 ? 0.0 : std::ldexp(unit(random), -50 + i % 8);
    above.translation() += turned.linear() * Vec3d(0, 0, 0.5 + gap);
    compare(torus, turned, gear, above, close);
  }
  for (const Count& c : {general, close}) {
    std::cout << "poses=" << c.poses << " hits=" << c.hits << " fcl_missed=" << c.fcl_missed
              << " fcl_invented=" << c.fcl_invented << '\n';
  }
}

TEST_CASE("The judge of bench-collide and collide_agreement finds wrong answers", "[ref][fcl]") {
  const PeerLibrary debian = PeerLibrary::fcl_debian();
  const Bodies bodies(
      {"torus and gear", make_torus(1, 0.25, 48, 24, Kind::quad), make_gear(1.25, 1.5, 0.5, 0.5, 24, 4)}, debian);
  const PosePair poses = {Pose::Identity(), Pose(make_pose({0, 0.1, 0.4}, {7, 8, 9}))};
  const auto device = open_device("cpu");
  const std::vector<Contact> right = collide(*device, bodies.a, poses.a, bodies.b, poses.b, all_contacts).contacts;
  REQUIRE(right.size() > 100);
  CHECK(bodies.fcl_a.hit(poses.a, bodies.fcl_b, poses.b));
  CHECK(bodies.fcl_a.count_contacts(poses.a, bodies.fcl_b, poses.b) >= right.size());
  CHECK(bodies.judge(poses, right, bodies.fcl_a.contacts(poses.a, bodies.fcl_b, poses.b)).unexplained == 0);
  CHECK(bodies.judge(poses, true, right.front()).unexplained == 0);
  CHECK(bodies.judge(poses, false, {}).unexplained == right.size());
  std::vector<Contact> wrong = right;
  wrong.erase(wrong.begin() + 17);
  CHECK(bodies.judge(poses, wrong, right).unexplained == 1);
  CHECK(bodies.judge(poses, right, wrong).asked == 1);
  CHECK(bodies.judge(poses, right, wrong).unexplained == 0);  // exact integers say that ours are right
  Contact apart = {0, 0};
  while (bodies.exact(apart, poses)) ++apart.face_b;
  CHECK(bodies.judge(poses, true, apart).unexplained == 1);
}
