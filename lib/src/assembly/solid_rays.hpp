// SPDX-License-Identifier: Apache-2.0
/// \file
/// On which side of a closed mesh is a point? By rays, in integers; shares no code with solids().
#ifndef CCHIP_ASSEMBLY_SOLID_RAYS_HPP
#define CCHIP_ASSEMBLY_SOLID_RAYS_HPP

#include <cchip/internal/certificate/exact_points.hpp>
#include <cchip/mesh.hpp>
#include <vector>

#include "solid_points.hpp"

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

}  // namespace cchip::assembly

#endif
