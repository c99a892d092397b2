// SPDX-License-Identifier: Apache-2.0
/// \file
/// Custom configuration controller (C3) of level 4: software that writes registers and waits for the interrupt.
#ifndef CCHIP_LEVELS_SOFTWARE_C3_HPP
#define CCHIP_LEVELS_SOFTWARE_C3_HPP

#include <tlm_utils/simple_initiator_socket.h>

#include <cchip/internal/wire/definitions.hpp>
#include <cstdint>
#include <systemc>

namespace cchip::levels {

class SoftwareC3 : public sc_core::sc_module {
 public:
  tlm_utils::simple_initiator_socket<SoftwareC3> registers{"registers"};
  sc_core::sc_in<bool> irq{"irq"};

  /// \param patience longest time of a swap
  SoftwareC3(const sc_core::sc_module_name& name, sc_core::sc_time patience);

  /// Tells the hardware the address of a bitstream of slot 0. From a thread, like configure().
  /// \param bytes length of the bitstream, header included
  /// \throws std::runtime_error a register does not answer or refuses
  void announce(ModuleId module_id, std::uint32_t address, std::size_t bytes);

  /// Loads the module into slot 0 and returns when it works.
  /// \throws std::runtime_error the swap fails or does not end in time
  void configure(ModuleId module_id);

 private:
  void write(std::uint32_t offset, std::uint32_t value);
  std::uint32_t read(std::uint32_t offset);
  void access(tlm::tlm_command command, std::uint32_t offset, std::uint32_t& value);

  sc_core::sc_time patience_;
};

}  // namespace cchip::levels

#endif
