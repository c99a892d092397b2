// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exact place of a primitive under a pose, as integers of any size times one power of two.
#ifndef CCHIP_EXACT_SCALED_POINTS_HPP
#define CCHIP_EXACT_SCALED_POINTS_HPP

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hulls.hpp"

namespace cchip::exact {

/// Any size, for doubles; up to 512 bits without an allocation.
using BigInt =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
                                      512, 0, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked,
                                      std::allocator<boost::multiprecision::limb_type>>,
                                  boost::multiprecision::et_off>;

/// value = mantissa * 2^exponent, exactly.
struct Scaled {
  explicit Scaled(double value) {
    if (!std::isfinite(value)) {
      throw std::invalid_argument("exact oracle: a coordinate is not finite: replace NaN and infinities by numbers");
    }
    constexpr int digits = std::numeric_limits<double>::digits;
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), digits));
    exponent -= digits;
  }
  std::int64_t mantissa = 0;
  int exponent = 0;
};

/// The same number with an odd mantissa. \pre it is not 0
inline Scaled odd(Scaled x) {
  for (const int step : {32, 16, 8, 4, 2, 1}) {
    const std::int64_t unit = std::int64_t{1} << step;
    if (x.mantissa % unit != 0) continue;
    x.mantissa /= unit;
    x.exponent += step;
  }
  return x;
}

/// A primitive under a pose: component k of vertex i is the sum of four products, the last one translation times 1.
/// Calls take(i, k, factor, factor) for each of them that is not zero.
template <class Take>
void for_each_product(const Primitive& p, const Pose& pose, const Take& take) {
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      for (Eigen::Index column = 0; column < 4; ++column) {
        const Scaled entry(pose(row, column));
        const Scaled component(column < 3 ? p.v[i][column] : 1.0);
        if (entry.mantissa != 0 && component.mantissa != 0) take(i, k, entry, component);
      }
    }
  }
}

/// Smallest exponent of the products that are not zero; `so_far` if there is none.
inline int common_exponent(const Primitive& p, const Pose& pose, int so_far) {
  for_each_product(p, pose, [&so_far](std::size_t, std::size_t, const Scaled& x, const Scaled& y) {
    so_far = std::min(so_far, x.exponent + y.exponent);
  });
  return so_far;
}

/// The vertices in units of 2^exponent. \pre exponent <= common_exponent(p, pose, exponent)
inline std::array<Vec<BigInt>, 4> scaled_points(const Primitive& p, const Pose& pose, int exponent) {
  std::array<Vec<BigInt>, 4> points;
  for_each_product(p, pose, [&](std::size_t i, std::size_t k, const Scaled& x, const Scaled& y) {
    points[i][k] += (BigInt(x.mantissa) * y.mantissa) << (x.exponent + y.exponent - exponent);
  });
  return points;
}

}  // namespace cchip::exact

#endif
