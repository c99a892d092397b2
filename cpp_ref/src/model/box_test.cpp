// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/model/box_test.hpp>
#include <cchip/internal/model/sat.hpp>

namespace cchip::model {
namespace {

using bvh::directions;
using bvh::first_corner;
using bvh::first_face;

/// 2^exponent, at least 1: a fraction of a quarter counts as a quarter.
std::int64_t quarters(int exponent) { return std::int64_t{1} << std::max(0, exponent); }

std::int64_t slack_of(const NodeGrid& grid, int step, const PoseSetup& pose) {
  // In half steps of the grid, per unit of |d|_1, rounded up to a quarter:
  //   2 epsilon / 2^step: the position of A's points;
  //   1/8: floors of A's planes, 1 of the offset, 3 of M centre, 3 of |m| half, each of 6 fraction bits; and those of
  //   B's corners, 2 fraction bits (docs/hardware/image.md says why they need no more).
  const int g = step + 1;  // >= 0
  std::int64_t slack =
      (1024 * std::int64_t{pose.epsilon} + (std::int64_t{32} << g) + (std::int64_t{64} << g) - 1) >> (g + 6);
  // A's box as a point: its corners are at most 128 half steps of A from the origin, rows of |M| add up to less than 2.
  if (grid.a_is_point) slack += quarters(2 + 8 - grid.x);
  // B's box as a point.
  if (grid.b_is_point) slack += quarters(2 + 7 - grid.y);
  return slack;
}

}  // namespace

Planes planes_of_a(const bvh::InnerLine& node, std::size_t child, const PoseSetup& pose, const NodeGrid& grid) {
  const bvh::ChildVolume& volume = node.child[child];
  Word3 centre = {};  // sum and difference of opposite corners are centre and half size in half steps; 5 fraction bits
  Word3 half = {};
  if (!grid.a_is_point) {
    for (std::size_t j = 0; j < 3; ++j) {
      centre[j] = ((volume.greatest[j] + volume.least[j]) * 32) >> grid.x;
      half[j] = ((volume.greatest[j] - volume.least[j]) * 32) >> grid.x;
    }
  }
  Word3 moved = grid.offset;  // 6 fraction bits
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) moved[i] += (pose.m[i][j] * centre[j]) >> 16;
  }
  Planes planes{};
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const DirectionSetup& setup = pose.direction[d];
    std::int64_t middle = 0;
    std::int64_t extent = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      middle += directions[d][i] * moved[i];
      extent += (setup.magnitude[i] * half[i]) >> 8;
    }
    const auto cut = [&](bool lower) {  // 4 fraction bits until the last shift
      if (!grid.use_a_cuts) return std::int64_t{0};
      const int face = volume.cut[setup.face - first_face][lower != setup.face_reversed ? 1 : 0];
      const int corner = volume.cut[setup.corner - first_face][lower != setup.corner_reversed ? 1 : 0];
      const std::int64_t product = setup.face_factor * face + setup.corner_factor * corner;
      return (product << (node.cut_exponent - 2)) << 2;
    };
    // Modulo 2^width like the hardware's sums. Planes of children that overlap fit; others may wrap into an overlap,
    // which is safe.
    const int width = d < first_face ? 17 : 18;
    planes.upper[d] = wrap(static_cast<std::uint64_t>(middle + extent - cut(false)), width) >> 5;
    planes.lower[d] = wrap(static_cast<std::uint64_t>(middle - extent + cut(true)), width) >> 5;
  }
  return planes;
}

Planes planes_of_b(const bvh::InnerLine& node, std::size_t child, const NodeGrid& grid) {
  const bvh::ChildVolume& volume = node.child[child];
  Word3 upper = {grid.slack, grid.slack, grid.slack};  // 2 fraction bits
  Word3 lower = {-grid.slack, -grid.slack, -grid.slack};
  if (!grid.b_is_point) {
    for (std::size_t i = 0; i < 3; ++i) {
      upper[i] += (volume.greatest[i] * 16) >> (grid.y + 1);
      lower[i] += (volume.least[i] * 16) >> (grid.y + 1);
    }
  }
  Planes planes{};
  for (std::size_t d = 0; d < directions.size(); ++d) {
    std::int64_t up = 0;
    std::int64_t low = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const int sign = directions[d][i];
      up += sign * (sign > 0 ? upper[i] : lower[i]);
      low += sign * (sign > 0 ? lower[i] : upper[i]);
    }
    if (d >= first_face && grid.use_b_cuts) {
      const int unit = node.cut_exponent + (d < first_corner ? 0 : 1) + 2 - grid.y;
      up -= std::int64_t{volume.cut[d - first_face][0]} << unit;
      low += std::int64_t{volume.cut[d - first_face][1]} << unit;
    }
    planes.upper[d] = up >> 1;
    planes.lower[d] = low >> 1;
  }
  return planes;
}

