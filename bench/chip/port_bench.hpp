// SPDX-License-Identifier: Apache-2.0
/// \file
/// cchip_chip behind its driver: queries go in by ring and doorbell, records come back by their phase bit.
#ifndef CCHIP_BENCH_PORT_BENCH_HPP
#define CCHIP_BENCH_PORT_BENCH_HPP

#include <cchip/driver/chip_driver.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/wire/chip_registers.hpp>
#include <cchip/machines/chip_answer.hpp>
#include <cchip/machines/chip_machine.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cchip::testing {

using sim::ChipAnswer;
using sim::compare_answer;

/// Scoreboard of a driver. A query's number is its tag.
template <class Model, int DATA_W>
class PortBench {
 public:
  using Machine = sim::ChipMachine<Model, DATA_W>;

  /// \param host_every clocks from one look of the host at its ring to the next
  PortBench(sim::SimulationOptions simulation, const sim::AxiLinesOptions& memory, const ChipDriverOptions& driver,
            std::uint64_t host_every)
      : driver_(driver), host_every_(host_every) {
    auto machine = std::make_unique<Machine>(std::move(simulation));
    machine_ = machine.get();
    machine_->memory().options = memory;
    port_ = open_chip(std::move(machine), driver);
    next_line_ = port_->capabilities().image_first;
  }

  Machine& machine() { return *machine_; }
  QueryPort& port() { return *port_; }

  /// Puts an image behind those that are there. \returns its line
  std::uint32_t place(const bvh::Image& image) {
    const std::uint32_t at = next_line_;
    port_->store(at, image.lines);
    next_line_ += static_cast<std::uint32_t>(image.lines.size()) + 64;
    return at;
  }

  /// \returns its number
  std::size_t submit(Query query) {
    query.tag = static_cast<std::uint32_t>(queries_.size());
    queries_.push_back(query);
    answers_.emplace_back();
    return queries_.size() - 1;
  }
  const std::vector<Query>& queries() const { return queries_; }
  /// Called with each line of the ring once the driver has written it, before the chip may read it.
  std::function<void(std::size_t number, Line& line)> edit;
  /// Records of this tag are those of query `number`.
  void rename(std::uint32_t tag, std::size_t number) { renamed_[tag] = number; }
  const std::vector<ChipAnswer>& answers() const { return answers_; }
  /// Submitted, or waiting to be.
  std::size_t unanswered() const { return queries_.size() - answered_; }
  std::size_t duplicated() const { return duplicated_; }
  const std::vector<std::string>& wrong() const { return wrong_; }
  std::uint64_t clocks() const { return machine_->simulation().total_clocks(); }
  std::uint64_t counter(std::uint32_t offset) {
    const std::uint64_t low = machine_->read_register(offset);
    return std::uint64_t{machine_->read_register(offset + 4)} << 32U | low;
  }

  /// Gives the chip what it takes and takes what it has, then lets time pass.
  /// \returns false: the driver says that nothing more will come
  bool step() {
    while (!hold && submitted_ < queries_.size() && port_->submit(queries_[submitted_])) {
      const std::uint64_t place = ring_++ & ((1U << driver_.query_log2) - 1);
      if (edit) edit(submitted_, machine_->memory().line(driver_.memory_base / 64 + place));
      ++submitted_;
    }
    while (std::optional<QueryOutcome> outcome = port_->collect()) take(*outcome);
    for (std::uint64_t i = 0; i < host_every_; ++i) {
      if (!port_->proceed()) return false;
    }
    return true;
  }
  bool hold = false;  ///< give the chip no further queries
  /// Queries that the chip has.
  std::size_t in_flight() const { return submitted_ - answered_; }
  /// Until every query has its answer. \returns false if that takes longer than that many clocks, or never ends
  bool run(std::uint64_t most_clocks) {
    return run(most_clocks, [] {});
  }
  /// The same. \param each called after each step
  template <class Each>
  bool run(std::uint64_t most_clocks, const Each& each) {
    const std::uint64_t end = clocks() + most_clocks;
    while (unanswered() > 0) {
      if (clocks() > end || !step()) return false;
      each();
    }
    return true;
  }
  /// Queries that wait to be submitted, or whose answers have not come, are given up: they stay without one.
  /// \returns false: the chip is dead
  bool recover() {
    answered_ = submitted_ = queries_.size();
    given_up_ = queries_.size();
    ring_ = 0;
    renamed_.clear();
    return port_->recover();
  }

 private:
  void take(QueryOutcome& outcome) {
    const auto other = renamed_.find(outcome.done.tag);
    const std::size_t number = other == renamed_.end() ? outcome.done.tag : other->second;
    if (number >= submitted_ || number < given_up_) {
      wrong_.push_back("done record of no query, tag " + std::to_string(number));
      return;
    }
    ChipAnswer& answer = answers_[number];
    if (answer.done) {
      ++duplicated_;
      wrong_.push_back("query " + std::to_string(number) + " ended twice");
      return;
    }
    if (outcome.done.pairs != outcome.pairs.size())
      wrong_.push_back("number of pairs of query " + std::to_string(number));
    answer.done = outcome.done;
    answer.pairs = std::move(outcome.pairs);
    ++answered_;
  }

  std::unique_ptr<QueryPort> port_;
  Machine* machine_ = nullptr;  // of the port
  ChipDriverOptions driver_;
  std::uint64_t host_every_;
  std::vector<Query> queries_;
  std::vector<ChipAnswer> answers_;
  std::vector<std::string> wrong_;
  std::map<std::uint32_t, std::size_t> renamed_;
  std::uint64_t ring_ = 0;  // queries written since the last reset
  std::size_t submitted_ = 0, answered_ = 0, duplicated_ = 0, given_up_ = 0;
  std::uint32_t next_line_ = 0;
};

}  // namespace cchip::testing

#endif
