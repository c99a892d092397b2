// SPDX-License-Identifier: Apache-2.0
#include <cchip/model/primtest.hpp>
#include <deque>
#include <models/cchip_axis_controller.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// The controller with a fake pipeline behind it: every beat comes back `latency` clocks later with a random
/// verdict. Every output is compared with the model's on every clock; results are compared a second time with
/// what the verdicts of their pair say.
template <class Config>
class ControllerBench {
 public:
  ControllerBench(const sim::SimulationOptions& options, std::size_t latency, sim::Pattern pattern)
      : random_(options.seed),
        simulation_(options),
        model_(Config::CONTEXTS),
        pipeline_(latency),
        pattern_(std::move(pattern)),
        bench_([this](const sim::ClockInfo& now) { drive(now); }, [this](const sim::ClockInfo& now) { sample(now); }) {
    simulation_.add(bench_);
  }

  sim::Simulation<typename Config::Model>& simulation() { return simulation_; }
  int legal_percent = 85;  ///< of the pairs ask for EXHAUSTIVE, the others for any mode
  std::uint64_t results = 0;
  std::uint64_t illegal = 0;
  std::uint64_t hits = 0;
  std::uint64_t open = 0;
  std::uint64_t reused_contexts = 0;

 private:
  /// What the pair's verdicts have said so far.
  struct Pair {
    model::PairHeader header;
    AxisCode witness;
    bool special = false;
    int beats = 0;
  };

  void drive(const sim::ClockInfo& now) {
    auto& top = simulation_.top();
    header_ = {static_cast<std::uint16_t>(random_()),
               static_cast<int>(chance(random_, legal_percent) ? 0 : random_() % 4),
               static_cast<int>(chance(random_, 50) ? 0 : random_() % 16)};
    // an owner with a registered ready sends nothing on the first clock after reset
    const bool may_send = !now.in_reset && now.clock > 0;
    const bool room = in_flight_.size() < static_cast<std::size_t>(Config::CONTEXTS);
    top.s_pair_valid = pattern_.next() && room && may_send ? 1 : 0;
    top.s_pair_tag = header_.tag;
    top.s_pair_mode = static_cast<CData>(header_.mode);
    top.s_pair_err = static_cast<CData>(header_.err);
    const auto& verdict = pipeline_.q();
    top.s_verdict_valid = verdict ? 1 : 0;
    sim::set_random(top.s_verdict_context, Config::CONTEXT_W, random_);
    sim::set_random(top.s_verdict_code, defs::axis_code_w, random_);
    sim::set_random(top.s_verdict_separated, 1, random_);
    sim::set_random(top.s_verdict_axis_zero, 1, random_);
    sim::set_random(top.s_verdict_zero, 3, random_);
    if (!verdict) return;
    top.s_verdict_context = static_cast<CData>(verdict->beat.context);
    top.s_verdict_code = model::to_bits(verdict->beat.code);
    top.s_verdict_separated = verdict->verdict.separated ? 1 : 0;
    top.s_verdict_axis_zero = verdict->verdict.axis_zero ? 1 : 0;
    top.s_verdict_zero = 0;
    for (unsigned i = 0; i < 3; ++i) top.s_verdict_zero |= static_cast<CData>(verdict->verdict.zero[i] ? 1U << i : 0U);
  }

  void sample(const sim::ClockInfo& now) {
    auto& top = simulation_.top();
    if (defined_) compare(now);
    if (now.in_reset) {
      model_.reset();
      pipeline_.reset();
      in_flight_.clear();
      used_.clear();
      defined_ = true;
      return;
    }
    std::optional<model::ReturnedBeat> entering;
    if (top.m_beat_valid != 0) {
      model::Verdict v;
      v.separated = chance(random_, 10);
      v.axis_zero = chance(random_, 10);
      const bool all = chance(random_, 10);
      for (bool& zero : v.zero) zero = all || chance(random_, 30);
      entering = {{top.m_beat_context, model::axis_code_from_bits(top.m_beat_code)}, v};
    }
    std::optional<model::PairHeader> accepted;
    if (top.s_pair_valid != 0) {
      accepted = header_;
      in_flight_.push_back({header_, {}, false, 0});
      reused_contexts += used_[top.m_load_context]++ != 0 ? 1 : 0;
    }
    note(pipeline_.q());
    model_.clock(accepted, pipeline_.q());
    pipeline_.clock(entering);
  }

  void compare(const sim::ClockInfo& now) {
    auto& top = simulation_.top();
    expect("m_beat_valid", top.m_beat_valid != 0, model_.beat().has_value());
    if (model_.beat()) {
      expect("m_beat_context", std::size_t{top.m_beat_context}, model_.beat()->context);
      expect("m_beat_code", std::uint16_t{top.m_beat_code}, model::to_bits(model_.beat()->code));
    }
    if (top.s_pair_valid != 0) expect("m_load_context", std::size_t{top.m_load_context}, model_.load_context());
    expect("m_result_valid", top.m_result_valid != 0, model_.result().has_value());
    if (!model_.result()) return;
    const model::Result r{top.m_result_tag,
                          top.m_result_hit != 0,
                          top.m_result_grid != 0,
                          top.m_result_definite != 0,
                          model::axis_code_from_bits(top.m_result_axis),
                          top.m_result_beats};
    sim::require(r == *model_.result(), "result with tag " + std::to_string(r.tag) + " differs from the model");
    if (!now.in_reset) judge(r);
  }

