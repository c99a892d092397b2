// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <models/cchip_fifo.hpp>

#include "stream_bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_fifo: every output on every clock is the model's", "[unit][cchip_fifo]",
                        cchip_fifo_configs) {
  sweep_stream_module<typename TestType::Model, TestType::WIDTH>(
      [] { return model::Fifo<std::uint64_t>(TestType::DEPTH); });
}

TEMPLATE_LIST_TEST_CASE("cchip_fifo: throughput, DEPTH beats of room, no path through", "[unit][cchip_fifo]",
                        cchip_fifo_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    // two clocks to the other side; a single place is free again a clock after that
    const std::uint64_t expected = TestType::DEPTH == 1 ? 66 : 198;
    REQUIRE(beats_passed<Model>(options, sim::Pattern::always(), 200) == expected);
    REQUIRE(beats_until_full<Model>(options, TestType::DEPTH + 100) == TestType::DEPTH);
    require_registered_outputs<Model, TestType::WIDTH>(options);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_fifo: from any level it drains in order, a beat each clock", "[unit][cchip_fifo]",
                        cchip_fifo_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int depth = TestType::DEPTH;
    constexpr std::uint64_t mask = (std::uint64_t{1} << TestType::WIDTH) - 1;
    auto& top = simulation.top();
    top.s_valid = top.m_ready = 0;
    simulation.reset();
    simulation.steps(2);
    for (int level = depth; level > 0; level = level > 40 ? level - 17 : level - 1) {
      std::deque<std::uint64_t> inside;
      top.m_ready = 0;
      while (static_cast<int>(inside.size()) < level) {
        const std::uint64_t word = random() & mask;
        top.s_valid = 1;
        top.s_data = static_cast<std::decay_t<decltype(top.s_data)>>(word);
        simulation.settle();
        REQUIRE(top.s_ready != 0);
        inside.push_back(word);
        simulation.rise();
      }
      top.s_valid = 0;
      simulation.steps(2);
      top.m_ready = 1;
      for (; !inside.empty(); inside.pop_front()) {
        simulation.settle();
        CAPTURE(level, inside.size());
        REQUIRE(top.m_valid != 0);
        REQUIRE(std::uint64_t{top.m_data} == inside.front());
        simulation.rise();
      }
      simulation.settle();
      REQUIRE(top.m_valid == 0);
      simulation.steps(2);
    }
  });
}
