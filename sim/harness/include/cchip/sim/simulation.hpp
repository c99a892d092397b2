// SPDX-License-Identifier: Apache-2.0
/// \file
/// One Verilated model under one clock.
#ifndef CCHIP_SIM_SIMULATION_HPP
#define CCHIP_SIM_SIMULATION_HPP

#include <verilated.h>
#include <verilated_fst_c.h>

#include <cchip/program/output_file.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/sim/agent.hpp>
#include <cchip/sim/coverage.hpp>
#include <cchip/sim/errors.hpp>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

namespace cchip::sim {

struct SimulationOptions {
  /// Seed of everything the RTL leaves undefined at power-up; tests use it for their stimulus too.
  std::uint64_t seed = seed_from_environment();
  /// step() throws SimulationTimeout after this many clocks in all; 0: never.
  std::uint64_t timeout_clocks = 1000000;
  /// FST file to write (its folder is created); no waveform if empty. Until the simulation ends, also by an exception,
  /// it is called <trace_path>.part. A model that was built without waveforms throws SimulationError.
  std::string trace_path;
  /// Such a model runs, and writes none.
  bool trace_optional = false;
  /// First traced clock, counted from construction, resets included.
  std::uint64_t trace_from = 0;
  /// Traced clocks; 0: all from trace_from.
  std::uint64_t trace_clocks = 20000;
  /// If set: receives the number of clocks simulated, also when the simulation ends by an exception.
  std::shared_ptr<std::uint64_t> clocks_run;
};

/// Options of a simulation that lasts as long as somebody steps it.
inline SimulationOptions without_timeout(std::uint64_t seed) {
  SimulationOptions options;
  options.seed = seed;
  options.timeout_clocks = 0;
  return options;
}
inline SimulationOptions without_timeout(std::uint64_t seed, std::string trace_path, std::uint64_t trace_clocks) {
  SimulationOptions options = without_timeout(seed);
  options.trace_path = std::move(trace_path);
  options.trace_clocks = trace_clocks;
  return options;
}

namespace detail {
template <class Model, class = void>
struct HasReset : std::false_type {};
template <class Model>
struct HasReset<Model, std::void_t<decltype(std::declval<Model&>().rst)>> : std::true_type {};
template <class Model, class = void>
struct CanCallTrace : std::false_type {};
template <class Model>
struct CanCallTrace<Model, std::void_t<decltype(std::declval<Model&>().trace(std::declval<VerilatedFstC*>(), 1))>>
    : std::true_type {};
/// Was the model built with waveforms? Where each model has trace(), it says so in `traceCapable`, and a call ends the
/// program if it is false.
template <class Model, class = void>
struct HasTrace : CanCallTrace<Model> {};
template <class Model>
struct HasTrace<Model, std::void_t<decltype(Model::traceCapable)>> : std::bool_constant<Model::traceCapable> {};
}  // namespace detail

/// Owns context, model, clock, reset, waveform; runs agents. `Model` has a pin `clk` and, mostly, a pin `rst`.
///
/// One step() is one clock n:
///
///     time     10n                  10n+5                10n+10
///     clk      ______________________/~~~~~~~~~~~~~~~~~~~~\____
///     agents   drive()               .                    drive()
///     model        eval, settled     eval                     eval
///     agents                 sample().                            sample()
///     clock()  n                     . n+1
///
/// drive() sets inputs, sample() sees what the flip-flops are going to see at the rising edge (10n+5), so a
/// beat with valid = 1 and ready = 1 in sample() is handed over on clock n. Assertions of the RTL are evaluated
/// at the rising edge; the first one that fails ends step() with AssertionFailure.
template <class Model>
class Simulation {
 public:
  /// Afterwards clk = 0, rst = 1, all other inputs undefined (seeded): set them, then reset().
  explicit Simulation(SimulationOptions options = {}) : options_(std::move(options)) {
    context_->randReset(2);
    context_->randSeed(power_up_seed(options_.seed));
    context_->assertOn(true);
    context_->fatalOnError(false);
    context_->traceEverOn(!options_.trace_path.empty());
    model_ = std::make_unique<Model>(context_.get());
    model_->clk = 0;
    set_reset(true);
    open_trace();
  }
  ~Simulation() {
    Verilated::threadContextp(context_.get());
    model_->final();
    close_trace();
    count_coverage(*context_);
    if (options_.clocks_run) *options_.clocks_run = total_;
  }
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  Model& top() { return *model_; }
  Model* operator->() { return model_.get(); }
  const SimulationOptions& options() const { return options_; }
  std::uint64_t seed() const { return options_.seed; }

  /// The agent must outlive the last step(). Agents run in the order in which they were added.
  void add(Agent& agent) { agents_.push_back(&agent); }

  /// rst = 1 for `clocks` clocks, then 0. Also for a reset in mid traffic; clock() restarts at 0. A model without rst
  /// just runs these clocks.
  void reset(int clocks = 2) {
    set_reset(true);
    in_reset_ = true;
    for (int i = 0; i < clocks; ++i) step();
    set_reset(false);
    in_reset_ = false;
    clock_ = 0;
    if (total_ == static_cast<std::uint64_t>(clocks)) forget_toggles(*context_);
  }

