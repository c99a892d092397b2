// SPDX-License-Identifier: Apache-2.0
// Assemblies that move. Robots are made here, of boxes whose places say what must be found and when.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/assembly_motion.hpp>
#include <cchip/distance.hpp>
#include <cchip/program/seed.hpp>
#include <cmath>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "bvh_meshes.hpp"

using namespace cchip;
using cchip::testing::make_box;

namespace {

using JointKind = AssemblyJoint::Kind;
using RuleKind = AssemblyRule::Kind;

Object box(const Vec3d& low, const Vec3d& high) { return Object(make_box(low, high)); }

/// A robot whose root, link 0, has no shape.
class Robot {
 public:
  Robot() { assembly.links.push_back({"root", std::nullopt, Pose::Identity()}); }
  /// \returns the number of the link
  std::size_t add(const std::string& name, std::size_t parent, JointKind kind, const Vec3d& origin, const Vec3d& axis,
                  const Object& object) {
    AssemblyJoint joint;
    joint.name = name;
    joint.kind = kind;
    joint.parent = parent;
    joint.child = assembly.links.size();
    joint.origin.translation() = origin;
    joint.axis = axis;
    joint.lower = -10;
    joint.upper = 10;
    assembly.joints.push_back(joint);
    assembly.links.push_back({name, assembly.parts.size(), Pose::Identity()});
    assembly.parts.push_back({name, object});
    move_joints(assembly, {});
    return joint.child;
  }
  Assembly assembly;
};

/// A cube of 0.1 that slides along x, and a wall of 0.001 at x = 0 above y = `low`.
Robot cube_and_wall(double low) {
  Robot robot;
  robot.add("wall", 0, JointKind::fixed, Vec3d::Zero(), {1, 0, 0}, box({-0.0005, low, -1}, {0.0005, low + 1, 1}));
  robot.add("cube", 0, JointKind::prismatic, Vec3d::Zero(), {1, 0, 0}, box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}));
  return robot;
}

AssemblyMotion moving(const std::vector<std::string>& joints, const std::vector<std::vector<double>>& values) {
  AssemblyMotion motion;
  motion.joints = joints;
  motion.values = values;
  return motion;
}

AssemblyRule rule(RuleKind kind, double limit = 0) {
  AssemblyRule made;
  made.kind = kind;
  made.limit = limit;
  return made;
}

bool is_unproved(const MotionPair& pair, double time) {
  return std::any_of(pair.unproved.begin(), pair.unproved.end(),
                     [time](const auto& range) { return time >= range[0] && time <= range[1]; });
}

}  // namespace

TEST_CASE("motion: a thin wall between two rows is found", "[assembly][motion]") {
  const Robot robot = cube_and_wall(-0.5);
  const MotionReport report = check_motion(robot.assembly, moving({"cube"}, {{-1}, {1}}));
  REQUIRE(report.violations == 1);
  REQUIRE(report.pairs.size() == 1);
  const double meets = (1 - 0.0505) / 2;
  CHECK(*report.pairs[0].time >= meets - 1e-12);
  CHECK(*report.pairs[0].time <= meets + 1e-4);
  CHECK(report.pairs[0].unproved.empty());
  CHECK(report.looks < 60);
}

TEST_CASE("motion: one that misses is proved", "[assembly][motion]") {
  Robot robot = cube_and_wall(0.06);
  const AssemblyMotion motion = moving({"cube"}, {{-1}, {1}, {-0.5}});
  const MotionReport report = check_motion(robot.assembly, motion);
  CHECK(report.violations == 0);
  CHECK(report.unproved == 0);
  CHECK(report.pairs[0].clearance_lower >= 0.009 * (1 - 1e-9));
  CHECK(report.pairs[0].clearance_lower <= 0.01);
  CHECK(report.pairs[0].clearance_upper >= 0.01 * (1 - 1e-9));
  robot.assembly.clearance = 0.009;
  CHECK(check_motion(robot.assembly, motion).violations == 0);
  CHECK(check_motion(robot.assembly, motion).unproved == 0);
  robot.assembly.clearance = 0.0101;
  const MotionReport near = check_motion(robot.assembly, motion);
  CHECK(near.violations == 1);
  CHECK(near.pairs[0].violation.verdict == PairVerdict::too_near);
}

TEST_CASE("motion: a turn of more than a half sweeps what is on its way", "[assembly][motion]") {
  Robot robot;
  robot.add("post", 0, JointKind::fixed, {-2, 0, 0}, {1, 0, 0}, box({-0.1, -0.1, -1}, {0.1, 0.1, 1}));
  robot.add("arm", 0, JointKind::continuous, Vec3d::Zero(), {0, 0, 1}, box({0.5, -0.1, -0.1}, {2.5, 0.1, 0.1}));
  const double pi = std::acos(-1.0);
  const MotionReport report = check_motion(robot.assembly, moving({"arm"}, {{-pi / 2}, {3 * pi / 2}}));
  REQUIRE(report.violations == 1);
  CHECK(*report.pairs[0].time > 0.7);
  CHECK(*report.pairs[0].time < 0.75);
  // The same places at both ends the other way round are clear.
  CHECK(check_motion(robot.assembly, moving({"arm"}, {{-pi / 2}, {pi / 2}})).violations == 0);
}

