// SPDX-License-Identifier: Apache-2.0
/// \file
/// Words of a line of memory.
#ifndef CCHIP_BLOCKS_LINE_DATA_HPP
#define CCHIP_BLOCKS_LINE_DATA_HPP

#include <array>
#include <cstdint>

namespace cchip::model {

/// 64 bytes, or the part of them that a beat carries; the lowest address first.
using LineData = std::array<std::uint32_t, 16>;

}  // namespace cchip::model

#endif
