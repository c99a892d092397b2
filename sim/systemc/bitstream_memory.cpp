// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/levels/bitstream_memory.hpp>

namespace cchip::levels {

BitstreamMemory::BitstreamMemory(const sc_core::sc_module_name& name, sc_core::sc_time latency)
    : sc_module(name), latency_(latency) {
  socket.register_b_transport(this, &BitstreamMemory::transport);
}

std::uint32_t BitstreamMemory::append(const Bytes& bitstream) {
  constexpr std::size_t align = defs::bitstream_align;
  const std::size_t address = (content_.size() + align - 1) / align * align;
  content_.resize(address);
  content_.insert(content_.end(), bitstream.begin(), bitstream.end());
  content_.resize((content_.size() + 3) / 4 * 4);  // the last beat of a burst is whole
  return static_cast<std::uint32_t>(address);
}

void BitstreamMemory::transport(tlm::tlm_generic_payload& transaction, sc_core::sc_time& delay) {
  delay += latency_;
  const std::uint64_t address = transaction.get_address();
  const std::uint64_t length = transaction.get_data_length();
  if (!transaction.is_read()) {
    transaction.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
  } else if (address > content_.size() || length > content_.size() - address) {
    transaction.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
  } else {
    std::copy_n(content_.begin() + static_cast<std::ptrdiff_t>(address), length, transaction.get_data_ptr());
    transaction.set_response_status(tlm::TLM_OK_RESPONSE);
  }
}

}  // namespace cchip::levels
