// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the command needs of the simulated hardware: hardware.cpp has it, no_hardware.cpp is for a cchip that is built
/// without (CCHIP_SIMULATION=OFF).
#ifndef CCHIP_APP_HARDWARE_HPP
#define CCHIP_APP_HARDWARE_HPP

#include <cchip/collide/collide.hpp>
#include <cchip/internal/driver/pair_engine.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engines.hpp"
#include "reconfig.hpp"

namespace cchip::app {

struct ChipOptions {
  std::string trace_path;  ///< FST file, none if empty
  unsigned slots = 0;      ///< whose modules are exchanged at run time; 0: a static chip
  unsigned chips = 1;
};
inline constexpr unsigned most_chips = 8;

/// Is the hardware there? Without it every call below throws.
bool has_hardware();

/// Makes open_device("sim") known, if there is hardware; a second call does nothing.
void add_chip_device();
/// \throws UsageError there is no hardware
std::unique_ptr<Device> open_chip(const ChipOptions& options);
/// The Verilated primitive tests.
/// \throws UsageError there is no hardware
std::unique_ptr<PairEngine> make_rtl(const EngineOptions& options);
/// A waveform of such an engine and the files of its layout.
std::vector<std::string> files_of_wave(const std::string& fst_path);

}  // namespace cchip::app

#endif
