// SPDX-License-Identifier: Apache-2.0
/// \file
/// The engines by name.
#ifndef CCHIP_COMMANDS_ENGINES_HPP
#define CCHIP_COMMANDS_ENGINES_HPP

#include <cchip/internal/driver/pair_engine.hpp>
#include <cchip/program/output_file.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace cchip::app {

enum class EngineKind { rtl, model, eigen, exact };

struct EngineOptions {
  EngineKind kind = EngineKind::rtl;
  PairMode mode = PairMode::exhaustive;
  /// Seed of what the RTL simulation leaves undefined at power-up.
  std::uint64_t seed = 1;
  /// Waveform of the RTL simulation, none if empty; see RtlEngineOptions.
  std::string trace_path;
  /// Clocks in the waveform; 0: all.
  std::uint64_t trace_clocks = 0;
};

const char* to_name(EngineKind kind);
/// True for the engines whose answers carry beats, clocks and axes.
bool is_hardware(EngineKind kind);

/// Every file that `--trace` may write: waveforms and their layouts; none without it.
std::vector<sim::NamedPath> trace_files(const EngineOptions& options);

/// \throws UsageError the name of a waveform does not end with .fst
void check_wave_name(const std::string& path);

/// \throws UsageError the options contradict each other
/// \throws sim::OutputError the waveform cannot be written
std::unique_ptr<PairEngine> make_engine(const EngineOptions& options);

}  // namespace cchip::app

#endif
