// SPDX-License-Identifier: Apache-2.0
/// \file
/// When two primitives meet while one of them moves along a line, as fractions.
#ifndef CCHIP_EXACT_MEETING_HPP
#define CCHIP_EXACT_MEETING_HPP

#include <optional>

#include "scaled_points.hpp"

namespace cchip::exact {

/// over / under * 2^exponent, under > 0, and doubles around it.
struct Fraction {
  Fraction() = default;
  Fraction(const BigInt& over, const BigInt& under, int exponent);

  BigInt over = 0;
  BigInt under = 1;
  int exponent = 0;
  double nearest = 0;  ///< ties to even; infinite beyond the doubles
  double low = 0;      ///< the greatest double that is at most the number
  double high = 0;     ///< the least double that is at least the number
};

/// Negative, zero or positive.
int compare(const Fraction& x, const Fraction& y);

/// B + s direction meets A for first <= s <= last and for no other s.
struct Meeting {
  Fraction first;
  Fraction last;
};

/// None if they do not meet for any s, which may be negative.
/// \param direction not zero, finite
/// \throws std::invalid_argument a coordinate or an entry of a pose is not finite
std::optional<Meeting> meeting(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b,
                               const Vec3d& direction);

}  // namespace cchip::exact

#endif
