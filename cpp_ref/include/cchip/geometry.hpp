// SPDX-License-Identifier: Apache-2.0
/// \file
/// Primitives in space (doubles) and on the local grid (integers).
#ifndef CCHIP_GEOMETRY_HPP
#define CCHIP_GEOMETRY_HPP

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

namespace cchip {

/// Point or direction in the caller's length unit.
using Vec3d = Eigen::Vector3d;
/// Point or direction in grid steps.
using Vec3i = Eigen::Matrix<std::int32_t, 3, 1>;

/// Kind of a primitive; the value is its number of vertices.
enum class Kind : std::uint8_t { tri = 3, quad = 4 };

/// A triangle or quad in the caller's coordinates; the closed hull of its vertices.
/// `v[3]` of a triangle is unused.
struct Primitive {
  Kind kind = Kind::tri;
  std::array<Vec3d, 4> v = {Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero()};
  std::size_t vertex_count() const { return static_cast<std::size_t>(kind); }
};

/// A primitive on the local grid of its pair, in grid steps.
struct GridPrimitive {
  Kind kind = Kind::tri;
  std::array<Vec3i, 4> v = {Vec3i::Zero(), Vec3i::Zero(), Vec3i::Zero(), Vec3i::Zero()};
  std::size_t vertex_count() const { return static_cast<std::size_t>(kind); }
};

/// Two primitives on one local grid, as they go through the stream `s_pair` of a primitive test.
struct GridPair {
  GridPrimitive a;
  GridPrimitive b;
  /// eta, `s_pair_err`: upper bound, in whole grid steps and infinity norm, on the error of the
  /// difference of any two vertices. 0 = exact input, 15 = unknown.
  int eta = 0;
};

/// True if the vertices span no plane: all on one line, or one point.
/// Exact for coordinates of up to defs::coord_w_max bits, like is_coplanar().
bool is_degenerate(const GridPrimitive& p);
/// True if some plane holds all vertices of both primitives. Degenerate primitives count like others: two
/// segments are coplanar unless their lines are skew, and a point is coplanar with every segment and point.
bool is_coplanar(const GridPair& pair);

}  // namespace cchip

#endif
