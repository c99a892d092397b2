// SPDX-License-Identifier: Apache-2.0
/// \file
/// The objects of an OBJ file.
#ifndef CCHIP_ASSEMBLY_OBJ_PARTS_HPP
#define CCHIP_ASSEMBLY_OBJ_PARTS_HPP

#include <cchip/mesh_file.hpp>
#include <string>
#include <vector>

namespace cchip::assembly {

struct ObjPart {
  std::string name;  ///< behind its `o`; empty if it has none
  Mesh mesh;         ///< with numbers of faces as in the whole file
};

/// A mesh for each `o`, and one for faces before the first, all in the coordinates of the file. Groups (`g`) make no
/// parts.
/// \param notes gets the notes of the mesh
/// \throws std::runtime_error as load_mesh(), or an `o` has no faces
std::vector<ObjPart> load_obj_parts(const std::string& path, const LoadOptions& options,
                                    std::vector<std::string>& notes);

}  // namespace cchip::assembly

#endif
