// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_cross3.hpp>

#include "multiplier_bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_cross3: cross product after the generated latency", "[unit][cchip_cross3]",
                        cchip_cross3_configs) {
  using Model = typename TestType::Model;
  constexpr int e_w = TestType::E_W;
  constexpr int latency =
      defs::mul_latency(e_w, e_w) + 1 + TestType::OPERAND_REGS + TestType::PRODUCT_REGS + TestType::RESULT_REGS;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    int orthogonal = 0;
    stream_vectors<Model>(options, e_w, e_w, latency, [&](Model& top, const Factors<model::Word3>& factors) {
      const model::Word3 q = get_word3(top.q, 2 * e_w);
      sim::require(q == model::cross3(factors.a, factors.b, e_w), "cross product differs from the model");
      const std::int64_t least = -(std::int64_t{1} << (e_w - 1));
      const auto within = [&](const model::Word3& w) { return w[0] > least && w[1] > least && w[2] > least; };
      if (!within(factors.a) || !within(factors.b)) return;  // exact there: orthogonal to both factors
      sim::require(wide_dot(q, factors.a) == 0 && wide_dot(q, factors.b) == 0, "not orthogonal");
      ++orthogonal;
    });
    REQUIRE(orthogonal > 10000);
  });
}
