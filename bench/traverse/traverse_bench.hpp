// SPDX-License-Identifier: Apache-2.0
/// \file
/// cchip_broad_phase_axi between a memory that holds images and a receiver that tests leaf pairs as the functional
/// model does.
#ifndef CCHIP_BENCH_TRAVERSE_BENCH_HPP
#define CCHIP_BENCH_TRAVERSE_BENCH_HPP

#include <algorithm>
#include <cchip/bvh/image.hpp>
#include <cchip/model/leaf_pair.hpp>
#include <cchip/model/programme.hpp>
#include <cchip/sim/bits.hpp>
#include <cchip/sim/simulation.hpp>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace cchip::testing {

/// What memory does with a read.
enum class ReadFault : std::uint8_t { none, slave_error, silence };

struct MemoryOptions {
  std::uint64_t latency = 60;      ///< clocks from the address to the first beat, at least
  std::uint64_t jitter = 0;        ///< up to so many more, at random
  bool reorder = false;            ///< reads that are due are answered in any order
  std::uint64_t beat_every = 1;    ///< clocks
  unsigned address_percent = 100;  ///< clocks on which an address is taken
};

struct ReceiverOptions {
  std::uint64_t transform = 28;  ///< clocks from a leaf pair to the first axis of its first primitives
  std::uint64_t ahead = 64;      ///< clocks of work that wait in front of the lane
  std::uint64_t first = 41;      ///< clocks from an axis to what becomes of it, of a pair's first one and of the others
  std::uint64_t others = 35;
  std::uint64_t jitter = 0;  ///< up to so many more, at random
  bool held = false;         ///< gives no results
  bool only_hits = false;    ///< holds back the results without a definite hit, and their room
  bool all_open = false;     ///< no hit is definite
};

/// Outcome of a query.
struct Answer {
  std::optional<DoneRecord> done;
  std::vector<PairRecord> pairs;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> leaf_pairs;  ///< lines of A and of B
  std::uint64_t started = 0;                                        ///< clocks
  std::uint64_t ended = 0;
};

