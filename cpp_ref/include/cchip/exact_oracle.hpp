// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exact oracle: orientation predicates over a multiprecision library; no separating axes, so it
/// shares neither arithmetic nor algorithm with the hardware, its model or the Eigen reference.
#ifndef CCHIP_EXACT_ORACLE_HPP
#define CCHIP_EXACT_ORACLE_HPP

#include <cchip/geometry.hpp>

namespace cchip {

/// True if the closed primitives share a point; fixed-width 128-bit integers.
bool exact_intersects(const GridPair& pair);
/// The same for any finite doubles, exact for these doubles (arbitrary precision after scaling).
/// Throws std::invalid_argument if a coordinate is not finite.
bool exact_intersects(const Primitive& a, const Primitive& b);

}  // namespace cchip

#endif
