// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/model/primtest.hpp>
#include <deque>
#include <map>
#include <models/cchip_axis_controller.hpp>

#include "programme_tools.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// The controller with a fake pipeline behind it: every beat comes back `latency` clocks later with a random verdict.
/// Every output is compared with the model's on every clock. Every result is also compared with what the verdicts of
/// its pair imply, tracked for each pair alone.
template <class Config>
class ControllerBench {
 public:
  ControllerBench(const sim::SimulationOptions& options, std::size_t latency, sim::Pattern pattern)
      : random_(options.seed),
        simulation_(options),
        model_(options_, Config::CONTEXTS),
        pipeline_(latency),
        pattern_(std::move(pattern)),
        bench_([this](const sim::ClockInfo& now) { drive(now); }, [this](const sim::ClockInfo& now) { sample(now); }) {
    simulation_.add(bench_);
  }

  sim::Simulation<typename Config::Model>& simulation() { return simulation_; }
  int separated_percent = 5;
  int reserved_percent = 15;
  int exhaustive_percent = 50;  ///< of the others
  std::uint64_t results = 0;
  std::uint64_t illegal = 0;
  std::uint64_t hits = 0;
  std::uint64_t indefinite = 0;
  std::uint64_t overtaken = 0;  ///< results of pairs that are not the oldest
  std::uint64_t reused_contexts = 0;

 private:
  static constexpr std::size_t points = static_cast<std::size_t>(defs::points(Config::VERTS_A, Config::VERTS_B));
  struct Flying {
    std::uint64_t user = 0;  ///< as the RTL sent it
    model::ReturnedBeat model;
  };
  struct Pair {
    model::PairHeader header;
    std::uint64_t number = 0;
    unsigned zero_axes = 0;
    model::State state;
    model::Exhaustive found;
    std::optional<model::Outcome> outcome;
  };

  void drive(const sim::ClockInfo& now) {
    auto& top = simulation_.top();
    const auto mode = chance(random_, reserved_percent)     ? 2 + random_() % 2
                      : chance(random_, exhaustive_percent) ? 0
                                                            : 1;
    top.s_pair_tag = header_.tag;  // of the pair before
    top.s_pair_err = static_cast<CData>(header_.err);
    // without its logic mode EXHAUSTIVE is a reserved one
    const auto meant = Config::EXHAUSTIVE == 0 && mode == 0 ? 2 : mode;
    header_ = {static_cast<std::uint16_t>(random_()), static_cast<PairMode>(meant),
               static_cast<int>(chance(random_, 50) ? 0 : random_() % 16)};
    // the first context is ready on the third clock after reset
    const bool may_send = !now.in_reset && now.clock > 1;
    const bool room = in_flight_.size() + (left_before_ + left_earlier_) < static_cast<std::size_t>(Config::CONTEXTS);
    top.s_pair_valid = pattern_.next() && room && may_send ? 1 : 0;
    top.s_pair_mode = static_cast<CData>(mode);
    const auto& flying = pipeline_.q();
    top.s_verdict_valid = flying ? 1 : 0;
    const model::Verdict v = flying ? flying->model.verdict : random_verdict(random_, 50, 0);
    CCHIP_PUT_VERDICT(top, s_verdict_, v, points);
    top.s_verdict_user =
        flying ? flying->user : random_() & ((std::uint64_t{1} << (Config::CONTEXT_W + defs::state_w)) - 1);
  }

  void sample(const sim::ClockInfo& now) {
    auto& top = simulation_.top();
    left_earlier_ = left_before_;
    left_before_ = 0;
    if (defined_) compare(now);
    if (now.in_reset) {
      model_.reset();
      pipeline_.reset();
      in_flight_.clear();
      done_.clear();
      used_.clear();
      defined_ = true;
      return;
    }
    std::optional<Flying> entering;
    if (top.m_beat_valid != 0) {
      const unsigned zero_axes = in_flight_.at(top.m_beat_context).zero_axes;
      entering = Flying{top.m_beat_user, {*model_.beat(), random_verdict(random_, separated_percent, zero_axes)}};
    }
    if (const auto& flying = pipeline_.q()) follow(flying->model);
    std::optional<model::PairHeader> accepted;
    if (top.s_pair_valid != 0) {
      accepted = header_;
      const std::size_t context = top.m_load_context;
      sim::require(in_flight_.count(context) == 0, "a context is handed out twice");
      in_flight_[context] = {
          header_, sent_++, random_zero_axes(random_), model::first_state(options_, header_.mode, header_.err), {}, {}};
      reused_contexts += used_[context]++ != 0 ? 1 : 0;
    }
    const auto& flying = pipeline_.q();
    model_.clock(accepted, flying ? std::optional(flying->model) : std::nullopt);
    pipeline_.clock(entering);
  }

  void compare(const sim::ClockInfo& now) {
    auto& top = simulation_.top();
    expect("m_beat_valid", top.m_beat_valid != 0, model_.beat().has_value());
    if (const auto& beat = model_.beat()) {
      const AxisBeat expected = model::beat_of(beat->state, 0);
      expect("m_beat_context", std::size_t{top.m_beat_context}, beat->context);
      expect("m_beat_code", std::uint16_t{top.m_beat_code}, to_bits(expected.code));
    }
    if (allowed_) {  // by the beat of the clock before
      expect("m_beat_allow_above", top.m_beat_allow_above != 0, allowed_->allow_above);
      expect("m_beat_allow_below", top.m_beat_allow_below != 0, allowed_->allow_below);
    }
    allowed_ = model_.beat() ? std::optional(model::beat_of(model_.beat()->state, 0)) : std::nullopt;
    if (top.s_pair_valid != 0) expect("m_load_context", std::size_t{top.m_load_context}, model_.load_context());
    expect("m_result_valid", top.m_result_valid != 0, model_.result().has_value());
    if (!model_.result()) return;
    const PairResult r{top.m_result_tag,
                       top.m_result_hit != 0,
                       top.m_result_grid != 0,
                       top.m_result_definite != 0,
                       axis_code_from_bits(top.m_result_axis),
                       top.m_result_beats};
    sim::require(r == *model_.result(), "result with tag " + std::to_string(r.tag) + " differs from the model");
    if (!now.in_reset) judge(r);
  }
  using AxisBeat = model::AxisBeat;

