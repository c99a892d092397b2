// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cchip/pose.hpp>
#include <cmath>

namespace cchip {
namespace {

/// Rotation in the plane of axes `from` and `to`; the quarter turns have no rounding error.
Eigen::Matrix3d rotation(double degrees, int from, int to) {
  int quarter = 0;
  const double rest = std::remquo(degrees, 90.0, &quarter);
  const double radians = rest * (std::acos(-1.0) / 180.0);
  const double c = std::cos(radians);
  const double s = std::sin(radians);
  const std::array<double, 4> cosines = {c, -s, -c, s};
  const std::array<double, 4> sines = {s, c, -s, -c};
  const auto turn = static_cast<std::size_t>(((quarter % 4) + 4) % 4);
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(from, from) = matrix(to, to) = cosines[turn];
  matrix(to, from) = sines[turn];
  matrix(from, to) = -sines[turn];
  return matrix;
}

}  // namespace

RigidPose make_pose(const Eigen::Vector3d& translation, const Eigen::Vector3d& degrees) {
  RigidPose pose = RigidPose::Identity();
  pose.linear() = rotation(degrees.z(), 0, 1) * rotation(degrees.y(), 2, 0) * rotation(degrees.x(), 1, 2);
  pose.translation() = translation;
  return pose;
}

}  // namespace cchip
