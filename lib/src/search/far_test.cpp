// SPDX-License-Identifier: Apache-2.0
#include "far_test.hpp"

#include <algorithm>
#include <cmath>

#include "exact/ieee.hpp"
#include "line_reach.hpp"

namespace cchip {
namespace {

using bvh::SupportTree;
using Vector = std::array<double, 3>;

constexpr double moderate_most = 0x1p100;
constexpr double moderate_least = 0x1p-100;

double sum_of_magnitudes(const double* v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }

/// An object's centre in the world, and bounds.
struct Placed {
  Vector centre;
  double entries;  ///< sum of the magnitudes of the map's entries
  double size;     ///< bound on the sum of what is added up for a point
};

Placed place(const SupportTree& tree, const Pose& pose) {
  const Vec3d& c = tree.centre();
  const double* const p = pose.data();  // columns of four
  Placed placed;
  for (std::size_t i = 0; i < 3; ++i) placed.centre[i] = p[i] * c[0] + p[4 + i] * c[1] + p[8 + i] * c[2] + p[12 + i];
  placed.entries = sum_of_magnitudes(p) + sum_of_magnitudes(p + 4) + sum_of_magnitudes(p + 8);
  placed.size = placed.entries * tree.extent() + sum_of_magnitudes(p + 12);
  return placed;
}

/// The axis as the object sees it.
Vector to_object(const Pose& pose, const Vector& axis) {
  const double* const p = pose.data();
  Vector m;
  for (std::size_t k = 0; k < 3; ++k) m[k] = p[4 * k] * axis[0] + p[4 * k + 1] * axis[1] + p[4 * k + 2] * axis[2];
  return m;
}

}  // namespace

CentreLine centre_line(const CollisionQuery& query) {
  const Placed a = place(query.a->tree(), *query.pose_a);
  const Placed b = place(query.b->tree(), *query.pose_b);
  CentreLine line;
  for (std::size_t i = 0; i < 3; ++i) line.between[i] = b.centre[i] - a.centre[i];
  line.size = a.size + b.size;
  line.entries_a = a.entries;
  line.entries_b = b.entries;
  // NaN is not moderate. Magnitudes of translations are parts of the size. Without branches, which would be
  // mispredicted.
  line.moderate = line.size < moderate_most;
  line.moderate &= a.entries < moderate_most;
  line.moderate &= b.entries < moderate_most;
  line.moderate &= query.a->tree().extent() < moderate_most;
  line.moderate &= query.b->tree().extent() < moderate_most;
  line.moderate &= line.size > moderate_least;
  return line;
}

bool is_far(const CollisionQuery& query, const CentreLine& line, double within, double margin) {
  const Vector& axis = line.between;
  const Vector of_a = to_object(*query.pose_a, axis);
  const Vector of_b = to_object(*query.pose_b, {-axis[0], -axis[1], -axis[2]});
  const double reach = reach_along(query.a->tree(), of_a) + reach_along(query.b->tree(), of_b);
  const double square = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
  double gap = square - reach;
  if (within > 0) gap -= within * std::sqrt(square) * (1 + 0x1p-48);
  const double longest = std::max({std::abs(axis[0]), std::abs(axis[1]), std::abs(axis[2])});
  return line.moderate && longest > far_axis_least && gap > margin * far_limit * (longest * line.size);
}

}  // namespace cchip
