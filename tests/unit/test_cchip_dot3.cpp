// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_dot3.hpp>

#include "multiplier_bench.hpp"

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
    int exact = 0;
    stream_vectors<Model>(options, a_w, b_w, latency, [&](Model& top, const Factors<model::Word3>& factors) {
      const std::int64_t q = sim::get_signed(top.q, 0, a_w + b_w);
      expect("q", q, model::dot3(factors.a, factors.b, a_w, b_w));
      const sim::Int128 whole = wide_dot(factors.a, factors.b);
      const sim::Int128 bound = sim::Int128{1} << (a_w + b_w - 1);
      if (whole < -bound || whole >= bound) return;
      sim::require(q == whole, "inexact dot product");  // it fits: nothing may be lost
      ++exact;
    });
    REQUIRE(exact > 10000);
  });
}
