// SPDX-License-Identifier: Apache-2.0
/// \file
/// Everything around a primitive test of level 3.
#ifndef CCHIP_LEVELS_STATIC_SIDE_HPP
#define CCHIP_LEVELS_STATIC_SIDE_HPP

#include <cchip/levels/level.hpp>
#include <cchip/levels/pin_driver.hpp>
#include <cchip/rc/rc.hpp>
#include <functional>

namespace cchip::levels {

/// Pins of a test but the reset, as a port group.
template <class Test>
auto pins_of(Test& t) {
  return rc::ports(t.clk, t.s_pair_valid, t.s_pair_ready, t.s_pair_tag, t.s_pair_mode, t.s_pair_a, t.s_pair_b,
                   t.s_pair_err, t.m_result_valid, t.m_result_ready, t.m_result_tag, t.m_result_hit, t.m_result_grid,
                   t.m_result_definite, t.m_result_axis, t.m_result_beats, t.rm_id, t.idle);
}

/// Portals for these pins.
using PinPortals = rc::portal_group<decltype(pins_of(std::declval<RtlShell&>()))>;

/// Listing 3.3 of the paper for a static test: reset for the first two clocks.
class StaticReset : public sc_core::sc_module {
 public:
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_out<bool> rst{"rst"};

  explicit StaticReset(const sc_core::sc_module_name& name);

 private:
  void write_rst();
};

/// API that, before each object pair, decouples the driver, configures, waits until the reset is over, compares rm_id
/// and couples the driver again.
class PinApi : public RtlApi {
 public:
  sc_core::sc_in<bool> clk{"clk"};

  PinApi(const sc_core::sc_module_name& name, const Stimulus& stimulus, const sc_core::sc_time& patience,
         PinDriver& driver, std::function<void(ModuleId)> configure);

 private:
  void prepare(const ObjectPair& objects) override;

  PinDriver& driver_;
  std::function<void(ModuleId)> configure_;
};

/// Clock of 100 MHz, signals, driver and API.
struct StaticSide {
  /// \param configure called from a thread before each object pair
  StaticSide(const Stimulus& stimulus, const LevelOptions& options, std::function<void(ModuleId)> configure);

  /// Binds the portals' static sides.
  void bind(PinPortals& portals);
  /// Binds a test directly, except its reset.
  template <class Test>
  void bind_test(Test& test) {
    test.clk(clk);
    bind_pins(test, signals);
  }

  sc_core::sc_clock clk{"clk", sc_core::sc_time(10, sc_core::SC_NS)};
  PrimtestSignals signals;
  sc_core::sc_fifo<RtlRequest> requests{"requests_fifo"};
  sc_core::sc_fifo<RtlResult> results{"results_fifo"};
  PinDriver driver{"driver"};
  PinApi api;
};

}  // namespace cchip::levels

#endif
