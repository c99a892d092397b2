// SPDX-License-Identifier: Apache-2.0
/// \file
/// Static side of level 3: from FIFOs to pins and back.
#ifndef CCHIP_LEVELS_PIN_DRIVER_HPP
#define CCHIP_LEVELS_PIN_DRIVER_HPP

#include <cchip/levels/rtl_api.hpp>
#include <cchip/levels/rtl_shell.hpp>

namespace cchip::levels {

template <class T>
using PinSignal = sc_core::sc_signal<T>;
/// Signals between the static side and a primitive test; the reset is not among them.
using PrimtestSignals = PrimtestPins<PinSignal, PinSignal>;

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
class PinDriver : public sc_core::sc_module, public PrimtestPins<sc_core::sc_out, sc_core::sc_in> {
 public:
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_fifo_in<RtlRequest> requests{"requests"};
  sc_core::sc_fifo_out<RtlResult> results{"results"};

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
