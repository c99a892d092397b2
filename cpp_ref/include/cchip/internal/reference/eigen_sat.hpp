// SPDX-License-Identifier: Apache-2.0
/// \file
/// The Eigen floating-point reference: plain separating axis test over every axis.
#ifndef CCHIP_INTERNAL_REFERENCE_EIGEN_SAT_HPP
#define CCHIP_INTERNAL_REFERENCE_EIGEN_SAT_HPP

#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>

namespace cchip {

/// True if the closed primitives of the pair share a point (touching counts). Brute force over a complete
/// axis set, intervals of all vertices, no early end; coplanar and degenerate pairs included, quads as hulls
/// of their four vertices. Coordinates in grid steps, each of `coord_w` signed bits.
/// Floating-point, yet exact: every product and partial sum is an integer below 2^(3 coord_w + 2), which
/// `double` holds for coord_w <= 17 and `long double` above. eta plays no part.
/// \throws std::invalid_argument if coord_w is not in 4..20
bool eigen_intersects(const GridPair& pair, int coord_w);

}  // namespace cchip

#endif
