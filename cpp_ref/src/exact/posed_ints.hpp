// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exact place of a primitive under a pose, as integers times one power of two.
#ifndef CCHIP_EXACT_POSED_INTS_HPP
#define CCHIP_EXACT_POSED_INTS_HPP

#include <algorithm>
#include <array>
#include <cchip/geometry/pose.hpp>
#include <cchip/geometry/primitive.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hulls.hpp"
#include "wide_int.hpp"

namespace cchip::exact {

/// A double as mantissa * 2^exponent with an odd mantissa, so that simple numbers have few bits; or 0.
struct OddDouble {
  OddDouble() = default;
  explicit OddDouble(double value) {
    if (value == 0) return;
    if (!std::isfinite(value)) {
      throw std::invalid_argument("exact: a coordinate is not finite: replace NaN and infinities by numbers");
    }
    constexpr int digits = std::numeric_limits<double>::digits;
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), digits));
    exponent -= digits;
    const int zeros = __builtin_ctzll(static_cast<std::uint64_t>(mantissa));
    mantissa /= std::int64_t{1} << zeros;
    exponent += zeros;
    top = mantissa == 1 || mantissa == -1 ? exponent : exponent + digits - zeros;
  }
  std::int64_t mantissa = 0;
  int exponent = 0;
  int top = 0;  ///< |value| <= 2^top
};

/// Every coordinate under the pose is a sum of four products of doubles, the last one translation times 1.
class PosedInts {
 public:
  /// \throws std::invalid_argument a coordinate is not finite
  PosedInts(const Primitive& p, const Pose& pose) : count_(p.vertex_count()) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 4; ++c) {
        entry_[k][c] = OddDouble(pose(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)));
      }
    }
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t c = 0; c < 3; ++c) vertex_[i][c] = OddDouble(p.v[i][static_cast<Eigen::Index>(c)]);
      vertex_[i][3] = OddDouble(1);
      std::array<int, 3> terms = {};
      std::array<int, 3> tops = {-limit, -limit, -limit};
      for_each_product(i, [&](std::size_t k, const OddDouble& x, const OddDouble& y) {
        exponent_ = std::min(exponent_, x.exponent + y.exponent);
        tops[k] = std::max(tops[k], x.top + y.top);
        ++terms[k];
      });
      for (std::size_t k = 0; k < 3; ++k) top_ = std::max(top_, tops[k] + (terms[k] > 2 ? 2 : terms[k] == 2 ? 1 : 0));
    }
  }

  /// All coordinates are whole multiples of 2^exponent() and at most 2^top() in magnitude. Of zeros only: exponent() is
  /// great, top() is small.
  int exponent() const { return exponent_; }
  int top() const { return top_; }

  /// In units of 2^exponent. \pre exponent <= exponent(), fits<N>(top() - exponent)
  template <std::size_t N>
  Hull<WideInt<N>> hull(int exponent) const {
    std::array<Vec<WideInt<N>>, 4> points;
    for (Vec<WideInt<N>>& point : points) point.fill(WideInt<N>(0, 0));
    for (std::size_t i = 0; i < count_; ++i) {
      for_each_product(i, [&](std::size_t k, const OddDouble& x, const OddDouble& y) {
        points[i][k] += WideInt<N>(SInt128{x.mantissa} * y.mantissa, x.exponent + y.exponent - exponent);
      });
    }
    return {points, count_};
  }

 private:
  /// Calls take(component, factor, factor) for every product that is not zero.
  template <class Take>
  void for_each_product(std::size_t i, const Take& take) const {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 4; ++c) {
        if (entry_[k][c].mantissa != 0 && vertex_[i][c].mantissa != 0) take(k, entry_[k][c], vertex_[i][c]);
      }
    }
  }

  std::size_t count_;
  std::array<std::array<OddDouble, 4>, 3> entry_;
  std::array<std::array<OddDouble, 4>, 4> vertex_;
  static constexpr int limit = 1 << 20;  // beyond the exponent of any product
  int exponent_ = limit;
  int top_ = -limit;
};

/// True if N words hold every result of hulls_meet() and hulls_cross() for coordinates of at most 2^bits in magnitude:
/// differences are at most 2^(bits + 1), components of cross products 2^(2 bits + 3), their products with a difference
/// 2^(3 bits + 4), and sums of three of these are below 2^(3 bits + 6).
template <std::size_t N>
constexpr bool fits(int bits) {
  return 3 * bits + 6 < WideInt<N>::bits;
}

}  // namespace cchip::exact

#endif
