// SPDX-License-Identifier: Apache-2.0
/// \file
/// Several Verilated cchip_chip on one memory: a machine for each.
#ifndef CCHIP_MACHINES_CHIPS_MACHINE_HPP
#define CCHIP_MACHINES_CHIPS_MACHINE_HPP

#include <cchip/machines/chip_machine.hpp>
#include <cchip/sim/axi_share.hpp>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cchip::sim {

/// Chips side by side under one clock and one reset. Their masters m_axi share a bus and its bandwidth (AxiShare). The
/// ports for bitstreams read the same memory beside that bus, as that of a lone chip does; they are not counted.
/// \tparam DATA_W width of the model's data buses, bit
template <class Model, int DATA_W>
class ChipsOnMemory {
 public:
  using Bus = AxiShare<Model, DATA_W>;

  /// \param options of the first chip; the others have other power-up values and no waveform
  ChipsOnMemory(std::size_t chips, const SimulationOptions& options) : bus_(make(chips, options), options.seed) {
    for (const std::unique_ptr<Chip>& chip : chips_) {
      chip->simulation->cfg_error = 0;
      chip->bitstreams.backing = [this](std::uint32_t address) { return read_word(bus_.memory(), address); };
    }
    reset();
  }

  std::size_t size() const { return chips_.size(); }
  Bus& bus() { return bus_; }
  typename Bus::Memory& memory() { return bus_.memory(); }
  Simulation<Model>& simulation(std::size_t chip) { return chips_[chip]->simulation; }
  AxiLiteMaster<Model>& registers(std::size_t chip) { return chips_[chip]->registers; }

  /// Chips and bus.
  void reset() {
    set_reset(1);
    step();
    step();
    set_reset(0);
    clock_ = 0;
  }

  /// One clock of all. \throws SimulationError with the number of the chip, if it is one's
  void step() {
    const ClockInfo now{clock_, in_reset_};
    bus_.drive(now);
    for_each_chip([&](Chip& chip) {
      chip.bitstreams.drive(now);
      chip.registers.drive(now);
      chip.simulation.settle();
    });
    try {
      bus_.sample(now);
    } catch (SimulationError& error) {
      error.add_context(" (bus of " + std::to_string(chips_.size()) + " chips" + where() + ")");
      throw;
    }
    for_each_chip([&](Chip& chip) {
      chip.bitstreams.sample(now);
      chip.registers.sample(now);
      chip.simulation.rise();
    });
    ++clock_;
    ++total_;
  }

  /// For AxiLiteMaster::read() and write(). \throws SimulationTimeout done() is still false after max_clocks
  template <class Done>
  void run_until(Done done, std::uint64_t max_clocks, const std::string& what) {
    for (std::uint64_t i = 0; !done(); ++i) {
      if (i == max_clocks)
        throw SimulationTimeout("timeout after " + std::to_string(max_clocks) + " clocks, waited for " + what + " (" +
                                std::to_string(chips_.size()) + " chips" + where() + ")");
      step();
    }
  }

  /// Since construction, resets included.
  std::uint64_t total_clocks() const { return total_; }

 private:
  struct Chip {
    explicit Chip(const SimulationOptions& options)
        : simulation(options), registers(simulation.top()), pins(simulation.top()), bitstreams(pins) {}
    Simulation<Model> simulation;
    AxiLiteMaster<Model> registers;
    BitstreamPins<Model> pins;
    AxiMemory<BitstreamPins<Model>> bitstreams;
  };

  std::vector<Model*> make(std::size_t chips, SimulationOptions options) {
    std::vector<Model*> models;
    for (std::size_t i = 0; i < chips; ++i) {
      chips_.push_back(std::make_unique<Chip>(options));
      models.push_back(&chips_.back()->simulation.top());
      options.trace_path.clear();
      ++options.seed;
    }
    return models;
  }

  void set_reset(CData on) {
    for (const std::unique_ptr<Chip>& chip : chips_) chip->simulation->rst = on;
    in_reset_ = on != 0;
  }

  template <class Action>
  void for_each_chip(const Action& action) {
    for (std::size_t i = 0; i < chips_.size(); ++i) {
      try {
        action(*chips_[i]);
      } catch (SimulationError& error) {
        error.add_context(" (chip " + std::to_string(i) + where() + ")");
        throw;
      }
    }
  }

  std::string where() const {
    return ", clock " + std::to_string(clock_) + ", seed " + std::to_string(chips_.front()->simulation.seed());
  }

  std::vector<std::unique_ptr<Chip>> chips_;
  Bus bus_;
  std::uint64_t clock_ = 0, total_ = 0;
  bool in_reset_ = true;
};

/// One of them: its own registers and interrupt, the memory and the clock of all. An access to a register takes some
/// clocks of all chips.
template <class Model, int DATA_W>
class ChipOfSeveral final : public Machine {
 public:
  ChipOfSeveral(std::shared_ptr<ChipsOnMemory<Model, DATA_W>> all, std::size_t chip)
      : all_(std::move(all)), chip_(chip) {}

  std::uint32_t read_register(std::uint32_t offset) override {
    const AxiLiteWord word = all_->registers(chip_).read(*all_, offset);
    if (!word.ok)
      throw std::runtime_error("chip " + std::to_string(chip_) + ": register " + std::to_string(offset) +
                               " refuses a read");
    return word.data;
  }
  void write_register(std::uint32_t offset, std::uint32_t value) override {
    if (!all_->registers(chip_).write(*all_, offset, value))
      throw std::runtime_error("chip " + std::to_string(chip_) + ": register " + std::to_string(offset) +
                               " refuses a write");
  }
  void write_memory(std::uint64_t address, const Bytes& bytes) override { write_bytes(all_->memory(), address, bytes); }
  Bytes read_memory(std::uint64_t address, std::size_t size) override {
    return read_bytes(all_->memory(), address, size);
  }
  bool interrupt() override { return all_->simulation(chip_)->irq != 0; }

  /// To a clock that this machine has not seen: if each of N is told to proceed once, all proceed by one clock.
  void proceed() override {
    if (seen_ == all_->total_clocks()) all_->step();
    seen_ = all_->total_clocks();
  }

 private:
  std::shared_ptr<ChipsOnMemory<Model, DATA_W>> all_;
  std::size_t chip_;
  std::uint64_t seen_ = 0;
};

/// A machine for each chip.
template <class Model, int DATA_W>
std::vector<std::unique_ptr<Machine>> machines_of(const std::shared_ptr<ChipsOnMemory<Model, DATA_W>>& all) {
  std::vector<std::unique_ptr<Machine>> machines;
  for (std::size_t i = 0; i < all->size(); ++i)
    machines.push_back(std::make_unique<ChipOfSeveral<Model, DATA_W>>(all, i));
  return machines;
}

}  // namespace cchip::sim

#endif
