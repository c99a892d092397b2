// SPDX-License-Identifier: Apache-2.0
/// \file
/// Polygons cut into triangles.
#ifndef CCHIP_SRC_MESH_IO_CUT_POLYGON_HPP
#define CCHIP_SRC_MESH_IO_CUT_POLYGON_HPP

#include <array>
#include <cchip/geometry/primitive.hpp>
#include <cstddef>
#include <vector>

namespace cchip::mesh_io {

/// Most corners that cut_polygon() takes; its time grows with their cube in the worst case.
constexpr std::size_t most_corners = 1024;

/// True if no corner of the outline turns against the quad's normal (V2 - V0) x (V3 - V1).
bool is_convex_quad(const std::array<Vec3d, 4>& quad);

/// Cuts a polygon with n corners, 4 to most_corners, into n - 2 triangles of its corners: the ears of its projection
/// along the axis that sees most of its area, found with exact arithmetic. Corners on a straight line make triangles
/// without area, so no corner is lost. A polygon without area becomes a fan. Polygons that touch themselves are cut.
/// Returns nothing if the outline crosses itself so that no ear is left (not every such outline is noticed).
/// Method: D. H. Eberly, "Triangulation by Ear Clipping" (Geometric Tools).
std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<Vec3d>& polygon);

}  // namespace cchip::mesh_io

#endif
