// SPDX-License-Identifier: Apache-2.0
#include <cchip/blocks/reconfig.hpp>
#include <models/cchip_roc_generator.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_roc_generator: the model's output on every clock, from power-up on",
                        "[unit][cchip_roc_generator]", cchip_roc_generator_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    model::RocGenerator model(TestType::CYCLES);
    top.rst = 0;  // no reset at first: power-up counts as a configuration
    top.configured = 0;
    int resets = 0;
    bool before = true;
    for (int clock = 0; clock < 3000; ++clock) {
      if (clock > 2 * TestType::CYCLES) {
        const bool dense = clock / 300 % 2 == 1;
        top.configured = chance(random, dense ? 30 : 2) ? 1 : 0;
        top.rst = chance(random, 1) ? 1 : 0;
      }
      simulation.settle();
      REQUIRE((top.roc != 0) == model.roc());
      resets += !before && model.roc() ? 1 : 0;
      before = model.roc();
      model.clock(top.rst != 0, top.configured != 0);
      simulation.rise();
    }
    REQUIRE(resets > 10);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_roc_generator: a pulse makes exactly CYCLES clocks, a level as many after it",
                        "[unit][cchip_roc_generator]", cchip_roc_generator_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    sim::Simulation<typename TestType::Model> simulation(options);
    auto& top = simulation.top();
    top.configured = 0;
    simulation.reset();
    simulation.steps(TestType::CYCLES + 1);
    for (const int level : {1, 2, 7}) {
      int high = 0;
      for (int clock = 0; clock < 100; ++clock) {
        top.configured = clock < level ? 1 : 0;
        simulation.settle();
        const bool expected = clock >= 1 && clock < level + TestType::CYCLES;
        REQUIRE((top.roc != 0) == expected);
        high += top.roc;
        simulation.rise();
      }
      REQUIRE(high == level - 1 + TestType::CYCLES);
    }
  });
}
