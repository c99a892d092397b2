// SPDX-License-Identifier: Apache-2.0
/// \file
/// An object: a mesh made ready for collision tests.
#ifndef CCHIP_OBJECT_HPP
#define CCHIP_OBJECT_HPP

#include <cchip/mesh.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace cchip {

struct Contact;
struct Shells;

namespace bvh {
class SupportTree;
}

/// An edge at which a surface is open: an odd number of its faces have both ends as neighbouring corners.
struct OpenEdge {
  Vec3d from;
  Vec3d to;
  std::uint32_t face;  ///< the first face that uses it; number as in Contact
};

/// A mesh with its tree, built once and shared by all copies of the object. One that was moved from has no mesh:
/// calls that need it throw, devices refuse it, and id() is null. Immutable, so it may be used by any number of threads
/// at a time. It is the surface of the mesh, not the volume inside: an object wholly inside another does not touch it.
class Object {
 public:
  /// Takes O(faces log(faces)) time. Degenerate faces are allowed.
  /// \throws std::invalid_argument no faces, more than 2^24 - 2 of them, one that check_faces() refuses, or a vertex
  ///         that a face uses and that is not finite or beyond 2^1000
  /// \throws std::runtime_error the calling thread flushes small numbers to zero
  explicit Object(Mesh mesh);

  /// The object with the same faces and other vertices, such as the next shape of a soft body. The tree keeps its nodes
  /// and gets new volumes, which takes O(faces) time, less than building it. Answers are as exact as those of a new
  /// Object; they take longer the further faces have moved against each other, so build anew once in a while. Faces
  /// that load_mesh() cut into triangles stay cut along the same lines.
  /// \param vertices as many as mesh().vertices, in the same order
  /// \throws std::invalid_argument this object was moved from; another number of vertices; one that a face uses and
  ///         that is not finite or beyond 2^1000
  /// \throws std::runtime_error as the constructor
  Object moved(std::vector<Vec3d> vertices) const;

  /// \throws std::invalid_argument the object was moved from; so does tree()
  const Mesh& mesh() const { return data().mesh; }
  /// What a CPU traverses, of <cchip/internal/tree/support_tree.hpp>. The chip's image is made from the same nodes:
  /// bvh::refit(tree().topology(), mesh()).
  const bvh::SupportTree& tree() const { return *data().tree; }
  /// Identity: equal only for copies of one object. Devices use it as the key of what they derive from an object.
  const void* id() const { return data_.get(); }
  /// moved() made it. A chip with a refit engine makes its image anew by that engine.
  /// \throws std::invalid_argument the object was moved from
  bool was_moved() const { return data().was_moved; }
  /// Faces of the mesh that are face `number` of the file or were cut from it; none if it has no such face.
  /// \throws std::invalid_argument the object was moved from
  std::vector<std::uint32_t> parts(std::uint32_t number) const;

  /// Is the surface closed? It is if an even number of faces use each piece of each edge; then it bounds a
  /// solid (docs/cpp/solids.md). Which way round the faces are is of no account, and an edge that one face uses whole
  /// may be used in parts by others. Vertices are the same if their coordinates
  /// are, whatever their numbers, so a mesh from an STL file may be closed. An edge whose ends coincide is none. The
  /// first call of is_closed(), open_edge() or same_place() takes O(faces log(faces)) time; copies of the object share
  /// its result.
  /// \throws std::invalid_argument the object was moved from; so do open_edge() and same_place()
  bool is_closed() const { return !open_edge(); }
  /// The first edge at which it is open, in the order of the faces; none if the surface is closed.
  std::optional<OpenEdge> open_edge() const;
  /// The first edge, in the order of the faces, that faces run along more often one way than the other; none if their
  /// sides are consistent, so that a winding number is the same whichever way it is counted.
  std::optional<OpenEdge> twisted_edge() const;
  /// For each vertex, the least number of a vertex with the same coordinates. Those that no face uses have their own.
  const std::vector<std::uint32_t>& same_place() const;

 private:
  friend const Shells& shells_of(const Object& object);
  friend std::optional<Contact> shell_overlap(const Object& object);
  struct Edges;
  struct Data {
    Mesh mesh;
    std::shared_ptr<const bvh::SupportTree> tree;
    /// Faces by their number in the file, if some were cut and file_face is not ascending; else empty.
    std::vector<std::uint32_t> by_file;
    std::shared_ptr<Edges> edges;  ///< what is known of them; filled at the first question
    bool was_moved;
  };
  const Edges& edges() const;
  const Shells& shells() const;
  const Data& data() const {
    if (!data_) refuse_moved_from();
    return *data_;
  }
  [[noreturn]] static void refuse_moved_from();
  Object() = default;

  std::shared_ptr<const Data> data_;
};

}  // namespace cchip

#endif
