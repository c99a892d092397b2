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

Hull<BigInt> scaled_hull(const Primitive& p, const Pose& pose, int exponent) {
  return {scaled_points(p, pose, exponent), p.vertex_count()};
}

}  // namespace

bool exact_intersects(const Primitive& a, const Primitive& b) {
  return exact_intersects(a, Pose::Identity(), b, Pose::Identity());
}

bool exact_intersects(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b) {
  const int exponent = common_exponent(b, pose_b, common_exponent(a, pose_a, std::numeric_limits<int>::max()));
  return hulls_meet(scaled_hull(a, pose_a, exponent), scaled_hull(b, pose_b, exponent));
}

Relation exact_relation(const Primitive& a, const Primitive& b) {
  return exact_relation(a, Pose::Identity(), b, Pose::Identity());
}

Relation exact_relation(const Primitive& a, const Pose& pose_a, const Primitive& b, const Pose& pose_b) {
  const int exponent = common_exponent(b, pose_b, common_exponent(a, pose_a, std::numeric_limits<int>::max()));
  return exact::relation_of(scaled_hull(a, pose_a, exponent), scaled_hull(b, pose_b, exponent));
}

}  // namespace cchip
