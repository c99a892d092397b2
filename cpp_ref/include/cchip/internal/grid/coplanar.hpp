// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the vertices of primitives on the grid have in common.
#ifndef CCHIP_INTERNAL_GRID_COPLANAR_HPP
#define CCHIP_INTERNAL_GRID_COPLANAR_HPP

#include <cchip/internal/wire/pair.hpp>

namespace cchip {

/// True if the vertices span no plane: all on one line, or one point.
/// Exact for coordinates of up to defs::coord_w_max bits, like is_coplanar().
bool is_degenerate(const GridPrimitive& p);
/// True if some plane holds all vertices of both primitives. Degenerate primitives count like others: two
/// segments are coplanar unless their lines are skew, and a point is coplanar with every segment and point.
bool is_coplanar(const GridPair& pair);

}  // namespace cchip

#endif