struct Counters {
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
  Counters& operator+=(const Counters& x) {
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
template <class Config>
class TraverseBench {
 public:
  using Model = typename Config::Model;

  explicit TraverseBench(sim::SimulationOptions options)
      : simulation_(std::move(options)), random_(simulation_.seed()) {
    Model& top = simulation_.top();
    top.pairs_each = 3;
    top.step_limit = 0xffffffff;
    top.open_limit = 16;
    top.memory_limit = 100000;
    top.s_query_valid = 0;
    top.s_result_valid = 0;
    top.s_credit = 0;
    top.m_done_ready = 1;
    top.m_axi_arready = 0;
    top.m_axi_rvalid = 0;
    top.invalidate_valid = 0;
    top.invalidate_first = 0;
    top.invalidate_last = 0;
    for (int i = 0; i < Config::LOCKS; ++i) set_lock(i, 1, 0);
    reset();
  }

  sim::Simulation<Model>& simulation() { return simulation_; }
  Model& top() { return simulation_.top(); }
  MemoryOptions memory;
  ReceiverOptions receiver;
  /// Of each read; by default none.
  std::function<ReadFault(std::uint64_t line)> fault = [](std::uint64_t) { return ReadFault::none; };
  unsigned done_percent = 100;  ///< clocks on which an answer is taken
  std::size_t at_once = 0;      ///< queries that may be unanswered; 0: no limit

  /// Lines that may be read, from this one on.
  void place(std::uint64_t line, const std::vector<Line>& lines) {
    for (const Line& x : lines) lines_[line++] = x;
  }
  Line& line(std::uint64_t number) { return lines_.at(number); }

  void set_lock(int range, std::uint32_t first, std::uint32_t last) {
    sim::set_bits(top().lock_first, 32 * range, 32, first);
    sim::set_bits(top().lock_last, 32 * range, 32, last);
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

  const std::vector<Answer>& answers() const { return answers_; }
  /// What has happened since the last call of clear_counters().
  const Counters& counters() const { return counters_; }
  void clear_counters() { counters_ = {}; }
  std::size_t unanswered() const { return open_ + waiting_.size(); }

  /// Forgets everything in flight.
  void reset() {
    waiting_.clear();
    offering_ = false;
    invalidate_.reset();
    reads_.clear();
    burst_.reset();
    results_.clear();
    given_.reset();
    started_.clear();
    simulation_.reset(3);
    open_ = 0;
    asked_ = false;
    lane_free_ = 0;
    credits_.clear();
    next_beat_ = 0;
  }

  void steps(std::uint64_t clocks) {
    for (std::uint64_t i = 0; i < clocks; ++i) step();
  }

  void invalidate(std::uint32_t first, std::uint32_t last) { invalidate_ = {first, last}; }
  bool invalidating() const { return invalidate_.has_value(); }

  /// Until every query has its answer. \throws SimulationTimeout
  void run(std::uint64_t most_clocks) {
    for (std::uint64_t i = 0; unanswered() > 0; ++i) {
      if (i == most_clocks) {
        throw sim::SimulationTimeout("queries without an answer: " + std::to_string(unanswered()) + "; reads owed " +
                                     std::to_string(reads_.size()));
      }
      step();
    }
  }

  void step() {
    Model& m = top();
    const std::uint64_t now = now_++;
    drive(m, now);
    simulation_.settle();
    sample(m, now);
    simulation_.rise();
    ++counters_.clocks;
  }

 private:
  struct Read {
    unsigned id = 0;
    std::uint64_t line = 0;
    std::uint64_t due = 0;
    bool okay = true;
  };
  struct Result {
    std::uint64_t due = 0;
    unsigned context = 0;
    unsigned epoch = 0;
    unsigned hits = 0;
    unsigned open = 0;
    QueryCode code = QueryCode::ok;
  };
  static constexpr int beats_of_line = 512 / Config::DATA_W;

  bool chance(unsigned percent) { return percent >= 100 || random_() % 100 < percent; }

  void drive(Model& m, std::uint64_t now) {
    // queries
    if (!offering_ && !waiting_.empty() && (at_once == 0 || open_ < at_once)) {
      const Query& query = waiting_.front();
      const auto raw = raw_.find(query.tag);
      const Line text = raw != raw_.end() ? raw->second : encode(query);
      std::memcpy(&m.s_query, text.data(), text.size());
      offering_ = true;
    }
    m.s_query_valid = offering_ ? 1 : 0;
    // memory
    m.m_axi_arready = chance(memory.address_percent) ? 1 : 0;
    if (!burst_ && now >= next_beat_) {
      std::vector<std::size_t> due;
      for (std::size_t i = 0; i < reads_.size() && (memory.reorder || due.empty()); ++i) {
        if (reads_[i].due <= now) due.push_back(i);
        if (!memory.reorder) break;
      }
      if (!due.empty()) {
        const std::size_t pick = due[memory.reorder ? random_() % due.size() : 0];
        burst_ = reads_[pick];
        const auto found = lines_.find(burst_->line);
        burst_->okay = burst_->okay && found != lines_.end();
        if (found != lines_.end()) data_ = found->second;
        beat_ = 0;
        reads_.erase(reads_.begin() + static_cast<std::ptrdiff_t>(pick));
      }
    }
    const bool beat = burst_ && now >= next_beat_;
    m.m_axi_rvalid = beat ? 1 : 0;
    if (beat) {
      m.m_axi_rid = static_cast<CData>(burst_->id);
      m.m_axi_rlast = beat_ == beats_of_line - 1 ? 1 : 0;
      m.m_axi_rresp = burst_->okay ? 0 : 2;
      std::memcpy(&m.m_axi_rdata, data_.data() + beat_ * (Config::DATA_W / 8), Config::DATA_W / 8);
    }
    // results
    if (!given_ && !receiver.held) {
      const auto ready = std::find_if(results_.begin(), results_.end(), [this, now](const Result& r) {
        return r.due <= now && (!receiver.only_hits || r.hits > 0);
      });
      if (ready != results_.end()) {
        given_ = *ready;
        results_.erase(ready);
      }
    }
    m.s_result_valid = given_ ? 1 : 0;
    if (given_) {
      const Result& r = *given_;
      m.s_result_context = static_cast<CData>(r.context);
      m.s_result_epoch = static_cast<CData>(r.epoch);
      m.s_result_hits = static_cast<CData>(r.hits);
      m.s_result_open = static_cast<CData>(r.open);
      m.s_result_code = static_cast<CData>(r.code);
    }
    const bool credit = !receiver.held && !credits_.empty() && credits_.front() <= now;
    m.s_credit = credit ? 1 : 0;
    if (credit) credits_.pop_front();
    m.m_done_ready = chance(done_percent) ? 1 : 0;
    m.invalidate_valid = invalidate_ ? 1 : 0;
    if (invalidate_) {
      m.invalidate_first = invalidate_->first;
      m.invalidate_last = invalidate_->second;
    }
  }

  void sample(Model& m, std::uint64_t now) {
    if (offering_ && m.s_query_ready != 0) {
      answers_[waiting_.front().tag].started = now;
      waiting_.pop_front();
      offering_ = false;
      ++open_;
    }
    if (m.m_start_valid != 0) {
      Line text;
      std::memcpy(text.data(), &m.m_start_query, text.size());
      started_[{m.m_start_context, m.m_start_epoch}] = decode_query(text);
    }
    // memory
    if (m.m_axi_arvalid != 0) {
      const std::uint64_t line = m.m_axi_araddr / 64;
      if (asked_ && line != asked_line_) throw sim::StreamError("m_axi_araddr changed before it was accepted");
      if (m.m_axi_araddr % 64 != 0 || m.m_axi_arlen != beats_of_line - 1 || m.m_axi_arburst != 1)
        throw sim::StreamError("m_axi_ar: not a burst of one line");
      asked_ = m.m_axi_arready == 0;
      asked_line_ = line;
      if (m.m_axi_arready != 0) {
        const ReadFault what = fault(line);
        const std::uint64_t jitter = memory.jitter == 0 ? 0 : random_() % (memory.jitter + 1);
        if (what != ReadFault::silence)
          reads_.push_back({m.m_axi_arid, line, now + memory.latency + jitter, what == ReadFault::none});
      }
    } else if (asked_) {
      throw sim::StreamError("m_axi_arvalid was taken back");
    }
    if (m.m_axi_rvalid != 0 && m.m_axi_rready != 0) {
      ++counters_.beats;
      next_beat_ = now + memory.beat_every;
      if (++beat_ == beats_of_line) burst_.reset();
    }
    if (m.invalidate_valid != 0 && m.invalidate_ready != 0) invalidate_.reset();
    // leaf pairs
    if (m.m_leaf_valid != 0) take_leaves(m, now);
    if (m.s_result_valid != 0 && m.s_result_ready != 0) given_.reset();
    // answers
    if (m.m_done_valid != 0 && m.m_done_ready != 0) {
      DoneRecord done;
      done.tag = m.m_done_tag;
      done.code = static_cast<QueryCode>(m.m_done_code);
      done.answer = static_cast<QueryAnswer>(m.m_done_answer);
      done.steps = m.m_done_steps;
      done.pairs = m.m_done_pairs;
      if (done.tag >= answers_.size() || answers_[done.tag].done)
        throw sim::StreamError("an answer that nobody waits for, tag " + std::to_string(done.tag));
      answers_[done.tag].done = done;
      answers_[done.tag].ended = now;
      --open_;
    }
    counters_.steps += m.count_step;
    counters_.box_tests += m.count_tests;
    counters_.leaf_pairs += m.count_leaf_pair;
    counters_.hits += ones(m.count_hit);
    counters_.misses += ones(m.count_miss);
    counters_.waits += ones(m.count_wait);
    counters_.again += ones(m.count_again);
    counters_.box_busy += m.count_box_busy;
  }

  static unsigned ones(unsigned x) { return (x & 1U) + (x >> 1U & 1U); }

  /// The primitive tests of a leaf pair: what the functional model says, after the clocks of a lane that takes an
  /// axis per clock.
  void take_leaves(Model& m, std::uint64_t now) {
    const unsigned context = m.m_leaf_context;
    const unsigned epoch = m.m_leaf_epoch;
    Result result{now, context, epoch, 0, 0, QueryCode::ok};
    const Query& query = started_.at({context, epoch});
    Answer& answer = answers_.at(query.tag);
    std::array<Line, 2> lines{};
    std::memcpy(lines.data(), &m.m_leaf_lines, sizeof(lines));
    const auto kind_a = static_cast<bvh::NodeKind>(m.m_leaf_kinds & 3);
    const auto kind_b = static_cast<bvh::NodeKind>(m.m_leaf_kinds >> 2);
    std::uint64_t beats = 1;
    std::uint64_t most = 1;
    if (m.m_leaf_failed != 0) {
      result.code = QueryCode::memory;
    } else {
      const bvh::LeafLine a = bvh::decode_leaf(lines[0], kind_a);
      const bvh::LeafLine b = bvh::decode_leaf(lines[1], kind_b);
      answer.leaf_pairs.emplace_back(a.id[0], b.id[0]);
      if (a.extent > bvh::extent_max || b.extent > bvh::extent_max) {
        result.code = QueryCode::corrupt;
      } else {
        beats = 0;
        const model::MovedLeaves moved = model::move_leaves(a, kind_a, b, kind_b, query);
        bool finished = false;
        for (std::size_t i = 0; i < bvh::primitives_in(kind_a) && !finished; ++i) {
          for (std::size_t j = 0; j < bvh::primitives_in(kind_b) && !finished; ++j) {
            GridPair pair = model::normalise(moved, kind_a, i, kind_b, j, defs::coord_w_default);
            if (pair.a.kind > pair.b.kind) std::swap(pair.a, pair.b);
            model::Options options;
            options.shape = {pair.a.vertex_count(), pair.b.vertex_count()};
            const model::Outcome outcome =
                model::run_programme(options, pair, PairMode::directed, defs::coord_w_default);
            beats += static_cast<std::uint64_t>(outcome.beats);
            most = std::max(most, static_cast<std::uint64_t>(outcome.beats));
            if (!outcome.hit()) continue;
            std::uint32_t id_a = a.id[i];
            std::uint32_t id_b = b.id[j];
            if (query.swapped) std::swap(id_a, id_b);
            const bool definite = outcome.definite && !receiver.all_open;
            answer.pairs.push_back({query.tag, id_a, id_b, definite});
            if (definite) {
              ++result.hits;
              finished = query.mode == QueryMode::first;
            } else {
              ++result.open;
            }
          }
        }
      }
    }
    // it makes room for the next one as soon as not too much waits in front of the lane
    credits_.push_back(std::max(lane_free_, now + receiver.ahead) - receiver.ahead);
    lane_free_ = std::max(lane_free_, now + receiver.transform) + beats;
    counters_.lane_busy += beats;
    result.due = lane_free_ + receiver.first + receiver.others * (most - 1);
    if (receiver.jitter != 0) result.due += random_() % (receiver.jitter + 1);
    const auto place = std::upper_bound(results_.begin(), results_.end(), result.due,
                                        [](std::uint64_t due, const Result& r) { return due < r.due; });
    results_.insert(place, result);
  }

  sim::Simulation<Model> simulation_;
  std::mt19937_64 random_;
  std::map<std::uint64_t, Line> lines_;
  std::deque<Query> waiting_;
  std::map<std::size_t, Line> raw_;
  std::vector<Answer> answers_;
  std::map<std::pair<unsigned, unsigned>, Query> started_;  // by context and epoch
  std::deque<Read> reads_;
  std::optional<Read> burst_;
  Line data_{};
  int beat_ = 0;
  std::uint64_t next_beat_ = 0;
  bool asked_ = false;
  std::uint64_t asked_line_ = 0;
  std::deque<Result> results_;
  std::optional<Result> given_;
  std::optional<std::pair<std::uint32_t, std::uint32_t>> invalidate_;
  std::deque<std::uint64_t> credits_;
  std::uint64_t lane_free_ = 0;
  bool offering_ = false;
  std::size_t open_ = 0;
  std::uint64_t now_ = 0;  ///< clocks since construction
  Counters counters_;
};

}  // namespace cchip::testing

#endif
