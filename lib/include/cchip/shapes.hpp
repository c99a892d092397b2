// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes made by formula: closed surfaces, fronts outside.
#ifndef CCHIP_SHAPES_HPP
#define CCHIP_SHAPES_HPP

#include <cchip/mesh.hpp>
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
/// Body like a scanned figure: make_sphere(1, cuts), each vertex v moved to v exp(relief w(v)). w is a sum of waves in
/// random directions by the seed, from a few bumps around the body to folds of a few faces; |w| is mostly below 1. The
/// same on every machine up to the rounding of sin and exp. It has no self-intersections.
/// \throws std::invalid_argument unless 1 <= cuts <= 1000, 0 <= relief <= 1
Mesh make_body(int cuts, double relief, std::uint64_t seed = 1);
/// Each triangle and each quad cut into four at the middles of its edges, and a quad at the mean of its vertices: the
/// same surface if the quads are flat. Faces that share both vertices of an edge share its middle.
Mesh subdivided(const Mesh& mesh);
/// The mesh moved and scaled so that its bounding box is around the origin and has a diagonal of 1. One vertex at least
/// is needed; a mesh in a point is only moved.
Mesh normalised(Mesh mesh);

}  // namespace cchip

#endif
