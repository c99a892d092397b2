// SPDX-License-Identifier: Apache-2.0
/// \file
/// Vertex transform and normaliser: from the leaves of two images to pairs for the primitive tests.
///
/// Both leaves are brought to one unit, 2^(x - 48) of B's, x the greater of the leaves' extents: 2^24 units reach from
/// a leaf's origin to its edge. Vertices are then relative to the origin of B's leaf.
#ifndef CCHIP_INTERNAL_MODEL_LEAF_PAIR_HPP
#define CCHIP_INTERNAL_MODEL_LEAF_PAIR_HPP

#include <array>
#include <cchip/internal/image/image_line.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cstdint>

namespace cchip::model {

/// The unit of a leaf pair is not finer than 2^(8 - 48): the error of a query is about 2^-30, and coordinates fit.
inline constexpr int extent_least = 8;
/// Bits of a signed coordinate in units.
inline constexpr int moved_w = 45;

struct MovedVertices {
  std::array<std::array<std::int64_t, 3>, 6> vertex = {};  ///< units
  std::array<bool, 6> lost = {};                           ///< rounding an offset lost a bit
  bool origin_lost = false;                                ///< rounding the origin of A's leaf lost a bit
  /// Bound, in units, on twice the error of a coordinate, less 1 for each of these roundings.
  std::int64_t error = 0;
};

struct MovedLeaves {
  MovedVertices a;
  MovedVertices b;
  bool open = false;  ///< a quad for which no answer is definite
};

MovedLeaves move_leaves(const bvh::LeafLine& a, bvh::NodeKind kind_a, const bvh::LeafLine& b, bvh::NodeKind kind_b,
                        const Query& query);

/// Primitive `index_a` of A's leaf and `index_b` of B's on their own grid: the least shift n for which
/// (x - min + 2^(n-1)) >> n fits coord_w bits on every axis; the middle of that range becomes 0.
/// eta: 0 if nothing is rounded, else 1 + the error in grid steps rounded up, at most 15. The error is that of the
/// vertices of these primitives.
GridPair normalise(const MovedLeaves& leaves, bvh::NodeKind kind_a, std::size_t index_a, bvh::NodeKind kind_b,
                   std::size_t index_b, int coord_w);

}  // namespace cchip::model

#endif
