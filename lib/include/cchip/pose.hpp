// SPDX-License-Identifier: Apache-2.0
/// \file
/// Poses.
#ifndef CCHIP_POSE_HPP
#define CCHIP_POSE_HPP

#include <Eigen/Geometry>

namespace cchip {

/// Where an object is: any affine map, x -> linear() x + translation(). Shears, mirrors, scales and singular maps are
/// allowed. make_pose() makes rigid ones. Converts from and to Eigen::Affine3d; unlike that, it has the alignment of a
/// double regardless of the instruction set the caller is compiled for, which may differ from the library's.
using Pose = Eigen::Transform<double, 3, Eigen::Affine, Eigen::DontAlign>;
/// A rotation and a translation. Converts from and to Eigen::Isometry3d, and to Pose.
using RigidPose = Eigen::Transform<double, 3, Eigen::Isometry, Eigen::DontAlign>;
static_assert(alignof(Pose) == alignof(double) && alignof(RigidPose) == alignof(double));

/// Rotation by `degrees` about the fixed axes x, then y, then z, followed by the translation in length units. Multiples
/// of 90 degrees have no rounding error.
RigidPose make_pose(const Eigen::Vector3d& translation, const Eigen::Vector3d& degrees);

}  // namespace cchip

#endif
