// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes of a command, and pictures of them.
#ifndef CCHIP_APP_MESH_SOURCE_HPP
#define CCHIP_APP_MESH_SOURCE_HPP

#include <cchip/mesh.hpp>
#include <cchip/mesh_file.hpp>
#include <cchip/object.hpp>
#include <cchip/program/output_file.hpp>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "cli.hpp"

namespace cchip::app {

/// Reads the meshes of a command.
class MeshReader {
 public:
  /// \param lenient faces that cannot be used are left out, with a line on `err` for each
  /// \param single coordinates are rounded to single precision
  MeshReader(const Streams& streams, bool lenient, bool single)
      : streams_(streams), lenient_(lenient), single_(single) {}
  /// Triangles and quads of a file, "-": of standard input; a line on `err` if other faces had to be cut.
  /// \throws UsageError the file is missing, broken or has no faces
  Mesh read(const std::string& path);
  /// The same, ready for queries.
  /// \throws UsageError as read()
  Object read_object(const std::string& path);
  /// Of all meshes so far.
  std::uint64_t faces_left_out() const { return faces_left_out_; }
  bool lenient() const { return lenient_; }

 private:
  const Streams& streams_;
  bool lenient_;
  bool single_;
  std::uint64_t faces_left_out_ = 0;
};

/// All that is left in a stream.
std::string read_all(std::istream& in);

/// \throws UsageError two of the paths are "-"
void check_standard_input(const std::vector<std::string>& paths);

/// Accepts an empty path, which stands for no picture, and names without an extension, such as those of pipes.
/// \throws UsageError the name of a picture has another extension than .ply
void check_picture_name(const std::string& path);

/// Columns of the pairs of faces: the face numbers, counted from 0.
const std::vector<std::string>& mesh_pair_names();

/// A PLY of both meshes: faces of A that hit are orange, those of B blue, all others light grey.
class HitPicture {
 public:
  /// The file appears when it is complete, see sim::OutputFile.
  /// \throws sim::OutputError it cannot be written
  explicit HitPicture(const std::string& path) : file_(path) {}
  /// Marks a face that hits, by its number in the mesh; those that only touch get a colour of their own.
  void add_hit_a(std::size_t face, bool crosses) { (crosses ? hits_a_ : touches_a_).insert(face); }
  void add_hit_b(std::size_t face, bool crosses) { (crosses ? hits_b_ : touches_b_).insert(face); }
  /// A black line, where the surfaces cross.
  void add_curve(const std::vector<Vec3d>& points, bool closed);
  /// \throws sim::OutputError as above
  void write(const Mesh& a, const Mesh& b);

 private:
  sim::OutputFile file_;
  std::set<std::size_t> hits_a_;
  std::set<std::size_t> hits_b_;
  std::set<std::size_t> touches_a_;
  std::set<std::size_t> touches_b_;
  std::vector<PlyCurve> curves_;
};

}  // namespace cchip::app

#endif
