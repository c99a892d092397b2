// SPDX-License-Identifier: Apache-2.0
#include "query_scale.hpp"

#include <algorithm>
#include <cchip/internal/tree/support_tree.hpp>
#include <cmath>
#include <limits>

namespace cchip {
namespace {

constexpr int far_below = -10000;  ///< exponent of 0

int exponent_of(double x) { return x == 0 ? far_below : std::ilogb(x); }

/// Exponent of about the greatest coordinate under the linear part of the pose.
int size_exponent(const Object& object, const Pose& pose) {
  const bvh::SupportTree& tree = object.tree();
  const double extent = tree.centre().cwiseAbs().maxCoeff() + bvh::support_most * tree.unit();
  return exponent_of(pose.linear().cwiseAbs().maxCoeff()) + exponent_of(extent);
}

double scaled_up(double length, int exponent) {
  const double scaled = std::ldexp(length, exponent);
  return std::ldexp(scaled, -exponent) < length ? std::nextafter(scaled, std::numeric_limits<double>::infinity())
                                                : scaled;
}

}  // namespace

QueryScale::QueryScale(const CollisionQuery& query) {
  const Vec3d between = query.pose_a->translation() - query.pose_b->translation();
  const int size = std::max({size_exponent(*query.a, *query.pose_a), size_exponent(*query.b, *query.pose_b),
                             exponent_of(between.cwiseAbs().maxCoeff())});
  if (std::abs(size) <= 100 || size < far_below / 2) return;
  int greatest = far_below;
  int least = -far_below;
  for (const Pose* pose : {query.pose_a, query.pose_b}) {
    for (const double entry : pose->affine().reshaped()) {
      if (entry == 0) continue;
      greatest = std::max(greatest, std::ilogb(entry));
      least = std::min(least, std::ilogb(entry));
    }
  }
  constexpr int digits = std::numeric_limits<double>::digits;
  constexpr int most = std::numeric_limits<double>::max_exponent - 24;
  constexpr int fewest = std::numeric_limits<double>::min_exponent + digits;
  exponent_ = size > 0 ? std::max(-size, std::min(0, fewest - least)) : std::min(-size, std::max(0, most - greatest));
}

Pose QueryScale::operator()(const Pose& pose) const {
  Pose scaled = pose;
  if (exponent_ == 0) return scaled;
  for (double& entry : scaled.affine().reshaped()) entry = std::ldexp(entry, exponent_);
  return scaled;
}

double QueryScale::rounded_up(double length) const { return scaled_up(length, exponent_); }

double QueryScale::lower(double length) const {
  const double mine = std::min(std::ldexp(length, -exponent_), std::numeric_limits<double>::max());
  return std::ldexp(mine, exponent_) > length ? std::nextafter(mine, 0.0) : mine;
}

double QueryScale::upper(double length) const { return scaled_up(length, -exponent_); }

Vec3d QueryScale::point(const Vec3d& p) const {
  return {std::ldexp(p[0], -exponent_), std::ldexp(p[1], -exponent_), std::ldexp(p[2], -exponent_)};
}

}  // namespace cchip
