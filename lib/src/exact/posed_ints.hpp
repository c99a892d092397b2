// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exact place of a primitive under a pose, as integers times one power of two.
#ifndef CCHIP_EXACT_POSED_INTS_HPP
#define CCHIP_EXACT_POSED_INTS_HPP

#include <algorithm>
#include <array>
#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>
#include <cmath>
#include <cstring>
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
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    const auto biased = static_cast<int>(bits >> (digits - 1) & 0x7FFU);
    std::uint64_t size = bits & ((std::uint64_t{1} << (digits - 1)) - 1);
    if (biased != 0) size |= std::uint64_t{1} << (digits - 1);  // all but subnormal numbers
    const int zeros = __builtin_ctzll(size);
    size >>= zeros;
    mantissa = value < 0 ? -static_cast<std::int64_t>(size) : static_cast<std::int64_t>(size);
    exponent = std::max(biased, 1) - 1074 - 1 + zeros;
    top = size == 1 ? exponent : exponent + 64 - __builtin_clzll(size);
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
      for (std::size_t k = 0; k < 3; ++k) add_up(coordinate_[i][k], i, k);
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
      for (std::size_t k = 0; k < 3; ++k) {
        const Coordinate& c = coordinate_[i][k];
        if (c.is_narrow) {
          if (c.sum != 0) points[i][k].add(c.sum, c.exponent - exponent);
          continue;
        }
        for_each_product(i, k, [&](const OddDouble& x, const OddDouble& y) {
          points[i][k].add(SInt128{x.mantissa} * y.mantissa, x.exponent + y.exponent - exponent);
        });
      }
    }
    return {points, count_};
  }

 private:
  /// The common exponent of a coordinate's products, and their sum in these units if it fits.
  struct Coordinate {
    int exponent;
    bool is_narrow;
    SInt128 sum;
  };

  /// Calls take(factor, factor) for every product that is not zero.
  template <class Take>
  void for_each_product(std::size_t i, std::size_t k, const Take& take) const {
    for (std::size_t c = 0; c < 4; ++c) {
      if (entry_[k][c].mantissa != 0 && vertex_[i][c].mantissa != 0) take(entry_[k][c], vertex_[i][c]);
    }
  }

  void add_up(Coordinate& c, std::size_t i, std::size_t k) {
    c.exponent = limit;
    int top = -limit;
    int terms = 0;
    for_each_product(i, k, [&](const OddDouble& x, const OddDouble& y) {
      c.exponent = std::min(c.exponent, x.exponent + y.exponent);
      top = std::max(top, x.top + y.top);
      ++terms;
    });
    top += terms > 2 ? 2 : terms == 2 ? 1 : 0;
    exponent_ = std::min(exponent_, c.exponent);
    top_ = std::max(top_, top);
    c.is_narrow = top - c.exponent <= 126;
    c.sum = 0;
    if (!c.is_narrow) return;
    for_each_product(i, k, [&](const OddDouble& x, const OddDouble& y) {
      const SInt128 factor = SInt128{1} << (x.exponent + y.exponent - c.exponent);
      c.sum += SInt128{x.mantissa} * y.mantissa * factor;
    });
  }

  std::size_t count_;
  std::array<std::array<OddDouble, 4>, 3> entry_;
  std::array<std::array<OddDouble, 4>, 4> vertex_;
  std::array<std::array<Coordinate, 3>, 4> coordinate_;
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
