// SPDX-License-Identifier: Apache-2.0
/// \file
/// The FCLs of this build: Debian's, and one that CCHIP_NATIVE_FCL names.
#ifndef CCHIP_TESTS_PEERS_FCL_LIBRARY_HPP
#define CCHIP_TESTS_PEERS_FCL_LIBRARY_HPP

#include <cchip/collide/collide.hpp>
#include <cchip/mesh/mesh.hpp>
#include <memory>
#include <string>
#include <vector>

#include "fcl_peer.hpp"

namespace cchip::testing {

class FclMesh;

/// One FCL, loaded as a module. It must outlive its meshes.
class FclLibrary {
 public:
  /// As Debian builds it.
  static FclLibrary debian();
  /// The one below CCHIP_NATIVE_FCL; none if the build was not given one.
  static std::unique_ptr<FclLibrary> native();

  std::string description() const { return peer_->description; }
  FclMesh mesh(const Mesh& mesh) const;

 private:
  explicit FclLibrary(const std::string& path);
  const CchipFclPeer* peer_;
};

/// A mesh with FCL's tree of OBBRSS. A quad is two triangles to FCL.
class FclMesh {
 public:
  /// A number below faces.size() for each triangle: the face that it belongs to.
  const std::vector<std::uint32_t>& face_of() const { return face_of_; }
  bool hit(const Pose& pose, const FclMesh& b, const Pose& pose_b) const {
    return peer_->hit(model_.get(), pose.data(), b.model_.get(), pose_b.data()) != 0;
  }
  /// The number of contacts by FCL's count; no result is kept.
  std::size_t count_contacts(const Pose& pose, const FclMesh& b, const Pose& pose_b) const {
    return peer_->contacts(model_.get(), pose.data(), b.model_.get(), pose_b.data(), most_contacts, nullptr, 0);
  }
  /// Pairs of faces in ascending order, none twice; at most `most` before duplicates go.
  std::vector<Contact> contacts(const Pose& pose, const FclMesh& b, const Pose& pose_b,
                                std::size_t most = most_contacts) const;

 private:
  friend class FclLibrary;
  static constexpr std::size_t most_contacts = 10000000;
  FclMesh(const CchipFclPeer* peer, const Mesh& mesh);

  const CchipFclPeer* peer_;
  std::vector<std::uint32_t> face_of_;
  std::unique_ptr<void, void (*)(void*)> model_;
};

}  // namespace cchip::testing

#endif
