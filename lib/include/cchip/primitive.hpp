// SPDX-License-Identifier: Apache-2.0
/// \file
/// Primitives in space, in doubles.
#ifndef CCHIP_PRIMITIVE_HPP
#define CCHIP_PRIMITIVE_HPP

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

namespace cchip {

/// Point or direction in the caller's length unit.
using Vec3d = Eigen::Vector3d;

/// Kind of a primitive; the value is its number of vertices.
enum class Kind : std::uint8_t { tri = 3, quad = 4 };

/// A triangle or quad in the caller's coordinates; the closed hull of its vertices.
/// `v[3]` of a triangle is unused.
struct Primitive {
  Kind kind = Kind::tri;
  std::array<Vec3d, 4> v = {Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero()};
  std::size_t vertex_count() const { return static_cast<std::size_t>(kind); }
};

}  // namespace cchip

#endif
