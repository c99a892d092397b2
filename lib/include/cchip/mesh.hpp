// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes of triangles and quads, moved by poses; candidate pairs of faces.
#ifndef CCHIP_MESH_HPP
#define CCHIP_MESH_HPP

#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>
#include <cstddef>
#include <cstdint>
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
  /// Faces of the file or the array that were cut into triangles.
  std::size_t polygons_cut = 0;
  /// For each face, the number of the file's or the array's face that it is or was cut from; empty if none was cut.
  std::vector<std::uint32_t> file_face;
  /// Number in the file of face `face`, less than faces.size().
  std::uint32_t number_in_file(std::uint32_t face) const { return file_face.empty() ? face : file_face[face]; }
  /// What load_mesh() left out, a line each; empty if that is nothing but points, lines and unused vertices.
  std::vector<std::string> notes;
  /// Face number `face` (less than faces.size()) with its vertex positions.
  Primitive primitive(std::size_t face) const;
};

/// Checks that faces are what primitive() takes.
/// \throws std::invalid_argument a face is neither triangle nor quad or has a vertex index beyond the vertices, or
///         file_face is neither empty nor as long as `faces`; one line with the number of the face
void check_faces(const Mesh& mesh);

/// Numbers of vertices, a row for each face.
using FaceMatrix = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic>;
/// Mesh from matrices.
/// \param vertices n x 3: x, y, z of each, in length units
/// \param faces m x 3 for triangles or m x 4 for quads: numbers of vertices, from 0. A quad whose outline has a dent or
/// a
///        spike is cut into triangles, as load_mesh() does
/// \throws std::invalid_argument another number of columns, or a number below 0 or beyond the vertices; one line with
///         the row. Object refuses what else makes no sense, such as NaN.
Mesh make_mesh(const Eigen::Ref<const Eigen::MatrixXd>& vertices, const FaceMatrix& faces);
/// The same with any other integers, such as Eigen::MatrixXi of libigl.
template <class Faces>
Mesh make_mesh(const Eigen::Ref<const Eigen::MatrixXd>& vertices, const Eigen::MatrixBase<Faces>& faces) {
  static_assert(Eigen::NumTraits<typename Faces::Scalar>::IsInteger, "faces are numbers of vertices");
  return make_mesh(vertices, FaceMatrix(faces.template cast<std::int64_t>()));
}
/// The same from arrays, row by row: 3 doubles a vertex, `corners` numbers a face, 3 for triangles or 4 for quads.
/// \throws std::invalid_argument as above, and a null pointer to more than nothing
Mesh make_mesh(const double* vertices, std::size_t vertex_count, const std::uint32_t* faces, std::size_t face_count,
               std::size_t corners = 3);

/// Mesh whose vertices are moved by the pose, rounded.
Mesh transformed(const Mesh& mesh, const Pose& pose);

/// Numbers of a face of A and a face of B.
struct CandidatePair {
  std::uint32_t face_a;
  std::uint32_t face_b;
};

/// Calls `visit` for every pair of faces whose closed axis-aligned boxes overlap: sort and sweep
/// along x, each pair once. The order depends on the meshes only. Memory is linear in the number of faces.
/// \throws std::invalid_argument check_faces() refuses one of them
void sweep_box_pairs(const Mesh& a, const Mesh& b, const std::function<void(CandidatePair)>& visit);

}  // namespace cchip

#endif
