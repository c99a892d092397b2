// SPDX-License-Identifier: Apache-2.0
/// \file
/// Doubles rounded in a direction, and intervals of them.
#ifndef CCHIP_TREE_ROUNDING_HPP
#define CCHIP_TREE_ROUNDING_HPP

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/ieee.hpp"

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

/// The least double that is not below the exact product, or the next one above where the product is too small for its
/// error to be computed.
inline double product_up(double a, double b) {
  const double product = a * b;
  const bool tiny = std::abs(product) < 0x1p-900 && a != 0 && b != 0;
  return tiny || std::fma(a, b, -product) > 0 ? std::nextafter(product, std::numeric_limits<double>::infinity())
                                              : product;
}
/// The same for a / b, b > 0.
inline double quotient_up(double a, double b) {
  const double quotient = a / b;
  const bool tiny = std::abs(quotient) < 0x1p-900 && a != 0;
  return tiny || std::fma(quotient, b, -a) < 0 ? std::nextafter(quotient, std::numeric_limits<double>::infinity())
                                               : quotient;
}

/// A closed interval; sums, products and quotients contain every result of every pair of members.
struct Interval {
  double least = 0;
  double greatest = 0;
  Interval() = default;
  Interval(double both) : least(both), greatest(both) {}  // NOLINT: a number is an interval
  Interval(double l, double g) : least(l), greatest(g) {}
  bool is_finite() const { return std::isfinite(least) && std::isfinite(greatest); }
};

inline Interval operator-(const Interval& x) { return {-x.greatest, -x.least}; }
inline Interval operator+(const Interval& x, const Interval& y) {
  return {sum_down(x.least, y.least), sum_up(x.greatest, y.greatest)};
}
inline Interval operator-(const Interval& x, const Interval& y) { return x + -y; }
inline Interval operator*(const Interval& x, const Interval& y) {
  const auto up = [](double a, double b) { return product_up(a, b); };
  const auto down = [](double a, double b) { return -product_up(-a, b); };
  return {
      std::min(
          {down(x.least, y.least), down(x.least, y.greatest), down(x.greatest, y.least), down(x.greatest, y.greatest)}),
      std::max({up(x.least, y.least), up(x.least, y.greatest), up(x.greatest, y.least), up(x.greatest, y.greatest)})};
}
/// \pre y does not contain 0
inline Interval operator/(const Interval& x, const Interval& y) {
  if (y.greatest < 0) return -x / -y;
  const auto down = [](double a, double b) { return -quotient_up(-a, b); };
  return {std::min(down(x.least, y.least), down(x.least, y.greatest)),
          std::max(quotient_up(x.greatest, y.least), quotient_up(x.greatest, y.greatest))};
}
inline Interval scale(const Interval& x, int exponent) {
  return {scale_down(x.least, exponent), scale_up(x.greatest, exponent)};
}

}  // namespace cchip::bvh

#endif
