// SPDX-License-Identifier: Apache-2.0
/// \file
/// The compression LZF, which PCD files use.
#ifndef CCHIP_MESH_IO_LZF_HPP
#define CCHIP_MESH_IO_LZF_HPP

#include <cstddef>
#include <string>
#include <string_view>

namespace cchip::mesh_io {

/// Unpacks LZF. A byte below 32 announces that many bytes and one as they are. Any other is a copy of what was unpacked
/// before: its three upper bits plus 2 are the length (7: the next byte is added), its five lower bits and the last
/// byte the distance less 1.
/// \param bytes that must come out
/// \throws FormatError the data is damaged, or others come out
std::string unpack_lzf(std::string_view packed, std::size_t bytes);

}  // namespace cchip::mesh_io

#endif
