// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bench of cchip_config_controller: memory, slots that behave as told, monitors of the sequence.
#ifndef CCHIP_TESTS_UNIT_SWAP_BENCH_HPP
#define CCHIP_TESTS_UNIT_SWAP_BENCH_HPP

#include <cchip/internal/wire/bitstream.hpp>
#include <cchip/internal/wire/swap.hpp>
#include <cchip/machines/swap_port.hpp>
#include <cchip/sim/axi_memory.hpp>
#include <deque>

#include "bench.hpp"

namespace cchip::test {

/// How a slot behaves; outputs of the slot are flip-flops.
struct SlotBehaviour {
  int drain = 3;        ///< clocks from stop to quiet, < 0: never
  int inside = 7;       ///< pairs lost by decoupling it before it is quiet
  bool follows = true;  ///< decoupled follows decouple
  int roc_clocks = 2;   ///< < 0: roc_busy never falls; 0: there is no reset on configuration
  int settles = 0;      ///< clocks from the end of that reset until the module shows its number
  bool spoilt = false;  ///< the region stays garbage
  int becomes = -1;     ///< module after a complete payload; < 0: the one it names
};

/// Slots and monitors. Throws where the sequence breaks a rule.
template <class Config>
class SwapBench : public sim::Agent {
 public:
  using Model = typename Config::Model;
  static constexpr int slots = Config::SLOTS;
  static constexpr int port_bytes = Config::CFG_W / 8;

  explicit SwapBench(const sim::SimulationOptions& options)
      : simulation_(options), memory_(simulation_.top()), random_(options.seed) {
    Model& top = simulation_.top();
    top.s_swap_valid = 0;
    top.abort_swap = 0;
    top.clear = 0;
    top.read_phase = 0;
    top.cfg_error = 0;
    top.shutdown_limit = 40;
    top.memory_limit = 50;
    simulation_.add(*this);
    simulation_.add(memory_);
    simulation_.reset();
  }

  sim::Simulation<Model>& simulation() { return simulation_; }
  sim::AxiMemory<Model>& memory() { return memory_; }
  Model& top() { return simulation_.top(); }
  SlotBehaviour& behaviour(int slot = 0) { return state_[at(slot)].behaviour; }
  int region(int slot = 0) const { return state_[at(slot)].region; }
  /// Bytes that passed the configuration port since the last request.
  const Bytes& passed() const { return passed_; }
  /// Phases since the last request, each once.
  const std::vector<SwapPhase>& phases() const { return phases_; }
  const std::vector<SwapReport>& reports() const { return reports_; }
  SwapPhase phase() { return static_cast<SwapPhase>(top().phase); }
  /// Events to be counted, since the beginning.
  std::uint64_t swaps() const { return swaps_; }
  std::uint64_t rejected() const { return rejected_; }
  std::uint64_t stalls() const { return stalls_; }
  /// Clock on which the last request was accepted.
  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t phase_clocks(SwapPhase phase) {
    top().read_phase = static_cast<CData>(phase);
    simulation_.step();
    return top().read_clocks;
  }

  /// Writes a good bitstream to memory; returns the request for it.
  SwapRequest load(int slot, ModuleId module_id, std::size_t payload_bytes, std::uint32_t address = 0x1000) {
    payload_ =
        make_payload(static_cast<std::uint8_t>(slot), module_id, payload_bytes, static_cast<std::uint32_t>(random_()));
    return load(make_bitstream(static_cast<std::uint8_t>(slot), module_id, payload_), slot, module_id, address);
  }
  /// Writes any bytes.
  SwapRequest load(const Bytes& bytes, int slot, ModuleId module_id, std::uint32_t address = 0x1000) {
    memory_.clear();
    memory_.write(address, bytes);
    return {slot, static_cast<int>(module_id), address, static_cast<std::uint32_t>(bytes.size()), false};
  }
  const Bytes& payload() const { return payload_; }

