// SPDX-License-Identifier: Apache-2.0
#include "peer_library.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <stdexcept>

namespace cchip::testing {

PeerLibrary::PeerLibrary(const std::string& path) {
  // Never closed: the code of a mesh may be needed until the process ends.
  void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) throw std::runtime_error(std::string(dlerror()) + "; build the target of that name");
  void* function = dlsym(module, "cchip_peer");
  if (function == nullptr) throw std::runtime_error(path + ": no function cchip_peer");
  peer_ = reinterpret_cast<CchipPeerFunction*>(function)();
  if (peer_ == nullptr) throw std::runtime_error(path + ": the library does not start; leave it out of the build");
}

PeerLibrary PeerLibrary::fcl_debian() { return PeerLibrary(CCHIP_FCL_DEBIAN_MODULE); }

std::unique_ptr<PeerLibrary> PeerLibrary::fcl_native() {
#ifdef CCHIP_FCL_NATIVE_MODULE
  return std::unique_ptr<PeerLibrary>(new PeerLibrary(CCHIP_FCL_NATIVE_MODULE));
#else
  return nullptr;
#endif
}

PeerMesh PeerLibrary::mesh(const Mesh& mesh) const { return PeerMesh(peer_, mesh); }

PeerMesh::PeerMesh(const CchipPeer* peer, const Mesh& mesh) : peer_(peer), model_(nullptr, peer->destroy) {
  std::vector<double> vertices;
  for (const Vec3d& v : mesh.vertices) vertices.insert(vertices.end(), v.begin(), v.end());
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
    const auto& vertex = mesh.faces[i].vertex;
    triangles.insert(triangles.end(), {vertex[0], vertex[1], vertex[2]});
    face_of_.push_back(i);
    if (mesh.faces[i].kind == Kind::tri) continue;
    triangles.insert(triangles.end(), {vertex[0], vertex[2], vertex[3]});
    face_of_.push_back(i);
  }
  model_.reset(peer->make(vertices.data(), mesh.vertices.size(), triangles.data(), face_of_.size()));
}

std::vector<Contact> PeerMesh::contacts(const Pose& pose, const PeerMesh& b, const Pose& pose_b,
                                        std::size_t most) const {
  const auto find = [&](std::vector<std::uint32_t>& pairs) {
    return peer_->contacts(model_.get(), pose.data(), b.model_.get(), pose_b.data(), most, pairs.data(),
                           pairs.size() / 2);
  };
  std::vector<std::uint32_t> pairs(2 * std::min<std::size_t>(most, 4096));
  const std::size_t count = find(pairs);
  if (2 * count > pairs.size()) {
    pairs.resize(2 * count);
    find(pairs);
  }
  std::vector<Contact> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back({face_of_[pairs[2 * i]], b.face_of_[pairs[2 * i + 1]]});
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace cchip::testing
