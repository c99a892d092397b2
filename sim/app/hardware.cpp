// SPDX-License-Identifier: Apache-2.0
#include "hardware.hpp"

#include <cchip/machines/rtl_engine.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/waves/wave_layout.hpp>

namespace cchip::app {

static_assert(most_chips == most_simulated_chips);

bool has_hardware() { return true; }

void add_chip_device() { add_simulated_chip(); }

std::unique_ptr<Device> open_chip(const ChipOptions& options) {
  SimulatedChipOptions chip;
  chip.trace_path = options.trace_path;
  chip.slots = options.slots;
  chip.chips = options.chips;
  return open_simulated_chip(chip);
}

std::unique_ptr<PairEngine> make_rtl(const EngineOptions& options) {
  RtlEngineOptions rtl;
  rtl.seed = options.seed;
  rtl.trace_path = options.trace_path;
  rtl.trace_clocks = options.trace_clocks;
  return make_rtl_engine(rtl);
}

std::vector<std::string> files_of_wave(const std::string& fst_path) {
  std::vector<std::string> files = gtkw_files(fst_path, ModuleId::tri_tri);  // all modules have the same
  files.insert(files.begin(), fst_path);
  return files;
}

}  // namespace cchip::app
