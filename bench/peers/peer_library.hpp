// SPDX-License-Identifier: Apache-2.0
/// \file
/// Other libraries and their meshes, all asked in the same way.
#ifndef CCHIP_BENCH_PEER_LIBRARY_HPP
#define CCHIP_BENCH_PEER_LIBRARY_HPP

#include <cchip/collide.hpp>
#include <cchip/mesh.hpp>
#include <memory>
#include <string>
#include <vector>

#include "peer.hpp"

namespace cchip::testing {

class PeerMesh;

/// What a library says of the distance of two meshes.
struct PeerDistance {
  double distance = 0;  ///< 0 or less: they meet
  Vec3d point_a = Vec3d::Zero();
  Vec3d point_b = Vec3d::Zero();
};

/// One library, loaded as a module. It must outlive its meshes.
class PeerLibrary {
 public:
  /// \throws std::runtime_error the module cannot be loaded
  explicit PeerLibrary(const std::string& module_path);
  /// One that is part of the program; it must not end before its meshes.
  explicit PeerLibrary(const CchipPeer& peer) : peer_(&peer) {}
  /// FCL as Debian builds it.
  static PeerLibrary fcl_debian();
  /// The FCL below CCHIP_NATIVE_FCL; none if the build was not given one.
  static std::unique_ptr<PeerLibrary> fcl_native();

  std::string description() const { return peer_->description; }
  bool has_contacts() const { return peer_->contacts != nullptr; }
  bool has_distance() const { return peer_->distance != nullptr && peer_->within != nullptr; }
  double distance_tolerance() const { return peer_->distance_tolerance; }
  PeerMesh mesh(const Mesh& mesh) const;
  /// Null: the library has none that is asked.
  const CchipBroadPeer* broad() const { return peer_->broad; }
  const CchipScenePeer* scene() const { return peer_->scene; }

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
  /// Only if the library has_distance().
  PeerDistance distance(const Pose& pose, const PeerMesh& b, const Pose& pose_b, double rel_error = 0) const {
    Eigen::Matrix<double, 3, 2> points;
    PeerDistance result;
    result.distance =
        peer_->distance(model_.get(), pose.data(), b.model_.get(), pose_b.data(), rel_error, points.data());
    result.point_a = points.col(0);
    result.point_b = points.col(1);
    return result;
  }
  /// As the library's scene takes it.
  void* model() const { return model_.get(); }
  /// Is the distance at most d? Only if the library has_distance().
  bool within(const Pose& pose, const PeerMesh& b, const Pose& pose_b, double d) const {
    return peer_->within(model_.get(), pose.data(), b.model_.get(), pose_b.data(), d) != 0;
  }

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
