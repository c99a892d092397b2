// SPDX-License-Identifier: Apache-2.0
#include "axis_gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exact/ieee.hpp"

namespace cchip {
namespace {

/// Greatest of m . y over the volume, at most: with a >= b >= c the magnitudes of m, it is (a - b) axis + (b - c) face
/// diagonal + c cube diagonal.
double support(const bvh::Dop26& dop, const Vec3d& m) {
  const std::array<double, 3> size = {std::abs(m[0]), std::abs(m[1]), std::abs(m[2])};
  std::array<std::size_t, 3> order = {0, 1, 2};
  if (size[order[0]] < size[order[1]]) std::swap(order[0], order[1]);
  if (size[order[1]] < size[order[2]]) std::swap(order[1], order[2]);
  if (size[order[0]] < size[order[1]]) std::swap(order[0], order[1]);
  const auto is_negative = [&m](std::size_t k) { return m[static_cast<Eigen::Index>(k)] < 0; };
  const auto reach = [&dop](std::size_t direction, bool against) {
    return against ? -dop.least[direction] : dop.greatest[direction];
  };
  const auto& [i, j, k] = order;
  // Face diagonals come in pairs by the missing axis 2, 1, 0: the sum and the difference of the other two.
  const std::size_t low = std::min(i, j);
  const std::size_t face = bvh::first_face + 2 * (2 - k) + (is_negative(i) != is_negative(j) ? 1 : 0);
  // Cube diagonals (1 1 1), (1 1 -1), (1 -1 1), (-1 1 1): the one component of another sign than the other two.
  const std::array<bool, 3> negative = {is_negative(0), is_negative(1), is_negative(2)};
  std::size_t corner = bvh::first_corner;
  bool against = negative[0];
  if (negative[0] == negative[1] && negative[1] != negative[2]) {
    corner += 1;
  } else if (negative[0] == negative[2] && negative[0] != negative[1]) {
    corner += 2;
  } else if (negative[1] == negative[2] && negative[0] != negative[1]) {
    corner += 3;
    against = negative[1];
  }
  return (size[i] - size[j]) * reach(i, is_negative(i)) + (size[j] - size[k]) * reach(face, is_negative(low)) +
         size[k] * reach(corner, against);
}

double row_sum(const Pose& pose) { return pose.linear().cwiseAbs().rowwise().sum().maxCoeff(); }

double extent(const Object& object) {
  return object.tree().centre().cwiseAbs().maxCoeff() + 2 * bvh::support_most * object.tree().unit();
}

}  // namespace

AxisGap::AxisGap(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b)
    : pose_a_(pose_a),
      pose_b_(pose_b),
      between_(pose_b.translation() - pose_a.translation()),
      size_(row_sum(pose_a) * extent(a) + row_sum(pose_b) * extent(b) + between_.cwiseAbs().maxCoeff()) {}

// With u = 2^-53 and every magnitude that is added up for a gap at most |n|_1 size: the rounding of L^T n costs 4u,
// that of the factors, their products and sums 6u, that of the translation and its product 5u, of the last sums 3u. 64u
// are allowed.
double AxisGap::operator()(const bvh::Dop26& volume_a, const bvh::Dop26& volume_b, const Vec3d& axis) const {
  const double greatest = axis.cwiseAbs().maxCoeff();
  if (!(greatest > 0x1p-200 && greatest < 0x1p200 && size_ > 0x1p-200 && size_ < 0x1p200)) return 0;
  const Vec3d of_a = pose_a_.linear().transpose() * axis;
  const Vec3d of_b = -(pose_b_.linear().transpose() * axis);
  const double gap = axis.dot(between_) - support(volume_a, of_a) - support(volume_b, of_b);
  const double sure = gap - 64 * 0x1p-53 * (axis.cwiseAbs().sum() * size_);
  return sure > 0 ? sure / (axis.norm() * (1 + 0x1p-48)) * (1 - 0x1p-50) : 0;
}

}  // namespace cchip