TEST_CASE("motion: what cannot be proved is named", "[assembly][motion]") {
  Robot robot = cube_and_wall(0.05);  // slides along the wall's lower end, and touches it
  const AssemblyMotion motion = moving({"cube"}, {{-1}, {1}});
  CHECK(check_motion(robot.assembly, motion).violations == 1);
  robot.assembly.rules = {rule(RuleKind::touching)};
  const MotionReport report = check_motion(robot.assembly, motion);
  CHECK(report.violations == 0);
  REQUIRE(report.unproved == 1);
  REQUIRE(report.pairs[0].unproved.size() == 1);
  CHECK(report.pairs[0].unproved[0][0] <= (1 - 0.0505) / 2);
  CHECK(report.pairs[0].unproved[0][1] >= (1 + 0.0505) / 2);
  CHECK(report.pairs[0].unproved[0][1] - report.pairs[0].unproved[0][0] < 0.06);
  robot.assembly.rules = {rule(RuleKind::anything)};
  robot.assembly.rules[0].reason = "a slide";
  CHECK(check_motion(robot.assembly, motion).pairs.empty());
}

TEST_CASE("motion: parts that move together stay as they are", "[assembly][motion]") {
  Robot robot;
  const std::size_t first =
      robot.add("a", 0, JointKind::continuous, Vec3d::Zero(), {0, 0, 1}, box({1, -0.1, -0.1}, {2, 0.1, 0.1}));
  robot.add("b", first, JointKind::fixed, {1, 0, 0}, {1, 0, 0}, box({1, -0.1, -0.1}, {2, 0.1, 0.1}));
  robot.assembly.rules = {rule(RuleKind::touching)};
  CHECK(check_motion(robot.assembly, moving({"a"}, {{0}, {1}, {7}})).unproved == 0);
  robot.assembly.rules.clear();
  const MotionReport report = check_motion(robot.assembly, moving({"a"}, {{0}, {1}, {7}}));
  REQUIRE(report.violations == 1);
  CHECK(*report.pairs[0].time == 0);
}

TEST_CASE("motion: a part inside another is found at the start", "[assembly][motion]") {
  Robot robot;
  robot.add("shell", 0, JointKind::fixed, Vec3d::Zero(), {1, 0, 0}, box({-9, -9, -9}, {9, 9, 9}));
  robot.add("cube", 0, JointKind::prismatic, Vec3d::Zero(), {1, 0, 0}, box({-1, -1, -1}, {1, 1, 1}));
  const MotionReport report = check_motion(robot.assembly, moving({"cube"}, {{-1}, {1}}));
  REQUIRE(report.violations == 1);
  CHECK(*report.pairs[0].time == 0);
  CHECK(report.pairs[0].violation.verdict == PairVerdict::b_in_a);
  robot.assembly.rules = {rule(RuleKind::inside)};
  robot.assembly.rules[0].parts = {"cube", "shell"};
  CHECK(check_motion(robot.assembly, moving({"cube"}, {{-1}, {1}})).violations == 0);
  const MotionReport out = check_motion(robot.assembly, moving({"cube"}, {{-1}, {10}}));
  REQUIRE(out.violations == 1);  // it leaves at x = 8
  CHECK(*out.pairs[0].time == Approx(9.0 / 11).margin(2e-4));
}

TEST_CASE("motion: parts that move by themselves", "[assembly][motion]") {
  Assembly assembly;
  assembly.parts = {{"plate", box({-1, -1, 0}, {1, 1, 0.01})}, {"pin", box({-0.1, -0.1, 1}, {0.1, 0.1, 2})}};
  AssemblyMotion motion;
  motion.parts = {"pin"};
  motion.moves = {{RigidPose::Identity()}, {make_pose({0, 0, -4}, {0, 0, 90})}};
  const MotionReport report = check_motion(assembly, motion);
  REQUIRE(report.violations == 1);
  CHECK(*report.pairs[0].time == Approx(0.99 / 4).margin(2e-4));
  motion.moves = {{RigidPose::Identity()}, {make_pose({5, 0, 0}, {0, 0, 180})}, {make_pose({5, 0, -4}, {0, 0, 0})}};
  CHECK(check_motion(assembly, motion).violations == 0);
  CHECK(check_motion(assembly, motion).unproved == 0);
  motion.parts = {"pin", "plate"};  // both together
  motion.moves = {{RigidPose::Identity(), RigidPose::Identity()},
                  {make_pose({5, 0, 0}, {0, 0, 180}), make_pose({5, 0, 0}, {0, 0, 180})}};
  CHECK(check_motion(assembly, motion).pairs[0].clearance_lower == Approx(0.99));
}

