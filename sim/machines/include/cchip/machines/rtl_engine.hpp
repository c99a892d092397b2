// SPDX-License-Identifier: Apache-2.0
/// \file
/// The Verilated primitive tests as an engine.
#ifndef CCHIP_MACHINES_RTL_ENGINE_HPP
#define CCHIP_MACHINES_RTL_ENGINE_HPP

#include <cchip/internal/driver/primtest_engine.hpp>
#include <cstdint>
#include <memory>
#include <string>

namespace cchip {

struct RtlEngineOptions {
  /// FST waveform to write, none if empty: of the module that the first pair needs. Waveforms of the others get
  /// "_tri_tri", "_tri_quad" or "_quad_quad" before the extension. Each comes with its layout (wave_layout.hpp) and
  /// is complete once the engine is destroyed.
  std::string trace_path;
  /// Clocks in each waveform, from the first reset on; 0: all.
  std::uint64_t trace_clocks = 20000;
  /// Seed of what the RTL leaves undefined at power-up.
  std::uint64_t seed = 1;
};

struct RtlMachineOptions : RtlEngineOptions {
  /// Random bits on the payload of s_pair while it is not valid, and on the unused vertex slot of triangles.
  bool scramble = false;
};

/// One Verilated primitive test with default parameters, after reset. Its waveform is trace_path, without a layout.
/// \throws std::invalid_argument the blank module
std::unique_ptr<PrimtestMachine> make_rtl_machine(ModuleId id, const RtlMachineOptions& options = {});

/// cchip_primtest_tri_tri, _tri_quad and _quad_quad with default parameters (16-bit coordinates), each made when a pair
/// needs it; make_primtest_engine() says how pairs are sent. run() throws std::invalid_argument for a coordinate that
/// does not fit, before anything is sent, and std::runtime_error if a module does not answer within its drain bound,
/// gives an unexpected answer, or one of its assertions fails.
/// \throws std::runtime_error the waveform cannot be written
std::unique_ptr<PairEngine> make_rtl_engine(const RtlEngineOptions& options = {});

}  // namespace cchip

#endif
