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

/// Triangles (later also quads) as vertex positions and index tuples.
struct Mesh {
  std::string name;
  std::vector<Vec3d> vertices;
  struct Face {
    Kind kind = Kind::tri;
    std::array<std::uint32_t, 4> vertex = {0, 0, 0, 0};
  };
  std::vector<Face> faces;
  Primitive primitive(std::size_t face) const;
};

/// Reads OBJ, STL, PLY or OFF (and what else assimp reads); all sub-meshes and node transforms
/// applied, polygons triangulated, points and lines dropped.
/// \throws std::runtime_error one line: file, what is wrong, what to do (missing file, parse error, no faces, non-finite vertex).
Mesh load_mesh(const std::string& path);

/// Torus around the z axis: `around` x `across` quads, each cut into two triangles.
Mesh make_torus(double major_radius, double minor_radius, int around, int across);
/// Spur gear around the z axis with a bore: closed triangle surface; every tooth has `steps`
/// subdivisions of flank, so triangle count grows with teeth, steps and layers.
Mesh make_gear(double root_radius, double tip_radius, double bore_radius, double thickness, int teeth, int layers);

/// Mesh moved by a rigid transform.
Mesh transformed(const Mesh& mesh, const Eigen::Isometry3d& pose);

struct CandidatePair {
  std::uint32_t face_a;
  std::uint32_t face_b;
};

/// Calls `visit` for every pair of faces whose closed axis-aligned boxes overlap: sort and sweep
/// along x. Order is deterministic. Memory is linear in the number of faces.
void sweep_box_pairs(const Mesh& a, const Mesh& b, const std::function<void(CandidatePair)>& visit);

}  // namespace cchip

#endif
