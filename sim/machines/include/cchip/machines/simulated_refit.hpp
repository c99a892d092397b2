// SPDX-License-Identifier: Apache-2.0
/// \file
/// A Verilated cchip_refit_axi and the memory that holds the images it refits.
#ifndef CCHIP_MACHINES_SIMULATED_REFIT_HPP
#define CCHIP_MACHINES_SIMULATED_REFIT_HPP

#include <cchip/driver/machine.hpp>
#include <cchip/internal/image/image_line.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/sim/axi_lines.hpp>
#include <cchip/sim/simulation.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cchip::sim {

/// Clocks of a refit: from the one that took the command to the one that offered the end.
/// \tparam Config names the Verilated class `Model` and DATA_W
template <class Config>
class SimulatedRefit : private Agent {
 public:
  using Model = typename Config::Model;
  using Memory = AxiLines<Model, Config::DATA_W>;

  explicit SimulatedRefit(SimulationOptions options)
      : simulation_(std::move(options)), memory_(simulation_.top(), simulation_.seed()) {
    Model& m = top();
    m.limit = 0;
    m.s_abort = 0;
    m.s_base = m.s_lines = m.s_root = 0;
    simulation_.add(memory_);
    simulation_.add(*this);
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
  void start(std::uint32_t base, std::uint32_t lines, std::uint32_t root) {
    Model& m = top();
    m.s_base = base;
    m.s_lines = lines;
    m.s_root = root;
    offers_ = at_work_ = true;
    end_.reset();
  }
  /// Steps until it has ended. \throws SimulationTimeout
  RefitEnd finish(std::uint64_t most_clocks) {
    simulation_.run_until([this] { return !at_work_; }, most_clocks, "the end of a refit");
    return *end_;
  }
  RefitEnd refit(std::uint32_t base, std::uint32_t lines, std::uint32_t root, std::uint64_t most_clocks) {
    start(base, lines, root);
    return finish(most_clocks);
  }
  bool at_work() const { return at_work_; }

  /// Resets engine and bus.
  void reset() {
    drop();
    simulation_.reset(3);
  }
  /// Resets the engine alone; memory does not notice. \pre nothing is at work or outstanding
  void reset_engine() {
    drop();
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
  std::string waits_for() const override { return at_work_ ? "a refit is at work" : ""; }

  void drop() {
    offers_ = at_work_ = false;
    end_.reset();
  }

  void drive(const ClockInfo& now) override {
    top().s_valid = offers_ && !now.in_reset ? 1 : 0;
    top().m_ready = end_ ? 1 : 0;  // a clock after it was offered first
  }

  void sample(const ClockInfo& now) override {
    Model& m = top();
    if (now.in_reset || m.rst != 0) return;
    ++clocks_;
    if (m.m_valid != 0) {
      const auto code = static_cast<RefitCode>(m.m_code);
      if (!at_work_ || offers_) throw StreamError("the end of no refit");
      if (end_ && (end_->code != code || end_->line != m.m_line || end_->lines != m.m_lines))
        throw StreamError("the end of a refit changed before it was taken");
      if (!end_) end_ = RefitEnd{code, m.m_line, m.m_lines, clocks_};
      if (m.m_ready != 0) at_work_ = false;
    }
    if (m.s_valid != 0 && m.s_ready != 0) {
      offers_ = false;
      clocks_ = 0;
    }
  }

  Simulation<Model> simulation_;
  Memory memory_;
  bool offers_ = false, at_work_ = false;
  std::optional<RefitEnd> end_;
  std::uint64_t clocks_ = 0;
};

}  // namespace cchip::sim

#endif
