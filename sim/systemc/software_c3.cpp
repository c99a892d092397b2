// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cchip/internal/wire/registers.hpp>
#include <cchip/levels/software_c3.hpp>
#include <stdexcept>

namespace cchip::levels {

namespace regs = registers;

SoftwareC3::SoftwareC3(const sc_core::sc_module_name& name, sc_core::sc_time patience)
    : sc_module(name), patience_(patience) {}

void SoftwareC3::announce(ModuleId module_id, std::uint32_t address, std::size_t bytes) {
  const auto index = static_cast<std::uint32_t>(module_id);
  write(regs::bitstream_address::offset(index), address);
  write(regs::bitstream_size::offset(index), static_cast<std::uint32_t>(bytes));
  write(regs::bitstream_valid::offset(index), 1);
}

void SoftwareC3::configure(ModuleId module_id) {
  constexpr std::uint32_t events = regs::interrupt_status::done_mask | regs::interrupt_status::error_mask;
  write(regs::interrupt_status::offset, events);
  write(regs::interrupt_enable::offset, events);
  const auto id = static_cast<std::uint32_t>(module_id);
  write(regs::command::offset, regs::command::go_mask | id << regs::command::module_id_shift);
  if (!irq.read()) wait(patience_, irq.posedge_event());
  if (!irq.read()) {
    throw std::runtime_error(fmt::format("the swap to module {} did not end in {}", id, patience_.to_string()));
  }
  const std::uint32_t report = read(regs::report::offset);
  write(regs::interrupt_status::offset, events);
  const std::uint32_t code = (report & regs::report::code_mask) >> regs::report::code_shift;
  if (code != static_cast<std::uint32_t>(SwapCode::ok)) {
    throw std::runtime_error(
        fmt::format("the swap to module {} ended with code {}; see docs/hardware/registers.md", id, code));
  }
}

void SoftwareC3::write(std::uint32_t offset, std::uint32_t value) { access(tlm::TLM_WRITE_COMMAND, offset, value); }

std::uint32_t SoftwareC3::read(std::uint32_t offset) {
  std::uint32_t value = 0;
  access(tlm::TLM_READ_COMMAND, offset, value);
  return value;
}

void SoftwareC3::access(tlm::tlm_command command, std::uint32_t offset, std::uint32_t& value) {
  tlm::tlm_generic_payload transaction;
  transaction.set_command(command);
  transaction.set_address(offset);
  transaction.set_data_ptr(reinterpret_cast<unsigned char*>(&value));
  transaction.set_data_length(4);
  transaction.set_streaming_width(4);
  sc_core::sc_time delay;
  registers->b_transport(transaction, delay);
  wait(delay);
  if (transaction.is_response_ok()) return;
  throw std::runtime_error(fmt::format("register 0x{:03X}: {}", offset, transaction.get_response_string()));
}

}  // namespace cchip::levels
