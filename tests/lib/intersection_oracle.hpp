// SPDX-License-Identifier: Apache-2.0
/// \file
/// The corners of the intersection of two hulls by brute force in fractions: every point that two simplices of vertices
/// may share alone is tried; no clipping. A corner lies inside a face of either hull, of any dimension, and these faces
/// meet in nothing else, so together they have at most three dimensions.
#ifndef CCHIP_TESTS_LIB_INTERSECTION_ORACLE_HPP
#define CCHIP_TESTS_LIB_INTERSECTION_ORACLE_HPP

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "distance_oracle.hpp"

namespace cchip_test {

/// over / under, under > 0.
struct RationalPoint {
  IntPoint<BigInt> over;
  BigInt under = 1;
};

/// q - p times a positive factor.
inline IntPoint<BigInt> arrow(const RationalPoint& p, const RationalPoint& q) {
  IntPoint<BigInt> result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = q.over[k] * p.under - p.over[k] * q.under;
  return result;
}
inline IntPoint<BigInt> cross_of(const IntPoint<BigInt>& p, const IntPoint<BigInt>& q) {
  return {BigInt(p[1] * q[2] - p[2] * q[1]), BigInt(p[2] * q[0] - p[0] * q[2]), BigInt(p[0] * q[1] - p[1] * q[0])};
}
inline BigInt dot_of(const IntPoint<BigInt>& p, const IntPoint<BigInt>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
inline bool vanishes(const IntPoint<BigInt>& p) { return p[0] == 0 && p[1] == 0 && p[2] == 0; }
inline bool same_point(const RationalPoint& p, const RationalPoint& q) { return vanishes(arrow(p, q)); }

/// Is p in a simplex of some of the points? (Caratheodory)
inline bool in_hull(const RationalPoint& p, const std::vector<RationalPoint>& v) {
  const std::size_t n = v.size();
  std::vector<IntPoint<BigInt>> to;
  for (const RationalPoint& q : v) to.push_back(arrow(p, q));
  for (std::size_t i = 0; i < n; ++i) {
    if (vanishes(to[i])) return true;
    for (std::size_t j = 0; j < i; ++j) {
      if (vanishes(cross_of(to[i], to[j])) && dot_of(to[i], to[j]) < 0) return true;
    }
  }
  const auto det = [&](std::size_t i, std::size_t j, std::size_t k) {
    return dot_of(to[i], cross_of(to[j], to[k])).sign();
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        if (det(i, j, k) == 0) {
          const IntPoint<BigInt> x = cross_of(to[i], to[j]);
          const IntPoint<BigInt> y = cross_of(to[j], to[k]);
          const IntPoint<BigInt> z = cross_of(to[k], to[i]);
          if (vanishes(x) || vanishes(y) || vanishes(z)) continue;  // on the line of an edge: seen above
          if (dot_of(x, y) > 0 && dot_of(y, z) > 0) return true;
          continue;
        }
        for (std::size_t l = 0; l < k; ++l) {
          const int all[] = {det(j, k, l), -det(i, k, l), det(i, j, l), -det(i, j, k)};
          if (std::all_of(std::begin(all), std::end(all), [](int s) { return s > 0; }) ||
              std::all_of(std::begin(all), std::end(all), [](int s) { return s < 0; })) {
            return true;  // inside; on a face: seen as triangle
          }
        }
      }
    }
  }
  return false;
}

