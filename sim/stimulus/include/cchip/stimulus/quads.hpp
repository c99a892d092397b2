// SPDX-License-Identifier: Apache-2.0
/// \file
/// Quads on the grid: flat or warped.
#ifndef CCHIP_STIMULUS_QUADS_HPP
#define CCHIP_STIMULUS_QUADS_HPP

#include <Eigen/Geometry>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>
#include <cstdint>

namespace cchip::stimulus {

/// True for a quad whose vertices are not in one plane. |det| <= 4 (2^20 - 1)^3 fits.
inline bool is_warped(const GridPrimitive& p) {
  using Vec3l = Eigen::Matrix<std::int64_t, 3, 1>;
  const auto edge = [&p](std::size_t to) { return Vec3l((p.v[to] - p.v[0]).cast<std::int64_t>()); };
  return p.kind == Kind::quad && edge(1).cross(edge(2)).dot(edge(3)) != 0;
}

}  // namespace cchip::stimulus

#endif
