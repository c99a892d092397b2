// SPDX-License-Identifier: Apache-2.0
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/exact/oracle.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hulls.hpp"

namespace cchip {
namespace {

using exact::Hull;
using exact::Triangle;
using exact::Vec;

/// The grid's integer. 32-bit coordinates need 3 x 33 + 3 bits.
using Int128 = boost::multiprecision::int128_t;
/// Any size, for doubles; up to 512 bits without an allocation.
using BigInt =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
                                      512, 0, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked,
                                      std::allocator<boost::multiprecision::limb_type>>,
                                  boost::multiprecision::et_off>;

Vec<Int128> to_int128(const Vec3i& p) { return {p.x(), p.y(), p.z()}; }

Hull<Int128> grid_hull(const GridPrimitive& p) {
  std::array<Vec<Int128>, 4> points;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) points[i] = to_int128(p.v[i]);
  return {points, p.vertex_count()};
}

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
int common_exponent(const Primitive& p, const Pose& pose, int so_far) {
  for_each_product(p, pose, [&so_far](std::size_t, std::size_t, const Scaled& x, const Scaled& y) {
    so_far = std::min(so_far, x.exponent + y.exponent);
  });
  return so_far;
}

Hull<BigInt> scaled_hull(const Primitive& p, const Pose& pose, int exponent) {
  std::array<Vec<BigInt>, 4> points;
  for_each_product(p, pose, [&](std::size_t i, std::size_t k, const Scaled& x, const Scaled& y) {
    points[i][k] += (BigInt(x.mantissa) * y.mantissa) << (x.exponent + y.exponent - exponent);
  });
  return {points, p.vertex_count()};
}

template <class Num>
Relation relation_of(const Hull<Num>& a, const Hull<Num>& b) {
  if (!hulls_meet(a, b)) return Relation::apart;
  return hulls_cross(a, b) ? Relation::crossing : Relation::touching;
}

}  // namespace

bool exact_intersects(const GridPair& pair) { return hulls_meet(grid_hull(pair.a), grid_hull(pair.b)); }

bool exact_intersects(const Primitive& a, const Primitive& b) {
  return exact_intersects(a, Pose::Identity(), b, Pose::Identity());
}

bool exact_intersects(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b) {
  const int exponent = common_exponent(b, pose_b, common_exponent(a, pose_a, std::numeric_limits<int>::max()));
  return hulls_meet(scaled_hull(a, pose_a, exponent), scaled_hull(b, pose_b, exponent));
}

Relation exact_relation(const GridPair& pair) { return relation_of(grid_hull(pair.a), grid_hull(pair.b)); }

Relation exact_relation(const Primitive& a, const Primitive& b) {
  return exact_relation(a, Pose::Identity(), b, Pose::Identity());
}

Relation exact_relation(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b) {
  const int exponent = common_exponent(b, pose_b, common_exponent(a, pose_a, std::numeric_limits<int>::max()));
  return relation_of(scaled_hull(a, pose_a, exponent), scaled_hull(b, pose_b, exponent));
}

}  // namespace cchip
