// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far are two objects apart? docs/cpp/distance.md
///
/// The distance of two placed objects is that of their nearest points in the world, 0 if they touch or cross. Objects
/// are surfaces: of one inside another it is the distance of the surfaces.
#ifndef CCHIP_DISTANCE_HPP
#define CCHIP_DISTANCE_HPP

#include <cchip/collide.hpp>
#include <cchip/cpu_device.hpp>
#include <cstdint>
#include <limits>
#include <vector>

namespace cchip {

/// Is the distance at most d? Exactly, in real arithmetic. The same as collide() with CollisionRequest::within = d: a
/// hit, and as contacts the pairs of faces whose distance is at most d. With d = 0 it is collide().
/// \param d in units of the world
/// \throws as Device::collide(); std::invalid_argument d is negative or not finite
inline CollisionResult within(Device& device, const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                              double d, CollisionRequest request = {}) {
  request.within = d;
  return collide(device, a, pose_a, b, pose_b, request);
}
/// The same without a device of one's own.
inline CollisionResult within(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b, double d,
                              CollisionRequest request = {}) {
  request.within = d;
  return collide(a, pose_a, b, pose_b, request);
}

struct DistanceRequest {
  /// The answer may be so inexact: upper - lower <= rel_error * upper. At least 0 and less than 1. With 0 both are the
  /// distance, or the two doubles beside it.
  double rel_error = 0;
  /// Of a distance above this nothing more is asked: the search ends, `upper` is infinite.
  double stop_above = std::numeric_limits<double>::infinity();
};

/// lower <= distance <= upper, proved.
struct DistanceResult {
  double lower = 0;
  /// Infinite if the distance is above DistanceRequest::stop_above, which is `lower` then, and the points and faces
  /// mean nothing; or if it is beyond the doubles.
  double upper = 0;
  Vec3d point_a = Vec3d::Zero();  ///< the nearest points in the world, rounded; of several the search names any
  Vec3d point_b = Vec3d::Zero();
  std::uint32_t face_a = 0;  ///< faces on which they lie, numbers as in Contact
  std::uint32_t face_b = 0;
  CollisionStats stats;
};

/// The distance of two placed objects. Any number of threads may call it at a time.
/// \throws as Device::collide(); std::invalid_argument rel_error or stop_above is out of its range
DistanceResult distance(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                        const DistanceRequest& request = {});

/// The distance of each of some points to the surface of a placed object, in their order. The object is A, `point_b`
/// the point, `face_b` 0. With inside() of <cchip/solids.hpp> a distance to a solid has a sign.
/// \param points in the world
/// \param threads 0: as many as there are cores
/// \throws as distance(); std::invalid_argument a point is not finite or beyond what a pose may hold
std::vector<DistanceResult> distances(const Object& object, const Pose& pose, const std::vector<Vec3d>& points,
                                      const DistanceRequest& request = {}, unsigned threads = 1);

}  // namespace cchip

#endif
