// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_delay.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_delay: q is d DEPTH clocks later, reset clears what it shall, nothing else",
                        "[unit][cchip_delay]", cchip_delay_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    // nothing: not defined
    using Value = std::optional<std::uint64_t>;
    const Value after_reset = TestType::RESET != 0 ? Value(0) : std::nullopt;
    model::Delay<Value> delay(TestType::DEPTH > 0 ? TestType::DEPTH : 1);
    std::uint64_t compared = 0;
    Bench bench([&](const sim::ClockInfo&) { sim::set_random(top.d, TestType::WIDTH, random); },
                [&](const sim::ClockInfo& now) {
                  const std::uint64_t d = sim::get_bits(top.d, 0, TestType::WIDTH);
                  const Value expected = TestType::DEPTH == 0 ? Value(d) : delay.q();
                  if (expected) {
                    expect("q", sim::get_bits(top.q, 0, TestType::WIDTH), *expected);
                    ++compared;
                  }
                  delay.clock(d);
                  if (TestType::RESET != 0 && now.in_reset) {
                    for (int i = 0; i < TestType::DEPTH; ++i) delay.clock(after_reset);
                  }
                });
    simulation.add(bench);
    simulation.reset(1);
    simulation.steps(500);
    simulation.reset(1);  // one clock must do, and registers with RESET = 0 must not notice
    simulation.steps(500);
    REQUIRE(compared >= 1000 - 2 * static_cast<std::uint64_t>(TestType::DEPTH));
  });
}
