// SPDX-License-Identifier: Apache-2.0
/// \file
/// The Verilated triangle-triangle module as an engine.
#ifndef CCHIP_RTL_ENGINE_HPP
#define CCHIP_RTL_ENGINE_HPP

#include <cchip/engine.hpp>
#include <cstdint>
#include <memory>
#include <string>

namespace cchip {

struct RtlEngineOptions {
  /// FST waveform to write; none if empty. Complete once the engine is destroyed.
  std::string trace_path;
  /// Clocks in the waveform, from the first reset on; 0: all.
  std::uint64_t trace_clocks = 20000;
  /// Seed of what the RTL leaves undefined at power-up.
  std::uint64_t seed = 1;
};

/// cchip_primtest_tri_tri with default parameters (16-bit coordinates). A batch is streamed with valid = 1 while
/// pairs are left and ready = 1; clocks go on counting from batch to batch.
/// run() throws std::invalid_argument for a quad or a coordinate that does not fit, before anything is sent, and
/// std::runtime_error if the module does not answer within its drain bound, answers what was not asked, or one
/// of its assertions fails.
/// \throws std::runtime_error the waveform cannot be written
std::unique_ptr<PairEngine> make_rtl_engine(const RtlEngineOptions& options = {});

}  // namespace cchip

#endif
