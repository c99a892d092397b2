// SPDX-License-Identifier: Apache-2.0
#include "swap_chip.hpp"

#include <Vcchip_chip_swaps1.h>
#include <Vcchip_chip_swaps1___024root.h>
#include <Vcchip_chip_swaps2.h>
#include <Vcchip_chip_swaps2___024root.h>

#include <cchip/internal/wire/swap.hpp>
#include <cchip/machines/chip_machine.hpp>
#include <cchip/machines/probes.hpp>

namespace cchip::testing {
namespace {

/// Counts what the registers do not show.
template <class Model>
class SwapObserver : public sim::Agent {
 public:
  SwapObserver(const Model& model, std::shared_ptr<std::array<std::uint64_t, 2>> overlap)
      : model_(model), overlap_(std::move(overlap)) {}
  void drive(const sim::ClockInfo&) override {}
  void sample(const sim::ClockInfo&) override {
    if (static_cast<SwapPhase>(probes::chip_swap_phase(model_)) != SwapPhase::transfer) return;
    ++(*overlap_)[0];
    (*overlap_)[1] += probes::chip_counts(model_) >> 1 & 1U;
  }

 private:
  const Model& model_;
  std::shared_ptr<std::array<std::uint64_t, 2>> overlap_;
};

/// ChipMachine that owns its observer.
template <class Model>
class ObservedChip : public sim::ChipMachine<Model, 128> {
 public:
  ObservedChip(std::uint64_t seed, std::shared_ptr<std::array<std::uint64_t, 2>> overlap)
      : sim::ChipMachine<Model, 128>(sim::without_timeout(seed)),
        observer_(this->simulation().top(), std::move(overlap)) {
    this->simulation().add(observer_);
  }

 private:
  SwapObserver<Model> observer_;
};

template <class Model>
SwapChip make(const sim::AxiLinesOptions& memory, const ChipDriverOptions& driver, std::uint64_t seed) {
  SwapChip made;
  made.overlap = std::make_shared<std::array<std::uint64_t, 2>>();
  auto machine = std::make_unique<ObservedChip<Model>>(seed, made.overlap);
  auto* chip = machine.get();
  chip->memory().options = memory;
  made.machine = chip;
  made.set_port = [chip](sim::AxiMemoryOptions options) { chip->bitstreams().set_options(std::move(options)); };
  made.set_fault = [chip](std::function<void(std::vector<sim::AxiBeat>&)> fault) {
    chip->bitstreams().set_fault(std::move(fault));
  };
  made.set_silent = [chip](bool silent) {
    if (silent) {
      chip->bitstreams().refuse_addresses();
    } else {
      chip->bitstreams().resume();
    }
  };
  made.clocks = [chip] { return chip->simulation().total_clocks(); };
  made.device = make_chip_device(open_chip(std::move(machine), driver));
  return made;
}

}  // namespace

SwapChip make_swap_chip(unsigned slots, const sim::AxiLinesOptions& memory, const ChipDriverOptions& driver,
                        std::uint64_t seed) {
  if (slots == 1) return make<Vcchip_chip_swaps1>(memory, driver, seed);
  return make<Vcchip_chip_swaps2>(memory, driver, seed);
}

}  // namespace cchip::testing
