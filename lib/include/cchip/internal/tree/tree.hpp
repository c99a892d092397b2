// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tree of 26-DOPs over the faces of a mesh, in doubles: what the image for the chip is made from, and what a CPU can
/// traverse as it is.
#ifndef CCHIP_INTERNAL_TREE_TREE_HPP
#define CCHIP_INTERNAL_TREE_TREE_HPP

#include <cchip/internal/tree/dop26.hpp>
#include <cchip/mesh.hpp>
#include <cstdint>
#include <vector>

namespace cchip::bvh {

/// What a node is; the values are those of the image.
enum class NodeKind : std::uint8_t { inner = 0, triangle = 1, two_triangles = 2, quad = 3 };

struct TreeNode {
  Dop26 dop;  ///< of all faces below, in the coordinates of the mesh
  NodeKind kind = NodeKind::inner;
  /// Children of an inner node, 1..4; faces of a leaf, 1 or 2.
  std::uint8_t count = 0;
  /// Inner node: number of its first child in Tree::nodes, greater than the node's own; the others follow.
  /// Leaf: place of its first face in Tree::faces; the other follows.
  std::uint32_t first = 0;
};

struct Tree {
  /// The root is nodes[0], always an inner node; it has one child if the mesh is a single leaf.
  std::vector<TreeNode> nodes;
  /// Numbers of the mesh's faces, each once.
  std::vector<std::uint32_t> faces;
  /// Levels, the root's and the leaves' included; 2..tree_depth_max.
  int depth = 0;
};

/// Bound on Tree::depth for any mesh. A traversal that descends in both trees at once and keeps one entry for each
/// expanded pair needs at most this many entries.
inline constexpr int tree_depth_max = 48;

struct TreeOptions {
  /// Cost of visiting a node relative to that of testing a primitive in it. Decides between a leaf of two triangles and
  /// two leaves of one; 0: never two.
  double visit_cost = 1;
};

/// Builds a tree: binary by the surface area heuristic in bins, then up to four children each by opening the child with
/// the greatest box. Degenerate and coincident triangles and quads are allowed. Takes O(faces log(faces)) time.
/// \throws std::invalid_argument the mesh has no faces, or more than 2^24 - 2, or a vertex of a face is not finite or
///         its coordinates exceed 2^1000 in magnitude
Tree build_tree(const Mesh& mesh, const TreeOptions& options = {});
/// The same without the volumes of the nodes, which SupportTree does not need.
Tree build_topology(const Mesh& mesh, const TreeOptions& options = {});

/// \pre check_faces() accepts the mesh
/// \throws std::invalid_argument a vertex of a face is not finite or its coordinates exceed 2^1000 in magnitude
void check_vertices(const Mesh& mesh);

/// Gives the nodes of a tree the volumes of a mesh with the same faces and other vertices. Takes O(faces) time. A query
/// stays exact and gets slower the further the faces have moved against each other.
/// \param tree of a mesh with the same faces; its volumes do not matter
/// \throws std::invalid_argument another number of faces, or a vertex as above
void refit(Tree& tree, const Mesh& mesh);

}  // namespace cchip::bvh

#endif
