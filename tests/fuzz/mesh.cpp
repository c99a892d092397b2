// SPDX-License-Identifier: Apache-2.0
// Any bytes as a mesh file: a mesh whose faces name its vertices, or an error of one line. CCHIP_FUZZ_NAME says the
// format, the file's size whether quads are cut.
#include <cchip/mesh_file.hpp>
#include <stdexcept>

#include "require.hpp"

using namespace cchip;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view file(reinterpret_cast<const char*>(data), size);
  try {
    const Mesh mesh =
        parse_mesh(file, CCHIP_FUZZ_NAME, size % 2 == 0 ? FaceKinds::triangles : FaceKinds::triangles_and_quads);
    require(!mesh.faces.empty(), "a mesh has faces");
    for (const Mesh::Face& face : mesh.faces) {
      for (const std::uint32_t vertex : face.vertex) require(vertex < mesh.vertices.size(), "vertices are there");
    }
    for (const Vec3d& v : mesh.vertices) require(v.allFinite(), "coordinates are finite");
  } catch (const std::runtime_error& error) {
    require_one_line(error);
  }
  return 0;
}
