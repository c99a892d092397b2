// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which nodes of an object lie behind a plane.
#ifndef CCHIP_SEARCH_BEHIND_PLANE_HPP
#define CCHIP_SEARCH_BEHIND_PLANE_HPP

#include <cchip/internal/tree/support_tree.hpp>
#include <cstdint>
#include <unordered_map>

#include "exact/nearest_planes.hpp"
#include "frame_gap.hpp"
#include "tree_side.hpp"

namespace cchip {

/// Descends to the vertices where the volumes leave it open; remembers nodes, so that all questions about a plane
/// together ask about each vertex a few times at most.
class BehindPlane {
 public:
  BehindPlane(const TreeSide& side, const exact::HalfSpace& space);

  /// Does all that lies below the node lie in the closed half space? Exactly.
  bool contains(bvh::NodeRef node);
  /// Does the whole object?
  bool contains_all();

 private:
  bool contains_line(const bvh::SupportLine& line);

  const TreeSide& side_;
  const exact::HalfSpace& space_;
  LineReach reach_;
  double limit_;  ///< a node that reaches less far from the centre is behind the plane
  std::unordered_map<std::uint32_t, bool> known_;
};

}  // namespace cchip

#endif
