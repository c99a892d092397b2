// SPDX-License-Identifier: Apache-2.0
/// \file
/// A swap of modules: its request and its report, as on the ports of cchip_config_controller.
#ifndef CCHIP_INTERNAL_WIRE_SWAP_HPP
#define CCHIP_INTERNAL_WIRE_SWAP_HPP

#include <cchip/internal/wire/definitions.hpp>
#include <cstdint>

namespace cchip {

/// One beat of s_swap.
struct SwapRequest {
  int slot = 0;
  int module_id = 0;
  std::uint32_t address = 0;  ///< of the bitstream, bytes
  std::uint32_t size = 0;     ///< of the bitstream, header included, bytes
  bool force = false;         ///< pairs that are not answered in time are given up
};

/// One clock of m_report.
struct SwapReport {
  int slot = 0;
  int module_id = 0;
  SwapCode code = SwapCode::ok;
  unsigned lost = 0;        ///< pairs given up
  std::uint64_t clock = 0;  ///< of the report, since reset
};

}  // namespace cchip

#endif
