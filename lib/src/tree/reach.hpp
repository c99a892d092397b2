// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far a whole object reaches, from the first line of its tree.
#ifndef CCHIP_TREE_REACH_HPP
#define CCHIP_TREE_REACH_HPP

#include <algorithm>
#include <array>
#include <cchip/internal/tree/support_tree.hpp>
#include <cmath>
#include <cstdint>

#include "exact/ieee.hpp"

namespace cchip::bvh {

/// How far the object reaches along a vector of its frame, at most: three words of its 26-DOP, a factor each. Without
/// branches, which would be mispredicted. With the magnitudes of m adding up to s, m as given, and the radius R of the
/// object's ball: off by at most 7.95 x 2^-53 R s, and by what underflows (docs/cpp/exactness.md, "Far apart").
inline double reach_along(const SupportTree& tree, const std::array<double, 3>& m) {
  const double x = std::abs(m[0]);
  const double y = std::abs(m[1]);
  const double z = std::abs(m[2]);
  const double high = std::max(x, y);
  const double low = std::min(x, y);
  const double a = std::max(high, z);
  const double b = std::max(low, std::min(high, z));
  const double c = std::min(low, z);
  const auto bit = [](bool condition) { return static_cast<unsigned>(condition); };
  const unsigned signs = bit(m[0] < 0) | bit(m[1] < 0) << 1U | bit(m[2] < 0) << 2U;
  // Of components of equal size any may be the greatest or the least: if these are the same one, all are equal, and
  // only the corner has a factor.
  const unsigned greatest_z = bit(z > high);
  const unsigned greatest = greatest_z << 1U | (bit(y > x) & ~greatest_z);
  const unsigned least_z = bit(z < low);
  const unsigned least = least_z << 1U | (bit(y < x) & ~least_z);
  const std::array<std::int16_t, support_words>& word = tree.whole_words();
  const double axis = word[2 * greatest + (signs >> greatest & 1U)];
  const double face = word[first_face_word + 4 * least + ((signs | signs << 3U) >> (least + 1) & 3U)];
  const double corner = word[first_corner_word + signs];
  return tree.unit() * ((a - b) * axis + 1.4142135623730951 * (b - c) * face + 1.7320508075688772 * c * corner);
}

}  // namespace cchip::bvh

#endif
