// SPDX-License-Identifier: Apache-2.0
/// \file
/// A sum of two doubles with a proven bound on its error.
#ifndef CCHIP_EXACT_FINE_FILTER_HPP
#define CCHIP_EXACT_FINE_FILTER_HPP

#include <cmath>

#include "ieee.hpp"

namespace cchip::exact {

/// As Filter, with twice the digits: |x - (high + low)| <= error, where low is at most half a unit in the last place of
/// high. An overflow leaves an error that is infinite or NaN. docs/cpp/exactness.md derives the bounds.
class FineFilter {
 public:
  FineFilter() = default;
  FineFilter(double value) : high_(value) {}
  FineFilter(const FineFilter& value, double error) : high_(value.high_), low_(value.low_), error_(error) {}

  /// Rounded.
  double value() const { return high_; }
  double error() const { return error_; }
  /// Is its sign?
  bool is_known() const { return std::abs(high_) * (1 - 0x1p-50) > error_ || is_zero(); }
  /// Exactly?
  bool is_zero() const { return high_ == 0 && error_ == 0; }
  /// 0 also if it is not known.
  int sign() const { return !is_known() || high_ == 0 ? 0 : high_ > 0 ? 1 : -1; }
  friend int sign_if_known(const FineFilter& x, bool& open) {
    open = open || !x.is_known();
    return x.sign();
  }

  friend FineFilter operator-(const FineFilter& x) {
    FineFilter negative = x;
    negative.high_ = -x.high_;
    negative.low_ = -x.low_;
    return negative;
  }
  friend FineFilter operator+(const FineFilter& x, const FineFilter& y) {
    const Pair s = sum(x.high_, y.high_);
    const Pair t = sum(x.low_, y.low_);
    const double middle = s.low + t.high;
    const Pair high = sum(s.high, middle);
    const double rest = high.low + t.low;
    const Pair result = sum(high.high, rest);
    // Roundings of `middle` and `rest`, none if the low parts are 0.
    const double rounding = t.high == 0 ? 0 : unit * (std::abs(middle) + std::abs(rest));
    return {result, inflated(x.error_ + y.error_ + rounding)};
  }
  friend FineFilter operator-(const FineFilter& x, const FineFilter& y) { return x + (-y); }
  friend FineFilter operator*(const FineFilter& x, const FineFilter& y) {
    if (x.is_zero() || y.is_zero()) return {};
    const double product = x.high_ * y.high_;
    const double rest = std::fma(x.high_, y.high_, -product);
    const double p = x.high_ * y.low_;
    const double q = x.low_ * y.high_;
    const double both = p + q;
    const double low = rest + both;
    // Roundings of p, q, their sum and `low`, and what underflows; low times low is left out.
    const double rounding = x.low_ == 0 && y.low_ == 0 ? 0
                                                       : unit * (2 * (std::abs(p) + std::abs(q)) + std::abs(low)) +
                                                             std::abs(x.low_ * y.low_) + lost;
    const double size_x = std::abs(x.high_) * (1 + 0x1p-50);
    const double size_y = std::abs(y.high_) * (1 + 0x1p-50);
    double error = size_x * y.error_ + (size_y + y.error_) * x.error_ + rounding;
    if (error != 0) error = inflated(error) + lost;
    if (std::abs(product) < 0x1p-900 && x.high_ != 0 && y.high_ != 0) error += lost;
    return {sum(product, low), error};
  }
  FineFilter& operator+=(const FineFilter& x) { return *this = *this + x; }

 private:
  struct Pair {
    double high;
    double low;
  };
  static constexpr double unit = 0x1p-53;
  /// What underflows of one product may take from its value and from its error bound.
  static constexpr double lost = 0x1p-1068;
  static double inflated(double bound) { return bound * (1 + 0x1p-48); }
  /// Knuth's TwoSum: exactly.
  static Pair sum(double x, double y) {
    const double sum = x + y;
    const double y_part = sum - x;
    return {sum, (x - (sum - y_part)) + (y - y_part)};
  }
  FineFilter(Pair value, double error) : high_(value.high), low_(value.low), error_(error) {}

  double high_ = 0;
  double low_ = 0;
  double error_ = 0;
};

}  // namespace cchip::exact

#endif
