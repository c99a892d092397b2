// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/mesh.hpp>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "cut_polygon.hpp"

namespace cchip {
namespace {

struct Box {
  Vec3d least;
  Vec3d greatest;
};

std::vector<Box> face_boxes(const Mesh& mesh) {
  std::vector<Box> boxes(mesh.faces.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Primitive p = mesh.primitive(i);
    boxes[i] = {p.v[0], p.v[0]};
    for (std::size_t k = 1; k < p.vertex_count(); ++k) {
      boxes[i].least = boxes[i].least.cwiseMin(p.v[k]);
      boxes[i].greatest = boxes[i].greatest.cwiseMax(p.v[k]);
    }
  }
  return boxes;
}

bool overlap(const Box& p, const Box& q) {
  return (p.least.array() <= q.greatest.array()).all() && (q.least.array() <= p.greatest.array()).all();
}

/// Faces of one mesh in the order in which a sweep along x meets them, and those that it is in now.
class Sweep {
 public:
  explicit Sweep(const Mesh& mesh) : boxes_(face_boxes(mesh)), order_(boxes_.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
    std::stable_sort(order_.begin(), order_.end(),
                     [this](std::uint32_t i, std::uint32_t j) { return boxes_[i].least.x() < boxes_[j].least.x(); });
  }
  bool done() const { return next_ == order_.size(); }
  /// Where the next face begins; there must be one.
  double next_x() const { return boxes_[order_[next_]].least.x(); }
  /// Enters the next face and returns its number.
  std::uint32_t enter() {
    active_.push_back(order_[next_]);
    return order_[next_++];
  }
  /// Leaves the faces that end before x and calls `visit` for those whose box overlaps the given one.
  template <class Visit>
  void meet(const Box& box, const Visit& visit) {
    const auto is_behind = [&](std::uint32_t i) { return boxes_[i].greatest.x() < box.least.x(); };
    active_.erase(std::remove_if(active_.begin(), active_.end(), is_behind), active_.end());
    for (const std::uint32_t i : active_) {
      if (overlap(boxes_[i], box)) visit(i);
    }
  }
  const Box& box(std::uint32_t face) const { return boxes_[face]; }

 private:
  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> active_;
  std::size_t next_ = 0;
};

/// Adds row `number` of an array; a quad with a dent becomes triangles.
void add_row(Mesh& mesh, const Mesh::Face& face, std::uint32_t number) {
  std::array<Vec3d, 4> quad;
  for (std::size_t k = 0; k < 4; ++k) quad[k] = mesh.vertices[face.vertex[k]];
  const auto is_finite = [](const Vec3d& v) { return v.allFinite(); };  // Object refuses others
  if (face.kind != Kind::quad || !std::all_of(quad.begin(), quad.end(), is_finite) || outline::hull_order(quad)) {
    mesh.faces.push_back(face);
    mesh.file_face.push_back(number);
    return;
  }
  ++mesh.polygons_cut;
  for (const auto& triangle : outline::cut_polygon({quad.begin(), quad.end()}).triangles) {
    Mesh::Face part;
    for (std::size_t k = 0; k < 3; ++k) part.vertex[k] = face.vertex[triangle[k]];
    mesh.faces.push_back(part);
    mesh.file_face.push_back(number);
  }
}

}  // namespace

Primitive Mesh::primitive(std::size_t face) const {
  Primitive p;
  p.kind = faces[face].kind;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] = vertices[faces[face].vertex[i]];
  return p;
}

