// SPDX-License-Identifier: Apache-2.0
#include "dop_pairs.hpp"

#include <algorithm>
#include <cchip/internal/tree/support_tree.hpp>
#include <cmath>
#include <limits>

namespace cchip {
namespace {

using bvh::directions;
using bvh::Dop26;
constexpr std::size_t count = directions.size();

/// A number for each direction of the 26: d along directions[d], count + d against it.
std::uint8_t number_of(const std::array<int, 3>& v) {
  for (std::size_t d = 0; d < count; ++d) {
    const auto& u = directions[d];
    if (v == u) return static_cast<std::uint8_t>(d);
    if (v[0] == -u[0] && v[1] == -u[1] && v[2] == -u[2]) return static_cast<std::uint8_t>(count + d);
  }
  return 0;  // the zero vector, whose factor is 0
}

/// number_of() of every vector of -1, 0, 1.
struct Numbers {
  Numbers() {
    for (int i = 0; i < 27; ++i) number[static_cast<std::size_t>(i)] = number_of({i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1});
  }
  std::uint8_t operator()(const std::array<int, 3>& v) const {
    return number[static_cast<std::size_t>(9 * v[0] + 3 * v[1] + v[2] + 13)];
  }
  std::array<std::uint8_t, 27> number = {};
};

std::uint8_t opposite(std::uint8_t number) {
  return static_cast<std::uint8_t>(number < count ? number + count : number - count);
}

Realignment::Directions own_directions() {
  Realignment::Directions d;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      d(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = directions[i][k];
  }
  return d;
}

/// Bound on the magnitude of the coordinates that an object's volumes are made of.
double extent(const Object& object) {
  const bvh::SupportTree& tree = object.tree();
  return tree.centre().cwiseAbs().maxCoeff() + 2 * bvh::support_most * tree.unit();
}

/// Directions of the world that the pose maps to the 13, nearly; nothing if the pose has no good inverse.
std::optional<Realignment::Directions> directions_that_become_own(const Eigen::Matrix3d& linear) {
  const double greatest = linear.cwiseAbs().maxCoeff();
  if (greatest == 0) return std::nullopt;
  const double scale = std::ldexp(1.0, -std::ilogb(greatest));  // so that the determinant does not overflow
  const Realignment::Directions world = ((linear * scale).inverse() * scale).transpose() * own_directions();
  const Realignment::Directions off = linear.transpose() * world - own_directions();
  // A bad inverse costs tightness, not truth: the distance goes into the slack.
  if (!(off.cwiseAbs().maxCoeff() <= 0x1p-20)) return std::nullopt;
  return world;
}

}  // namespace

Realignment::Realignment(const Directions& wanted, const Row& offset, const Row& slack) {
  static const Numbers numbers;
  for (std::size_t d = 0; d < count; ++d) {
    const auto column = static_cast<Eigen::Index>(d);
    // With a >= b >= c the magnitudes: (a - b) axis + (b - c) face diagonal + c cube diagonal.
    std::array<Eigen::Index, 3> order = {0, 1, 2};
    const auto size = [&](Eigen::Index i) { return std::abs(wanted(i, column)); };
    std::sort(order.begin(), order.end(), [&size](Eigen::Index i, Eigen::Index k) { return size(i) > size(k); });
    std::array<int, 3> towards = {0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      towards[static_cast<std::size_t>(order[i])] = wanted(order[i], column) < 0 ? -1 : 1;
      Part& part = parts_[d][i];
      part.factor = size(order[i]) - (i < 2 ? size(order[i + 1]) : 0.0);
      part.at = numbers(towards);
      part.opposite = opposite(part.at);
    }
    low_[d] = offset[column] - slack[column];
    high_[d] = offset[column] + slack[column];
  }
}

Dop26 Realignment::operator()(const Dop26& dop) const {
  std::array<double, 2 * count> support;
  for (std::size_t d = 0; d < count; ++d) {
    support[d] = dop.greatest[d];
    support[count + d] = -dop.least[d];
  }
  Dop26 result;
  for (std::size_t d = 0; d < count; ++d) {
    const auto& p = parts_[d];
    result.greatest[d] =
        p[0].factor * support[p[0].at] + p[1].factor * support[p[1].at] + p[2].factor * support[p[2].at] + high_[d];
    result.least[d] = low_[d] - (p[0].factor * support[p[0].opposite] + p[1].factor * support[p[1].opposite] +
                                 p[2].factor * support[p[2].opposite]);
  }
  return result;
}

DopPairs::DopPairs(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b, double within) {
  const auto chosen = directions_that_become_own(pose_b.linear());
  const Realignment::Directions world = chosen ? *chosen : own_directions();
  world_ = world;
  const Realignment::Directions in_a = pose_a.linear().transpose() * world;
  const Realignment::Directions in_b = pose_b.linear().transpose() * world;
  const Vec3d shift = pose_a.translation() - pose_b.translation();
  const double extent_a = extent(a);
  const double extent_b = extent(b);

  // Sums of the magnitudes of all that is added up, for A's bounds, B's bounds and the offset.
  const Realignment::Row size_a =
      (pose_a.linear().cwiseAbs().transpose() * world.cwiseAbs()).colwise().sum() * extent_a;
  const Realignment::Row size_b =
      (pose_b.linear().cwiseAbs().transpose() * world.cwiseAbs()).colwise().sum() * extent_b;
  const Realignment::Row size_shift = shift.cwiseAbs().transpose() * world.cwiseAbs();
  constexpr double lost = 0x1p-1060;  // more than what underflows
  Realignment::Row slack = 0x1p-48 * (size_a + size_b + size_shift);
  slack.array() += lost * (1 + extent_a + extent_b);
  const Realignment::Row greatest = world.cwiseAbs().colwise().maxCoeff();  // so that no square underflows
  length_ = (1 + 0x1p-48) * greatest.array() * (world * greatest.cwiseInverse().asDiagonal()).colwise().norm().array();
  if (within > 0) slack += within * length_;
  // Where a sum might overflow nothing is excluded.
  const auto moderate = (size_a + size_b + size_shift).array() < 0x1p1000;
  slack = moderate.select(slack.array(), std::numeric_limits<double>::infinity()).matrix().eval();
  if (chosen) slack += 2 * extent_b * (in_b - own_directions()).cwiseAbs().colwise().sum();

  a_.emplace(in_a, shift.transpose() * world, slack);
  if (!chosen) b_.emplace(in_b, Realignment::Row::Zero(), Realignment::Row::Zero());
}

double DopPairs::overlap(const Dop26& volume_a, const Dop26& volume_b) {
  constexpr std::array<double, 3> per_length = {1, 0.70710678118654752, 0.57735026918962576};  // 1 / |direction|
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t d = 0; d < count; ++d) {
    // A NaN, which an overflow may leave, separates nothing.
    if (volume_a.greatest[d] < volume_b.least[d] || volume_b.greatest[d] < volume_a.least[d]) return -1;
    const double on_this = std::min(volume_a.greatest[d] - volume_b.least[d], volume_b.greatest[d] - volume_a.least[d]);
    const double length = per_length[d < bvh::first_face ? 0 : d < bvh::first_corner ? 1 : 2];
    if (on_this * length < depth) depth = on_this * length;
  }
  return depth;
}

double DopPairs::gap(const Dop26& volume_a, const Dop26& volume_b) const {
  double most = 0;
  for (std::size_t d = 0; d < count; ++d) {
    const double on_this = std::max(volume_b.least[d] - volume_a.greatest[d], volume_a.least[d] - volume_b.greatest[d]);
    const double length = length_[static_cast<Eigen::Index>(d)];
    if (on_this > 0 && length > 0x1p-500 && length < 0x1p500) most = std::max(most, on_this / length);  // not for NaN
  }
  return most < std::numeric_limits<double>::infinity() ? std::max(0.0, most * (1 - 0x1p-50) - 0x1p-1070) : 0;
}

}  // namespace cchip
