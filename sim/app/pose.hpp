// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rigid poses from the command line.
#ifndef CCHIP_APP_POSE_HPP
#define CCHIP_APP_POSE_HPP

#include <Eigen/Geometry>
#include <string>

namespace cchip::app {

/// "tx,ty,tz" or "tx,ty,tz,rx,ry,rz": rotation by rx, ry, rz degrees about the fixed axes x, then y,
/// then z, followed by the translation. Exact for multiples of 90 degrees.
/// \throws UsageError
Eigen::Isometry3d parse_pose(const std::string& text);

/// Twelve numbers, the rows of the 3x4 matrix [R | t].
/// \throws UsageError not twelve numbers, or R is not a rotation within 1e-9
Eigen::Isometry3d parse_pose_matrix(const std::string& text);

}  // namespace cchip::app

#endif
