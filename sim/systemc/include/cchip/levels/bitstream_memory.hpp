// SPDX-License-Identifier: Apache-2.0
/// \file
/// Memory behind a TLM-2.0 socket.
#ifndef CCHIP_LEVELS_BITSTREAM_MEMORY_HPP
#define CCHIP_LEVELS_BITSTREAM_MEMORY_HPP

#include <tlm_utils/simple_target_socket.h>

#include <cchip/internal/wire/bitstream.hpp>
#include <cstdint>
#include <systemc>

namespace cchip::levels {

/// Reads by b_transport, each with the same latency added to its delay. Addresses beyond the content get
/// TLM_ADDRESS_ERROR_RESPONSE, writes TLM_COMMAND_ERROR_RESPONSE.
class BitstreamMemory : public sc_core::sc_module {
 public:
  tlm_utils::simple_target_socket<BitstreamMemory> socket{"socket"};

  BitstreamMemory(const sc_core::sc_module_name& name, sc_core::sc_time latency);

  /// Appends at the next multiple of defs::bitstream_align. \return the address, bytes
  std::uint32_t append(const Bytes& bitstream);

 private:
  void transport(tlm::tlm_generic_payload& transaction, sc_core::sc_time& delay);

  sc_core::sc_time latency_;
  Bytes content_;
};

}  // namespace cchip::levels

#endif
