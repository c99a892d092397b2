// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/bitstream_length.hpp>
#include <cchip/levels/static_side.hpp>
#include <cchip/rc/bitstream_timing.hpp>
#include <stdexcept>
#include <utility>

namespace cchip::levels {
namespace {

using sc_core::sc_time;

sc_time patience(const LevelOptions& options) {
  const sc_time swap = rc::bitstream_timing().configuration(8 * longest_payload_bytes(options));
  return 10 * (swap + sc_time(1, sc_core::SC_MS));
}

}  // namespace

StaticReset::StaticReset(const sc_core::sc_module_name& name) : sc_module(name) {
  SC_HAS_PROCESS(StaticReset);
  SC_THREAD(write_rst);
  sensitive << clk.pos();
}

void StaticReset::write_rst() {
  rst.write(true);
  wait();
  wait();
  rst.write(false);
}

PinApi::PinApi(const sc_core::sc_module_name& name, const Stimulus& stimulus, const sc_time& patience,
               PinDriver& driver, std::function<void(ModuleId)> configure)
    : RtlApi(name, stimulus, patience), driver_(driver), configure_(std::move(configure)) {}

void PinApi::prepare(const ObjectPair& objects) {
  constexpr int clocks = defs::roc_clocks_default + 2;
  driver_.couple(false);
  wait(clk.posedge_event());  // now it is
  configure_(objects.test);
  for (int i = 0; i < clocks; ++i) wait(clk.posedge_event());
  if (driver_.rm_id.read() != static_cast<unsigned>(objects.test)) {
    throw std::runtime_error("module " + std::to_string(static_cast<unsigned>(objects.test)) +
                             " was asked for, rm_id is " + std::to_string(driver_.rm_id.read()));
  }
  driver_.couple(true);
}

StaticSide::StaticSide(const Stimulus& stimulus, const LevelOptions& options, std::function<void(ModuleId)> configure)
    : api("api", stimulus, patience(options), driver, std::move(configure)) {
  driver.clk(clk);
  driver.requests(requests);
  driver.results(results);
  bind_pins(driver, signals);
  api.clk(clk);
  api.requests(requests);
  api.results(results);
}

void StaticSide::bind(PinPortals& portals) {
  portals.bind_static(clk, signals.s_pair_valid, signals.s_pair_ready, signals.s_pair_tag, signals.s_pair_mode,
                      signals.s_pair_a, signals.s_pair_b, signals.s_pair_err, signals.m_result_valid,
                      signals.m_result_ready, signals.m_result_tag, signals.m_result_hit, signals.m_result_grid,
                      signals.m_result_definite, signals.m_result_axis, signals.m_result_beats, signals.rm_id,
                      signals.idle);
}

}  // namespace cchip::levels
