// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lengths that times are computed from.
#ifndef CCHIP_LEVELS_BITSTREAM_LENGTH_HPP
#define CCHIP_LEVELS_BITSTREAM_LENGTH_HPP

#include <algorithm>
#include <cchip/internal/wire/bitstream.hpp>
#include <cchip/levels/level.hpp>

namespace cchip::levels {

/// Payload of the module's bitstream, bytes.
inline std::size_t payload_bytes(const LevelOptions& options, ModuleId id) {
  return options.payload_bytes != 0 ? options.payload_bytes : default_payload_bytes(id);
}

/// Longest payload of the tests, bytes.
inline std::size_t longest_payload_bytes(const LevelOptions& options) {
  return std::max({payload_bytes(options, ModuleId::tri_tri), payload_bytes(options, ModuleId::tri_quad),
                   payload_bytes(options, ModuleId::quad_quad), payload_bytes(options, ModuleId::point_tri)});
}

}  // namespace cchip::levels

#endif
