// SPDX-License-Identifier: Apache-2.0
#include "hardware.hpp"

#include <cchip/driver/model_device.hpp>
#include <cchip/machines/simulated_chip.hpp>

#include "commands.hpp"
#include "engines.hpp"

namespace cchip::app {
namespace {

std::unique_ptr<Device> open_chip(const ChipOptions& options) {
  if (!options.trace_path.empty()) check_wave_name(options.trace_path);
  SimulatedChipOptions chip;
  chip.trace_path = options.trace_path;
  chip.slots = options.slots;
  chip.chips = options.chips;
  return open_simulated_chip(chip);
}

}  // namespace

const Hardware* hardware() {
  static const Hardware all = {open_chip, most_simulated_chips, hardware_commands()};
  add_model_device();
  add_simulated_chip();
  return &all;
}

}  // namespace cchip::app