  /// One clock. \throws SimulationError or a class derived from it, with clock, seed and wave in the message
  void step() {
    try {
      if (options_.timeout_clocks != 0 && total_ >= options_.timeout_clocks)
        throw SimulationTimeout(waiting("the end of the test", total_));
      const ClockInfo now{clock_, in_reset_};
      for (Agent* agent : agents_) agent->drive(now);
      settle();
      for (Agent* agent : agents_) agent->sample(now);
      rise();
    } catch (SimulationError& error) {
      error.add_context(where());
      throw;
    }
  }
  void steps(std::uint64_t clocks) {
    for (std::uint64_t i = 0; i < clocks; ++i) step();
  }

  /// Steps until done() is true (asked before each step).
  /// \param what for the message: what is being waited for
  /// \throws SimulationTimeout done() is still false after max_clocks
  template <class Done>
  void run_until(Done done, std::uint64_t max_clocks, const std::string& what) {
    for (std::uint64_t i = 0; !done(); ++i) {
      if (i == max_clocks) throw SimulationTimeout(waiting(what, max_clocks) + where());
      step();
    }
  }

  /// First half of a clock without agents: clk falls, combinational signals settle.
  void settle() {
    model_->clk = 0;
    model_->eval();
    dump(10 * total_);
  }
  /// Second half: the rising edge. \throws AssertionFailure
  void rise() {
    Verilated::threadContextp(context_.get());
    context_->time(10 * total_ + 5);
    model_->clk = 1;
    model_->eval();
    dump(10 * total_ + 5);
    if (context_->errorCount() != 0 || context_->gotError()) throw assertion_failure();
    ++clock_;
    ++total_;
  }

  /// Clocks since the last reset = number of the clock that the next step() runs.
  std::uint64_t clock() const { return clock_; }
  /// Clocks since construction, resets included.
  std::uint64_t total_clocks() const { return total_; }

 private:
  void set_reset(bool on) {
    if constexpr (detail::HasReset<Model>::value) model_->rst = on ? 1 : 0;
  }

  void open_trace() {
    if (options_.trace_path.empty()) return;
    if constexpr (detail::HasTrace<Model>::value) {
      const std::filesystem::path path(options_.trace_path);
      std::error_code ignored;  // isOpen() below tells
      if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
      trace_ = std::make_unique<VerilatedFstC>();
      trace_->set_time_unit("1ns");
      trace_->set_time_resolution("1ns");
      model_->trace(trace_.get(), 99);
      try {
        trace_file_ = std::make_unique<PendingFile>(options_.trace_path);
        trace_->open(trace_file_->part().c_str());
        if (!trace_->isOpen()) trace_file_->refuse("no waveform");
      } catch (const OutputError& error) {
        throw SimulationError(error.what());
      }
    } else if (!options_.trace_optional) {
      throw SimulationError(
          options_.trace_path +
          ": no waveform, the model was built without; run: scripts/run wave-of MODEL=" + model_->modelName());
    }
  }

  /// The waveform gets its name, also if the run failed: that is the one to look at.
  void close_trace() {
    if (!trace_) return;
    trace_->close();
    try {
      trace_file_->commit();
    } catch (const OutputError& error) {
      std::cerr << error.what() << std::endl;
    }
  }

  void dump(std::uint64_t time) {
    if (!trace_ || total_ < options_.trace_from) return;
    if (options_.trace_clocks != 0 && total_ - options_.trace_from >= options_.trace_clocks) return;
    trace_->dump(time);
  }

  std::string waiting(const std::string& what, std::uint64_t clocks) const {
    std::string message = "timeout after " + std::to_string(clocks) + " clocks, waited for " + what;
    for (const Agent* agent : agents_) {
      const std::string waits = agent->waits_for();
      if (!waits.empty()) message += "; " + waits;
    }
    return message;
  }

  AssertionFailure assertion_failure() {
    const int count = context_->errorCount();
    context_->errorCount(0);
    context_->gotError(false);
    context_->gotFinish(false);
    return AssertionFailure{std::to_string(count) + " assertion(s) of the RTL failed (text on standard output)"};
  }

  std::string where() const {
    return " (clock " + std::to_string(clock_) + (in_reset_ ? " in reset" : "") + ", seed " +
           std::to_string(options_.seed) + ", wave " + wave() + ")";
  }

  /// Name of the waveform, or how to come by one.
  std::string wave() const {
    if (trace_) return options_.trace_path;
    if (options_.trace_path.empty() || detail::HasTrace<Model>::value) return "none";
    return std::string("none: built without, run: scripts/run wave-of MODEL=") + model_->modelName();
  }

  SimulationOptions options_;
  std::unique_ptr<VerilatedContext> context_ = std::make_unique<VerilatedContext>();
  std::unique_ptr<Model> model_;
  std::unique_ptr<PendingFile> trace_file_;
  std::unique_ptr<VerilatedFstC> trace_;
  std::vector<Agent*> agents_;
  std::uint64_t clock_ = 0;
  std::uint64_t total_ = 0;
  bool in_reset_ = true;
};

}  // namespace cchip::sim

#endif
