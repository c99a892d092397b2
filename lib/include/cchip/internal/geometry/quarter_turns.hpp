// SPDX-License-Identifier: Apache-2.0
/// \file
/// Quarter turns that rounding has moved a little, put right.
#ifndef CCHIP_INTERNAL_GEOMETRY_QUARTER_TURNS_HPP
#define CCHIP_INTERNAL_GEOMETRY_QUARTER_TURNS_HPP

#include <Eigen/Core>
#include <cmath>

namespace cchip {

/// What rounding leaves of a quarter turn.
constexpr double quarter_turn_error = 0x1p-48;

/// Exactly the quarter turns that a rotation is within rounding of, or else the rotation.
inline Eigen::Matrix3d snapped(const Eigen::Matrix3d& rotation) {
  const Eigen::Matrix3d turns = rotation.array().round();
  const bool is_near = (rotation - turns).cwiseAbs().maxCoeff() <= quarter_turn_error;
  return is_near && (turns * turns.transpose()).isIdentity(0) ? Eigen::Matrix3d(turns.array() + 0.0) : rotation;
}

/// Multiples of 90 for radians that are within rounding of quarter turns.
inline double to_degrees(double radians) {
  const double quarter = std::acos(0.0);
  const double turns = std::round(radians / quarter);
  if (std::abs(radians - turns * quarter) <= quarter_turn_error * std::abs(radians)) return 90 * turns;
  return radians * (180 / std::acos(-1.0));
}

}  // namespace cchip

#endif
