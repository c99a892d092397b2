// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far are two objects apart? docs/cpp/distance.md
///
/// The distance of two placed objects is that of their nearest points in the world, 0 if they touch or cross. Objects
/// are surfaces: of one inside another it is the distance of the surfaces.
#ifndef CCHIP_CPU_DISTANCE_HPP
#define CCHIP_CPU_DISTANCE_HPP

#include <cchip/collide/collide.hpp>
#include <cchip/cpu/cpu_device.hpp>

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

}  // namespace cchip

#endif
