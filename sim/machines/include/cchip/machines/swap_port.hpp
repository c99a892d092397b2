// SPDX-License-Identifier: Apache-2.0
/// \file
/// The streams s_swap and m_report, records SWAP_REQUEST and SWAP_REPORT, as values.
#ifndef CCHIP_MACHINES_SWAP_PORT_HPP
#define CCHIP_MACHINES_SWAP_PORT_HPP

#include <cchip/internal/wire/swap.hpp>
#include <cchip/sim/bits.hpp>

namespace cchip::sim {

template <class Port>
void put_swap_request(Port& port, const SwapRequest& request) {
  const auto put = [&](defs::Field field, std::uint64_t value) { set_bits(port, field.lsb, field.width, value); };
  put(defs::swap_request_slot, static_cast<std::uint64_t>(request.slot));
  put(defs::swap_request_module, static_cast<std::uint64_t>(request.module_id));
  put(defs::swap_request_address, request.address);
  put(defs::swap_request_size, request.size);
  put(defs::swap_request_force, request.force ? 1 : 0);
}
template <class Port>
SwapRequest get_swap_request(const Port& port) {
  const auto get = [&](defs::Field field) {
    return static_cast<std::uint32_t>(get_bits(port, field.lsb, field.width));
  };
  return {static_cast<int>(get(defs::swap_request_slot)), static_cast<int>(get(defs::swap_request_module)),
          get(defs::swap_request_address), get(defs::swap_request_size), get(defs::swap_request_force) != 0};
}

template <class Port>
void put_swap_report(Port& port, const SwapReport& report) {
  const auto put = [&](defs::Field field, std::uint64_t value) { set_bits(port, field.lsb, field.width, value); };
  put(defs::swap_report_slot, static_cast<std::uint64_t>(report.slot));
  put(defs::swap_report_module, static_cast<std::uint64_t>(report.module_id));
  put(defs::swap_report_code, static_cast<std::uint64_t>(report.code));
  put(defs::swap_report_lost, report.lost);
}
/// \param clock of the report, since reset
template <class Port>
SwapReport get_swap_report(const Port& port, std::uint64_t clock = 0) {
  const auto get = [&](defs::Field field) { return static_cast<unsigned>(get_bits(port, field.lsb, field.width)); };
  return {static_cast<int>(get(defs::swap_report_slot)), static_cast<int>(get(defs::swap_report_module)),
          static_cast<SwapCode>(get(defs::swap_report_code)), get(defs::swap_report_lost), clock};
}

}  // namespace cchip::sim

#endif
