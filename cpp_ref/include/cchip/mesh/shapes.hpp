// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes made by formula: closed surfaces, fronts outside.
#ifndef CCHIP_MESH_SHAPES_HPP
#define CCHIP_MESH_SHAPES_HPP

#include <cchip/mesh/mesh.hpp>
#include <cstdint>

namespace cchip {

/// Torus around the z axis, closed, fronts outside: `around` x `across` quads, or twice as many triangles.
/// \throws std::invalid_argument unless major_radius > minor_radius > 0, around >= 3, across >= 3
Mesh make_torus(double major_radius, double minor_radius, int around, int across, Kind kind = Kind::tri);
/// Spur gear around the z axis from z = -thickness / 2 to thickness / 2, closed, fronts outside. The outline has
/// four points per tooth; walls have `layers` bands: 16 teeth (layers + 1) triangles with a bore, so 24 teeth in
/// 6 layers make 2,688; 8 teeth (layers + 1) with bore_radius 0, which makes no bore.
/// \throws std::invalid_argument unless tip > root > bore >= 0, thickness > 0, teeth >= 3, layers >= 1
Mesh make_gear(double root_radius, double tip_radius, double bore_radius, double thickness, int teeth, int layers);
/// Sphere around the origin, closed, fronts outside: an icosahedron with each edge cut into `cuts` parts, 20 cuts^2
/// triangles. Each vertex lies at radius (1 + noise u), u uniform in -1..1 by the seed; the same on every machine up to
/// the rounding of its square root.
/// \throws std::invalid_argument unless radius > 0, 1 <= cuts <= 1000, 0 <= noise < 1
Mesh make_sphere(double radius, int cuts, double noise = 0, std::uint64_t seed = 1);

}  // namespace cchip

#endif
