// SPDX-License-Identifier: Apache-2.0
/// \file
/// Packed files.
#ifndef CCHIP_MESH_IO_UNPACK_HPP
#define CCHIP_MESH_IO_UNPACK_HPP

#include <cstdint>
#include <string>
#include <string_view>

namespace cchip::mesh_io {

/// True if the library was built with zlib, so that unpack_gzip() works.
bool can_unpack_gzip();

/// The content of a gzip file: of all its members, one after the other, as gunzip does. Bytes behind the last member
/// are ignored.
/// \param most_bytes that the content may have; memory does not grow further
/// \throws FormatError the file is truncated or damaged, or its content is larger
std::string unpack_gzip(std::string_view packed, std::uint64_t most_bytes);

}  // namespace cchip::mesh_io

#endif
