// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_programme_exhaustive.hpp>

#include "programme_tools.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_programme_exhaustive: what the verdicts of a pair have shown is the model's",
                        "[unit][cchip_programme_exhaustive]", cchip_programme_exhaustive_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    constexpr bool tetrahedron = TestType::TETRAHEDRON != 0;
    const model::Options o{{4, 4}, tetrahedron};
    Random random(options.seed);
    sim::Simulation<typename TestType::Model> simulation(options);
    auto& top = simulation.top();
    top.s_valid = 0;
    simulation.reset(1);
    REQUIRE(top.m_valid == 0);
    top.s_valid = 1;  // a verdict on the clock of a reset does not count
    simulation.reset(1);
    REQUIRE(top.m_valid == 0);
    top.s_valid = 0;
    int hits = 0, gaps = 0, plans = 0, tetrahedra = 0, deep_hits = 0;
    for (int i = 0; i < 5000; ++i) {
      const int separated_percent = chance(random, 50) ? 1 : 10;
      const unsigned zero_axes = random_zero_axes(random);
      // Eta 1: a certain answer is definite, no other is.
      model::State state = model::first_state(o, PairMode::exhaustive, 1);
      model::Exhaustive found;
      while (true) {
        const model::Verdict v = random_verdict(random, separated_percent, zero_axes);
        const model::Step step = model::advance(o, state, v, 1, found);
        const auto following = model::following_beat(o, state);
        top.s_valid = 1;
        top.s_normal_a = state.code.cls == AxisClass::normal_a ? 1 : 0;
        top.s_normal_b = state.code.cls == AxisClass::normal_b ? 1 : 0;
        top.s_last = following ? 0 : 1;
        top.s_code = to_bits(state.code);
        top.s_separated = v.compare.separated ? 1 : 0;
        top.s_certain_gap = v.compare.certain_gap ? 1 : 0;
        top.s_sign_certain = v.compare.certain ? 1 : 0;
        top.s_sign_negative = v.compare.negative[2] ? 1 : 0;  // vertex VERTS_A - 2
        top.s_deep = v.compare.deep || v.zero_axis() ? 1 : 0;
        top.s_certain_sides = found.sides.certain ? 1 : 0;
        top.s_plan = static_cast<IData>(plan_bits(o, found.plan));
        simulation.settle();
        simulation.rise();
        INFO("pair " << i << ", axis " << to_words(state.code));
        REQUIRE(top.m_valid != 0);
        REQUIRE((top.m_separated != 0) == found.separated);
        REQUIRE(top.m_witness == to_bits(found.witness));
        REQUIRE((top.m_deep != 0) == found.deep);
        // Without a gap certainty means something for the two axes of CROSSING only.
        if (found.separated || (state.code.cls == AxisClass::cross && found.plan.programme == Programme::crossing)) {
          const bool warped = found.sides.warped_a || found.sides.warped_b;
          const bool certain_hit = found.certain || (found.deep && !warped);
          REQUIRE((top.m_certain != 0) == (found.separated ? found.certain_gap : certain_hit));
        }
        REQUIRE((top.m_outcome != 0) == step.outcome.has_value());
        REQUIRE((top.m_proceed != 0) == step.next.has_value());
        if (step.outcome) {
          REQUIRE((top.m_certain != 0) == step.outcome->definite);
          deep_hits += !found.separated && !found.certain && step.outcome->definite ? 1 : 0;
          ++(found.separated ? gaps : hits);
          break;
        }
        if (step.next) {
          const bool to_tetrahedron = found.plan.programme == Programme::crossing;
          REQUIRE((top.m_to_tetrahedron != 0) == to_tetrahedron);
          REQUIRE(top.m_plan == plan_bits(o, found.plan));
          ++(to_tetrahedron ? tetrahedra : plans);
          break;
        }
        state = following.value();
      }
      // Between two pairs anything may be on the inputs, as long as it is not valid.
      for (std::uint64_t n = random() % 3; n > 0; --n) {
        top.s_valid = 0;
        top.s_normal_a = chance(random, 50) ? 1 : 0;
        top.s_normal_b = chance(random, 50) ? 1 : 0;
        top.s_separated = chance(random, 50) ? 1 : 0;
        top.s_plan = static_cast<IData>(random() & ((1U << defs::plan_w) - 1));
        simulation.settle();
        simulation.rise();
        REQUIRE(top.m_valid == 0);
      }
    }
    REQUIRE(hits > 100);
    REQUIRE(gaps > 100);
    REQUIRE(deep_hits > 30);
    REQUIRE(plans > 100);
    REQUIRE((tetrahedra > 100) == tetrahedron);
  });
}
