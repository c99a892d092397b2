// SPDX-License-Identifier: Apache-2.0
/// \file
/// Squares of distances by brute force over all simplices of vertices, in integers: normal equations by Cramer's rule,
/// nothing in common with the library's features.
#ifndef CCHIP_TESTS_LIB_DISTANCE_ORACLE_HPP
#define CCHIP_TESTS_LIB_DISTANCE_ORACLE_HPP

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>
#include <cmath>
#include <vector>

namespace cchip_test {

using BigInt = boost::multiprecision::cpp_int;

template <class Int>
using IntPoint = std::array<Int, 3>;

/// over / under, under > 0.
template <class Int>
struct IntSquare {
  Int over = 0;
  Int under = 0;  ///< 0: none yet
};

template <class Int>
Int det3(const std::array<std::array<Int, 3>, 3>& m, std::size_t n) {
  if (n == 0) return 1;
  if (n == 1) return m[0][0];
  if (n == 2) return m[0][0] * m[1][1] - m[0][1] * m[1][0];
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// The nearest points of two hulls are inside two simplices of their vertices, and unique there for a suitable choice:
/// of at most three dimensions together (Caratheodory, for A - B and the point of it that is nearest to 0).
template <class Int>
IntSquare<Int> square_of_distance(const std::vector<IntPoint<Int>>& a, const std::vector<IntPoint<Int>>& b) {
  IntSquare<Int> least;
  const auto dot = [](const IntPoint<Int>& p, const IntPoint<Int>& q) -> Int {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  };
  const auto minus = [](const IntPoint<Int>& p, const IntPoint<Int>& q) -> IntPoint<Int> {
    return {Int(p[0] - q[0]), Int(p[1] - q[1]), Int(p[2] - q[2])};
  };
  const auto members = [](unsigned mask) {
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < 4; ++i) {
      if ((mask >> i & 1U) != 0) at.push_back(i);
    }
    return at;
  };
  for (unsigned mask_a = 1; mask_a < 1U << a.size(); ++mask_a) {
    const std::vector<std::size_t> in_a = members(mask_a);
    for (unsigned mask_b = 1; mask_b < 1U << b.size(); ++mask_b) {
      const std::vector<std::size_t> in_b = members(mask_b);
      const std::size_t n = in_a.size() + in_b.size() - 2;
      if (n > 3) continue;
      // Least |w + sum of z_i column_i|.
      const IntPoint<Int> w = minus(a[in_a[0]], b[in_b[0]]);
      std::vector<IntPoint<Int>> column;
      for (std::size_t i = 1; i < in_a.size(); ++i) column.push_back(minus(a[in_a[i]], a[in_a[0]]));
      for (std::size_t i = 1; i < in_b.size(); ++i) column.push_back(minus(b[in_b[0]], b[in_b[i]]));
      std::array<std::array<Int, 3>, 3> gram = {};
      std::array<Int, 3> right = {};
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) gram[i][k] = dot(column[i], column[k]);
        right[i] = -dot(column[i], w);
      }
      const Int under = det3(gram, n);
      if (under == 0) continue;
      Int over = dot(w, w) * under;
      Int sum_a = 0;
      Int sum_b = 0;
      bool inside = true;
      for (std::size_t i = 0; i < n && inside; ++i) {
        std::array<std::array<Int, 3>, 3> replaced = gram;
        for (std::size_t k = 0; k < n; ++k) replaced[k][i] = right[k];
        const Int z = det3(replaced, n);
        inside = z >= 0;
        (i + 1 < in_a.size() ? sum_a : sum_b) += z;
        over -= z * right[i];
      }
      if (!inside || sum_a > under || sum_b > under) continue;
      if (least.under == 0 || BigInt(over) * BigInt(least.under) < BigInt(least.over) * BigInt(under)) {
        least = {over, under};
      }
    }
  }
  return least;
}

/// value = mantissa 2^exponent.
struct Parts {
  explicit Parts(double value) {
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
    exponent -= 53;
    if (mantissa == 0) exponent = 0;
  }
  std::int64_t mantissa = 0;
  int exponent = 0;
};

/// Vertices under a pose in units of 2^-unit_bits, exactly.
inline std::vector<IntPoint<BigInt>> posed_points(const cchip::Primitive& p, const cchip::Pose& pose, int unit_bits) {
  std::vector<IntPoint<BigInt>> points(p.vertex_count());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      for (Eigen::Index c = 0; c < 4; ++c) {
        const Parts x(pose(k, c));
        const Parts y(c < 3 ? p.v[i][c] : 1.0);
        if (x.mantissa == 0 || y.mantissa == 0) continue;
        points[i][static_cast<std::size_t>(k)] += (BigInt(x.mantissa) * y.mantissa)
                                                  << (x.exponent + y.exponent + unit_bits);
      }
    }
  }
  return points;
}

/// Sign of the distance, whose square is in units of 2^-(2 unit_bits), less d.
inline int compare(const IntSquare<BigInt>& square, double d, int unit_bits) {
  const Parts x(d);
  const int shift = 2 * (x.exponent + unit_bits);
  BigInt left = square.over;
  BigInt right = BigInt(x.mantissa) * x.mantissa * square.under;
  (shift < 0 ? left : right) <<= std::abs(shift);
  return left.compare(right) < 0 ? -1 : left.compare(right) > 0 ? 1 : 0;
}

/// The root in doubles, near enough to begin with.
inline double rough_root(const IntSquare<BigInt>& square, int unit_bits) {
  if (square.over == 0) return 0;
  const int shift =
      2 * (70 + std::max(0, static_cast<int>(msb(square.under)) - static_cast<int>(msb(square.over))) / 2);
  const BigInt root = sqrt(BigInt((square.over << shift) / square.under));
  const int drop = std::max(0, static_cast<int>(msb(root)) - 62);
  return std::ldexp(static_cast<double>(static_cast<std::uint64_t>(root >> drop)), drop - shift / 2 - unit_bits);
}

}  // namespace cchip_test

#endif
