// SPDX-License-Identifier: Apache-2.0
/// \file
/// All libraries that a benchmark asks. CMakeLists.txt defines the names of the modules for the programs that include
/// this.
#ifndef CCHIP_BENCH_OTHER_LIBRARIES_HPP
#define CCHIP_BENCH_OTHER_LIBRARIES_HPP

#include <string>
#include <vector>

#include "peer_library.hpp"

namespace cchip::testing {

/// Libraries beside FCL, and what brings one that the build did not find.
struct OtherLibrary {
  const char* name;
  const char* module;  ///< empty: not found
  const char* remedy;
};
inline constexpr OtherLibrary other_libraries[] = {{"Coal", CCHIP_COAL_MODULE, "scripts/run peers"},
                                                   {"CGAL", CCHIP_CGAL_MODULE, "scripts/bootstrap"},
                                                   {"ODE", CCHIP_ODE_MODULE, "scripts/bootstrap --dev"}};

struct NamedLibrary {
  std::string name;
  PeerLibrary library;
};

/// "FCL Debian" first, then "FCL native" if there is one, then the others that the build found.
inline std::vector<NamedLibrary> open_libraries() {
  std::vector<NamedLibrary> result;
  result.push_back({"FCL Debian", PeerLibrary::fcl_debian()});
  if (const auto native = PeerLibrary::fcl_native()) result.push_back({"FCL native", *native});
  for (const OtherLibrary& other : other_libraries) {
    if (*other.module != 0) result.push_back({other.name, PeerLibrary(other.module)});
  }
  return result;
}

/// A pair of meshes in one library.
struct PeerPair {
  std::string name;
  bool has_contacts;
  PeerMesh a;
  PeerMesh b;
};

/// The meshes in each of the libraries.
inline std::vector<PeerPair> peer_pairs(const std::vector<NamedLibrary>& libraries, const Mesh& a, const Mesh& b) {
  std::vector<PeerPair> result;
  for (const auto& [name, library] : libraries) {
    result.push_back({name, library.has_contacts(), library.mesh(a), library.mesh(b)});
  }
  return result;
}

}  // namespace cchip::testing

#endif
