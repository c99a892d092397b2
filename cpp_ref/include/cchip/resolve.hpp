// SPDX-License-Identifier: Apache-2.0
/// \file
/// The final answer for a pair.
#ifndef CCHIP_RESOLVE_HPP
#define CCHIP_RESOLVE_HPP

#include <cchip/engine.hpp>
#include <cchip/geometry.hpp>

namespace cchip {

/// True if the closed primitives share a point: the engine's answer where it is definite, otherwise
/// exact_intersects() of the doubles from which the engine's grid pair was made.
/// \throws std::invalid_argument if the exact oracle is needed and a coordinate is not finite
bool resolve(const Primitive& a, const Primitive& b, const EngineAnswer& answer);

}  // namespace cchip

#endif
