// SPDX-License-Identifier: Apache-2.0
/// \file
/// Broad phase: which of many boxes overlap?
#ifndef CCHIP_COLLIDE_BOX_PAIRS_HPP
#define CCHIP_COLLIDE_BOX_PAIRS_HPP

#include <cchip/collide/scene.hpp>
#include <cstdint>
#include <functional>
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

/// Calls `visit` once for each pair of boxes that overlap, by their numbers, either first. Builds a tree of boxes by
/// halves along the axis of the greatest spread and descends it against itself: O(n log n), plus the pairs, for boxes
/// that are small beside the space between them; O(n^2) if all overlap. The order depends on the boxes only.
void visit_box_pairs(const std::vector<WorldBox>& boxes,
                     const std::function<void(std::uint32_t, std::uint32_t)>& visit);

}  // namespace cchip

#endif
