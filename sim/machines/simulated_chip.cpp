// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_chip.h>
#include <Vcchip_chip_swaps1.h>
#include <Vcchip_chip_swaps2.h>

#include <algorithm>
#include <cchip/device/device.hpp>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/machines/chip_machine.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <stdexcept>
#include <string>

namespace cchip {
namespace {

constexpr int bus_w = 128;

template <class Model>
class SimulatedChip final : public sim::ChipMachine<Model, bus_w> {
 public:
  explicit SimulatedChip(const SimulatedChipOptions& options)
      : sim::ChipMachine<Model, bus_w>(sim::without_timeout(options.seed, options.trace_path, options.trace_clocks)) {
    this->memory().options = options.memory;
    if (!options.trace_path.empty()) {
      constexpr std::uint64_t units = 10;  // of time per clock
      write_chip_gtkw(options.trace_path, 0, units * std::min<std::uint64_t>(options.trace_clocks, 5000),
                      options.slots);
    }
  }
};

}  // namespace

std::unique_ptr<Machine> make_simulated_chip(const SimulatedChipOptions& options) {
  switch (options.slots) {
    case 0:
      return std::make_unique<SimulatedChip<Vcchip_chip>>(options);
    case 1:
      return std::make_unique<SimulatedChip<Vcchip_chip_swaps1>>(options);
    case 2:
      return std::make_unique<SimulatedChip<Vcchip_chip_swaps2>>(options);
    default:
      throw std::invalid_argument("simulated chip: " + std::to_string(options.slots) +
                                  " slots with swaps; 1 or 2, or 0 for a static chip");
  }
}

std::unique_ptr<Device> open_simulated_chip(const SimulatedChipOptions& options) {
  ChipDriverOptions driver;
  driver.payload_bytes = options.payload_bytes;
  return make_chip_device(open_chip(make_simulated_chip(options), driver));
}

void add_simulated_chip() {
  [[maybe_unused]] static const bool added = [] {
    add_device("sim", [] { return open_simulated_chip(); });
    return true;
  }();
}

}  // namespace cchip
