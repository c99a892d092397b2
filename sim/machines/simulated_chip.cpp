// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_chip.h>
#include <Vcchip_chip_swaps1.h>
#include <Vcchip_chip_swaps2.h>
#include <Vcchip_refit_axi.h>

#include <algorithm>
#include <cchip/device.hpp>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/machines/chip_machine.hpp>
#include <cchip/machines/chips_machine.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/machines/simulated_refit.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <stdexcept>
#include <string>

namespace cchip {
namespace {

constexpr int bus_w = 128;

void write_layout(const SimulatedChipOptions& options) {
  if (options.trace_path.empty()) return;
  constexpr std::uint64_t units = 10;  // of time per clock
  write_chip_gtkw(options.trace_path, 0, units * std::min<std::uint64_t>(options.trace_clocks, 5000), options.slots);
}

[[noreturn]] void refuse_slots(unsigned slots) {
  throw std::invalid_argument("simulated chip: " + std::to_string(slots) +
                              " slots with swaps; 1 or 2, or 0 for a static chip");
}

/// With a refit engine on its bus: queries of other images go on while it works.
template <class Model>
class SimulatedChip final : public sim::ChipMachine<Model, bus_w, sim::BusWithRefit<Model, Vcchip_refit_axi, bus_w>> {
 public:
  explicit SimulatedChip(const SimulatedChipOptions& options)
      : SimulatedChip::ChipMachine(sim::without_timeout(options.seed, options.trace_path, options.trace_clocks)) {
    this->memory().options = options.memory;
    write_layout(options);
  }

  bool has_refit() const override { return true; }
  RefitEnd refit(std::uint32_t base, std::uint32_t lines, std::uint32_t root) override {
    constexpr std::uint64_t clocks_a_line = 4000;  // some 100, what memory takes, and what queries take of it
    const std::uint64_t most_clocks = clocks_a_line * (lines + 100);
    auto& commands = this->bus().commands();
    commands.start(base, lines, root);
    this->simulation().run_until([&] { return !commands.at_work(); }, most_clocks, "the end of a refit");
    RefitEnd end = commands.end();
    for (std::uint64_t n = 0; !this->bus().is_settled() && n < most_clocks; ++n) this->proceed();
    end.outstanding = !this->bus().is_settled();
    return end;
  }
};

/// Queries of each of several chips in flight: twice as many as it works on at once, so that it has the next ones, and
/// the others of a batch go to the chip that has room for them.
constexpr unsigned shared_query_log2 = 5;

template <class Model>
std::vector<std::unique_ptr<Machine>> make_chips(const SimulatedChipOptions& options) {
  const auto all = std::make_shared<sim::ChipsOnMemory<Model, bus_w>>(
      options.chips, sim::without_timeout(options.seed, options.trace_path, options.trace_clocks));
  all->memory().options = options.memory;
  write_layout(options);
  return sim::machines_of(all);
}

}  // namespace

std::unique_ptr<Machine> make_simulated_chip(const SimulatedChipOptions& options) {
  if (options.chips != 1)
    throw std::invalid_argument("make_simulated_chip: " + std::to_string(options.chips) +
                                " chips; it makes 1, make_simulated_chips() makes more");
  switch (options.slots) {
    case 0:
      return std::make_unique<SimulatedChip<Vcchip_chip>>(options);
    case 1:
      return std::make_unique<SimulatedChip<Vcchip_chip_swaps1>>(options);
    case 2:
      return std::make_unique<SimulatedChip<Vcchip_chip_swaps2>>(options);
    default:
      refuse_slots(options.slots);
  }
}

std::vector<std::unique_ptr<Machine>> make_simulated_chips(const SimulatedChipOptions& options) {
  if (options.chips < 1 || options.chips > most_simulated_chips)
    throw std::invalid_argument("simulated chip: " + std::to_string(options.chips) + " chips; 1 to " +
                                std::to_string(most_simulated_chips) + " share a memory");
  switch (options.slots) {
    case 0:
      return make_chips<Vcchip_chip>(options);
    case 1:
      return make_chips<Vcchip_chip_swaps1>(options);
    case 2:
      return make_chips<Vcchip_chip_swaps2>(options);
    default:
      refuse_slots(options.slots);
  }
}

std::unique_ptr<Device> open_simulated_chip(const SimulatedChipOptions& options) {
  ChipDriverOptions driver;
  driver.payload_bytes = options.payload_bytes;
  if (options.chips != 1) {
    driver.query_log2 = shared_query_log2;
    return make_chip_device(open_chips(make_simulated_chips(options), driver));
  }
  return make_chip_device(open_chip(make_simulated_chip(options), driver));
}

void add_simulated_chip() {
  [[maybe_unused]] static const bool added = [] {
    add_device("sim", [] { return open_simulated_chip(); });
    return true;
  }();
}

}  // namespace cchip
