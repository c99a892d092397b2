// SPDX-License-Identifier: Apache-2.0
/// \file
/// A double with a proven bound on its error.
#ifndef CCHIP_EXACT_FILTER_HPP
#define CCHIP_EXACT_FILTER_HPP

#include <cmath>

#include "ieee.hpp"

namespace cchip::exact {

/// Represents a real number x with |x - value| <= error. Error 0 means that x is a double, and stays 0 through every
/// operation whose result is a double again, so that whole numbers of moderate size are decided here. A product with
/// an exact 0 is an exact 0, so that faces in one plane across an axis are decided here, too. An overflow leaves an
/// error that is infinite or NaN. docs/cpp/exactness.md derives the bounds.
class Filter {
 public:
  Filter() = default;
  Filter(double value) : value_(value) {}
  Filter(double value, double error) : value_(value), error_(error) {}

  /// True if a sign since the last call of reset() could not be decided. Every answer derived from signs since then is
  /// invalid. One flag for each thread.
  static bool gave_up() { return gave_up_; }
  static void reset() { gave_up_ = false; }

  double value() const { return value_; }
  int sign() const {
    bool open = false;
    const int known = sign_if_known(*this, open);
    gave_up_ = gave_up_ || open;
    return known;
  }

  /// The hooks of hulls.hpp for numbers that may not know their sign.
  friend int sign_if_known(const Filter& x, bool& open) {
    if (std::abs(x.value_) > x.error_) return x.value_ > 0 ? 1 : -1;
    if (!x.is_zero()) open = true;
    return 0;
  }
  friend void give_up(const Filter&) { gave_up_ = true; }
  friend bool is_pointless(const Filter&) { return gave_up_; }

  friend Filter operator+(const Filter& x, const Filter& y) {
    if (x.is_zero()) return y;
    const double sum = x.value_ + y.value_;
    const double y_part = sum - x.value_;
    const double rest = (x.value_ - (sum - y_part)) + (y.value_ - y_part);  // Knuth's TwoSum
    return {sum, inflated(std::abs(rest) + (x.error_ + y.error_))};
  }
  friend Filter operator-(const Filter& x, const Filter& y) { return x + Filter(-y.value_, y.error_); }
  friend Filter operator*(const Filter& x, const Filter& y) {
    // 0 times any real number is 0, even if the bound on that number is infinite.
    if (x.is_zero() || y.is_zero()) return {};
    const double product = x.value_ * y.value_;
    const double rest = std::fma(x.value_, y.value_, -product);
    const double size_x = std::abs(x.value_);
    const double size_y = std::abs(y.value_);
    double error = std::abs(rest);
    if (x.error_ != 0 || y.error_ != 0)
      error = inflated(error + (size_x * y.error_ + (size_y + y.error_) * x.error_)) + lost;
    if (std::abs(product) < 0x1p-960 && size_x != 0 && size_y != 0) error += lost;
    return {product, error};
  }
  Filter& operator+=(const Filter& x) { return *this = *this + x; }

  friend bool operator<(const Filter& x, const Filter& y) { return (x - y).sign() < 0; }
  friend bool operator<=(const Filter& x, const Filter& y) { return (x - y).sign() <= 0; }
  friend bool operator>=(const Filter& x, const Filter& y) { return (x - y).sign() >= 0; }

 private:
  /// What underflows of one product may take from its value and from its error bound.
  static constexpr double lost = 0x1p-1072;
  bool is_zero() const { return value_ == 0 && error_ == 0; }
  /// Covers the rounding of the few operations that made the bound; keeps 0.
  static double inflated(double bound) { return bound * (1 + 0x1p-49); }

  static inline thread_local bool gave_up_ = false;

  double value_ = 0;
  double error_ = 0;
};

}  // namespace cchip::exact

#endif
