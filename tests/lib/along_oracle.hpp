// SPDX-License-Identifier: Apache-2.0
/// \file
/// For which s does A meet B + s d? By brute force over triangles of differences of vertices, in integers of any size;
/// nothing in common with the library's view along d.
#ifndef CCHIP_TESTS_LIB_ALONG_ORACLE_HPP
#define CCHIP_TESTS_LIB_ALONG_ORACLE_HPP

#include <optional>
#include <utility>

#include "distance_oracle.hpp"

namespace cchip_test {

/// over / under 2^exponent, under > 0.
struct Factor {
  BigInt over = 0;
  BigInt under = 1;
  int exponent = 0;
};

inline int compare(const Factor& x, const Factor& y) {
  const int exponent = std::min(x.exponent, y.exponent);
  const BigInt left = (x.over * y.under) << (x.exponent - exponent);
  const BigInt right = (y.over * x.under) << (y.exponent - exponent);
  return left.compare(right);
}
inline Factor factor_of(double value) {
  const Parts parts(value);
  return {parts.mantissa, 1, parts.exponent};
}

/// Integers times 2^exponent, as short as they can be.
struct Coordinates {
  std::vector<IntPoint<BigInt>> points;
  int exponent = 0;
  void shorten() {
    BigInt all = 0;
    for (const auto& p : points) {
      for (const BigInt& x : p) all |= abs(x);
    }
    if (all == 0) return;
    const auto zeros = static_cast<int>(lsb(all));
    for (auto& p : points) {
      for (BigInt& x : p) x /= BigInt(1) << zeros;
    }
    exponent += zeros;
  }
};

inline IntPoint<BigInt> cross(const IntPoint<BigInt>& p, const IntPoint<BigInt>& q) {
  return {BigInt(p[1] * q[2] - p[2] * q[1]), BigInt(p[2] * q[0] - p[0] * q[2]), BigInt(p[0] * q[1] - p[1] * q[0])};
}
inline BigInt dot(const IntPoint<BigInt>& p, const IntPoint<BigInt>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
inline bool is_zero(const IntPoint<BigInt>& p) { return p[0] == 0 && p[1] == 0 && p[2] == 0; }

/// A direction that a line has, and all that is asked about it.
class LineOracle {
 public:
  explicit LineOracle(const cchip::Vec3d& direction) {
    constexpr int bits = 1200;
    direction_.points.resize(1);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Parts x(direction[k]);
      if (x.mantissa != 0) {
        direction_.points[0][static_cast<std::size_t>(k)] = BigInt(x.mantissa) << (x.exponent + bits);
      }
    }
    direction_.exponent = -bits;
    direction_.shorten();
    while (d()[main_] == 0) ++main_;
  }

  /// Least and greatest s; none if they meet for no s. Points as posed_points() with unit_bits.
  std::optional<std::pair<Factor, Factor>> meeting(const std::vector<IntPoint<BigInt>>& a,
                                                   const std::vector<IntPoint<BigInt>>& b, int unit_bits) const {
    Coordinates difference;
    difference.exponent = -unit_bits;
    for (const auto& p : a) {
      for (const auto& q : b)
        difference.points.push_back({BigInt(p[0] - q[0]), BigInt(p[1] - q[1]), BigInt(p[2] - q[2])});
    }
    difference.shorten();
    const std::vector<IntPoint<BigInt>>& c = difference.points;
    std::vector<IntPoint<BigInt>> off;  // from the line
    for (const auto& p : c) off.push_back(cross(p, d()));
    if (is_on_one_side(off)) return std::nullopt;

    std::optional<std::pair<Factor, Factor>> found;
    const auto add = [&](BigInt over, BigInt under) {
      if (under < 0) {
        over = -over;
        under = -under;
      }
      const Factor s = {over, under, difference.exponent - direction_.exponent};
      if (!found) found = {s, s};
      if (compare(s, found->first) < 0) found->first = s;
      if (compare(s, found->second) > 0) found->second = s;
    };
    const auto weight = [](const BigInt& x, const BigInt& whole) { return x == 0 || (x > 0) == (whole > 0); };
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (is_zero(off[i])) add(c[i][main_], d()[main_]);
      for (std::size_t j = 0; j < i; ++j) {
        if (is_zero(cross(off[i], off[j]))) {
          for (std::size_t k = 0; k < 3; ++k) {
            const BigInt whole = off[i][k] - off[j][k];
            if (whole == 0) continue;
            if (weight(-off[j][k], whole) && weight(off[i][k], whole)) {
              add(off[i][k] * c[j][main_] - off[j][k] * c[i][main_], whole * d()[main_]);
            }
            break;
          }
        }
        for (std::size_t k = 0; k < j; ++k) {
          // Cramer: the weights of the three are as these, which also say where on the line.
          const BigInt at_i = dot(cross(c[j], c[k]), d());
          const BigInt at_j = dot(cross(c[k], c[i]), d());
          const BigInt at_k = dot(cross(c[i], c[j]), d());
          const BigInt whole = at_i + at_j + at_k;
          if (whole == 0 || !weight(at_i, whole) || !weight(at_j, whole) || !weight(at_k, whole)) continue;
          add(dot(cross(c[i], c[j]), c[k]), whole);
        }
      }
    }
    return found;
  }

  /// Points moved by s d, times a common factor, and points so scaled but not moved.
  std::pair<std::vector<IntPoint<BigInt>>, std::vector<IntPoint<BigInt>>> moved(const std::vector<IntPoint<BigInt>>& a,
                                                                                const std::vector<IntPoint<BigInt>>& b,
                                                                                int unit_bits, const Factor& s) const {
    const int exponent = std::min(-unit_bits, s.exponent + direction_.exponent);
    auto own = a;
    auto other = b;
    for (auto* points : {&own, &other}) {
      for (auto& p : *points) {
        for (BigInt& x : p) x = (x * s.under) << (-unit_bits - exponent);
      }
    }
    for (auto& p : other) {
      for (std::size_t k = 0; k < 3; ++k) p[k] += (s.over * d()[k]) << (s.exponent + direction_.exponent - exponent);
    }
    return {own, other};
  }

 private:
  const IntPoint<BigInt>& d() const { return direction_.points[0]; }
  static bool is_on_one_side(const std::vector<IntPoint<BigInt>>& points) {
    for (std::size_t k = 0; k < 3; ++k) {
      bool above = true;
      bool below = true;
      for (const auto& p : points) {
        above = above && p[k] > 0;
        below = below && p[k] < 0;
      }
      if (above || below) return true;
    }
    return false;
  }

  Coordinates direction_;
  std::size_t main_ = 0;  ///< a component that is not 0
};

}  // namespace cchip_test

#endif