  /// Pairs are answered in order; the verdicts of the oldest one come first.
  void note(const std::optional<model::ReturnedBeat>& verdict) {
    if (!verdict) return;
    Pair* pair = nullptr;
    for (Pair& p : in_flight_) {
      if (p.beats < beats(p)) {
        pair = &p;
        break;
      }
    }
    sim::require(pair != nullptr, "a beat too many");
    const AxisCode expected =
        pair->header.mode == 0 ? model::exhaustive_axis(pair->beats) : AxisCode{AxisClass::illegal, 0, 0};
    sim::require(verdict->beat.code == expected, "beat out of order: " + to_words(verdict->beat.code));
    ++pair->beats;
    if (pair->header.mode != 0) return;
    const auto& v = verdict->verdict;
    if (v.separated && pair->witness.cls == AxisClass::none) pair->witness = verdict->beat.code;
    pair->special = pair->special || (v.axis_zero && pair->beats <= 2) ||
                    (pair->beats == 1 && v.zero == std::array<bool, 3>{true, true, true});
  }
  static int beats(const Pair& p) { return p.header.mode == 0 ? defs::exhaustive_beats_tri_tri : 1; }

  void judge(const model::Result& r) {
    sim::require(!in_flight_.empty() && in_flight_.front().beats == beats(in_flight_.front()), "result too early");
    const Pair pair = in_flight_.front();
    in_flight_.pop_front();
    ++results;
    expect("tag", r.tag, pair.header.tag);
    expect("hit", r.hit, r.grid || !r.definite);
    if (pair.header.mode != 0) {
      ++illegal;
      sim::require(r.axis.cls == AxisClass::illegal && r.hit && !r.definite && r.beats == 0, "reserved mode");
      return;
    }
    expect("grid", r.grid, pair.witness.cls == AxisClass::none);
    sim::require(r.axis == pair.witness, "the witness is not the first separating axis");
    expect("beats", r.beats, defs::exhaustive_beats_tri_tri);
    expect("definite", r.definite, pair.header.err == 0 && !(pair.special && r.grid));
    hits += r.grid ? 1 : 0;
    open += r.grid && pair.special ? 1 : 0;
  }

  Random random_;
  sim::Simulation<typename Config::Model> simulation_;
  model::AxisController model_;
  model::Delay<std::optional<model::ReturnedBeat>> pipeline_;
  sim::Pattern pattern_;
  Bench bench_;
  model::PairHeader header_;
  std::deque<Pair> in_flight_;
  std::map<std::size_t, int> used_;
  bool defined_ = false;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_axis_controller: every output on every clock, for pipelines of any latency",
                        "[unit][cchip_axis_controller]", cchip_axis_controller_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    std::uint64_t illegal = 0;
    std::uint64_t hits = 0;
    std::uint64_t open = 0;
    for (const std::size_t latency : {1U, 2U, 7U, 24U, 60U}) {
      for (const sim::Pattern& pattern : sim::standard_patterns(options.seed)) {
        ControllerBench<TestType> bench(options, latency, pattern);
        for (int part = 0; part < 3; ++part) {
          bench.simulation().reset(1);
          bench.simulation().steps(1500);
        }
        INFO("latency " << latency << ", pairs " << pattern.name());
        REQUIRE(bench.results > 4000 / (latency + 20) / 5);
        REQUIRE(bench.reused_contexts + 3 * TestType::CONTEXTS >= bench.results);
        illegal += bench.illegal;
        hits += bench.hits;
        open += bench.open;
      }
    }
    REQUIRE(illegal > 100);
    REQUIRE(hits > 500);
    REQUIRE(open > 100);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_axis_controller: a beat on every clock while pairs wait",
                        "[unit][cchip_axis_controller]", cchip_axis_controller_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    // as many pairs in flight as contexts: with enough of them the round trip is hidden
    ControllerBench<TestType> bench(options, 12, sim::Pattern::always());
    bench.legal_percent = 100;
    std::uint64_t beats = 0;
    Bench counter([](const sim::ClockInfo&) {},
                  [&](const sim::ClockInfo& now) {
                    beats += !now.in_reset && now.clock >= 100 && bench.simulation()->m_beat_valid != 0 ? 1 : 0;
                  });
    bench.simulation().add(counter);
    bench.simulation().reset();
    bench.simulation().steps(1100);
    REQUIRE(bench.results > 20);
    if (TestType::CONTEXTS >= 5) REQUIRE(beats == 1000);
    if (TestType::CONTEXTS == 1) REQUIRE(beats < 500);
  });
}
