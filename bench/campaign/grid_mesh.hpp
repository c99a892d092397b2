// SPDX-License-Identifier: Apache-2.0
/// \file
/// Primitives of the grid as a mesh.
#ifndef CCHIP_CAMPAIGN_GRID_MESH_HPP
#define CCHIP_CAMPAIGN_GRID_MESH_HPP

#include <cchip/internal/wire/pair.hpp>
#include <cchip/mesh.hpp>
#include <cmath>
#include <vector>

namespace cchip::campaign {

/// A face for each primitive, no vertex shared; a step of the grid is 2^exponent.
inline Mesh mesh_of(const std::vector<GridPrimitive>& primitives, int exponent = 0) {
  Mesh mesh;
  for (const GridPrimitive& primitive : primitives) {
    Mesh::Face face;
    face.kind = primitive.kind;
    for (std::size_t k = 0; k < primitive.vertex_count(); ++k) {
      face.vertex[k] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(
          primitive.v[k].cast<double>().unaryExpr([exponent](double x) { return std::ldexp(x, exponent); }));
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

}  // namespace cchip::campaign

#endif
