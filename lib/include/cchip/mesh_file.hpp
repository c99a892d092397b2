// SPDX-License-Identifier: Apache-2.0
/// \file
/// Mesh files.
#ifndef CCHIP_MESH_FILE_HPP
#define CCHIP_MESH_FILE_HPP

#include <array>
#include <cchip/mesh.hpp>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace cchip {

/// What load_mesh() keeps as it is; other polygons are cut into triangles.
enum class FaceKinds {
  triangles,
  /// and quads. One whose outline has a dent or a spike is cut: as a primitive it would be the hull of its vertices.
  triangles_and_quads
};

struct LoadOptions {
  FaceKinds kinds = FaceKinds::triangles;
  /// Faces that cannot be used are left out and not an error: with vertices that are not there or not finite, with
  /// sides that cross. Mesh::notes names the first hundred, with their lines, and says how many there are. A file that
  /// is truncated or no mesh is an error all the same, and so is one without any face that can be used. Lines of an OBJ
  /// that begin with no word of OBJ are left out, too, with a note, but for free-form surfaces.
  bool lenient = false;
  /// Coordinates are rounded to the nearest number of single precision, before faces are cut: parts from programs that
  /// round and from others meet again (docs/cpp/mesh_files.md). One beyond its range is an error.
  bool single_precision = false;
  /// If not null, set to the number of faces that were left out because they cannot be used.
  std::size_t* faces_left_out = nullptr;
  /// Bytes that the content of a packed file may have: a small file may hold one that exhausts the memory.
  std::uint64_t most_unpacked_bytes = std::uint64_t{1} << 32;
};

/// Reads a mesh in the file's order and unit: Wavefront OBJ, Geomview OFF (text), Stanford PLY (text, binary of both
/// byte orders), STL (text, binary). The extension of the name decides the format, or else the beginning of the file.
/// A file packed with gzip is unpacked first, if the library was built with zlib; its name may end with `.gz` besides.
///
/// Positions are doubles: the nearest one of each decimal number; binary STL and PLY's `float` hold single precision.
/// Points, lines and curves are left out. Free-form surfaces, binary OFF and homogeneous coordinates are refused.
/// Polygons of up to 16384 corners are cut into triangles, by the even-odd rule and exactly; sides that cross are an
/// error (docs/cpp/mesh_files.md).
///
/// A truncated or damaged file is refused where this can be detected: counts must match, numbers must be whole words,
/// and vertices must exist. OBJ announces no counts, so a file that lacks whole lines at its end may pass.
/// Memory and time are bounded by multiples of the (unpacked) file's size: counts that the file cannot hold are refused
/// first.
///
/// The readers are our own because none of Debian's passed tests/lib/test_mesh_file.cpp: assimp rounds to single
/// precision and does not terminate on a truncated PLY; CGAL loses corners that tabs separate in OBJ, refuses its `l`
/// lines and takes 1.5 GB for a list in a PLY of 250 bytes.
/// \throws std::runtime_error one line: file, line number if it has one, what is wrong, what to do
Mesh load_mesh(const std::string& path, FaceKinds kinds = FaceKinds::triangles);

Mesh load_mesh(const std::string& path, const LoadOptions& options);

/// The same for the content of a file. `name` stands for its path: its end says the format, and messages begin with it.
Mesh parse_mesh(std::string_view file, const std::string& name, FaceKinds kinds = FaceKinds::triangles);

Mesh parse_mesh(std::string_view file, const std::string& name, const LoadOptions& options);

/// Rounds the vertices as LoadOptions::single_precision does.
/// \throws std::invalid_argument a coordinate is beyond its range; one line with the number of the vertex
void round_to_single(Mesh& mesh);

/// Red, green, blue.
using Colour = std::array<std::uint8_t, 3>;

/// A line through points in their order.
struct PlyCurve {
  std::vector<Vec3d> points;
  bool closed = false;  ///< the last point is joined to the first, which is not repeated
  Colour colour = {};
};

/// Writes a binary PLY (little endian, doubles). Each face has its own vertices, which have its colour. Quads are cut
/// in two if there are triangles, too. The curves follow as edges between vertices of their own, behind those of the
/// faces; without any the file has no edges. `scripts/run test-ply` reads such files with other programs
/// (docs/cpp/mesh_files.md).
/// \throws std::invalid_argument unless there is one colour for each face
void write_ply(std::ostream& out, const Mesh& mesh, const std::vector<Colour>& face_colours,
               const std::vector<PlyCurve>& curves = {});

}  // namespace cchip

#endif
