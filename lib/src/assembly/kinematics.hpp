// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where links are when joints have values.
#ifndef CCHIP_ASSEMBLY_KINEMATICS_HPP
#define CCHIP_ASSEMBLY_KINEMATICS_HPP

#include <cchip/assembly.hpp>
#include <map>
#include <string>
#include <vector>

namespace cchip::assembly {

/// A value for each joint: those of the assembly, in place of them the named ones, and those of joints that follow.
/// \throws std::invalid_argument as move_joints()
std::vector<double> joint_values(const Assembly& assembly, const std::map<std::string, double>& values);

/// From the coordinates of each link to those of the assembly.
/// \param values one for each joint
std::vector<Pose> link_poses(const Assembly& assembly, const std::vector<double>& values);

/// Joints that follow others beyond their own limits, a line each.
std::vector<std::string> followers_beyond_limits(const Assembly& assembly, const std::vector<double>& values);

/// Do the limits of the joint count?
bool has_limits(const AssemblyJoint& joint);

}  // namespace cchip::assembly

#endif
