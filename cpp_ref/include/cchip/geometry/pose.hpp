// SPDX-License-Identifier: Apache-2.0
/// \file
/// Poses.
#ifndef CCHIP_GEOMETRY_POSE_HPP
#define CCHIP_GEOMETRY_POSE_HPP

#include <Eigen/Geometry>

namespace cchip {

/// Where an object is: any affine map, x -> linear() x + translation(). Shears, mirrors, scales and singular maps are
/// allowed. make_pose() makes rigid ones.
using Pose = Eigen::Affine3d;

/// Rotation by `degrees` about the fixed axes x, then y, then z, followed by the translation in length units. Multiples
/// of 90 degrees have no rounding error.
Eigen::Isometry3d make_pose(const Eigen::Vector3d& translation, const Eigen::Vector3d& degrees);

}  // namespace cchip

#endif
