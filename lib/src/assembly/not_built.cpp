// SPDX-License-Identifier: Apache-2.0
// Readers that this build of the library does not have.
#include <cchip/assembly_receipts.hpp>
#include <stdexcept>

#include "placed_meshes.hpp"
#include "robot.hpp"

#ifndef CCHIP_WITH_GLTF
namespace cchip {

constexpr const char* no_receipts =
    "receipts: this build of the library has none; build it with nlohmann-json (Debian's nlohmann-json3-dev)";
void write_receipts(const Assembly&, const AssemblyReport&, const std::string&, const ReceiptOptions&) {
  throw std::runtime_error(no_receipts);
}
ReceiptReport verify_receipts(const Assembly&, const std::string&, unsigned) { throw std::runtime_error(no_receipts); }

}  // namespace cchip
#endif

namespace cchip::assembly {

#ifndef CCHIP_WITH_GLTF
PlacedMeshes read_gltf(const std::string& path, std::uint64_t) {
  throw std::runtime_error(path +
                           ": is glTF, and this build of the library has no reader for it; build it with "
                           "nlohmann-json (Debian's nlohmann-json3-dev)");
}
#endif
#ifndef CCHIP_WITH_3MF
PlacedMeshes read_3mf(const std::string& path, std::uint64_t) {
  throw std::runtime_error(path +
                           ": is 3MF, and this build of the library has no reader for it; build it with libzip "
                           "and pugixml (Debian's libzip-dev and libpugixml-dev)");
}
#endif
#ifndef CCHIP_WITH_URDF
Robot read_urdf(const std::string& path, const AssemblyLoadOptions&) {
  throw std::runtime_error(path +
                           ": is URDF, and this build of the library has no reader for it; build it with urdfdom "
                           "and pugixml (Debian's liburdfdom-dev and libpugixml-dev)");
}
std::vector<AssemblyRule> read_srdf(const std::string&, const std::vector<RobotLink>&, std::vector<std::string>&) {
  return {};
}
#endif

}  // namespace cchip::assembly
