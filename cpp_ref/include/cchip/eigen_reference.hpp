// SPDX-License-Identifier: Apache-2.0
/// \file
/// The Eigen floating-point reference: plain separating axis test over every axis.
#ifndef CCHIP_EIGEN_REFERENCE_HPP
#define CCHIP_EIGEN_REFERENCE_HPP

#include <cchip/geometry.hpp>

namespace cchip {

/// True if the closed primitives of the pair share a point. Brute force over a complete axis set,
/// intervals of all vertices, no early end. Floating-point, yet exact: `double` for coord_w <= 17,
/// `long double` above (DESIGN: |projection| < 2^(3W+2)).
bool eigen_intersects(const GridPair& pair, int coord_w);

}  // namespace cchip

#endif
