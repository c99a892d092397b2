// SPDX-License-Identifier: Apache-2.0
/// \file
/// Exact distances of many pairs under the same two poses, at the speed of doubles where these can tell.
#ifndef CCHIP_INTERNAL_EXACT_POSED_DISTANCES_HPP
#define CCHIP_INTERNAL_EXACT_POSED_DISTANCES_HPP

#include <cchip/internal/exact/posed_pairs.hpp>
#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>

namespace cchip {

namespace exact {
class NearestPlanes;
}

/// The distance of two closed primitives in the world, that of their nearest points, lies between `lower` and `upper`.
struct DistanceBounds {
  double lower = 0;
  double upper = 0;               ///< infinite if it is beyond the doubles
  Vec3d point_a = Vec3d::Zero();  ///< the nearest points, rounded
  Vec3d point_b = Vec3d::Zero();
};

/// Compares the distance of a primitive of A and one of B with a number, and encloses it. Answers are exact for any
/// finite numbers, in real arithmetic without rounding: nearest points and an axis in doubles with a bound on the
/// rounding come first, then squares in doubles with an error bound each, then, where these leave it open, integers of
/// any size (docs/cpp/exactness.md). Immutable: any number of threads may use it at a time.
class PosedDistances {
 public:
  struct Answer {
    bool hit = false;   ///< the answer to the question
    bool open = false;  ///< it took integers, since doubles could not tell
  };

  /// \throws std::invalid_argument an entry of a pose is not finite
  PosedDistances(const Pose& pose_a, const Pose& pose_b);

  /// Is the distance at most d?
  /// \param d at least 0, finite
  /// \throws std::invalid_argument a coordinate is not finite
  Answer within(const Primitive& a, const Primitive& b, double d) const { return compare(a, b, d, false); }
  /// Is the distance less than d?
  Answer nearer(const Primitive& a, const Primitive& b, double d) const { return compare(a, b, d, true); }

  /// The distance as closely as doubles tell it; of primitives that share a point, `lower` is 0 and `upper` may be far
  /// above it.
  /// \throws std::invalid_argument a coordinate is not finite
  DistanceBounds bounds(const Primitive& a, const Primitive& b) const;
  /// `lower` and `upper` are the distance, or the two doubles beside it.
  /// \throws std::invalid_argument a coordinate is not finite
  DistanceBounds tight_bounds(const Primitive& a, const Primitive& b) const;
  /// At most the distance, by the gap along an axis of the world that leads from A to B, of any length; at least 0.
  double gap_along(const Vec3d& axis, const Primitive& a, const Primitive& b) const;

 private:
  class Pair;
  friend class exact::NearestPlanes;

  Answer compare(const Primitive& a, const Primitive& b, double d, bool strictly) const;

  PosedPairs pairs_;
  Pose pose_a_;
  Pose pose_b_;
  Vec3d offset_;        ///< translation of A relative to B, rounded
  Vec3d offset_error_;  ///< bound on its error; exactly 0 where it is exact
  bool same_linear_;    ///< bit for bit but for the signs of zeros
  double row_sum_a_;    ///< greatest sum of magnitudes in a row of the linear part
  double row_sum_b_;
};

}  // namespace cchip

#endif