  /// Sends a request without waiting.
  void start(const SwapRequest& request) {
    if (phase() == SwapPhase::idle) {
      passed_.clear();
      phases_.clear();
    }
    requests_.push_back(request);
    simulation_.run_until([&] { return requests_.empty(); }, 10, "a request to be taken");
  }
  /// Offers requests from now on, each as soon as the one before was taken.
  void offer(const std::vector<SwapRequest>& requests) {
    requests_.insert(requests_.end(), requests.begin(), requests.end());
  }
  std::size_t waiting() const { return requests_.size(); }  ///< offered, but not taken yet
  /// Waits for its report.
  SwapReport finish(std::uint64_t max_clocks = 5000) {
    const std::size_t before = reports_.size();
    simulation_.run_until([&] { return reports_.size() > before; }, max_clocks, "a report");
    return reports_.back();
  }
  SwapReport swap(const SwapRequest& request) {
    start(request);
    return finish();
  }
  /// A good swap must work after any other one.
  void require_good_swap(int slot, ModuleId module_id, std::size_t bytes = 64) {
    const SwapRequest request = load(slot, module_id, bytes);
    behaviour(slot) = SlotBehaviour{};
    expect("code of a good swap", static_cast<int>(swap(request).code), static_cast<int>(SwapCode::ok));
    expect("bytes passed", passed_ == payload_, true);
    require_at_work(slot, module_id);
  }
  void require_at_work(int slot, ModuleId module_id) {
    simulation_.steps(4);
    expect("module", region(slot), static_cast<int>(module_id));
    expect("stop", bit(top().stop, slot), false);
    expect("decouple", bit(top().decouple, slot), false);
    expect("hold_reset", bit(top().hold_reset, slot), false);
  }
  void require_shut(int slot) {
    simulation_.steps(4);
    expect("stop", bit(top().stop, slot), true);
    expect("decouple", bit(top().decouple, slot), true);
    expect("hold_reset", bit(top().hold_reset, slot), true);
  }
  /// Reset in the middle of anything.
  void reset() {
    requests_.clear();
    simulation_.reset(1);
  }

  void drive(const sim::ClockInfo& now) override {
    Model& m = top();
    if (now.in_reset) requests_.clear();
    m.s_swap_valid = requests_.empty() ? 0 : 1;
    if (!requests_.empty()) sim::put_swap_request(m.s_swap_data, requests_.front());
    for (int i = 0; i < slots; ++i) {
      State& s = state_[at(i)];
      sim::set_bits(m.quiet, i, 1, s.quiet ? 1 : 0);
      sim::set_bits(m.decoupled, i, 1, s.decoupled ? 1 : 0);
      sim::set_bits(m.roc_busy, i, 1, s.roc_left != 0 ? 1 : 0);
      // a closed module shows anything while it is in reset, and until it has had one of its own
      std::uint64_t shown = random_() & 255U;
      if (s.region >= 0 && s.works && !bit(m.hold_reset, i) && s.roc_left == 0) {
        shown = static_cast<std::uint64_t>(s.region) ^ (clock_ < s.shows_at ? 255U : 0U);
      }
      sim::set_bits(m.region_rm_id, 8 * i, 8, shown);
      sim::set_bits(m.lost, 16 * i, 16, static_cast<std::uint64_t>(s.lost));
    }
  }

  void sample(const sim::ClockInfo& now) override {
    Model& m = top();
    ++clock_;
    if (m.s_swap_valid != 0 && m.s_swap_ready != 0 && !now.in_reset) {
      requests_.pop_front();
      if (phase() == SwapPhase::idle) accepted_ = clock_;
    }
    if (m.phase != 0 && !now.in_reset && (phases_.empty() || phases_.back() != phase())) phases_.push_back(phase());
    if (m.m_report_valid != 0 && !now.in_reset) reports_.push_back(sim::get_swap_report(m.m_report_data, clock_));
    if (m.cfg_valid != 0) pass(m);
    if (!now.in_reset) {
      // an event comes with the report that it counts
      const bool reported = m.m_report_valid != 0;
      const SwapCode code = reported ? reports_.back().code : SwapCode::same;
      expect("swapped", m.swapped != 0, reported && code == SwapCode::ok);
      expect("rejected", m.rejected != 0, reported && code != SwapCode::ok && code != SwapCode::same);
      swaps_ += m.swapped;
      rejected_ += m.rejected;
      stalls_ += m.stall;
    }
    for (int i = 0; i < slots; ++i) step(i, now.in_reset);
  }

