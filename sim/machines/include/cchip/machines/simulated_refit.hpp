// SPDX-License-Identifier: Apache-2.0
/// \file
/// A Verilated cchip_refit_axi with the memory that holds the images it refits: its own, or that of a chip.
#ifndef CCHIP_MACHINES_SIMULATED_REFIT_HPP
#define CCHIP_MACHINES_SIMULATED_REFIT_HPP

#include <cchip/driver/machine.hpp>
#include <cchip/internal/image/image_line.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/sim/agent.hpp>
#include <cchip/sim/axi_lines.hpp>
#include <cchip/sim/axi_share.hpp>
#include <cchip/sim/errors.hpp>
#include <cchip/sim/simulation.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cchip::sim {

/// The command port of a Verilated cchip_refit_axi: a refit at a time. Clocks of a refit: from the one that took the
/// command to the one that offered the end.
template <class Model>
class RefitCommands : public Agent {
 public:
  explicit RefitCommands(Model& model) : model_(model) {
    model_.limit = 0;
    model_.s_abort = 0;
    model_.s_base = model_.s_lines = model_.s_root = 0;
  }

  /// Offers a refit. \pre none is at work
  void start(std::uint32_t base, std::uint32_t lines, std::uint32_t root) {
    model_.s_base = base;
    model_.s_lines = lines;
    model_.s_root = root;
    offers_ = at_work_ = true;
    end_.reset();
  }
  bool at_work() const { return at_work_; }
  /// \pre one has ended
  const RefitEnd& end() const { return *end_; }
  /// Before a reset.
  void drop() {
    offers_ = at_work_ = false;
    end_.reset();
  }

  std::string waits_for() const override { return at_work_ ? "a refit is at work" : ""; }

  void drive(const ClockInfo& now) override {
    model_.s_valid = offers_ && !now.in_reset ? 1 : 0;
    model_.m_ready = end_ ? 1 : 0;  // a clock after it was offered first
  }

  void sample(const ClockInfo& now) override {
    if (now.in_reset || model_.rst != 0) return;
    ++clocks_;
    if (model_.m_valid != 0) {
      const auto code = static_cast<RefitCode>(model_.m_code);
      if (!at_work_ || offers_) throw StreamError("the end of no refit");
      if (end_ && (end_->code != code || end_->line != model_.m_line || end_->lines != model_.m_lines))
        throw StreamError("the end of a refit changed before it was taken");
      if (!end_) end_ = RefitEnd{code, model_.m_line, model_.m_lines, clocks_};
      if (model_.m_ready != 0) at_work_ = false;
    }
    if (model_.s_valid != 0 && model_.s_ready != 0) {
      offers_ = false;
      clocks_ = 0;
    }
  }

 private:
  Model& model_;
  bool offers_ = false, at_work_ = false;
  std::optional<RefitEnd> end_;
  std::uint64_t clocks_ = 0;
};

/// With a memory of its own.
/// \tparam Config names the Verilated class `Model` and DATA_W
template <class Config>
class SimulatedRefit {
 public:
  using Model = typename Config::Model;
  using Memory = AxiLines<Model, Config::DATA_W>;

  explicit SimulatedRefit(SimulationOptions options)
      : simulation_(std::move(options)), memory_(simulation_.top(), simulation_.seed()), commands_(simulation_.top()) {
    simulation_.add(memory_);
    simulation_.add(commands_);
    reset();
  }

  Model& top() { return simulation_.top(); }
  Memory& memory() { return memory_; }

  void place(std::uint32_t base, const std::vector<Line>& lines) { memory_.write(base, lines); }
  /// \pre these lines were placed
  std::vector<Line> lines(std::uint32_t base, std::size_t count) const {
    std::vector<Line> lines;
    for (std::size_t n = 0; n < count; ++n) lines.push_back(*memory_.find(base + n));
    return lines;
  }

  /// Offers a refit. \pre none is at work
  void start(std::uint32_t base, std::uint32_t lines, std::uint32_t root) { commands_.start(base, lines, root); }
  /// Steps until it has ended. \throws SimulationTimeout
  RefitEnd finish(std::uint64_t most_clocks) {
    simulation_.run_until([this] { return !at_work(); }, most_clocks, "the end of a refit");
    return commands_.end();
  }
  RefitEnd refit(std::uint32_t base, std::uint32_t lines, std::uint32_t root, std::uint64_t most_clocks) {
    start(base, lines, root);
    return finish(most_clocks);
  }
  bool at_work() const { return commands_.at_work(); }

  /// Resets engine and bus.
  void reset() {
    commands_.drop();
    simulation_.reset(3);
  }
  /// Resets the engine alone; memory does not notice. \pre nothing is at work or outstanding
  void reset_engine() {
    commands_.drop();
    top().rst = 1;
    steps(3);
    top().rst = 0;
  }

  void step() { simulation_.step(); }
  void steps(std::uint64_t clocks) { simulation_.steps(clocks); }
  /// Steps until memory owes no answer. \throws SimulationTimeout
  void settle(std::uint64_t most_clocks) {
    simulation_.run_until([this] { return top().outstanding == 0; }, most_clocks, "the last answer of memory");
  }

 private:
  Simulation<Model> simulation_;
  Memory memory_;
  RefitCommands<Model> commands_;
};

/// A refit engine on the bus of a chip, and the memory behind it: what a ChipMachine has as its bus. The chip's clock
/// is that of the engine, whose model is evaluated only while it has something to do.
///
/// \tparam Chip, Engine  Verilated classes
/// \tparam DATA_W        width of their data buses, bit
template <class Chip, class Engine, int DATA_W>
class BusWithRefit : public Agent {
 public:
  using Bus = AxiShare<MasterPins<DATA_W>, DATA_W>;
  using Memory = typename Bus::Memory;

  BusWithRefit(Chip& chip, std::uint64_t seed)
      : engine_(without_timeout(seed)),
        commands_(engine_.top()),
        chip_pins_(chip),
        engine_pins_(engine_.top()),
        bus_({&chip_pins_, &engine_pins_}, seed) {}

  Memory& memory() { return bus_.memory(); }
  const Memory& memory() const { return bus_.memory(); }
  RefitCommands<Engine>& commands() { return commands_; }
  /// Memory owes the engine no answer.
  bool is_settled() { return engine_->outstanding == 0; }

  void drive(const ClockInfo& now) override {
    if (now.in_reset) commands_.drop();
    engine_->rst = now.in_reset ? 1 : 0;
    is_awake_ = now.in_reset || commands_.at_work() || !is_settled();
    bus_.drive(now);
    if (!is_awake_) return;
    commands_.drive(now);
    engine_.settle();
  }
  void sample(const ClockInfo& now) override {
    bus_.sample(now);
    if (!is_awake_) return;
    commands_.sample(now);
    engine_.rise();
  }
  std::string waits_for() const override { return commands_.at_work() ? commands_.waits_for() : bus_.waits_for(); }

 private:
  Simulation<Engine> engine_;
  RefitCommands<Engine> commands_;
  MasterPins<DATA_W> chip_pins_, engine_pins_;
  Bus bus_;
  bool is_awake_ = true;
};

}  // namespace cchip::sim

#endif
