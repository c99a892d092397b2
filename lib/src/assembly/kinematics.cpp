// SPDX-License-Identifier: Apache-2.0
#include "kinematics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cchip/internal/geometry/quarter_turns.hpp>
#include <cmath>
#include <stdexcept>

#include "texts.hpp"

namespace cchip {

using JointKind = AssemblyJoint::Kind;

const char* name_of(AssemblyJoint::Kind kind) {
  switch (kind) {
    case JointKind::fixed:
      return "fixed";
    case JointKind::revolute:
      return "revolute";
    case JointKind::continuous:
      return "continuous";
    case JointKind::prismatic:
      return "prismatic";
    case JointKind::planar:
      return "planar";
    case JointKind::floating:
      return "floating";
  }
  return "";
}

namespace assembly {
namespace {

std::string limits_text(const AssemblyJoint& joint) {
  return number_text(joint.lower) + " to " + number_text(joint.upper);
}

bool is_within_limits(const AssemblyJoint& joint, double value) {
  return !has_limits(joint) || (value >= joint.lower && value <= joint.upper);
}

void check_value(const Assembly& assembly, const AssemblyJoint& joint, double value) {
  const auto refuse = [&joint](const std::string& what) {
    throw std::invalid_argument("joint '" + joint.name + "': " + what);
  };
  if (joint.kind == JointKind::fixed) refuse("is fixed; name one that moves");
  if (joint.kind == JointKind::planar || joint.kind == JointKind::floating) {
    refuse(std::string("is ") + name_of(joint.kind) + ", which is not moved; leave it out");
  }
  if (joint.leader) {
    refuse("follows joint '" + assembly.joints[*joint.leader].name + "'; give the value of that one");
  }
  if (!std::isfinite(value)) refuse("the value is not finite; give one that is");
  if (!is_within_limits(joint, value)) {
    refuse("the value " + number_text(value) + " is beyond its limits, " + limits_text(joint) +
           "; give one within them");
  }
}

/// What the value does, in the coordinates of the joint. Quarter turns about the axes of coordinates are exact.
Pose moved_by(const AssemblyJoint& joint, double value) {
  Pose pose = Pose::Identity();
  if (joint.kind == JointKind::prismatic) {
    pose.translation() = value * joint.axis;
  } else if (joint.kind == JointKind::revolute || joint.kind == JointKind::continuous) {
    if (joint.axis.cwiseAbs().sum() == 1 && joint.axis.cwiseAbs().maxCoeff() == 1) {
      pose.linear() = make_pose(Vec3d::Zero(), to_degrees(value) * joint.axis).linear();
    } else {
      pose.linear() = snapped(Eigen::AngleAxisd(value, joint.axis).toRotationMatrix());
    }
  }
  return pose;
}

}  // namespace

bool has_limits(const AssemblyJoint& joint) {
  return joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic;
}

std::vector<double> joint_values(const Assembly& assembly, const std::map<std::string, double>& values) {
  std::vector<double> all;
  for (const AssemblyJoint& joint : assembly.joints) {
    const auto named = values.find(joint.name);
    if (named != values.end()) check_value(assembly, joint, named->second);
    all.push_back(named != values.end() ? named->second : joint.value);
  }
  for (const auto& [name, value] : values) {
    if (std::any_of(assembly.joints.begin(), assembly.joints.end(),
                    [&named = name](const AssemblyJoint& joint) { return joint.name == named; })) {
      continue;
    }
    std::string known;
    for (const AssemblyJoint& joint : assembly.joints) {
      const bool moves = has_limits(joint) || joint.kind == JointKind::continuous;
      if (moves && !joint.leader) known += (known.empty() ? "" : ", ") + joint.name;
    }
    throw std::invalid_argument("joint '" + name + "': there is no such joint; " +
                                (known.empty() ? "leave it out, none can be moved" : "name one of " + known));
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const AssemblyJoint& joint = assembly.joints[i];
    if (joint.leader) all[i] = joint.multiplier * all[*joint.leader] + joint.offset;
  }
  return all;
}

std::vector<Pose> link_poses(const Assembly& assembly, const std::vector<double>& values) {
  std::vector<Pose> poses(assembly.links.size(), Pose::Identity());
  for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
    const AssemblyJoint& joint = assembly.joints[i];
    poses[joint.child] = poses[joint.parent] * joint.origin * moved_by(joint, values[i]);
  }
  return poses;
}

std::vector<std::string> followers_beyond_limits(const Assembly& assembly, const std::vector<double>& values) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const AssemblyJoint& joint = assembly.joints[i];
    if (!joint.leader || is_within_limits(joint, values[i])) continue;
    notes.push_back("joint '" + joint.name + "' follows '" + assembly.joints[*joint.leader].name + "' to " +
                    rounded_text(values[i]) + ", beyond its limits, " + limits_text(joint));
  }
  return notes;
}

}  // namespace assembly

std::vector<std::string> move_joints(Assembly& assembly, const std::map<std::string, double>& values) {
  const std::vector<double> all = assembly::joint_values(assembly, values);
  const std::vector<Pose> poses = assembly::link_poses(assembly, all);
  for (std::size_t i = 0; i < all.size(); ++i) assembly.joints[i].value = all[i];
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const AssemblyLink& link = assembly.links[i];
    if (link.part) assembly.parts[*link.part].pose = poses[i] * link.place;
  }
  return assembly::followers_beyond_limits(assembly, all);
}

}  // namespace cchip
