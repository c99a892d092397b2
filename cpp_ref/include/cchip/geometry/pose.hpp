// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rigid poses.
#ifndef CCHIP_GEOMETRY_POSE_HPP
#define CCHIP_GEOMETRY_POSE_HPP

#include <Eigen/Geometry>

namespace cchip {

/// Rotation by `degrees` about the fixed axes x, then y, then z, followed by the translation in length units. Multiples
/// of 90 degrees have no rounding error.
Eigen::Isometry3d make_pose(const Eigen::Vector3d& translation, const Eigen::Vector3d& degrees);

}  // namespace cchip

#endif
