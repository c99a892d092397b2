// SPDX-License-Identifier: Apache-2.0
/// \file
/// The final answer for a pair.
#ifndef CCHIP_INTERNAL_GRID_RESOLVE_HPP
#define CCHIP_INTERNAL_GRID_RESOLVE_HPP

#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>

namespace cchip {

/// True if the closed primitives share a point: the hardware's answer where it is definite, otherwise
/// exact_intersects() of the doubles from which the grid pair was made.
/// \throws std::invalid_argument if the exact oracle is needed and a coordinate is not finite
bool resolve(const Primitive& a, const Primitive& b, const PairResult& result);

}  // namespace cchip

#endif
