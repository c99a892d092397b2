// SPDX-License-Identifier: Apache-2.0
#include <cchip/mesh_io/mesh_file.hpp>
#include <cstring>
#include <stdexcept>

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

}  // namespace

void write_ply(std::ostream& out, const Mesh& mesh, const std::vector<Colour>& face_colours,
               const std::vector<PlyCurve>& curves) {
  if (face_colours.size() != mesh.faces.size()) throw std::invalid_argument("write_ply: one colour for each face");
  std::size_t vertices = 0;
  for (const Mesh::Face& face : mesh.faces) vertices += face.kind == Kind::quad ? 4 : 3;
  const std::uint64_t first_of_curves = vertices;
  std::size_t edges = 0;
  for (const PlyCurve& curve : curves) {
    vertices += curve.points.size();
    edges += edges_of(curve);
  }
  const char* const colour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  // as texts, because the stream's locale may group digits
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << std::to_string(vertices)
      << "\nproperty double x\nproperty double y\nproperty double z\n"
      << colour << "element face " << std::to_string(mesh.faces.size()) << "\nproperty list uchar uint vertex_indices\n"
      << colour;
  if (edges > 0) {
    out << "element edge " << std::to_string(edges) << "\nproperty uint vertex1\nproperty uint vertex2\n" << colour;
  }
  out << "end_header\n";
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Primitive face = mesh.primitive(i);
    for (std::size_t k = 0; k < face.vertex_count(); ++k) {
      for (const double x : face.v[k]) put(out, x);
      put(out, face_colours[i]);
    }
  }
  for (const PlyCurve& curve : curves) {
    for (const Vec3d& point : curve.points) {
      for (const double x : point) put(out, x);
      put(out, curve.colour);
    }
  }
  std::uint64_t vertex = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const std::size_t corners = mesh.faces[i].kind == Kind::quad ? 4 : 3;
    put(out, corners, 1);
    for (std::size_t k = 0; k < corners; ++k) put(out, vertex++, 4);
    put(out, face_colours[i]);
  }
  std::uint64_t first = first_of_curves;
  for (const PlyCurve& curve : curves) {
    const std::size_t count = curve.points.size();
    for (std::size_t k = 0; k < edges_of(curve); ++k) {
      put(out, first + k, 4);
      put(out, first + (k + 1) % count, 4);
      put(out, curve.colour);
    }
    first += count;
  }
}

}  // namespace cchip
