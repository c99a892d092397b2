// SPDX-License-Identifier: Apache-2.0
/// \file
/// Exact answers for many pairs under the same two poses, at the speed of doubles where these can tell.
#ifndef CCHIP_INTERNAL_EXACT_POSED_PAIRS_HPP
#define CCHIP_INTERNAL_EXACT_POSED_PAIRS_HPP

#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>

namespace cchip {

/// Decides pairs of a primitive of A and one of B. The answers are those of exact_intersects(), for any finite numbers:
/// first separating axes in doubles with a bound on the rounding, then the predicates of the exact oracle in doubles
/// with an error bound each, then, where a sign is open, the same in integers (docs/cpp/exactness.md). Immutable: any
/// number of threads may use it at a time.
class PosedPairs {
 public:
  struct Answer {
    bool hit = false;      ///< the closed primitives share a point
    bool open = false;     ///< deciding it took integers, since doubles could not
    bool crosses = false;  ///< the primitives cross; false if it was not asked
  };

  /// \throws std::invalid_argument an entry of a pose is not finite
  PosedPairs(const Pose& pose_a, const Pose& pose_b);

  /// \param tell_crossing of primitives that share a point, also tell whether they cross (docs/cpp/touching.md)
  /// \throws std::invalid_argument a coordinate is not finite
  Answer decide(const Primitive& a, const Primitive& b, bool tell_crossing = false) const;

  /// Of two primitives that share a point: whether they cross (docs/cpp/touching.md). The answer is that of
  /// exact_relation().
  /// \throws std::invalid_argument a coordinate is not finite
  bool cross(const Primitive& a, const Primitive& b) const;

 private:
  Answer decide_in_integers(const Primitive& a, const Primitive& b, bool tell_crossing) const;

  Pose pose_a_;
  Pose pose_b_;
  Vec3d offset_;        ///< translation of A relative to B, rounded
  Vec3d offset_error_;  ///< bound on its error; exactly 0 where it is exact
  bool rounds_;         ///< coordinates under a pose need more bits than a double has, as a rule
  double row_sum_a_;    ///< greatest sum of magnitudes in a row of the linear part
  double row_sum_b_;
};

}  // namespace cchip

#endif