NodeGrid grid_of(const bvh::InnerLine& a, const bvh::InnerLine& b, const PoseSetup& pose) {
  NodeGrid grid;
  const int step_a = a.step - pose.shift;  // in B's unit
  const int coarser = b.step - step_a;
  grid.x = coarser <= 1 ? 0 : coarser <= 3 ? 2 : coarser <= 5 ? 4 : coarser - 1;
  grid.a_is_point = coarser > 5;
  grid.use_a_cuts = grid.x == 0;
  const int step = step_a + grid.x;  // of the grid; at least -1, because it is at least B's - 1
  grid.y = step - b.step;
  grid.b_is_point = grid.y >= 6;
  grid.use_b_cuts = grid.y <= 1;
  for (std::size_t i = 0; i < 3; ++i) {
    std::int64_t turned = 0;  // 2^-(35 + shift)
    for (std::size_t j = 0; j < 3; ++j) turned += std::int64_t{pose.m[i][j]} * a.origin[j];
    const std::int64_t between = pose.t[i] - std::int64_t{b.origin[i]} * 64;  // 2^-24
    grid.offset[i] = (between * (std::int64_t{1} << (11 + pose.shift)) + turned) >> (step + 4 + pose.shift);
    // Boxes reach at most 256 half steps from their origins, A's after M, and the slack 64.
    grid.far = grid.far || wrap(static_cast<std::uint64_t>(grid.offset[i]), offset_w) != grid.offset[i];
  }
  const std::int64_t slack = slack_of(grid, step, pose);
  grid.near = slack > slack_max;
  grid.slack = grid.near ? 0 : slack;
  return grid;
}

BoxVerdict test_boxes(const bvh::InnerLine& a, const bvh::InnerLine& b, const PoseSetup& pose, const NodeGrid& grid) {
  BoxVerdict verdict;
  const auto children_a = static_cast<std::size_t>(a.children);
  const auto children_b = static_cast<std::size_t>(b.children);
  if (grid.far) return verdict;
  std::array<Planes, 4> planes_b{};
  for (std::size_t j = 0; j < children_b; ++j) planes_b[j] = planes_of_b(b, j, grid);
  for (std::size_t i = 0; i < children_a; ++i) {
    const Planes p = planes_of_a(a, i, pose, grid);
    for (std::size_t j = 0; j < children_b; ++j) {
      const Planes& q = planes_b[j];
      bool separated = false;
      std::int64_t key = 15;
      for (std::size_t d = 0; d < directions.size(); ++d) {
        const std::int64_t above = p.upper[d] - q.lower[d];
        const std::int64_t below = q.upper[d] - p.lower[d];
        separated = separated || above < 0 || below < 0;
        key = std::min({key, above >> (d < first_face ? 3 : 4), below >> (d < first_face ? 3 : 4)});
      }
      if (separated && !grid.near) continue;
      verdict.overlap = static_cast<std::uint16_t>(verdict.overlap | 1U << (4 * i + j));
      verdict.key[4 * i + j] = grid.near ? std::uint8_t{0} : static_cast<std::uint8_t>(key);
    }
  }
  return verdict;
}

ChildPairs sort_children(const bvh::InnerLine& a, unsigned children_a, const bvh::InnerLine& b, unsigned children_b,
                         const BoxVerdict& verdict) {
  ChildPairs pairs;
  for (unsigned number = 0; number < 16; ++number) {
    const unsigned i = number / 4;
    const unsigned j = number % 4;
    if ((children_a >> i & 1U) == 0 || (children_b >> j & 1U) == 0) continue;
    if (static_cast<int>(i) >= a.children || static_cast<int>(j) >= b.children) continue;
    const auto with = [number](std::uint16_t mask) { return static_cast<std::uint16_t>(mask | 1U << number); };
    pairs.counted = with(pairs.counted);
    if ((verdict.overlap >> number & 1U) == 0) continue;
    if (a.kind[i] != bvh::NodeKind::inner && b.kind[j] != bvh::NodeKind::inner) {
      pairs.leaves = with(pairs.leaves);
      continue;
    }
    if (pairs.waiting == 0 || verdict.key[number] > verdict.key[pairs.best]) pairs.best = number;
    pairs.waiting = with(pairs.waiting);
    if (verdict.key[number] >= strong_key) pairs.strong = with(pairs.strong);
  }
  return pairs;
}

}  // namespace cchip::model
