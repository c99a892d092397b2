// SPDX-License-Identifier: Apache-2.0
/// \file
/// Choice of the local grid of a primitive pair: integer translation and power-of-two scale.
#ifndef CCHIP_INTERNAL_GRID_LOCAL_GRID_HPP
#define CCHIP_INTERNAL_GRID_LOCAL_GRID_HPP

#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>
#include <cstdint>
#include <stdexcept>

namespace cchip {

/// Grid step and origin: a point p lies at round(p / 2^exponent) - origin, in grid steps.
struct LocalGrid {
  int exponent = 0;                                ///< one grid step is 2^exponent of the caller's length unit
  std::array<std::int64_t, 3> origin = {0, 0, 0};  ///< grid steps
};

/// A pair on its grid; `pair.eta` is 0 (nothing rounded) or 1.
struct QuantisedPair {
  GridPair pair;
  LocalGrid grid;
};

/// The pair cannot be placed on a local grid (not finite, or magnitudes too far apart).
/// what() is one line: what is wrong and what to do.
class GridError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Places both primitives on a grid on which the pair's box fits into signed `coord_w` bits.
/// - If every coordinate is a whole number of steps on a grid that holds the box, nothing is rounded and
///   eta = 0. The step is then 1 if possible, else the greatest of which all coordinates are multiples, and the
///   origin 0 if the coordinates are in range as they are: such integers go in verbatim.
/// - Otherwise the step is the finest on which the box fits after rounding to nearest, ties to even; the box is centred
///   and eta = 1. A primitive much smaller than the other one may collapse: this is rounding, not an error.
/// \throws GridError if a coordinate is not finite, or 2^62 or more steps from 0 on the grid that the box needs
/// \throws std::invalid_argument if coord_w is not in 4..20
QuantisedPair quantise(const Primitive& a, const Primitive& b, int coord_w);

}  // namespace cchip

#endif
