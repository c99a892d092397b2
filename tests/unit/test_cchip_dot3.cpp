// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_dot3.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_dot3: dot product modulo 2^(A_W+B_W) after the generated latency", "[unit][cchip_dot3]",
                        cchip_dot3_configs) {
  using Model = typename TestType::Model;
  constexpr int a_w = TestType::A_W;
  constexpr int b_w = TestType::B_W;
  constexpr int latency =
      defs::mul_latency(a_w, b_w) + 2 + TestType::OPERAND_REGS + TestType::PRODUCT_REGS + TestType::RESULT_REGS;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    Model& top = simulation.top();
    struct Factors {
      model::Word3 a, b;
    };
    model::Delay<std::optional<Factors>> delay(latency);
    Factors in{};
    int exact = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          in = {random_word3(random, a_w), random_word3(random, b_w)};
          set_word3(top.a, a_w, in.a);
          set_word3(top.b, b_w, in.b);
        },
        [&](const sim::ClockInfo&) {
          if (const auto factors = delay.q()) {
            const std::int64_t q = sim::get_signed(top.q, 0, a_w + b_w);
            expect("q", q, model::dot3(factors->a, factors->b, a_w, b_w));
            const sim::Int128 whole = wide_dot(factors->a, factors->b);
            const sim::Int128 bound = sim::Int128{1} << (a_w + b_w - 1);
            if (whole >= -bound && whole < bound) {  // it fits: nothing may be lost
              sim::require(q == whole, "inexact dot product");
              ++exact;
            }
          }
          delay.clock(in);
        });
    simulation.add(bench);
    simulation.steps(20000);
    REQUIRE(exact > 10000);
  });
}
