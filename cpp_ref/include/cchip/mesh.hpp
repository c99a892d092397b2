// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes: files (assimp), procedural shapes, poses, candidate pairs.
#ifndef CCHIP_MESH_HPP
#define CCHIP_MESH_HPP

#include <Eigen/Geometry>
#include <cchip/geometry.hpp>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace cchip {

/// Faces as tuples of indices into the vertex positions.
struct Mesh {
  std::string name;  ///< path of the file, or name of the shape
  std::vector<Vec3d> vertices;
  struct Face {
    Kind kind = Kind::tri;
    std::array<std::uint32_t, 4> vertex = {0, 0, 0, 0};
  };
  std::vector<Face> faces;
  /// Faces of the file that load_mesh() cut into triangles.
  std::size_t polygons_cut = 0;
  /// Face number `face` (less than faces.size()) with its vertex positions.
  Primitive primitive(std::size_t face) const;
};

/// What load_mesh() keeps as it is; other polygons are cut into triangles.
enum class FaceKinds {
  triangles,
  /// and convex quads. A quad whose outline has a dent is cut: as a primitive it would be the hull of its vertices.
  triangles_and_quads
};

/// Reads OBJ, STL, PLY or OFF (and what else assimp reads): all sub-meshes with the transforms of their nodes,
/// points and lines dropped, in the order of the file. Positions are in the file's unit, as assimp holds them:
/// rounded to single precision.
/// \throws std::runtime_error one line: file, what is wrong, what to do (missing file, parse error, no faces,
///         vertex that is not finite, face with unknown vertices)
Mesh load_mesh(const std::string& path, FaceKinds kinds = FaceKinds::triangles);

/// Torus around the z axis, closed, fronts outside: `around` x `across` quads, or twice as many triangles.
/// \throws std::invalid_argument unless major_radius > minor_radius > 0, around >= 3, across >= 3
Mesh make_torus(double major_radius, double minor_radius, int around, int across, Kind kind = Kind::tri);
/// Spur gear around the z axis from z = -thickness / 2 to thickness / 2, closed, fronts outside. The outline has
/// four points per tooth; walls have `layers` bands: 16 teeth (layers + 1) triangles with a bore, so 24 teeth in
/// 6 layers make 2,688; 8 teeth (layers + 1) with bore_radius 0, which makes no bore.
/// \throws std::invalid_argument unless tip > root > bore >= 0, thickness > 0, teeth >= 3, layers >= 1
Mesh make_gear(double root_radius, double tip_radius, double bore_radius, double thickness, int teeth, int layers);

/// Mesh moved by a rigid transform.
Mesh transformed(const Mesh& mesh, const Eigen::Isometry3d& pose);

/// Numbers of a face of A and a face of B.
struct CandidatePair {
  std::uint32_t face_a;
  std::uint32_t face_b;
};

/// Calls `visit` for every pair of faces whose closed axis-aligned boxes overlap: sort and sweep
/// along x, each pair once. The order depends on the meshes only. Memory is linear in the number of faces.
void sweep_box_pairs(const Mesh& a, const Mesh& b, const std::function<void(CandidatePair)>& visit);

}  // namespace cchip

#endif
