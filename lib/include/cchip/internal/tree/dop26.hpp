// SPDX-License-Identifier: Apache-2.0
/// \file
/// 26-DOPs: bounding volumes of 26 planes in 13 fixed orientations.
#ifndef CCHIP_INTERNAL_TREE_DOP26_HPP
#define CCHIP_INTERNAL_TREE_DOP26_HPP

#include <array>
#include <cchip/primitive.hpp>
#include <cstddef>

namespace cchip::bvh {

/// Normals of the plane pairs, not normalised: 3 axes, 6 face diagonals and 4 cube diagonals of a cube. The first
/// nonzero component of each is positive, except in the last. The chip uses the same order.
inline constexpr std::array<std::array<int, 3>, 13> directions = {{{1, 0, 0},
                                                                   {0, 1, 0},
                                                                   {0, 0, 1},
                                                                   {1, 1, 0},
                                                                   {1, -1, 0},
                                                                   {1, 0, 1},
                                                                   {1, 0, -1},
                                                                   {0, 1, 1},
                                                                   {0, 1, -1},
                                                                   {1, 1, 1},
                                                                   {1, 1, -1},
                                                                   {1, -1, 1},
                                                                   {-1, 1, 1}}};
/// Directions first_face..first_corner - 1 are face diagonals, those before them axes, those after them cube diagonals.
inline constexpr std::size_t first_face = 3;
inline constexpr std::size_t first_corner = 9;

/// Intervals of a set of points along the directions, in units of the caller's length times |direction|. Each bound is
/// exact or rounded outward, and infinite where doubles overflow.
struct Dop26 {
  std::array<double, directions.size()> least = {};
  std::array<double, directions.size()> greatest = {};
};

/// The smallest 26-DOP of the hull of the vertices, up to rounding: at most two units in the last place of the sums.
Dop26 make_dop26(const Primitive& p);
Dop26 make_dop26(const Vec3d& point);

/// The smallest 26-DOP that contains both.
Dop26 enclose(const Dop26& p, const Dop26& q);

/// False only if the sets inside are disjoint.
bool overlap(const Dop26& p, const Dop26& q);

}  // namespace cchip::bvh

#endif
