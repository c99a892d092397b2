// SPDX-License-Identifier: Apache-2.0
/// \file
/// An object: a mesh made ready for collision tests.
#ifndef CCHIP_COLLIDE_OBJECT_HPP
#define CCHIP_COLLIDE_OBJECT_HPP

#include <cchip/bvh/support_tree.hpp>
#include <cchip/mesh/mesh.hpp>
#include <memory>

namespace cchip {

/// A mesh with its tree, built once and shared by all copies of the object. One that was moved from has no mesh:
/// devices refuse it, and id() is null. Immutable, so it may be used by any number of threads at a time. It is the
/// surface of the mesh, not the volume inside: an object wholly inside another does not touch it.
class Object {
 public:
  /// Takes O(faces log(faces)) time. Degenerate faces are allowed.
  /// \throws std::invalid_argument no faces, more than 2^24 - 2 of them, one that check_faces() refuses, or a vertex
  /// that
  ///         is not finite or beyond 2^1000
  /// \throws std::runtime_error the calling thread flushes small numbers to zero
  explicit Object(Mesh mesh);

  const Mesh& mesh() const { return data_->mesh; }
  /// What a CPU traverses. The chip's image is made from the mesh: make_image(mesh, build_tree(mesh)).
  const bvh::SupportTree& tree() const { return data_->tree; }
  /// Identity: equal only for copies of one object. Devices use it as the key of what they derive from an object.
  const void* id() const { return data_.get(); }

 private:
  struct Data {
    Mesh mesh;
    bvh::SupportTree tree;
  };
  std::shared_ptr<const Data> data_;
};

}  // namespace cchip

#endif
