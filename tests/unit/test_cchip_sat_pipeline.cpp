// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_sat_pipeline.hpp>

#include "../campaign/pair_source.hpp"
#include "pair_tools.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// What goes in on one clock; nothing on clocks without a valid beat.
struct BeatIn {
  std::uint64_t user = 0;
  AxisCode code;
  GridPair pair;
};

template <class Config>
class PipelineBench {
 public:
  using Model = typename Config::Model;
  static constexpr int w = Config::COORD_W;

  explicit PipelineBench(const sim::SimulationOptions& options)
      : random_(options.seed),
        simulation_(options),
        delay_(static_cast<std::size_t>(defs::pipe_latency(Config::SUBSTAGES))),
        bench_([this](const sim::ClockInfo&) { drive(); }, [this](const sim::ClockInfo& now) { sample(now); }) {
    simulation_.add(bench_);
  }

  sim::Simulation<Model>& simulation() { return simulation_; }
  /// Beats to send, one on every clock that has its turn.
  std::function<std::optional<BeatIn>()> source;
  /// Called for each verdict after it was compared.
  std::function<void(const BeatIn&, bool separated)> on_verdict = [](const BeatIn&, bool) {};

 private:
  void drive() {
    Model& top = simulation_.top();
    in_ = source();
    top.s_beat_valid = in_ ? 1 : 0;
    sim::set_random(top.s_beat_code, defs::axis_code_w, random_);
    sim::set_random(top.s_beat_user, Config::USER_W, random_);
    sim::set_random(top.s_beat_a, 9 * w, random_);
    sim::set_random(top.s_beat_b, 9 * w, random_);
    if (!in_) return;
    in_->user = sim::get_bits(top.s_beat_user, 0, Config::USER_W);
    top.s_beat_code = model::to_bits(in_->code);
    set_triangle(top.s_beat_a, in_->pair.a, w);
    set_triangle(top.s_beat_b, in_->pair.b, w);
  }

  void sample(const sim::ClockInfo& now) {
    Model& top = simulation_.top();
    if (defined_) {
      const std::optional<BeatIn>& out = delay_.q();
      expect("m_verdict_valid", top.m_verdict_valid != 0, out.has_value());
      if (out) compare(*out);
    }
    delay_.clock(in_);
    if (now.in_reset) {
      delay_.reset();
      defined_ = true;
    }
  }

  void compare(const BeatIn& beat) {
    Model& top = simulation_.top();
    const model::Verdict v = model::sat_pipeline(beat.code, beat.pair.a, beat.pair.b, w);
    expect("m_verdict_user", sim::get_bits(top.m_verdict_user, 0, Config::USER_W), beat.user);
    expect("m_verdict_separated", top.m_verdict_separated != 0, v.separated);
    expect("m_verdict_axis_zero", top.m_verdict_axis_zero != 0, v.axis_zero);
    for (unsigned i = 0; i < 3; ++i) {
      expect("m_verdict_negative", (top.m_verdict_negative >> i & 1) != 0, v.negative[i]);
      expect("m_verdict_zero", (top.m_verdict_zero >> i & 1) != 0, v.zero[i]);
    }
    sim::require(
        (top.m_verdict_separated != 0) == axis_separates(beat.code, beat.pair),
        to_words(beat.code) + ": verdict is not that of the projections of all vertices, " + describe(beat.pair));
    on_verdict(beat, top.m_verdict_separated != 0);
  }

  Random random_;
  sim::Simulation<Model> simulation_;
  model::Delay<std::optional<BeatIn>> delay_;
  Bench bench_;
  std::optional<BeatIn> in_;
  bool defined_ = false;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_sat_pipeline: every verdict on its clock, through idle clocks and resets",
                        "[unit][cchip_sat_pipeline]", cchip_sat_pipeline_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    PipelineBench<TestType> bench(options);
    campaign::PairSource pairs(TestType::COORD_W, options.seed);
    Random random(options.seed);
    int verdicts = 0;
    int separated = 0;
    bench.source = [&]() -> std::optional<BeatIn> {
      if (chance(random, 20)) return std::nullopt;
      const auto c = campaign::pair_classes[pairs.draw_class()].value;
      return BeatIn{0, model::exhaustive_axis(static_cast<int>(random() % 11)), pairs.draw(c)};
    };
    bench.on_verdict = [&](const BeatIn&, bool s) {
      ++verdicts;
      separated += s ? 1 : 0;
    };
    for (int part = 0; part < 4; ++part) {
      bench.simulation().reset(1);
      bench.simulation().steps(3000);
    }
    REQUIRE(verdicts > 8000);
    REQUIRE(separated > 500);
    REQUIRE(separated < verdicts - 500);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_sat_pipeline: each of the eleven axes is the only one that separates some pair",
                        "[unit][cchip_sat_pipeline]", cchip_sat_pipeline_configs) {
  const std::uint64_t seed = sim::seed_from_environment();
  std::vector<GridPair> pairs;
  for (int beat = 0; beat < defs::exhaustive_beats_tri_tri; ++beat) {
    pairs.push_back(pair_separated_only_by(model::exhaustive_axis(beat), TestType::COORD_W, seed));
  }
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    PipelineBench<TestType> bench(options);
    std::size_t next = 0;
    bench.source = [&]() -> std::optional<BeatIn> {
      if (next == 11 * pairs.size()) return std::nullopt;
      const std::size_t i = next++;
      return BeatIn{0, model::exhaustive_axis(static_cast<int>(i % 11)), pairs[i / 11]};
    };
    std::vector<AxisCode> separating;
    bench.on_verdict = [&](const BeatIn& beat, bool separated) {
      if (separated) separating.push_back(beat.code);
    };
    bench.simulation().reset();
    next = 0;
    bench.simulation().steps(11 * pairs.size() + 40);
    REQUIRE(separating.size() == pairs.size());
    for (std::size_t i = 0; i < separating.size(); ++i) {
      REQUIRE(separating[i] == model::exhaustive_axis(static_cast<int>(i)));
    }
  });
}
