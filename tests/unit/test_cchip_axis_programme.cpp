// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <models/cchip_axis_programme.hpp>

#include "programme_tools.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

std::uint64_t mask(defs::Field field) { return in_field(field, (1ULL << field.width) - 1); }
std::uint64_t get(std::uint64_t state, defs::Field field) { return (state & mask(field)) >> field.lsb; }

std::uint64_t with_code(std::uint64_t state, const model::State& s) {
  return (state & ~mask(defs::state_code) & ~mask(defs::state_beats)) | in_field(defs::state_code, to_bits(s.code)) |
         in_field(defs::state_beats, static_cast<std::uint64_t>(s.beats));
}

/// The state with which the controller starts a pair: certain, nothing known.
std::uint64_t start_bits(const model::State& s) {
  return with_code(in_field(defs::state_certain, 1) | in_field(defs::state_deep, s.deep) |
                       in_field(defs::state_programme, static_cast<std::uint64_t>(s.programme)),
                   s);
}

/// Walks whole programmes with made-up verdicts, the RTL's states beside the model's.
template <class Config>
class Walk {
 public:
  explicit Walk(const sim::SimulationOptions& options) : random_(options.seed), simulation_(options) {
    simulation_->s_valid = 0;
    simulation_.reset(1);
  }

  std::map<Programme, int> outcomes;  ///< by the programme that gave it
  int hits = 0;
  int open = 0;
  int deep_hits = 0;        ///< definite by depth, in DIRECTED without a warped quad
  int deep_degenerate = 0;  ///< definite by depth, in DEGENERATE
  int most_beats = 0;

  void pair(PairMode mode) {
    auto& top = simulation_.top();
    const int separated_percent = chance(random_, 50) ? 1 : 10;
    const unsigned zero_axes = random_zero_axes(random_);
    const int err = chance(random_, 30) ? 0 : static_cast<int>(random_() % 16);
    model::State state = model::first_state(options_, mode, err);
    std::uint64_t bits = start_bits(state);
    while (true) {
      const model::Verdict v = random_verdict(random_, separated_percent, zero_axes);
      present(v, bits, true);
      const model::Step step = model::advance(options_, state, v, err, found_);
      if (!step.outcome && !step.next) {  // EXHAUSTIVE: the next verdict comes at once
        state = model::following_beat(options_, state).value();
        bits = with_code(bits, state);
        continue;
      }
      // without valid nothing happens, for any verdict
      for (int clock = 1; clock < defs::programme_latency(); ++clock) {
        present(random_verdict(random_, 50, 0), random_() & ((1ULL << defs::state_w) - 1), false);
      }
      INFO("programme " << static_cast<int>(state.programme) << ", axis " << to_words(state.code) << ", beats "
                        << state.beats << ", eta " << err);
      REQUIRE((top.m_outcome != 0) == step.outcome.has_value());
      REQUIRE((top.m_proceed != 0) == step.next.has_value());
      if (step.outcome) return judge(state, *step.outcome, err);
      bits = top.m_state;
      state = *step.next;
      REQUIRE(get(bits, defs::state_programme) == static_cast<std::uint64_t>(state.programme));
      REQUIRE(get(bits, defs::state_code) == to_bits(state.code));
      REQUIRE(get(bits, defs::state_beats) == static_cast<std::uint64_t>(state.beats));
      REQUIRE((get(bits, defs::state_deep) != 0) == state.deep);
      // what the programme remembers; what NORMALS knows of nA alone shows in the plan that follows nB
      if (state.programme != Programme::normals)
        REQUIRE(get(bits, defs::state_info) ==
                (plan_bits(options_, state) & mask(defs::plan_info)) >> defs::plan_info.lsb);
      idle();
    }
  }

 private:
  /// One clock with this verdict; the verdict before it has no more influence.
  void present(const model::Verdict& v, std::uint64_t bits, bool valid) {
    auto& top = simulation_.top();
    REQUIRE(top.m_outcome == 0);
    REQUIRE(top.m_proceed == 0);
    top.s_valid = valid ? 1 : 0;
    top.s_state = bits;
    CCHIP_PUT_VERDICT(top, s_, v, static_cast<std::size_t>(defs::points(Config::VERTS_A, Config::VERTS_B)));
    simulation_.settle();
    simulation_.rise();
  }
  void idle() {
    simulation_->s_valid = 0;
    simulation_.settle();
    simulation_.rise();
  }

  void judge(const model::State& state, const model::Outcome& o, int err) {
    auto& top = simulation_.top();
    const bool illegal = state.programme == Programme::illegal;
    REQUIRE((top.m_illegal != 0) == illegal);
    REQUIRE((top.m_grid != 0) == o.grid);
    REQUIRE(top.m_witness == to_bits(o.witness));
    REQUIRE(int{top.m_beats} == o.beats);
    const bool certain = top.m_certain != 0;
    const bool definite = err == 0 ? certain || top.m_open == 0 : certain && err != defs::err_unknown;
    REQUIRE((definite && !illegal) == o.definite);
    ++outcomes[state.programme];
    hits += o.grid ? 1 : 0;
    open += top.m_open != 0 ? 1 : 0;
    const bool warped = state.sides.warped_a || state.sides.warped_b;
    deep_hits += state.programme == Programme::tetrahedron && !warped && o.definite ? 1 : 0;
    deep_degenerate += state.programme == Programme::degenerate && o.grid && o.definite && err != 0 ? 1 : 0;
    idle();
    most_beats = std::max(most_beats, o.beats);
  }

  Random random_;
  sim::Simulation<typename Config::Model> simulation_;
  model::Options options_{{Config::VERTS_A, Config::VERTS_B}, Config::WARPED_EXACT != 0};
  model::Exhaustive found_;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_axis_programme: outcome and next axis of every programme are the model's",
                        "[unit][cchip_axis_programme]", cchip_axis_programme_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Walk<TestType> walk(options);
    Random random(options.seed);
    for (int i = 0; i < 8000; ++i) {
      const auto choice = static_cast<int>(random() % 100);
      walk.pair(static_cast<PairMode>(choice < 49 ? 0 : choice < 98 ? 1 : choice < 99 ? 2 : 3));
    }
    constexpr bool tetra = TestType::VERTS_B == 4 && TestType::WARPED_EXACT != 0;
    for (const Programme p : {Programme::normals, Programme::crossing, Programme::coplanar, Programme::degenerate,
                              Programme::exhaustive, Programme::illegal}) {
      INFO("programme " << static_cast<int>(p));
      REQUIRE(walk.outcomes[p] > 30);
    }
    // without warped quads too: hits that only depth can prove
    REQUIRE(walk.outcomes[Programme::tetrahedron] > 30);
    REQUIRE(walk.deep_hits > 10);
    REQUIRE(walk.deep_degenerate > 3);
    REQUIRE((walk.open > 30) == (TestType::WARPED_EXACT == 0));
    REQUIRE(walk.hits > 1000);
    // EXHAUSTIVE to its end, then the longest programme to its end: six edges instead of a warped quad's four
    constexpr int exhaustive = defs::exhaustive_beats(TestType::VERTS_A, TestType::VERTS_B);
    constexpr int a = TestType::VERTS_A, b = TestType::VERTS_B;
    constexpr int degenerate = a * b + 3 * (a + b);
    constexpr int tetrahedron = tetra ? (a == 4 ? 4 + 4 + 36 : 4 + 6 * a) : 0;
    REQUIRE(walk.most_beats == exhaustive + std::max(degenerate, tetrahedron));
  });
}
