// SPDX-License-Identifier: Apache-2.0
/// \file
/// A Verilated cchip_broad_phase_axi between a memory that holds images and a receiver of its leaf pairs.
#ifndef CCHIP_MACHINES_SIMULATED_BROAD_PHASE_HPP
#define CCHIP_MACHINES_SIMULATED_BROAD_PHASE_HPP

#include <cchip/machines/leaf_receiver.hpp>
#include <cchip/sim/axi_lines.hpp>
#include <cchip/sim/bits.hpp>
#include <cchip/sim/simulation.hpp>
#include <cstring>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cchip::sim {

/// What happened on some clocks.
struct BroadPhaseCounters {
  std::uint64_t clocks = 0;
  std::uint64_t steps = 0;
  std::uint64_t box_tests = 0;
  std::uint64_t leaf_pairs = 0;
  std::uint64_t hits = 0;  ///< lines that the cache had
  std::uint64_t misses = 0;
  std::uint64_t waits = 0;
  std::uint64_t again = 0;
  std::uint64_t beats = 0;
  std::uint64_t box_busy = 0;
  std::uint64_t lane_busy = 0;
  BroadPhaseCounters& operator+=(const BroadPhaseCounters& x) {
    clocks += x.clocks;
    steps += x.steps;
    box_tests += x.box_tests;
    leaf_pairs += x.leaf_pairs;
    hits += x.hits;
    misses += x.misses;
    waits += x.waits;
    again += x.again;
    beats += x.beats;
    box_busy += x.box_busy;
    lane_busy += x.lane_busy;
    return *this;
  }
};

/// One model, its memory and its receiver. Queries are tagged by their number in `answers()`.
/// \tparam Config names the Verilated class `Model`, DATA_W and LOCKS
template <class Config>
class SimulatedBroadPhase : private Agent {
 public:
  using Model = typename Config::Model;
  using Memory = AxiLines<Model, Config::DATA_W>;

  explicit SimulatedBroadPhase(SimulationOptions options)
      : simulation_(std::move(options)), memory_(simulation_.top(), simulation_.seed()), random_(simulation_.seed()) {
    Model& top = simulation_.top();
    top.pairs_each = 3;
    top.step_limit = 0xffffffff;
    top.open_limit = 16;
    top.memory_limit = 100000;
    top.m_done_ready = 1;
    top.invalidate_first = 0;
    top.invalidate_last = 0;
    for (int i = 0; i < Config::LOCKS; ++i) set_lock(i, 1, 0);
    simulation_.add(memory_);
    simulation_.add(*this);
    reset();
  }

  Simulation<Model>& simulation() { return simulation_; }
  Model& top() { return simulation_.top(); }
  Memory& memory() { return memory_; }
  LeafReceiverOptions& receiver() { return receiver_.options; }
  unsigned done_percent = 100;  ///< clocks on which an answer is taken
  std::size_t at_once = 0;      ///< queries that may be unanswered; 0: no limit

  /// Lines that may be read, from this one on.
  void place(std::uint64_t line, const std::vector<Line>& lines) { memory_.write(line, lines); }

  void set_lock(int range, std::uint32_t first, std::uint32_t last) {
    set_bits(top().lock_first, 32 * range, 32, first);
    set_bits(top().lock_last, 32 * range, 32, last);
  }

  /// Lines are stored as they lie in memory, so this needs a little-endian host. \returns its number
  std::size_t submit(Query query) {
    query.tag = static_cast<std::uint32_t>(answers_.size());
    waiting_.push_back(query);
    answers_.emplace_back();
    return query.tag;
  }
  std::size_t submit_line(const Line& descriptor) {
    raw_[answers_.size()] = descriptor;
    return submit(decode_query(descriptor));
  }

  const std::vector<BroadPhaseAnswer>& answers() const { return answers_; }
  /// What has happened since the last call of clear_counters().
  const BroadPhaseCounters& counters() const { return counters_; }
  void clear_counters() { counters_ = {}; }
  std::size_t unanswered() const { return open_ + waiting_.size(); }

  /// Drops everything in flight.
  void reset() {
    waiting_.clear();
    offering_ = false;
    invalidate_.reset();
    receiver_.clear();
    started_.clear();
    leaves_.reset();
    open_ = 0;
    simulation_.reset(3);
  }

  void step() { simulation_.step(); }
  void steps(std::uint64_t clocks) { simulation_.steps(clocks); }

  void invalidate(std::uint32_t first, std::uint32_t last) { invalidate_ = {first, last}; }
  bool invalidating() const { return invalidate_.has_value(); }

  /// Until every query has its answer. \throws SimulationTimeout
  void run(std::uint64_t most_clocks) {
    simulation_.run_until([this] { return unanswered() == 0; }, most_clocks, "answers to queries");
  }

 private:
  std::string waits_for() const override {
    return unanswered() == 0 ? "" : "queries without an answer: " + std::to_string(unanswered());
  }

