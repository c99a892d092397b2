// SPDX-License-Identifier: Apache-2.0
/// \file
/// Canonical quads: the form in which the primitive tests take them.
#ifndef CCHIP_INTERNAL_GRID_CANONICAL_HPP
#define CCHIP_INTERNAL_GRID_CANONICAL_HPP

#include <array>
#include <cchip/internal/wire/pair.hpp>
#include <cstddef>

namespace cchip {

/// True for triangles and for quads that are
/// - warped: V1 lies off the plane through V0 parallel to the diagonals, so the hull is a tetrahedron; or
/// - planar in weakly convex cyclic order with a normal (V2 - V0) x (V3 - V1) that is not zero; vertices may coincide
///   or lie on the line between their neighbours; or
/// - collapsed: all four vertices on one line.
/// Exact for coordinates of up to defs::coord_w_max bits, like all functions here.
bool is_canonical(const GridPrimitive& p);

/// Vertex i of the canonical form is vertex order[i] of `p`. {0, 1, 2, 3} if `p` is canonical already; a quad that
/// crosses itself or is folded is reordered; if one vertex lies inside the triangle of the others, that vertex is
/// left out and the last of the other three is repeated.
std::array<std::size_t, 4> canonical_order(const GridPrimitive& p);

/// The canonical primitive with the same convex hull. Rounding to a grid can flatten or dent a quad: call it after
/// quantise(). The engines call it themselves.
GridPrimitive canonical_quad(const GridPrimitive& p);

}  // namespace cchip

#endif
