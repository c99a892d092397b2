// SPDX-License-Identifier: Apache-2.0
/// \file
/// 24-DOPs: bounding volumes of 24 planes in 12 fixed orientations.
#ifndef CCHIP_BVH_DOP24_HPP
#define CCHIP_BVH_DOP24_HPP

#include <array>
#include <cchip/geometry/primitive.hpp>
#include <cstddef>

namespace cchip {

/// Normals of the plane pairs, not normalised: x, y, z, x+y, x+z, y+z, x-y, x-z, y-z, x+y-z, x-y+z, -x+y+z.
constexpr std::array<std::array<int, 3>, 12> dop24_directions = {{{1, 0, 0},
                                                                  {0, 1, 0},
                                                                  {0, 0, 1},
                                                                  {1, 1, 0},
                                                                  {1, 0, 1},
                                                                  {0, 1, 1},
                                                                  {1, -1, 0},
                                                                  {1, 0, -1},
                                                                  {0, 1, -1},
                                                                  {1, 1, -1},
                                                                  {1, -1, 1},
                                                                  {-1, 1, 1}}};

/// Intervals of a primitive on the directions, in units of the caller's length times |direction|; rounded outward,
/// so that every point of the primitive is inside. Without bound where doubles overflow.
struct Dop24 {
  std::array<double, dop24_directions.size()> least = {};
  std::array<double, dop24_directions.size()> greatest = {};
};

/// The smallest 24-DOP, up to rounding.
Dop24 make_dop24(const Primitive& p);

/// False only if the primitives inside are disjoint.
bool overlap(const Dop24& p, const Dop24& q);

}  // namespace cchip

#endif
