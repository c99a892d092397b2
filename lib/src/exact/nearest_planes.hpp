// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exact distance of two faces as a bound on that of many others.
#ifndef CCHIP_EXACT_NEAREST_PLANES_HPP
#define CCHIP_EXACT_NEAREST_PLANES_HPP

#include <array>
#include <cchip/internal/exact/posed_distances.hpp>

#include "filter.hpp"
#include "scaled_points.hpp"

namespace cchip::exact {

/// One side of a plane in the coordinates of an object; the plane is exact, and so are answers.
class HalfSpace {
 public:
  HalfSpace() = default;
  /// \param normal in any unit, points outward
  HalfSpace(const Vec<BigInt>& normal, const Vec3d& through);

  /// Is the point inside or on the plane?
  bool contains(const Vec3d& v) const;
  bool contains(const Primitive& p) const;

  const Vec3d& through() const { return through_; }
  /// Each component is off by less than 2^-50 of the greatest one, whose magnitude is from 1/2 to 1.
  Vec3d normal() const { return rounded_; }

 private:
  Vec<Filter> normal_;
  Vec3d rounded_ = Vec3d::Zero();
  Vec<BigInt> exact_;
  Vec3d through_ = Vec3d::Zero();
};

/// The planes through the nearest points of two faces, across the line between these. All that lies behind A's plane
/// is at least as far from all that lies behind B's as the two faces are from each other.
class NearestPlanes {
 public:
  /// \pre the primitives share no point
  NearestPlanes(const PosedDistances& distances, const Primitive& a, const Primitive& b);

  /// The distance of the two faces, as PosedDistances::tight_bounds() has it.
  const DistanceBounds& bounds() const { return bounds_; }
  const HalfSpace& a() const { return a_; }
  const HalfSpace& b() const { return b_; }

 private:
  DistanceBounds bounds_;
  HalfSpace a_;
  HalfSpace b_;
};

}  // namespace cchip::exact

#endif