  void drive(const ClockInfo& now) override {
    Model& m = top();
    if (!now.in_reset && !offering_ && !waiting_.empty() && (at_once == 0 || open_ < at_once)) {
      const Query& query = waiting_.front();
      const auto raw = raw_.find(query.tag);
      const Line text = raw != raw_.end() ? raw->second : encode(query);
      std::memcpy(&m.s_query, text.data(), text.size());
      offering_ = true;
    }
    m.s_query_valid = offering_ ? 1 : 0;
    const LeafReceiver::Result* result = receiver_.offer(now.clock);
    m.s_result_valid = result != nullptr ? 1 : 0;
    if (result != nullptr) {
      m.s_result_context = static_cast<CData>(result->context);
      m.s_result_epoch = static_cast<CData>(result->epoch);
      m.s_result_hits = static_cast<CData>(result->hits);
      m.s_result_open = static_cast<CData>(result->open);
      m.s_result_code = static_cast<CData>(result->code);
    }
    m.s_credit = receiver_.credit(now.clock) ? 1 : 0;
    m.m_done_ready = done_percent >= 100 || random_() % 100 < done_percent ? 1 : 0;
    m.invalidate_valid = invalidate_ ? 1 : 0;
    if (invalidate_) {
      m.invalidate_first = invalidate_->first;
      m.invalidate_last = invalidate_->second;
    }
  }

  void sample(const ClockInfo& now) override {
    if (now.in_reset) return;
    Model& m = top();
    if (offering_ && m.s_query_ready != 0) {
      answers_[waiting_.front().tag].started = simulation_.total_clocks();
      waiting_.pop_front();
      offering_ = false;
      ++open_;
    }
    if (m.m_start_valid != 0) {
      Line text;
      std::memcpy(text.data(), &m.m_start_query, text.size());
      started_[{m.m_start_context, m.m_start_epoch}] = decode_query(text);
    }
    if (m.invalidate_valid != 0 && m.invalidate_ready != 0) invalidate_.reset();
    if (leaves_) take_beat(now.clock);
    if (m.m_leaf_valid != 0) take_first_beat(now.clock);
    if (m.s_result_valid != 0 && m.s_result_ready != 0) receiver_.taken();
    if (m.m_done_valid != 0 && m.m_done_ready != 0) take_done();
    count();
  }

  void take_first_beat(std::uint64_t now) {
    const Model& m = top();
    leaves_ = LeafPair{m.m_leaf_context, m.m_leaf_epoch, m.m_leaf_kinds, m.m_leaf_failed != 0, {}};
    beats_ = 0;
    take_beat(now);
  }
  /// Eight beats on clocks behind each other, 64 bits of A's line and 64 of B's each, the lowest first.
  void take_beat(std::uint64_t now) {
    constexpr std::size_t size = 8;
    auto* to = reinterpret_cast<unsigned char*>(leaves_->lines.data());
    const auto* from = reinterpret_cast<const unsigned char*>(&top().m_leaf_lines);
    for (std::size_t object = 0; object < 2; ++object)
      std::memcpy(to + (8 * object + beats_) * size, from + object * size, size);
    if (++beats_ == 8) take_leaves(now);
  }
  void take_leaves(std::uint64_t now) {
    const LeafPair leaves = *std::exchange(leaves_, std::nullopt);
    const Query& query = started_.at({leaves.context, leaves.epoch});
    counters_.lane_busy += receiver_.take(leaves, query, now, answers_.at(query.tag));
  }

  void take_done() {
    const Model& m = top();
    DoneRecord done;
    done.tag = m.m_done_tag;
    done.code = static_cast<QueryCode>(m.m_done_code);
    done.answer = static_cast<QueryAnswer>(m.m_done_answer);
    done.steps = m.m_done_steps;
    done.pairs = m.m_done_pairs;
    if (done.tag >= answers_.size() || answers_[done.tag].done)
      throw StreamError("an answer that no query waits for, tag " + std::to_string(done.tag));
    answers_[done.tag].done = done;
    answers_[done.tag].ended = simulation_.total_clocks();
    --open_;
  }

  void count() {
    const auto ones = [](unsigned x) { return (x & 1U) + (x >> 1U & 1U); };
    const Model& m = top();
    ++counters_.clocks;
    counters_.beats += m.m_axi_rvalid != 0 && m.m_axi_rready != 0 ? 1 : 0;
    counters_.steps += m.count_step;
    counters_.box_tests += m.count_tests;
    counters_.leaf_pairs += m.count_leaf_pair;
    counters_.hits += ones(m.count_hit);
    counters_.misses += ones(m.count_miss);
    counters_.waits += ones(m.count_wait);
    counters_.again += ones(m.count_again);
    counters_.box_busy += m.count_box_busy;
  }

  Simulation<Model> simulation_;
  Memory memory_;
  std::mt19937_64 random_;
  LeafReceiver receiver_{random_};
  std::deque<Query> waiting_;
  std::map<std::size_t, Line> raw_;
  std::vector<BroadPhaseAnswer> answers_;
  std::map<std::pair<unsigned, unsigned>, Query> started_;  // by context and epoch
  std::optional<LeafPair> leaves_;                          // whose beats come
  std::size_t beats_ = 0;                                   // of them that have come
  std::optional<std::pair<std::uint32_t, std::uint32_t>> invalidate_;
  bool offering_ = false;
  std::size_t open_ = 0;
  BroadPhaseCounters counters_;
};

}  // namespace cchip::sim

#endif
