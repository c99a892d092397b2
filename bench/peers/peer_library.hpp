// SPDX-License-Identifier: Apache-2.0
/// \file
/// Other libraries and their meshes, all asked in the same way.
#ifndef CCHIP_BENCH_PEER_LIBRARY_HPP
#define CCHIP_BENCH_PEER_LIBRARY_HPP

#include <cchip/collide/collide.hpp>
#include <cchip/mesh/mesh.hpp>
#include <memory>
#include <string>
#include <vector>

#include "peer.hpp"

namespace cchip::testing {

class PeerMesh;

/// One library, loaded as a module. It must outlive its meshes.
class PeerLibrary {
 public:
  /// \throws std::runtime_error the module cannot be loaded
  explicit PeerLibrary(const std::string& module_path);
  /// FCL as Debian builds it.
  static PeerLibrary fcl_debian();
  /// The FCL below CCHIP_NATIVE_FCL; none if the build was not given one.
  static std::unique_ptr<PeerLibrary> fcl_native();

  std::string description() const { return peer_->description; }
  bool has_contacts() const { return peer_->contacts != nullptr; }
  PeerMesh mesh(const Mesh& mesh) const;

 private:
  const CchipPeer* peer_;
};

/// A mesh with the library's tree. A quad is two triangles to the library.
class PeerMesh {
 public:
  /// A number below faces.size() for each triangle: the face that it belongs to.
  const std::vector<std::uint32_t>& face_of() const { return face_of_; }
  bool hit(const Pose& pose, const PeerMesh& b, const Pose& pose_b) const {
    return peer_->hit(model_.get(), pose.data(), b.model_.get(), pose_b.data()) != 0;
  }
  /// The number of contacts by the library's count; no result is kept. Only if the library has_contacts().
  std::size_t count_contacts(const Pose& pose, const PeerMesh& b, const Pose& pose_b) const {
    return peer_->contacts(model_.get(), pose.data(), b.model_.get(), pose_b.data(), max_contacts, nullptr, 0);
  }
  /// Pairs of faces in ascending order, none twice; at most `most` before duplicates go. Only if the library
  /// has_contacts().
  std::vector<Contact> contacts(const Pose& pose, const PeerMesh& b, const Pose& pose_b,
                                std::size_t most = max_contacts) const;

 private:
  friend class PeerLibrary;
  static constexpr std::size_t max_contacts = 10000000;
  PeerMesh(const CchipPeer* peer, const Mesh& mesh);

  const CchipPeer* peer_;
  std::vector<std::uint32_t> face_of_;
  std::unique_ptr<void, void (*)(void*)> model_;
};

}  // namespace cchip::testing

#endif
