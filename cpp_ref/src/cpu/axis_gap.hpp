// SPDX-License-Identifier: Apache-2.0
/// \file
/// Gaps of 26-DOPs of two objects along any axis of the world.
#ifndef CCHIP_CPU_AXIS_GAP_HPP
#define CCHIP_CPU_AXIS_GAP_HPP

#include <cchip/bvh/dop26.hpp>
#include <cchip/collide/object.hpp>
#include <cchip/geometry/pose.hpp>

namespace cchip {

/// The 26 directions are a poor measure of a distance that is great beside the volumes: it may be 1.13 times the gap
/// along the best of them. Along the line between two volumes the gap is as good as they are small.
class AxisGap {
 public:
  AxisGap(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b);

  /// In the world, rounded.
  Vec3d centre_a(const bvh::Dop26& dop) const { return pose_a_ * middle(dop); }
  Vec3d centre_b(const bvh::Dop26& dop) const { return pose_b_ * middle(dop); }

  /// At most the distance in the world of what the volumes contain, by their gap along the axis; at least 0. The
  /// volumes are in the coordinates of their objects; the axis leads from A to B and is not normalised.
  double operator()(const bvh::Dop26& volume_a, const bvh::Dop26& volume_b, const Vec3d& axis) const;

 private:
  static Vec3d middle(const bvh::Dop26& dop) {
    return 0.5 * Vec3d(dop.least[0] + dop.greatest[0], dop.least[1] + dop.greatest[1], dop.least[2] + dop.greatest[2]);
  }

  Pose pose_a_;
  Pose pose_b_;
  Vec3d between_;  ///< translation of B relative to A
  double size_;    ///< bound on the sum of the magnitudes that are added up for a coordinate of any point
};

}  // namespace cchip

#endif