void check_faces(const Mesh& mesh) {
  const auto refuse = [](std::size_t face, const std::string& what) {
    throw std::invalid_argument("face " + std::to_string(face) + ": " + what);
  };
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Mesh::Face& face = mesh.faces[i];
    if (face.kind != Kind::tri && face.kind != Kind::quad) {
      refuse(i, "its kind is " + std::to_string(static_cast<int>(face.kind)) + ", neither triangle (3) nor quad (4)");
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
      if (face.vertex[k] < mesh.vertices.size()) continue;
      refuse(i, "vertex index " + std::to_string(face.vertex[k]) + " is out of range (the mesh has " +
                    std::to_string(mesh.vertices.size()) + " vertices)");
    }
  }
  if (!mesh.file_face.empty() && mesh.file_face.size() != mesh.faces.size()) {
    refuse(std::min(mesh.file_face.size(), mesh.faces.size()),
           "file_face has " + std::to_string(mesh.file_face.size()) + " entries for " +
               std::to_string(mesh.faces.size()) + " faces; give one for each face or none");
  }
}

Mesh make_mesh(const Eigen::Ref<const Eigen::MatrixXd>& vertices, const FaceMatrix& faces) {
  if (vertices.cols() != 3) {
    throw std::invalid_argument("vertices have " + std::to_string(vertices.cols()) +
                                " columns; give three, x, y and z, a row for each vertex");
  }
  if (faces.cols() != 3 && faces.cols() != 4) {
    throw std::invalid_argument("faces have " + std::to_string(faces.cols()) +
                                " columns; give three for triangles or four for quads, a row for each face");
  }
  Mesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(vertices.rows()));
  for (Eigen::Index i = 0; i < vertices.rows(); ++i) mesh.vertices.emplace_back(vertices.row(i).transpose());
  mesh.faces.reserve(static_cast<std::size_t>(faces.rows()));
  for (Eigen::Index i = 0; i < faces.rows(); ++i) {
    Mesh::Face face;
    face.kind = faces.cols() == 4 ? Kind::quad : Kind::tri;
    for (Eigen::Index k = 0; k < faces.cols(); ++k) {
      if (faces(i, k) < 0 || faces(i, k) >= vertices.rows()) {
        throw std::invalid_argument("face " + std::to_string(i) + ": vertex index " + std::to_string(faces(i, k)) +
                                    " is out of range (there are " + std::to_string(vertices.rows()) +
                                    " vertices, from 0)");
      }
      face.vertex[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(faces(i, k));
    }
    add_row(mesh, face, static_cast<std::uint32_t>(i));
  }
  if (mesh.polygons_cut == 0) mesh.file_face.clear();
  return mesh;
}

Mesh make_mesh(const double* vertices, std::size_t vertex_count, const std::uint32_t* faces, std::size_t face_count,
               std::size_t corners) {
  const auto check = [](const void* pointer, std::size_t count, const char* what) {
    if (pointer != nullptr || count == 0) return;
    throw std::invalid_argument(std::string(what) + " are a null pointer; point it to the first one");
  };
  check(vertices, vertex_count, "vertices");
  check(faces, face_count, "faces");
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  using Indices = Eigen::Matrix<std::uint32_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto index = [](std::size_t count) { return static_cast<Eigen::Index>(count); };
  return make_mesh(Eigen::Map<const Rows>(vertices, index(vertex_count), 3),
                   Eigen::Map<const Indices>(faces, index(face_count), index(corners)));
}

Mesh transformed(const Mesh& mesh, const Pose& pose) {
  Mesh result = mesh;
  for (Vec3d& p : result.vertices) p = pose * p;
  return result;
}

void sweep_box_pairs(const Mesh& a, const Mesh& b, const std::function<void(CandidatePair)>& visit) {
  check_faces(a);
  check_faces(b);
  Sweep sweep_a(a);
  Sweep sweep_b(b);
  while (!sweep_a.done() || !sweep_b.done()) {
    if (sweep_b.done() || (!sweep_a.done() && sweep_a.next_x() <= sweep_b.next_x())) {
      const std::uint32_t i = sweep_a.enter();
      sweep_b.meet(sweep_a.box(i), [&](std::uint32_t j) { visit({i, j}); });
    } else {
      const std::uint32_t j = sweep_b.enter();
      sweep_a.meet(sweep_b.box(j), [&](std::uint32_t i) { visit({i, j}); });
    }
  }
}

}  // namespace cchip
