// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/model/pose_setup.hpp>

namespace cchip::model {
namespace {

using Components = std::array<std::int32_t, 3>;

/// value / 2^bits, to nearest, halves up.
template <class Int>
Int rounded(Int value, int bits) {
  return (value + (Int{1} << (bits - 1))) >> bits;
}
std::int64_t rounded_up(std::int64_t value, int bits) { return (value + (std::int64_t{1} << bits) - 1) >> bits; }

struct Found {
  std::size_t number;
  bool reversed;
};

/// The place of a direction, or of its opposite, among the directions.
Found find(const Components& d) {
  for (std::size_t k = 0; k < bvh::directions.size(); ++k) {
    const auto& e = bvh::directions[k];
    if (d[0] == e[0] && d[1] == e[1] && d[2] == e[2]) return {k, false};
    if (d[0] == -e[0] && d[1] == -e[1] && d[2] == -e[2]) return {k, true};
  }
  return {0, false};  // not reached: every nonzero vector of -1, 0, 1 is in the table
}

DirectionSetup direction_of(const PoseSetup& pose, const std::array<int, 3>& d) {
  Components m = {};
  Components magnitude = {};
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) m[j] += d[i] * pose.m[i][j];
    magnitude[j] = std::abs(m[j]);
  }
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t p, std::size_t q) { return magnitude[p] > magnitude[q]; });
  const std::int32_t b = magnitude[order[1]];
  const std::int32_t c = magnitude[order[2]];
  DirectionSetup result;
  for (std::size_t j = 0; j < 3; ++j) {
    result.magnitude[j] = static_cast<std::int32_t>(rounded_up(magnitude[j], box_m_fraction - 9));
  }
  result.face_factor = std::min(127, (b - c) >> (box_m_fraction - 6));
  result.corner_factor = std::min(127, c >> (box_m_fraction - 7));
  Components v = {};
  const auto sign = [&m](std::size_t j) { return m[j] < 0 ? -1 : 1; };
  v[order[0]] = sign(order[0]);
  v[order[1]] = sign(order[1]);
  const Found face = find(v);
  v[order[2]] = sign(order[2]);
  const Found corner = find(v);
  result.face = face.number;
  result.face_reversed = face.reversed;
  result.corner = corner.number;
  result.corner_reversed = corner.reversed;
  return result;
}

}  // namespace

PoseSetup set_up(const Query& query) {
  PoseSetup pose;
  pose.shift = query.shift;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      pose.m[i][j] = static_cast<std::int32_t>(rounded<std::int64_t>(query.m[i][j], query_m_fraction - box_m_fraction));
    }
    pose.t[i] = static_cast<std::int32_t>(rounded<std::int64_t>(query.t[i], query_t_fraction - box_t_fraction));
  }
  // In 2^-38: three entries of M off by up to 2^-18, times |u_j| <= 1/2, times 2^-shift; t off by up to 2^-25; the
  // query's own bound.
  constexpr int unit = query_error_fraction;
  const std::int64_t of_m = (std::int64_t{3} << (unit - box_m_fraction - 2)) >> query.shift;
  const std::int64_t of_t = std::int64_t{1} << (unit - box_t_fraction - 1);
  pose.epsilon = static_cast<std::int32_t>(rounded_up(of_m + of_t + query.error, unit - box_t_fraction));
  for (std::size_t k = 0; k < pose.direction.size(); ++k) pose.direction[k] = direction_of(pose, bvh::directions[k]);
  return pose;
}

}  // namespace cchip::model
