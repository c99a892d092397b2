// SPDX-License-Identifier: Apache-2.0
/// \file
/// The separating axis test as the paper states it, on 64-bit integers; for the functional modules.
#ifndef CCHIP_LEVELS_EXACT_SAT_HPP
#define CCHIP_LEVELS_EXACT_SAT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cchip::levels {

/// A point, an edge or an axis; grid steps to the power 1, 1, 2.
using Integers = std::array<std::int64_t, 3>;

/// A primitive with all axes that it alone determines.
struct SatPrimitive {
  std::vector<Integers> vertices;
  std::vector<Integers> edges;  ///< between any two vertices: 3 of a triangle, 6 of a quad
  std::vector<Integers>
      normals;  ///< of any three vertices: 1 of a triangle, 4 of a quad, whose hull may be a tetrahedron
};

/// \param vertices 3 or 4, each coordinate of 16 signed bits, so that projections have 52
SatPrimitive make_sat_primitive(std::vector<Integers> vertices);

/// True if the closed hulls share a point. The axes are nA, nB and C_kl of equation (1); for coplanar and degenerate
/// primitives, where these may all be zero or parallel, e x u as well, u a unit vector, and u itself.
bool sat_intersects(const SatPrimitive& a, const SatPrimitive& b);

/// True if a point of the triangle is no farther than `radius` from the centre. The axes are those to the three
/// vertices, those perpendicular to the three sides, and the triangle's normal.
/// \param triangle three vertices of 16 signed bits, as the centre; it may be degenerate
/// \param radius 0..2^16 - 1, grid steps
bool sphere_intersects(const Integers& centre, std::int64_t radius, std::vector<Integers> triangle);

}  // namespace cchip::levels

#endif