/// Corners of the intersection of the hulls, in any order.
inline std::vector<RationalPoint> common_corners(const std::vector<RationalPoint>& a,
                                                 const std::vector<RationalPoint>& b, std::mt19937_64& random) {
  std::vector<RationalPoint> found;
  const auto offer = [&](const RationalPoint& p) {
    const bool known = std::any_of(found.begin(), found.end(), [&](const auto& q) { return same_point(p, q); });
    if (!known && in_hull(p, a) && in_hull(p, b)) found.push_back(p);
  };
  const auto between = [](const RationalPoint& p, const RationalPoint& q, const BigInt& over, const BigInt& under) {
    RationalPoint x;  // p + (q - p) over / under, both of denominator 1
    for (std::size_t k = 0; k < 3; ++k) x.over[k] = p.over[k] * under + (q.over[k] - p.over[k]) * over;
    x.under = under;
    if (x.under > 0) return x;
    x.under = -x.under;
    for (BigInt& c : x.over) c = -c;
    return x;
  };
  for (const RationalPoint& p : a) offer(p);
  for (const RationalPoint& p : b) offer(p);
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (std::size_t i = 0; i < one->size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const RationalPoint& p = (*one)[i];
        const RationalPoint& q = (*one)[j];
        const IntPoint<BigInt> u = arrow(p, q);
        for (std::size_t k = 0; k < other->size(); ++k) {
          for (std::size_t l = 0; l < k; ++l) {
            const RationalPoint& r = (*other)[k];
            const IntPoint<BigInt> w = arrow(r, (*other)[l]);
            const IntPoint<BigInt> normal = cross_of(u, w);
            const IntPoint<BigInt> to = arrow(p, r);
            if (!vanishes(normal)) {
              if (dot_of(normal, to) == 0) {
                offer(between(p, q, dot_of(normal, cross_of(to, w)), dot_of(normal, normal)));
              }
            }
            for (std::size_t m = 0; m < l; ++m) {
              const IntPoint<BigInt> n = cross_of(w, arrow(r, (*other)[m]));
              const BigInt under = dot_of(n, u);
              if (under != 0) offer(between(p, q, dot_of(n, to), under));
            }
          }
        }
      }
    }
  }
  // A point that alone is farthest in some direction is a corner; where random directions do not tell, simplices do.
  std::vector<bool> is_corner(found.size(), found.size() == 1);
  std::uniform_int_distribution<int> component(-1000, 1000);
  for (int i = 0; found.size() > 1 && i < 100; ++i) {
    const IntPoint<BigInt> d = {component(random), component(random), component(random)};
    std::size_t best = 0;
    bool alone = true;
    for (std::size_t k = 1; k < found.size(); ++k) {
      const int s = dot_of(d, arrow(found[best], found[k])).sign();
      if (s > 0) best = k;
      alone = s > 0 || (alone && s < 0);
    }
    if (alone) is_corner[best] = true;
  }
  std::vector<RationalPoint> corners;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!is_corner[i]) {
      std::vector<RationalPoint> others = found;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      if (in_hull(found[i], others)) continue;
    }
    corners.push_back(found[i]);
  }
  return corners;
}

inline int dimension_of(const std::vector<RationalPoint>& points) {
  if (points.size() < 3) return static_cast<int>(points.size()) - 1;
  for (std::size_t i = 3; i < points.size(); ++i) {
    const auto to = [&](std::size_t k) { return arrow(points[0], points[k]); };
    if (dot_of(to(i), cross_of(to(1), to(2))) != 0) return 3;  // three corners are not on one line
  }
  return 2;
}

/// The double nearest to over / under 2^-unit_bits, by search among all of them.
inline double round_to_double(const BigInt& over, const BigInt& under, int unit_bits) {
  constexpr std::uint64_t beyond = std::uint64_t{0x7FF} << 52U;  // the bits of infinity: here of 2^1024
  const auto parts = [](std::uint64_t bits) {
    if (bits == beyond) {
      Parts p(1.0);
      p.exponent += 1024;
      return p;
    }
    double x = 0;
    std::memcpy(&x, &bits, sizeof x);
    return Parts(x);
  };
  const BigInt size = abs(over);
  // Sign of the number less the half of the sum of two.
  const auto side = [&](std::uint64_t low, std::uint64_t high) {
    const Parts x = parts(low);
    const Parts y = parts(high);
    const int least = std::min(x.exponent, y.exponent);
    BigInt middle = (BigInt(x.mantissa) << (x.exponent - least)) + (BigInt(y.mantissa) << (y.exponent - least));
    middle *= under;
    BigInt left = size;
    const int shift = least - 1 + unit_bits;
    (shift > 0 ? middle : left) <<= std::abs(shift);
    return left.compare(middle);
  };
  std::uint64_t low = 0;
  std::uint64_t high = beyond;
  if (side(high, high) >= 0) {
    low = high;
  } else {
    while (high - low > 1) {
      const std::uint64_t middle = low + (high - low) / 2;
      (side(middle, middle) >= 0 ? low : high) = middle;
    }
    const int s = side(low, high);
    if (s > 0 || (s == 0 && low % 2 == 1)) low = high;
  }
  double result = 0;
  std::memcpy(&result, &low, sizeof result);
  return over < 0 ? -result : result;
}

}  // namespace cchip_test

#endif
