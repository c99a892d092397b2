// SPDX-License-Identifier: Apache-2.0
/// \file
/// Choice of the local grid of a primitive pair: integer translation and power-of-two scale.
#ifndef CCHIP_LOCAL_GRID_HPP
#define CCHIP_LOCAL_GRID_HPP

#include <cchip/geometry.hpp>
#include <cstdint>
#include <stdexcept>

namespace cchip {

/// Grid step and origin: a point p lies at round(p / 2^exponent) - origin.
struct LocalGrid {
  int exponent = 0;
  std::array<std::int64_t, 3> origin = {0, 0, 0};
};

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

/// Places both primitives on the finest grid on which the pair's box fits into signed `coord_w` bits.
/// If every coordinate is a whole number of steps on a grid that holds the box, eta = 0 and nothing
/// is rounded; otherwise every vertex is rounded to nearest and eta = 1.
/// \throws GridError
QuantisedPair quantise(const Primitive& a, const Primitive& b, int coord_w);

}  // namespace cchip

#endif
