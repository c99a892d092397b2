// SPDX-License-Identifier: Apache-2.0
/// \file
/// The content of a file, and what its name says.
#ifndef CCHIP_MESH_IO_FILE_CONTENT_HPP
#define CCHIP_MESH_IO_FILE_CONTENT_HPP

#include <string>

namespace cchip::mesh_io {

/// The content of a file or a pipe. Of a file no second copy is made.
/// \param what is in it, for messages: "mesh"
/// \throws std::runtime_error it cannot be read or is empty; one line
std::string read_file(const std::string& path, const std::string& what);

/// The name without `.gz`.
std::string name_inside(const std::string& name);

}  // namespace cchip::mesh_io

#endif
