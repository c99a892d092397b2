// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/mesh_file.hpp>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace cchip {
namespace {

void put(std::ostream& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.put(static_cast<char>(value >> 8 * i));
}

void put(std::ostream& out, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put(out, bits, 8);
}

void put(std::ostream& out, const Colour& colour) {
  for (const std::uint8_t c : colour) put(out, c, 1);
}

/// One fewer than points, or as many if the last point is joined to the first.
std::size_t edges_of(const PlyCurve& curve) {
  const std::size_t count = curve.points.size();
  return count < 2 ? 0 : curve.closed ? count : count - 1;
}

/// The corners of each face, as numbers in its outline.
using Corners = std::vector<std::uint8_t>;

/// Quads are cut in two unless all faces are quads: some programs read one length of list only.
std::vector<Corners> pieces_of(const Mesh& mesh, std::size_t face, bool all_quads) {
  if (mesh.faces[face].kind != Kind::quad) return {{0, 1, 2}};
  if (all_quads) return {{0, 1, 2, 3}};
  return {{0, 1, 2}, {0, 2, 3}};
}

void put_point(std::ostream& out, const Vec3d& point, const Colour& colour) {
  for (const double x : point) put(out, x);
  put(out, colour);
}

}  // namespace

void write_ply(std::ostream& out, const Mesh& mesh, const std::vector<Colour>& face_colours,
               const std::vector<PlyCurve>& curves) {
  if (face_colours.size() != mesh.faces.size()) throw std::invalid_argument("write_ply: one colour for each face");
  const auto quads = static_cast<std::size_t>(std::count_if(
      mesh.faces.begin(), mesh.faces.end(), [](const Mesh::Face& face) { return face.kind == Kind::quad; }));
  const bool all_quads = quads == mesh.faces.size();
  std::size_t vertices = 3 * mesh.faces.size() + quads;
  const std::uint64_t first_of_curves = vertices;
  std::size_t edges = 0;
  for (const PlyCurve& curve : curves) {
    vertices += curve.points.size();
    edges += edges_of(curve);
  }
  // as texts, because the stream's locale may group digits
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << std::to_string(vertices)
      << "\nproperty double x\nproperty double y\nproperty double z\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
      << std::to_string(mesh.faces.size() + (all_quads ? 0 : quads)) << "\nproperty list uchar int vertex_indices\n";
  if (edges > 0) {
    out << "element edge " << std::to_string(edges) << "\nproperty int vertex1\nproperty int vertex2\n";
  }
  out << "end_header\n";
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Primitive face = mesh.primitive(i);
    for (std::size_t k = 0; k < face.vertex_count(); ++k) put_point(out, face.v[k], face_colours[i]);
  }
  for (const PlyCurve& curve : curves) {
    for (const Vec3d& point : curve.points) put_point(out, point, curve.colour);
  }
  std::uint64_t vertex = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    for (const Corners& corners : pieces_of(mesh, i, all_quads)) {
      put(out, corners.size(), 1);
      for (const std::uint8_t corner : corners) put(out, vertex + corner, 4);
    }
    vertex += mesh.faces[i].kind == Kind::quad ? 4 : 3;
  }
  std::uint64_t first = first_of_curves;
  for (const PlyCurve& curve : curves) {
    const std::size_t count = curve.points.size();
    for (std::size_t k = 0; k < edges_of(curve); ++k) {
      put(out, first + k, 4);
      put(out, first + (k + 1) % count, 4);
    }
    first += count;
  }
}

}  // namespace cchip
