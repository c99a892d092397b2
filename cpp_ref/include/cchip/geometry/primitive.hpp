// SPDX-License-Identifier: Apache-2.0
/// \file
/// Primitives in space (doubles), and what the vertices of primitives on the grid have in common.
#ifndef CCHIP_GEOMETRY_PRIMITIVE_HPP
#define CCHIP_GEOMETRY_PRIMITIVE_HPP

#include <Eigen/Core>
#include <array>
#include <cchip/wire/pair.hpp>
#include <cstddef>

namespace cchip {

/// Point or direction in the caller's length unit.
using Vec3d = Eigen::Vector3d;

/// A triangle or quad in the caller's coordinates; the closed hull of its vertices.
/// `v[3]` of a triangle is unused.
struct Primitive {
  Kind kind = Kind::tri;
  std::array<Vec3d, 4> v = {Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero()};
  std::size_t vertex_count() const { return static_cast<std::size_t>(kind); }
};

/// True if the vertices span no plane: all on one line, or one point.
/// Exact for coordinates of up to defs::coord_w_max bits, like is_coplanar().
bool is_degenerate(const GridPrimitive& p);
/// True if some plane holds all vertices of both primitives. Degenerate primitives count like others: two
/// segments are coplanar unless their lines are skew, and a point is coplanar with every segment and point.
bool is_coplanar(const GridPair& pair);

}  // namespace cchip

#endif
