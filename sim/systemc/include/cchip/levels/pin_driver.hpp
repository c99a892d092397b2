// SPDX-License-Identifier: Apache-2.0
/// \file
/// Static side of level 3: from FIFOs to pins and back.
#ifndef CCHIP_LEVELS_PIN_DRIVER_HPP
#define CCHIP_LEVELS_PIN_DRIVER_HPP

#include <cchip/levels/rtl_api.hpp>
#include <cchip/levels/rtl_shell.hpp>

namespace cchip::levels {

/// Signals between the static side and a primitive test; the reset is not among them.
struct PrimtestSignals {
  sc_core::sc_signal<bool> s_pair_valid{"s_pair_valid"};
  sc_core::sc_signal<bool> s_pair_ready{"s_pair_ready"};
  sc_core::sc_signal<std::uint32_t> s_pair_tag{"s_pair_tag"};
  sc_core::sc_signal<std::uint32_t> s_pair_mode{"s_pair_mode"};
  sc_core::sc_signal<VertexBits> s_pair_a{"s_pair_a"};
  sc_core::sc_signal<VertexBits> s_pair_b{"s_pair_b"};
  sc_core::sc_signal<std::uint32_t> s_pair_err{"s_pair_err"};
  sc_core::sc_signal<bool> m_result_valid{"m_result_valid"};
  sc_core::sc_signal<bool> m_result_ready{"m_result_ready"};
  sc_core::sc_signal<std::uint32_t> m_result_tag{"m_result_tag"};
  sc_core::sc_signal<bool> m_result_hit{"m_result_hit"};
  sc_core::sc_signal<bool> m_result_grid{"m_result_grid"};
  sc_core::sc_signal<bool> m_result_definite{"m_result_definite"};
  sc_core::sc_signal<std::uint32_t> m_result_axis{"m_result_axis"};
  sc_core::sc_signal<std::uint32_t> m_result_beats{"m_result_beats"};
  sc_core::sc_signal<std::uint32_t> rm_id{"rm_id"};
  sc_core::sc_signal<bool> idle{"idle"};
};

/// Binds the pins of `test`, clk and rst excepted, to the signals.
template <class Test>
void bind_pins(Test& test, PrimtestSignals& signals) {
  test.s_pair_valid(signals.s_pair_valid);
  test.s_pair_ready(signals.s_pair_ready);
  test.s_pair_tag(signals.s_pair_tag);
  test.s_pair_mode(signals.s_pair_mode);
  test.s_pair_a(signals.s_pair_a);
  test.s_pair_b(signals.s_pair_b);
  test.s_pair_err(signals.s_pair_err);
  test.m_result_valid(signals.m_result_valid);
  test.m_result_ready(signals.m_result_ready);
  test.m_result_tag(signals.m_result_tag);
  test.m_result_hit(signals.m_result_hit);
  test.m_result_grid(signals.m_result_grid);
  test.m_result_definite(signals.m_result_definite);
  test.m_result_axis(signals.m_result_axis);
  test.m_result_beats(signals.m_result_beats);
  test.rm_id(signals.rm_id);
  test.idle(signals.idle);
}

/// Offers pairs and takes answers, at most one of each per clock, while it is coupled. Decoupled, it does neither: the
/// outputs of a module that was not yet reset are random and must be ignored.
class PinDriver : public sc_core::sc_module {
 public:
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_fifo_in<RtlRequest> requests{"requests"};
  sc_core::sc_fifo_out<RtlResult> results{"results"};
  sc_core::sc_out<bool> s_pair_valid{"s_pair_valid"};
  sc_core::sc_in<bool> s_pair_ready{"s_pair_ready"};
  sc_core::sc_out<std::uint32_t> s_pair_tag{"s_pair_tag"};
  sc_core::sc_out<std::uint32_t> s_pair_mode{"s_pair_mode"};
  sc_core::sc_out<VertexBits> s_pair_a{"s_pair_a"};
  sc_core::sc_out<VertexBits> s_pair_b{"s_pair_b"};
  sc_core::sc_out<std::uint32_t> s_pair_err{"s_pair_err"};
  sc_core::sc_in<bool> m_result_valid{"m_result_valid"};
  sc_core::sc_out<bool> m_result_ready{"m_result_ready"};
  sc_core::sc_in<std::uint32_t> m_result_tag{"m_result_tag"};
  sc_core::sc_in<bool> m_result_hit{"m_result_hit"};
  sc_core::sc_in<bool> m_result_grid{"m_result_grid"};
  sc_core::sc_in<bool> m_result_definite{"m_result_definite"};
  sc_core::sc_in<std::uint32_t> m_result_axis{"m_result_axis"};
  sc_core::sc_in<std::uint32_t> m_result_beats{"m_result_beats"};
  sc_core::sc_in<std::uint32_t> rm_id{"rm_id"};
  sc_core::sc_in<bool> idle{"idle"};

  explicit PinDriver(const sc_core::sc_module_name& name);

  /// From the next rising edge on.
  void couple(bool on) { coupled_ = on; }

 private:
  void clock();
  void put(const RtlRequest& request);
  RtlResult result() const;

  bool coupled_ = false;
  bool offers_ = false;
};

}  // namespace cchip::levels

#endif
