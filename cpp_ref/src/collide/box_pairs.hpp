// SPDX-License-Identifier: Apache-2.0
/// \file
/// Broad phase: which of many boxes overlap?
#ifndef CCHIP_COLLIDE_BOX_PAIRS_HPP
#define CCHIP_COLLIDE_BOX_PAIRS_HPP

#include <cchip/collide/scene.hpp>
#include <cstdint>
#include <utility>
#include <vector>

namespace cchip {

/// Whether they share a point.
inline bool overlap(const WorldBox& p, const WorldBox& q) {
  bool apart = false;  // without branches, which would be mispredicted
  for (std::size_t axis = 0; axis < 3; ++axis) {
    apart |= p.least[axis] > q.greatest[axis];
    apart |= q.least[axis] > p.greatest[axis];
  }
  return !apart;
}

/// Every pair of boxes that overlap, once, by their numbers, either first. Builds a tree of boxes by halves of the
/// greatest spread of their middles and descends it against itself: O(n log n), plus the pairs, for boxes that are
/// small beside the space between them; O(n^2) if all overlap. The order depends on the boxes only.
std::vector<std::pair<std::uint32_t, std::uint32_t>> box_pairs(const std::vector<WorldBox>& boxes);

}  // namespace cchip

#endif
