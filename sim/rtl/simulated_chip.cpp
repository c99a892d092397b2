// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_chip.h>

#include <algorithm>
#include <cchip/device/chip_driver.hpp>
#include <cchip/device/chip_host.hpp>
#include <cchip/device/device.hpp>
#include <cchip/rtl/chip_machine.hpp>
#include <cchip/rtl/simulated_chip.hpp>
#include <cchip/waves/wave_layout.hpp>

namespace cchip {
namespace {

constexpr int bus_w = 128;

class SimulatedChip final : public sim::ChipMachine<Vcchip_chip, bus_w> {
 public:
  explicit SimulatedChip(const SimulatedChipOptions& options)
      : ChipMachine(sim::without_timeout(options.seed, options.trace_path, options.trace_clocks)) {
    memory().options = options.memory;
    if (!options.trace_path.empty()) {
      constexpr std::uint64_t units = 10;  // of time per clock
      write_chip_gtkw(options.trace_path, 0, units * std::min<std::uint64_t>(options.trace_clocks, 5000));
    }
  }
};

}  // namespace

std::unique_ptr<Machine> make_simulated_chip(const SimulatedChipOptions& options) {
  return std::make_unique<SimulatedChip>(options);
}

std::unique_ptr<Device> open_simulated_chip(const SimulatedChipOptions& options) {
  return make_chip_device(open_chip(make_simulated_chip(options)));
}

void add_simulated_chip() {
  [[maybe_unused]] static const bool added = [] {
    add_device("sim", [] { return open_simulated_chip(); });
    return true;
  }();
}

}  // namespace cchip
