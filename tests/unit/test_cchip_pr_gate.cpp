// SPDX-License-Identifier: Apache-2.0
#include <cchip/model/reconfig.hpp>
#include <models/cchip_pr_gate.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_pr_gate: every output on every clock is the model's, closed, stopped and open",
                        "[unit][cchip_pr_gate]", cchip_pr_gate_configs) {
  constexpr int width = TestType::WIDTH;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    int held = 0;  // stopped with a beat inside
    for (const sim::Pattern& source : sim::standard_patterns(options.seed)) {
      for (const sim::Pattern& sink : sim::standard_patterns(options.seed + 100)) {
        sim::Pattern offer = source;
        sim::Pattern accept = sink;
        Random random(options.seed);
        sim::Simulation<typename TestType::Model> simulation(options);
        auto& top = simulation.top();
        model::Gate<std::uint64_t> model;
        int passed = 0;
        int closed = 0;
        for (int clock = 0; clock < 1200; ++clock) {
          top.close = clock < 1 || (clock / 200 % 2 == 1 && clock % 40 < 5) ? 1 : 0;
          top.stop = clock / 200 % 3 == 1 && clock % 50 < 20 ? 1 : 0;
          top.s_valid = offer.next() ? 1 : 0;
          sim::set_random(top.s_data, width, random);
          top.m_ready = accept.next() ? 1 : 0;
          simulation.settle();
          if (clock > 0) {
            REQUIRE((top.s_ready != 0) == model.s_ready());
            REQUIRE((top.m_valid != 0) == model.m_valid());
            const std::uint64_t data = sim::get_bits(top.m_data, 0, width);
            if (model.m_valid()) REQUIRE(data == model.m_data());
            if (model.closed()) REQUIRE(data == 0);
            passed += top.m_valid & top.m_ready;
            closed += model.closed() ? 1 : 0;
            held += top.stop != 0 && model.m_valid() && !model.s_ready() ? 1 : 0;
          }
          model.clock(top.close != 0, top.stop != 0, top.s_valid != 0, sim::get_bits(top.s_data, 0, width),
                      top.m_ready != 0);
          simulation.rise();
        }
        INFO("source " << source.name() << ", sink " << sink.name());
        REQUIRE(passed > 20);
        REQUIRE(closed > 50);
      }
    }
    REQUIRE(held > 100);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_gate: no output follows an input before the rising edge", "[unit][cchip_pr_gate]",
                        cchip_pr_gate_configs) {
  constexpr int width = TestType::WIDTH;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    sim::Simulation<typename TestType::Model> simulation(options);
    auto& top = simulation.top();
    const auto drive = [&] {
      top.close = chance(random, 10) ? 1 : 0;
      top.stop = chance(random, 20) ? 1 : 0;
      top.s_valid = random() & 1;
      top.m_ready = random() & 1;
      sim::set_random(top.s_data, width, random);
    };
    const auto outputs = [&] {
      return std::vector<std::uint64_t>{top.s_ready, top.m_valid, sim::get_bits(top.m_data, 0, width)};
    };
    drive();
    top.close = 1;
    simulation.settle();
    simulation.rise();
    for (int clock = 0; clock < 500; ++clock) {
      drive();
      simulation.settle();
      const auto before = outputs();
      for (int i = 0; i < 4; ++i) {
        drive();
        top.eval();
        REQUIRE(outputs() == before);
      }
      simulation.rise();
    }
  });
}
