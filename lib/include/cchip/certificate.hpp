// SPDX-License-Identifier: Apache-2.0
/// \file
/// Certificates: answers of collide() with their proof, as plain data (docs/cpp/certificates.md).
#ifndef CCHIP_CERTIFICATE_HPP
#define CCHIP_CERTIFICATE_HPP

#include <array>
#include <cchip/mesh.hpp>
#include <cchip/pose.hpp>
#include <cchip/relation.hpp>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace cchip {

/// An integer in decimal digits: "0", or digits without a leading zero, after a "-" if it is negative.
using Digits = std::string;

/// Whether the text is such a number, of at most 20,000 digits.
inline bool is_integer(const Digits& text) {
  const std::size_t sign = !text.empty() && text[0] == '-';
  return text.size() > sign && text.size() <= 20000 &&
         text.find_first_not_of("0123456789", sign) == std::string::npos && (text[sign] != '0' || text.size() == 1);
}

/// A step of the proof. A cell stands for all pairs of a face of a set of A and a face of a set of B.
struct CertificateCell {
  enum class Kind : std::uint8_t {
    split_a,  ///< the set of A in two: faces before `at` and from `at` on; the cells of the first follow, then the rest
    split_b,  ///< the same for the set of B
    separated,  ///< along `direction`, every vertex of the set of A lies strictly below every vertex of the set of B;
                ///< `within` asks for more, `along` for something else. In version 3 the points that stand for the
                ///< sets do, those of CertificateTree::for_hull()
    meet,       ///< one face each: they share a point, which both weights name
    touch,      ///< one face each: the same, and along `direction` no vertex of A lies above a vertex of B
    cross,      ///< one face each: the same with positive weights, and the edges of `span` span space
    near        ///< one face each: a point of A and one of B, which the weights name, are as near as the claim says
  };
  /// An edge from the first vertex of a face to another one.
  struct Edge {
    bool of_b = false;        ///< of the face of B
    std::uint8_t vertex = 1;  ///< 1..3: where the edge ends
  };
  Kind kind = Kind::separated;
  std::uint32_t at = 0;  ///< of a split: place in Certificate::order_a or order_b
  /// Of the kinds that name points: numbers of the two faces in Mesh::faces.
  std::uint32_t face_a = 0;
  std::uint32_t face_b = 0;
  /// For each vertex of the face a weight of at least 0. The point is the sum of the weighted vertices, divided by the
  /// sum of the weights, which is not 0.
  std::vector<Digits> weights_a;
  std::vector<Digits> weights_b;
  std::vector<Digits> direction;  ///< three components, not all 0
  std::array<Edge, 3> span = {};
};

/// A claim about two placed meshes, and its proof.
struct Certificate {
  struct Contact {
    std::uint32_t face_a = 0;  ///< number in the file, as in CollisionResult
    std::uint32_t face_b = 0;
    std::optional<Relation> relation = std::nullopt;  ///< touching or crossing, if the claim tells
  };
  /// 3 if it cites trees; otherwise 2 of claims with `within` or `along`, 1 of others.
  int version = 1;
  std::uint64_t hash_a = 0;  ///< hash_mesh() of A
  std::uint64_t hash_b = 0;
  std::uint64_t hash_poses = 0;

  /// The claim. `all`: `contacts` are all contacts, so that there is no hit without one. Otherwise `contacts` holds
  /// one, and nothing is said of others.
  bool all = true;
  /// The least relation that makes a contact: touching or crossing.
  Relation least = Relation::touching;
  /// Above 0: faces at most this far apart are contacts, in units of the world; `least` and relations tell nothing
  /// then.
  double within = 0;
  bool below = false;  ///< with `within`: only those nearer than that are contacts
  /// There is no contact after any translation of B by a positive multiple of this, in the world. With `all` and
  /// without contacts; nothing is said of the poses themselves, where the meshes may touch.
  std::optional<Vec3d> along;
  std::optional<Relation> relation;  ///< of the two meshes, if the claim tells
  std::vector<Contact> contacts;     ///< ascending, none twice

  /// The proof. With `all`: the faces of A and of B in any order, each once; sets of faces are intervals of these. The
  /// first cell is of all pairs, and those of a split follow it. Without: no orders and one cell.
  /// Version 3 has no orders: sets are those of the trees with these hashes, and a split has no `at`.
  std::uint64_t tree_a = 0;  ///< CertificateTree::tree_hash()
  std::uint64_t tree_b = 0;
  std::vector<std::uint32_t> order_a;
  std::vector<std::uint32_t> order_b;
  std::vector<CertificateCell> cells;
};

/// Of words of 64 bits, by the numbers of FNV. Tells data that were mistaken for others; a proof holds for the data it
/// is checked with.
class CertificateHash {
 public:
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x100000001b3U;
    value_ ^= value_ >> 32U;
  }
  void add(double number) {
    number = number == 0 ? 0 : number;  // -0 is 0
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    add(bits);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

/// Of each face its number in the file, its number of vertices and their coordinates.
/// \pre check_faces() accepts the mesh
inline std::uint64_t hash_mesh(const Mesh& mesh) {
  CertificateHash hash;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Mesh::Face& face = mesh.faces[i];
    hash.add(static_cast<std::uint64_t>(face.kind) << 32U | mesh.number_in_file(static_cast<std::uint32_t>(i)));
    for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
      for (const double x : mesh.vertices[face.vertex[k]]) hash.add(x);
    }
  }
  return hash.value();
}

/// Of A's matrix [linear, translation] row by row, then of B's.
inline std::uint64_t hash_poses(const Pose& pose_a, const Pose& pose_b) {
  CertificateHash hash;
  for (const Pose* pose : {&pose_a, &pose_b}) {
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 4; ++column) hash.add((*pose)(row, column));
    }
  }
  return hash.value();
}

}  // namespace cchip

#endif
