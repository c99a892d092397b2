// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exact oracle for pairs on the grid, in fixed-width 128-bit integers; see <cchip/internal/exact/oracle.hpp>.
#ifndef CCHIP_INTERNAL_GRID_GRID_ORACLE_HPP
#define CCHIP_INTERNAL_GRID_GRID_ORACLE_HPP

#include <cchip/internal/exact/oracle.hpp>
#include <cchip/internal/wire/pair.hpp>

namespace cchip {

/// True if the closed primitives share a point (touching counts), for any 32-bit coordinates. eta plays no part.
bool exact_intersects(const GridPair& pair);
/// Whether they are apart, touch or cross, for any 32-bit coordinates.
Relation exact_relation(const GridPair& pair);

}  // namespace cchip

#endif
