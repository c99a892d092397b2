// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far must an object move along a direction until it is clear of another, or until it touches it?
/// docs/cpp/along.md
///
/// Object B is moved by s times a vector, s >= 0. Objects are surfaces, as in collide(): one that is inside another and
/// touches no face is clear of it.
#ifndef CCHIP_ALONG_HPP
#define CCHIP_ALONG_HPP

#include <cchip/collide.hpp>
#include <cchip/cpu_device.hpp>
#include <cstdint>

namespace cchip {

/// A factor s of the direction: the exact number, a fraction, in doubles.
struct AlongResult {
  /// B + factor * direction touches A, in the exact number. False if clear_along() finds the objects apart as they are
  /// (the factor is 0) or if first_contact() finds that they never touch (it is infinite).
  bool touches = false;
  /// The double nearest to the exact number; infinite beyond the doubles.
  double factor = 0;
  double lower = 0;          ///< the greatest double that is at most the exact number; the factor if that is a double
  double upper = 0;          ///< the least double that is at least the exact number; the factor if that is a double
  std::uint32_t face_a = 0;  ///< two faces that touch there, numbers as in Contact; of several the search names any
  std::uint32_t face_b = 0;  ///< they mean nothing if `touches` is false
  CollisionStats stats;
};

/// The least s >= 0 such that B, moved by any slightly greater multiple of the direction, is clear of A: objects that
/// touch stay in touch on the whole way from 0 to s. 0 if they are apart as they are. They may touch again further on;
/// first_contact() from there tells. Exact, in real arithmetic. Any number of threads may call it at a time.
/// \param direction in the world, not zero, of any length
/// \throws as Device::collide(); std::invalid_argument the direction is zero or not finite
AlongResult clear_along(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                        const Vec3d& direction);

/// The least s >= 0 for which B, moved by s times the direction, touches A; 0 if they touch as they are. Exact, in real
/// arithmetic. Any number of threads may call it at a time.
/// \param direction in the world, not zero, of any length
/// \throws as clear_along()
AlongResult first_contact(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                          const Vec3d& direction);

}  // namespace cchip

#endif
