// SPDX-License-Identifier: Apache-2.0
/// \file
/// Mesh files.
#ifndef CCHIP_MESH_IO_MESH_FILE_HPP
#define CCHIP_MESH_IO_MESH_FILE_HPP

#include <cchip/mesh/mesh.hpp>
#include <string>

namespace cchip {

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

}  // namespace cchip

#endif
