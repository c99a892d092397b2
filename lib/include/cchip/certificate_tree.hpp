// SPDX-License-Identifier: Apache-2.0
/// \file
/// Trees that certificates cite (docs/cpp/certificates.md): the faces of a mesh in an order, halved again and again,
/// and the boxes of these sets. A checker trusts nothing of it but the mesh: it makes the boxes itself.
#ifndef CCHIP_CERTIFICATE_TREE_HPP
#define CCHIP_CERTIFICATE_TREE_HPP

#include <algorithm>
#include <array>
#include <cchip/certificate.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace cchip {

/// The greatest power of two that divides all numbers that were added; 1 if these are 0.
class PowerOfTwo {
 public:
  /// \pre x is finite
  void add(double x) {
    if (x == 0) return;
    int exponent = 0;
    auto m = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
    exponent -= 53;
    if (any_ && exponent >= exponent_) return;
    for (; m % 2 == 0; m /= 2) ++exponent;
    exponent_ = any_ ? std::min(exponent, exponent_) : exponent;
    any_ = true;
  }
  void add(const PowerOfTwo& other) {
    if (!other.any_) return;
    exponent_ = any_ ? std::min(other.exponent_, exponent_) : other.exponent_;
    any_ = true;
  }
  int exponent() const { return exponent_; }

 private:
  int exponent_ = 0;
  bool any_ = false;
};

namespace certificate_check {

inline void require(bool holds, const char* otherwise) {
  if (!holds) throw std::invalid_argument(otherwise);
}

/// \throws std::invalid_argument it does not hold 0 to count - 1 once each, or there are none
inline void check_order(const std::vector<std::uint32_t>& order, std::size_t count) {
  std::vector<bool> seen(count);
  bool once = count > 0 && order.size() == count;
  for (std::size_t i = 0; once && i < count; ++i) {
    once = order[i] < count && !seen[order[i]];
    if (once) seen[order[i]] = true;
  }
  require(once, "an order does not hold each face once");
}

}  // namespace certificate_check

/// A mesh and what all checks of certificates ask about it. Keeps a reference to the mesh.
class CheckedMesh {
 public:
  /// \throws std::invalid_argument a face that is neither triangle nor quad or names no vertex; one that is not finite
  explicit CheckedMesh(const Mesh& mesh) : mesh_(&mesh) {
    using certificate_check::require;
    require(mesh.file_face.empty() || mesh.file_face.size() == mesh.faces.size(), "a broken mesh");
    for (const Mesh::Face& face : mesh.faces) {
      require(face.kind == Kind::tri || face.kind == Kind::quad, "a face is neither triangle nor quad");
      for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
        require(face.vertex[k] < mesh.vertices.size(), "a face has a vertex that does not exist");
        for (const double x : mesh.vertices[face.vertex[k]]) {
          require(std::isfinite(x), "a number of a mesh or a pose is not finite");
          unit_.add(x);
        }
      }
    }
    hash_ = hash_mesh(mesh);
  }

  const Mesh& mesh() const { return *mesh_; }
  std::uint64_t hash() const { return hash_; }  ///< hash_mesh()
  /// Divides all coordinates of faces.
  PowerOfTwo unit() const { return unit_; }

 private:
  const Mesh* mesh_;
  std::uint64_t hash_ = 0;
  PowerOfTwo unit_;
};

/// The tree of a mesh. A set is an interval of the order; its halves are those before and from its middle, and the sets
/// of one face are the leaves. Memory: 52 bytes a face.
class CertificateTree : public CheckedMesh {
 public:
  /// Sets with more faces have boxes.
  static constexpr std::size_t most_faces_without_box = 4;
  /// How often a set is halved to the boxes whose corners stand for it.
  static constexpr int halvings = 3;

  struct Set {
    std::size_t begin = 0, end = 0;  ///< in the order
    std::size_t size() const { return end - begin; }
    std::size_t middle() const { return begin + (end - begin) / 2; }
    Set first_half() const { return {begin, middle()}; }
    Set second_half() const { return {middle(), end}; }
  };
  struct Box {  ///< of vertices, in coordinates of the mesh
    Vec3d low, high;
  };

  /// \param order each face of the mesh once
  /// \throws std::invalid_argument it is another order; as CheckedMesh
  CertificateTree(const Mesh& mesh, std::vector<std::uint32_t> order) : CheckedMesh(mesh), order_(std::move(order)) {
    certificate_check::check_order(order_, mesh.faces.size());
    boxes_.resize(order_.size());
    make_boxes(all());
    CertificateHash hash;
    hash.add(this->hash());
    for (const std::uint32_t face : order_) hash.add(std::uint64_t{face});
    tree_hash_ = hash.value();
  }

  const std::vector<std::uint32_t>& order() const { return order_; }
  std::uint64_t tree_hash() const { return tree_hash_; }
  Set all() const { return {0, order_.size()}; }
  /// \pre the set comes of all() by halving, and has more than most_faces_without_box faces
  const Box& box(const Set& set) const { return boxes_[set.middle()]; }
  /// What stands for a set: the points whose hull holds it. Those of its parts after so many halvings: of a part that
  /// is too small for a box, the vertices of its faces, of others the corners of their boxes.
  template <class OnFaces, class OnBox>
  void for_hull(const Set& set, const OnFaces& on_faces, const OnBox& on_box, int level = halvings) const {
    if (set.size() <= most_faces_without_box) return on_faces(set);
    if (level == 0) return on_box(box(set));
    for_hull(set.first_half(), on_faces, on_box, level - 1);
    for_hull(set.second_half(), on_faces, on_box, level - 1);
  }
  /// The box of any set, by its vertices.
  Box box_of_vertices(const Set& set) const {
    const Vec3d& one = mesh().vertices[mesh().faces[order_[set.begin]].vertex[0]];
    Box box = {one, one};
    for (std::size_t i = set.begin; i < set.end; ++i) {
      const Mesh::Face& face = mesh().faces[order_[i]];
      for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
        const Vec3d& vertex = mesh().vertices[face.vertex[k]];
        box = {box.low.cwiseMin(vertex), box.high.cwiseMax(vertex)};
      }
    }
    return box;
  }

 private:
  /// Each set has a middle of its own, where its box is kept.
  Box make_boxes(const Set& set) {
    if (set.size() <= most_faces_without_box) return box_of_vertices(set);
    const Box first = make_boxes(set.first_half());
    const Box second = make_boxes(set.second_half());
    Box& box = boxes_[set.middle()];
    box = {first.low.cwiseMin(second.low), first.high.cwiseMax(second.high)};
    return box;
  }
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;
  std::uint64_t tree_hash_ = 0;
};

}  // namespace cchip

#endif
