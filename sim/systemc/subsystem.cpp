// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/levels/subsystem.hpp>
#include <cstring>
#include <vector>

#include "subsystem_rtl.hpp"

namespace cchip::levels {

Subsystem::Subsystem(const sc_core::sc_module_name& name, std::uint64_t seed, const sc_core::sc_time& period)
    : sc_module(name), period_(period), rtl_(std::make_unique<SubsystemRtl>(seed)) {
  SC_HAS_PROCESS(Subsystem);
  registers.register_b_transport(this, &Subsystem::transport);
  SC_METHOD(clock);
  sensitive << clk.pos();
  dont_initialize();
  SC_THREAD(fetch);
}

Subsystem::~Subsystem() = default;

void Subsystem::clock() {
  rtl_->set_result_ready(results.num_free() > 0);
  RtlRequest request;
  if (rtl_->wants_pair() && requests.nb_read(request)) rtl_->offer(request, request.test);
  rtl_->clock();
  if (const auto result = rtl_->result()) results.nb_write(RtlResult{*result});
  if (const auto answer = rtl_->register_answer()) {
    register_data_ = answer->data;
    register_status_ = answer->ok ? tlm::TLM_OK_RESPONSE : tlm::TLM_GENERIC_ERROR_RESPONSE;
    register_answered_.notify();
  }
  irq.write(rtl_->irq());
  clocked_.notify();
}

void Subsystem::fetch() {
  while (true) {
    wait(clocked_);
    while (const auto burst = rtl_->burst()) {
      std::vector<std::uint32_t> words(burst->beats);
      tlm::tlm_generic_payload transaction;
      transaction.set_read();
      transaction.set_address(burst->address);
      transaction.set_data_ptr(reinterpret_cast<unsigned char*>(words.data()));
      transaction.set_data_length(4 * burst->beats);
      transaction.set_streaming_width(4 * burst->beats);
      sc_core::sc_time delay;
      memory->b_transport(transaction, delay);
      wait(delay);
      for (std::uint32_t i = 0; i < burst->beats; ++i) {
        rtl_->give_beat(words[i], transaction.is_response_ok(), i + 1 == burst->beats);
      }
    }
  }
}

void Subsystem::transport(tlm::tlm_generic_payload& transaction, sc_core::sc_time& delay) {
  transaction.set_response_status(refusal(transaction));
  if (!transaction.is_response_ok()) return;
  wait(delay);
  delay = sc_core::SC_ZERO_TIME;
  register_access_.lock();
  transaction.set_response_status(access_register(transaction));
  register_access_.unlock();
}

tlm::tlm_response_status Subsystem::refusal(const tlm::tlm_generic_payload& transaction) {
  if (transaction.get_data_length() != 4) return tlm::TLM_BURST_ERROR_RESPONSE;
  if (transaction.get_byte_enable_ptr() != nullptr) return tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE;
  if (!transaction.is_read() && !transaction.is_write()) return tlm::TLM_COMMAND_ERROR_RESPONSE;
  return transaction.get_address() < 4096 ? tlm::TLM_OK_RESPONSE : tlm::TLM_ADDRESS_ERROR_RESPONSE;
}

tlm::tlm_response_status Subsystem::access_register(tlm::tlm_generic_payload& transaction) {
  if (register_status_ == tlm::TLM_INCOMPLETE_RESPONSE) return tlm::TLM_GENERIC_ERROR_RESPONSE;  // hangs since earlier
  register_status_ = tlm::TLM_INCOMPLETE_RESPONSE;
  const auto address = static_cast<std::uint32_t>(transaction.get_address());
  if (transaction.is_write()) {
    std::uint32_t data = 0;
    std::memcpy(&data, transaction.get_data_ptr(), 4);
    rtl_->write_register(address, data);
  } else {
    rtl_->read_register(address);
  }
  wait(register_clocks_max * period_, register_answered_);
  if (register_status_ == tlm::TLM_INCOMPLETE_RESPONSE) return tlm::TLM_GENERIC_ERROR_RESPONSE;
  if (transaction.is_read()) std::memcpy(transaction.get_data_ptr(), &register_data_, 4);
  return register_status_;
}

}  // namespace cchip::levels
