// SPDX-License-Identifier: Apache-2.0
/// \file
/// A tree of an object, as searches in doubles descend it.
#ifndef CCHIP_SEARCH_TREE_SIDE_HPP
#define CCHIP_SEARCH_TREE_SIDE_HPP

#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/mesh.hpp>
#include <cstdint>

namespace cchip {

/// One object of a search in doubles.
struct TreeSide {
  const Mesh& mesh;
  const bvh::SupportTree& tree;

  /// Volume of a line. That of a leaf is made from its faces: lines are too coarse for an object that is much larger
  /// than its partner.
  bvh::Dop26 volume(const bvh::SupportLine& line) const {
    const bvh::NodeRef node = line.ref();
    if (!node.is_leaf()) return dop_of(tree, line);
    bvh::Dop26 dop = bvh::make_dop26(mesh.primitive(tree.faces()[node.first()]));
    for (std::uint32_t i = 1; i < node.count(); ++i) {
      dop = enclose(dop, bvh::make_dop26(mesh.primitive(tree.faces()[node.first() + i])));
    }
    return dop;
  }
  /// Line `number` as a node of its own, for a leaf that waits for the other object's nodes to come down.
  bvh::NodeRef below(std::uint32_t number, bool other_is_leaf) const {
    const bvh::NodeRef node = tree.lines()[number].ref();
    return node.is_leaf() && !other_is_leaf ? bvh::NodeRef::inner(number, 1) : node;
  }
};

}  // namespace cchip

#endif
