// SPDX-License-Identifier: Apache-2.0
/// \file
/// Level 4: the RTL of cchip_primtest_subsystem, one slot with simulated reconfiguration, as a SystemC module.
#ifndef CCHIP_LEVELS_SUBSYSTEM_HPP
#define CCHIP_LEVELS_SUBSYSTEM_HPP

#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>

#include <cchip/levels/rtl_api.hpp>
#include <cstdint>
#include <memory>
#include <systemc>

namespace cchip::levels {

class SubsystemRtl;

/// Its slot is empty at power-up. Registers behind a TLM-2.0 target socket, 4-byte accesses to the addresses of
/// cchip/registers.hpp, by an AXI4-Lite transactor; the memory of the bitstreams behind a TLM-2.0 initiator socket, by
/// an AXI4 transactor, a transaction for each burst; pairs and answers in FIFOs. A failing assertion of the RTL ends
/// the simulation with an error.
class Subsystem : public sc_core::sc_module {
 public:
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_out<bool> irq{"irq"};
  sc_core::sc_fifo_in<RtlRequest> requests{"requests"};
  sc_core::sc_fifo_out<RtlResult> results{"results"};
  /// b_transport() waits for the AXI4-Lite answer, at most register_clocks_max clocks. Responses: TLM_OK_RESPONSE;
  /// TLM_BURST_ERROR_RESPONSE for a length other than 4 bytes; TLM_BYTE_ENABLE_ERROR_RESPONSE for byte enables;
  /// TLM_COMMAND_ERROR_RESPONSE for neither read nor write; TLM_ADDRESS_ERROR_RESPONSE for an address outside the 4 KiB
  /// of the registers; TLM_GENERIC_ERROR_RESPONSE if the registers refuse the access, or do not answer in time, now or
  /// earlier
  tlm_utils::simple_target_socket<Subsystem> registers{"registers"};
  tlm_utils::simple_initiator_socket<Subsystem> memory{"memory"};

  static constexpr int register_clocks_max = 1000;

  /// \param seed of what the RTL leaves undefined at power-up
  /// \param period of the clock
  Subsystem(const sc_core::sc_module_name& name, std::uint64_t seed, const sc_core::sc_time& period);
  ~Subsystem() override;

 private:
  void clock();
  void fetch();
  void transport(tlm::tlm_generic_payload& transaction, sc_core::sc_time& delay);
  static tlm::tlm_response_status refusal(const tlm::tlm_generic_payload& transaction);
  tlm::tlm_response_status access_register(tlm::tlm_generic_payload& transaction);

  sc_core::sc_time period_;
  sc_core::sc_event clocked_;
  sc_core::sc_mutex register_access_;
  sc_core::sc_event register_answered_;
  tlm::tlm_response_status register_status_ = tlm::TLM_OK_RESPONSE;
  std::uint32_t register_data_ = 0;
  std::unique_ptr<SubsystemRtl> rtl_;
};

}  // namespace cchip::levels

#endif
