// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exact distance of two faces as a bound on that of many others.
#ifndef CCHIP_EXACT_NEAREST_PLANES_HPP
#define CCHIP_EXACT_NEAREST_PLANES_HPP

#include <array>
#include <cchip/internal/exact/posed_distances.hpp>
#include <functional>
#include <optional>
#include <vector>

#include "feature_pairs.hpp"
#include "fine_filter.hpp"
#include "scaled_points.hpp"

namespace cchip::exact {

/// One side of a plane in the coordinates of an object; the plane is exact, and so are answers. Sums of two doubles
/// answer first; the integers are made where these cannot tell.
class HalfSpace {
 public:
  HalfSpace() = default;
  /// \param normal in any unit, points outward
  /// \param on_plane points of the plane, of which one may be there several times
  HalfSpace(const Vec<FineFilter>& normal, const std::array<Vec3d, 3>& on_plane, std::function<Vec<BigInt>()> exact);
  HalfSpace(const Vec<BigInt>& normal, const std::array<Vec3d, 3>& on_plane);

  /// Is the point inside or on the plane?
  bool contains(const Vec3d& v) const;
  bool contains(const Primitive& p) const;
  bool contains(const std::vector<Vec3d>& points) const;

  const Vec3d& through() const { return on_plane_[0]; }
  /// Each component is off by less than 2^-50 of the greatest one, whose magnitude is from 1/2 to 1.
  Vec3d normal() const { return rounded_; }

 private:
  Vec<FineFilter> normal_;
  Vec3d rounded_ = Vec3d::Zero();
  std::array<bool, 3> is_zero_ = {};  ///< exactly
  int along_ = -1;                    ///< the axis of the object that the normal is exactly along, or -1
  std::array<Vec3d, 3> on_plane_;
  std::function<Vec<BigInt>()> make_exact_;
  mutable std::optional<Vec<BigInt>> exact_;
};

/// The planes through the nearest points of two faces, across the line between these. All that lies behind A's plane
/// is at least as far from all that lies behind B's as the two faces are from each other.
class NearestPlanes {
 public:
  /// \param distances must outlive the planes
  /// \pre the primitives share no point
  NearestPlanes(const PosedDistances& distances, const Primitive& a, const Primitive& b);

  /// The distance of the two faces, as PosedDistances::tight_bounds() has it.
  const DistanceBounds& bounds() const { return bounds_; }
  const HalfSpace& a() const { return a_; }
  const HalfSpace& b() const { return b_; }

 private:
  void make_exactly(const PosedDistances& distances, const Primitive& a, const Primitive& b);

  DistanceBounds bounds_;
  HalfSpace a_;
  HalfSpace b_;
};

}  // namespace cchip::exact

#endif
