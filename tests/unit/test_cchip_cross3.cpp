// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_cross3.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_cross3: cross product after the generated latency", "[unit][cchip_cross3]",
                        cchip_cross3_configs) {
  using Model = typename TestType::Model;
  constexpr int e_w = TestType::E_W;
  constexpr int latency =
      defs::mul_latency(e_w, e_w) + 1 + TestType::OPERAND_REGS + TestType::PRODUCT_REGS + TestType::RESULT_REGS;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    Model& top = simulation.top();
    struct Factors {
      model::Word3 a, b;
    };
    model::Delay<std::optional<Factors>> delay(latency);
    Factors in{};
    int orthogonal = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          in = {random_word3(random, e_w), random_word3(random, e_w)};
          set_word3(top.a, e_w, in.a);
          set_word3(top.b, e_w, in.b);
        },
        [&](const sim::ClockInfo&) {
          if (const auto factors = delay.q()) {
            const model::Word3 q = get_word3(top.q, 2 * e_w);
            sim::require(q == model::cross3(factors->a, factors->b, e_w), "cross product differs from the model");
            const std::int64_t least = -(std::int64_t{1} << (e_w - 1));
            const auto within = [&](const model::Word3& w) { return w[0] > least && w[1] > least && w[2] > least; };
            if (within(factors->a) && within(factors->b)) {  // exact there: orthogonal to both factors
              sim::require(wide_dot(q, factors->a) == 0 && wide_dot(q, factors->b) == 0, "not orthogonal");
              ++orthogonal;
            }
          }
          delay.clock(in);
        });
    simulation.add(bench);
    simulation.steps(20000);
    REQUIRE(orthogonal > 10000);
  });
}
