// SPDX-License-Identifier: Apache-2.0
/// \file
/// Trees of the meshes of an assembly that its receipts cite.
#ifndef CCHIP_ASSEMBLY_MESH_TREES_HPP
#define CCHIP_ASSEMBLY_MESH_TREES_HPP

#include <cchip/certificate_tree.hpp>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace cchip::assembly {

/// Each is made once, when it is first asked for, from any thread. Meshes are told apart by their places in memory.
class MeshTrees {
 public:
  using Make = std::function<CertificateTree(const Mesh&)>;
  explicit MeshTrees(Make make) : make_(std::move(make)) {}

  /// \throws what Make throws; the next caller tries again
  const CertificateTree& of(const Mesh& mesh) {
    Entry* entry = nullptr;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      entry = &entries_[&mesh];
    }
    std::call_once(entry->once, [&] { entry->tree.emplace(make_(mesh)); });
    return *entry->tree;
  }

 private:
  struct Entry {
    std::once_flag once;
    std::optional<CertificateTree> tree;
  };
  Make make_;
  std::mutex mutex_;
  std::map<const Mesh*, Entry> entries_;
};

/// In the folder of the receipts.
/// \param hash of the mesh
std::string tree_file_name(std::uint64_t hash);

}  // namespace cchip::assembly

#endif