 private:
  struct State {
    SlotBehaviour behaviour;
    int region = 0;  ///< < 0: garbage
    bool quiet = false;
    bool decoupled = false;
    int roc_left = 0;
    int lost = 0;
    int stopped = 0;           ///< clocks since stop rose
    bool transferred = false;  ///< a complete payload has passed since it was decoupled
    bool works = true;         ///< it was reset after its last word, by a reset of its own
    std::uint64_t shows_at = 0;
    bool was_decoupled = false;
  };

  static std::size_t at(int slot) { return static_cast<std::size_t>(slot); }
  template <class Port>
  static bool bit(const Port& port, int i) {
    return sim::get_bits(port, i, 1) != 0;
  }

  /// A word passes the port, which is allowed only while its slot is shut.
  void pass(Model& m) {
    sim::require(passed_.empty() || clock_ - last_word_ >= static_cast<std::uint64_t>(Config::CFG_DIVIDER),
                 "the port is faster than its clock");
    last_word_ = clock_;
    State& s = state_[at(m.phase_slot)];
    sim::require(bit(m.stop, m.phase_slot) && s.decoupled && bit(m.hold_reset, m.phase_slot),
                 "a word passes the port while the slot is not stopped, decoupled and in reset");
    for (int i = 0; i < port_bytes; ++i) {
      passed_.push_back(static_cast<std::uint8_t>(sim::get_bits(m.cfg_data, 8 * i, 8)));
    }
    s.region = -1;
    s.works = false;
    s.transferred = passed_ == payload_;
    if (s.transferred && !s.behaviour.spoilt) s.region = s.behaviour.becomes < 0 ? payload_[5] : s.behaviour.becomes;
  }

  void step(int i, bool in_reset) {
    Model& m = top();
    State& s = state_[at(i)];
    const bool stop = bit(m.stop, i);
    const bool decouple = bit(m.decouple, i);
    const bool hold = bit(m.hold_reset, i);
    if (!in_reset) {
      sim::require(!hold || decouple, "reset without decoupling");
      sim::require(!decouple || stop, "decoupled without stop");
      sim::require(!bit(m.roc_start, i) || s.transferred, "ROC without a complete payload");
      sim::require(!bit(m.roc_start, i) || !hold, "ROC under a reset that hides it");
      if (s.was_decoupled && !decouple) {
        sim::require(s.region >= 0, "garbage recoupled");
        sim::require(!hold && s.works, "recoupled without a reset on configuration");
        sim::require(s.roc_left == 0, "recoupled during ROC");
      }
      sim::require(s.region >= 0 || decouple, "garbage is not decoupled");
    }
    s.was_decoupled = decouple;
    // the slot
    s.stopped = stop ? s.stopped + 1 : 0;
    s.quiet = stop && (s.decoupled || (s.behaviour.drain >= 0 && s.stopped >= s.behaviour.drain));
    const bool follows = decouple && s.behaviour.follows;
    if (follows && !s.decoupled) s.lost = s.quiet ? 0 : s.behaviour.inside;
    if (s.behaviour.follows) s.decoupled = decouple;
    if (bit(m.roc_start, i))
      s.roc_left = s.behaviour.roc_clocks;
    else if (s.roc_left > 0 && --s.roc_left == 0 && !hold) {
      s.works = true;
      s.shows_at = clock_ + static_cast<std::uint64_t>(s.behaviour.settles);
    }
    if (in_reset) s.roc_left = 0;
  }

  sim::Simulation<Model> simulation_;
  sim::AxiMemory<Model> memory_;
  Random random_;
  std::array<State, 2> state_;
  std::deque<SwapRequest> requests_;
  std::vector<SwapReport> reports_;
  std::vector<SwapPhase> phases_;
  Bytes passed_;
  Bytes payload_;
  std::uint64_t swaps_ = 0, rejected_ = 0, stalls_ = 0;
  std::uint64_t clock_ = 0;
  std::uint64_t accepted_ = 0;
  std::uint64_t last_word_ = 0;
};

}  // namespace cchip::test

#endif