  /// A pair by itself: its beats come in the order of its programme.
  void follow(const model::ReturnedBeat& returned) {
    const auto found = in_flight_.find(returned.beat.context);
    sim::require(found != in_flight_.end() && !found->second.outcome, "a beat too many");
    Pair& pair = found->second;
    sim::require(returned.beat.state.code == pair.state.code,
                 "beat out of order: " + to_words(returned.beat.state.code));
    const model::Step step = model::advance(options_, pair.state, returned.verdict, pair.header.err, pair.found);
    if (step.outcome) {
      pair.outcome = step.outcome;
      done_.push_back(found->first);
      for (const auto& [context, other] : in_flight_) overtaken += other.number < pair.number && !other.outcome ? 1 : 0;
    } else {
      pair.state = step.next ? *step.next : model::following_beat(options_, pair.state).value();
    }
  }

  void judge(const PairResult& r) {
    sim::require(!done_.empty(), "a result without its verdict");
    const Pair pair = in_flight_.at(done_.front());
    in_flight_.erase(done_.front());
    left_before_ = 1;
    done_.pop_front();
    ++results;
    const model::Outcome& o = *pair.outcome;
    expect("tag", r.tag, pair.header.tag);
    expect("grid", r.grid, o.grid);
    expect("definite", r.definite, o.definite);
    expect("hit", r.hit, r.grid || !r.definite);
    expect("beats", r.beats, o.beats);
    sim::require(r.axis == o.witness, "wrong witness");
    if (pair.header.mode > PairMode::directed) {
      ++illegal;
      sim::require(r.axis.cls == AxisClass::illegal && r.hit && !r.definite && r.beats == 0, "reserved mode");
      return;
    }
    hits += r.grid ? 1 : 0;
    indefinite += r.definite ? 0 : 1;
  }

  model::Options options_{{Config::VERTS_A, Config::VERTS_B}, Config::WARPED_EXACT != 0};
  Random random_;
  sim::Simulation<typename Config::Model> simulation_;
  model::AxisController model_;
  model::Delay<std::optional<Flying>> pipeline_;
  sim::Pattern pattern_;
  Bench bench_;
  model::PairHeader header_;
  std::map<std::size_t, Pair> in_flight_;  ///< by context, until its result
  std::deque<std::size_t> done_;           ///< decided contexts whose results are on their way
  std::map<std::size_t, int> used_;
  std::uint64_t sent_ = 0;
  std::optional<AxisBeat> allowed_;
  std::size_t left_before_ = 0;   ///< results that left on the clock before: their context is not free yet
  std::size_t left_earlier_ = 0;  ///< and on the clock before that
  bool defined_ = false;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_axis_controller: every output on every clock, for pipelines of any latency",
                        "[unit][cchip_axis_controller]", cchip_axis_controller_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    std::uint64_t illegal = 0;
    std::uint64_t hits = 0;
    std::uint64_t indefinite = 0;
    std::uint64_t overtaken = 0;
    for (const std::size_t latency : {1U, 2U, 7U, 24U, 60U}) {
      for (const sim::Pattern& pattern : sim::standard_patterns(options.seed)) {
        ControllerBench<TestType> bench(options, latency, pattern);
        bench.separated_percent = latency == 7 ? 40 : 5;
        for (int part = 0; part < 3; ++part) {
          bench.simulation().reset(1);
          bench.simulation().steps(1200);
        }
        INFO("latency " << latency << ", pairs " << pattern.name());
        REQUIRE(bench.results > 0);
        REQUIRE(bench.reused_contexts + 3 * TestType::CONTEXTS >= bench.results);
        illegal += bench.illegal;
        hits += bench.hits;
        indefinite += bench.indefinite;
        overtaken += bench.overtaken;
      }
    }
    REQUIRE(illegal > 100);
    REQUIRE(hits > 150);
    REQUIRE(indefinite > 100);
    REQUIRE((overtaken > 100) == (TestType::CONTEXTS > 1));
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_axis_controller: a beat on every clock while pairs wait",
                        "[unit][cchip_axis_controller]", cchip_axis_controller_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    for (const int exhaustive_percent : {100, 50, 0}) {
      // as many pairs in flight as contexts: with enough of them the round trip is hidden
      ControllerBench<TestType> bench(options, 12, sim::Pattern::always());
      bench.reserved_percent = 0;
      bench.exhaustive_percent = exhaustive_percent;
      std::uint64_t beats = 0;
      Bench counter([](const sim::ClockInfo&) {},
                    [&](const sim::ClockInfo& now) {
                      beats += !now.in_reset && now.clock >= 100 && bench.simulation()->m_beat_valid != 0 ? 1 : 0;
                    });
      bench.simulation().add(counter);
      bench.simulation().reset();
      bench.simulation().steps(2100);
      REQUIRE(bench.results > 5);
      if (TestType::CONTEXTS == 42) REQUIRE(beats >= 1990);
      if (TestType::CONTEXTS == 1) REQUIRE(beats < 1600);
    }
  });
}
