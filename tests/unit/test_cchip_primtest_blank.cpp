// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_primtest_blank.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEST_CASE("cchip_primtest_blank: constant outputs, never ready, never valid, idle", "[unit][cchip_primtest_blank]") {
  using Model = cchip_primtest_blank::Model;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    sim::PairPort<Model> port(simulation.top(), cchip_primtest_blank::COORD_W);
    Model& top = simulation.top();
    for (int clock = 0; clock < 500; ++clock) {
      port.scramble(random);
      top.rst = random() & 1;
      top.s_pair_valid = random() & 1;
      top.m_result_ready = random() & 1;
      simulation.settle();
      for (int phase = 0; phase < 2; ++phase) {
        REQUIRE(top.s_pair_ready == 0);
        REQUIRE(top.m_result_valid == 0);
        REQUIRE(top.idle == 1);
        REQUIRE(int{top.rm_id} == static_cast<int>(ModuleId::blank));
        REQUIRE(port.result() == PairResult{});
        simulation.rise();
      }
    }
  });
}