TEST_CASE("motion: wrong input", "[assembly][motion]") {
  const Robot robot = cube_and_wall(0.06);
  const auto error = [&](const AssemblyMotion& motion, const MotionOptions& options = {}) {
    try {
      check_motion(robot.assembly, motion, options);
    } catch (const std::invalid_argument& thrown) {
      return std::string(thrown.what());
    }
    return std::string();
  };
  CHECK(error(moving({"cube"}, {{0}})).empty());
  CHECK(error(moving({"cube"}, {})).find("no row") != std::string::npos);
  CHECK(error(moving({"cube"}, {{0}, {11}})).find("row 1 of the path: joint 'cube': the value 11") == 0);
  CHECK(error(moving({"x"}, {{0}})).find("there is no such joint") != std::string::npos);
  CHECK(error(moving({"cube"}, {{0, 1}})).find("another number of values") != std::string::npos);
  CHECK(error(moving({"cube", "cube"}, {{0, 1}})).find("twice") != std::string::npos);
  AssemblyMotion parts;
  parts.parts = {"cube"};
  parts.moves = {{RigidPose::Identity()}};
  CHECK(error(parts).find("is a robot") != std::string::npos);
  MotionOptions options;
  options.least_step = 0;
  CHECK(error(moving({"cube"}, {{0}}), options).find("least step") != std::string::npos);
}

// Many looks on the way as reference: what they hit must be known, and none may be nearer than was proved.
TEST_CASE("motion: random arms against many looks", "[assembly][motion]") {
  const std::uint64_t seed = sim::seed_from_environment();
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t hits = 0;
  std::size_t clear = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Robot robot;
    const auto axis = [&] { return Vec3d(unit(random), unit(random), 1).normalized(); };
    for (int i = 0; i < 3; ++i) {
      const Vec3d at = 3 * Vec3d(unit(random), unit(random), 0.3 * unit(random));
      robot.add("post" + std::to_string(i), 0, JointKind::fixed, at, {1, 0, 0},
                box({-0.2, -0.1, -0.5}, {0.2, 0.1, 0.5}));
    }
    const std::size_t upper =
        robot.add("upper", 0, JointKind::revolute, Vec3d::Zero(), axis(), box({0.4, -0.1, -0.1}, {1.3, 0.1, 0.1}));
    robot.add("lower", upper, trial % 2 == 0 ? JointKind::revolute : JointKind::prismatic, {1.5, 0, 0}, axis(),
              box({0, -0.05, -0.05}, {1.2, 0.05, 0.05}));
    robot.assembly.left_out = {{3, 4}};
    robot.assembly.rules = {rule(RuleKind::nothing)};
    std::vector<std::vector<double>> rows;
    for (int i = 0; i < 3; ++i) rows.push_back({3 * unit(random), 2 * unit(random)});
    MotionOptions options;
    options.least_step = 1e-3;
    const MotionReport report = check_motion(robot.assembly, moving({"upper", "lower"}, rows), options);
    constexpr int looks = 400;
    for (int i = 0; i < 2 * looks; ++i) {
      const double time = static_cast<double>(i) / looks;
      const auto row = static_cast<std::size_t>(i / looks);
      const double rest = time - static_cast<double>(row);
      const auto value = [&](std::size_t joint) {
        return rows[row][joint] + rest * (rows[row + 1][joint] - rows[row][joint]);
      };
      move_joints(robot.assembly, {{"upper", value(0)}, {"lower", value(1)}});
      for (const MotionPair& pair : report.pairs) {
        if (pair.time && time > *pair.time - options.least_step) continue;
        const AssemblyPart& a = robot.assembly.parts[pair.a];
        const AssemblyPart& b = robot.assembly.parts[pair.b];
        const bool unproved = is_unproved(pair, time);
        INFO("seed " << seed << " trial " << trial << " pair " << pair.a << ' ' << pair.b << " time " << time);
        if (collide(a.object, a.pose, b.object, b.pose).hit) REQUIRE(unproved);
        if (!pair.time && !unproved && i % 16 == 0) {
          REQUIRE(distance(a.object, a.pose, b.object, b.pose).upper >= pair.clearance_lower * (1 - 1e-12));
        }
      }
    }
    for (const MotionPair& pair : report.pairs) {
      hits += pair.time && *pair.time > 0 ? 1 : 0;
      clear += !pair.time && pair.unproved.empty() ? 1 : 0;
      if (!pair.time) continue;
      const auto row = std::min<std::size_t>(static_cast<std::size_t>(*pair.time), 1);
      const double rest = *pair.time - static_cast<double>(row);
      const auto value = [&](std::size_t joint) {
        return rest == 1 ? rows[row + 1][joint] : rows[row][joint] + rest * (rows[row + 1][joint] - rows[row][joint]);
      };
      move_joints(robot.assembly, {{"upper", value(0)}, {"lower", value(1)}});
      CHECK(check(robot.assembly).violations > 0);
    }
  }
  CHECK(hits >= 10);
  CHECK(clear >= 100);
}
