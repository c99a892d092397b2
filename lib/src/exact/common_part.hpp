// SPDX-License-Identifier: Apache-2.0
/// \file
/// The points that two primitives share, as fractions.
#ifndef CCHIP_EXACT_COMMON_PART_HPP
#define CCHIP_EXACT_COMMON_PART_HPP

#include <cchip/internal/exact/intersection.hpp>
#include <optional>
#include <vector>

#include "scaled_points.hpp"

namespace cchip::exact {

/// over / under * 2^exponent, under > 0. A point has several such forms.
struct FractionPoint {
  Vec<BigInt> over;
  BigInt under;
  int exponent = 0;
  Vec3d rounded;  ///< the nearest doubles
};

/// Order of the exact points by x, then y, then z: negative, zero or positive.
int compare(const FractionPoint& p, const FractionPoint& q);

/// Intersection with exact points, in the same order.
struct CommonPart {
  Intersection::Kind kind = Intersection::Kind::point;
  std::vector<FractionPoint> points;
};

/// As exact_intersection().
std::optional<CommonPart> common_part(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b);

/// over / under * 2^exponent as the nearest double, ties to even; infinite beyond the doubles. \pre under > 0
double nearest_double(const BigInt& over, const BigInt& under, int exponent);

}  // namespace cchip::exact

#endif
