// SPDX-License-Identifier: Apache-2.0
/// \file
/// On which side of a closed mesh is a point? By rays, in integers; shares no code with solids().
#ifndef CCHIP_ASSEMBLY_SOLID_RAYS_HPP
#define CCHIP_ASSEMBLY_SOLID_RAYS_HPP

#include <cchip/assembly.hpp>
#include <cchip/internal/certificate/exact_points.hpp>
#include <cstdint>
#include <vector>

namespace cchip::assembly {

struct PointSide {
  bool is_known = false;  ///< false: on the surface, or all rays met an edge
  bool is_odd = false;    ///< inside by InsideRule::odd
  bool winds = false;     ///< inside by InsideRule::nonzero
  bool is_outside() const { return is_known && !is_odd && !winds; }
};
/// \param points of the vertices of the mesh, as exact as `at`
PointSide side_of(const certificate_check::Point& at, const Mesh& mesh,
                  const std::vector<certificate_check::Point>& points);

/// The number of a vertex of each piece of a mesh; pieces hang together by vertices in the same place.
std::vector<std::uint32_t> vertex_of_each_piece(const Mesh& mesh);

/// Is the point, of the world, inside both parts, by the same rule?
bool is_common_point(const Vec3d& point, const AssemblyPart& a, const AssemblyPart& b);

}  // namespace cchip::assembly

#endif
