// SPDX-License-Identifier: Apache-2.0
/// \file
/// Doubles rounded in a direction.
#ifndef CCHIP_BVH_ROUNDING_HPP
#define CCHIP_BVH_ROUNDING_HPP

#include <cmath>
#include <limits>

namespace cchip::bvh {

/// a + b - fl(a + b), exactly, unless the sum overflows (Knuth's TwoSum).
inline double sum_error(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return (a - (sum - b_part)) + (b - b_part);
}

/// The least double that is not below the exact sum; infinity if it is too great for a double.
inline double sum_up(double a, double b) {
  const double sum = a + b;
  if (sum == -std::numeric_limits<double>::infinity()) return std::numeric_limits<double>::lowest();
  return sum_error(a, b) > 0 ? std::nextafter(sum, std::numeric_limits<double>::infinity()) : sum;
}
/// The greatest double that is not above the exact sum; minus infinity if it is too small for a double.
inline double sum_down(double a, double b) { return -sum_up(-a, -b); }

/// x 2^exponent; where that underflows, the least double that is not below.
inline double scale_up(double x, int exponent) {
  const double scaled = std::ldexp(x, exponent);
  return std::ldexp(scaled, -exponent) < x ? std::nextafter(scaled, std::numeric_limits<double>::infinity()) : scaled;
}
inline double scale_down(double x, int exponent) { return -scale_up(-x, exponent); }

}  // namespace cchip::bvh

#endif
