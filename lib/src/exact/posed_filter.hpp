// SPDX-License-Identifier: Apache-2.0
/// \file
/// The place of a primitive under a pose, as doubles with a bound on the error of each.
#ifndef CCHIP_EXACT_POSED_FILTER_HPP
#define CCHIP_EXACT_POSED_FILTER_HPP

#include <algorithm>
#include <array>
#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "filter.hpp"
#include "hulls.hpp"

namespace cchip::exact {

/// Greatest magnitude of a coordinate.
/// \throws std::invalid_argument one is not finite
inline double greatest_component(const Primitive& p) {
  double greatest = 0;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    if (!p.v[i].allFinite()) {
      throw std::invalid_argument("primitive: a coordinate is not finite: replace NaN and infinities by numbers");
    }
    greatest = std::max(greatest, p.v[i].cwiseAbs().maxCoeff());
  }
  return greatest;
}

/// Translation of A relative to B.
struct Offset {
  Offset(const Pose& pose_a, const Pose& pose_b) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double to = pose_a.translation()[k];
      const double from = pose_b.translation()[k];
      value[k] = to - from;
      const double part = value[k] - to;
      error[k] = std::abs((to - (value[k] - part)) - (from + part));  // TwoSum
    }
  }
  Vec3d value;  ///< rounded
  Vec3d error;  ///< bound on its error; exactly 0 where it is exact
};

/// The vertices under a map, each with a bound on its error.
/// \tparam Number Filter or FineFilter
template <class Number>
std::array<Vec<Number>, 4> filter_points(const Primitive& p, const Eigen::Matrix3d& linear, const Vec<Number>& offset) {
  std::array<Vec<Number>, 4> points;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      // Most poses of assemblies have zeros and ones, which spare a product.
      points[i][k] = offset[k];
      for (Eigen::Index c = 0; c < 3; ++c) {
        const double entry = linear(static_cast<Eigen::Index>(k), c);
        if (entry == 0) continue;
        points[i][k] += entry == 1 ? Number(p.v[i][c]) : Number(entry) * Number(p.v[i][c]);
      }
    }
  }
  return points;
}

inline Vec<Filter> filter_offset(const Vec3d& offset, const Vec3d& error) {
  return {Filter(offset.x(), error.x()), Filter(offset.y(), error.y()), Filter(offset.z(), error.z())};
}

}  // namespace cchip::exact

#endif
