// SPDX-License-Identifier: Apache-2.0
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hulls.hpp"
#include "scaled_points.hpp"

namespace cchip {
namespace {

using exact::BigInt;
using exact::common_exponent;
using exact::Hull;
using exact::scaled_points;
using exact::Triangle;
using exact::Vec;

/// The grid's integer. 32-bit coordinates need 3 x 33 + 3 bits.
using Int128 = boost::multiprecision::int128_t;
Vec<Int128> to_int128(const Vec3i& p) { return {p.x(), p.y(), p.z()}; }

Hull<Int128> grid_hull(const GridPrimitive& p) {
  std::array<Vec<Int128>, 4> points;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) points[i] = to_int128(p.v[i]);
  return {points, p.vertex_count()};
}

Hull<BigInt> scaled_hull(const Primitive& p, const Pose& pose, int exponent) {
  return {scaled_points(p, pose, exponent), p.vertex_count()};
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
