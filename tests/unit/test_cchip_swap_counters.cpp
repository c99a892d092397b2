// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <models/cchip_swap_counters.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEST_CASE("cchip_swap_counters: counts of random swaps", "[unit][cchip_swap_counters]") {
  using Model = cchip_swap_counters::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    top.clear = 0;
    top.phase = 0;
    top.report_valid = 0;
    top.stall = 0;
    simulation.reset();
    std::uint32_t swaps = 0;
    std::uint32_t rejected = 0;
    std::uint32_t stalls = 0;
    for (int round = 0; round < 300; ++round) {
      std::array<std::uint64_t, 9> clocks{};
      for (unsigned phase = 1; phase <= 9; ++phase) {
        if (phase > 1 && phase < 9 && chance(random, 30)) continue;
        clocks[phase - 1] = 1 + random() % 20;
        top.phase = static_cast<CData>(phase);
        for (std::uint64_t clock = 0; clock < clocks[phase - 1]; ++clock) {
          top.elapsed = static_cast<IData>(clock + 1);
          top.report_valid = chance(random, 10) ? 1 : 0;
          top.report_code = static_cast<CData>(random() % 16);
          top.stall = static_cast<CData>(random() % 2);
          const auto code = static_cast<SwapCode>(top.report_code);
          if (top.report_valid != 0 && code == SwapCode::ok) ++swaps;
          if (top.report_valid != 0 && code != SwapCode::ok && code != SwapCode::same) ++rejected;
          stalls += top.stall;
          simulation.step();
        }
      }
      top.phase = 0;
      top.report_valid = 0;
      top.stall = 0;
      simulation.steps(1 + random() % 3);
      for (int phase = 0; phase < 9; ++phase) {
        REQUIRE(sim::get_bits(top.phase_clocks, 32 * phase, 32) == clocks[static_cast<std::size_t>(phase)]);
      }
      REQUIRE(top.swaps == swaps);
      REQUIRE(top.rejected == rejected);
      REQUIRE(top.stalls == stalls);
      if (chance(random, 5)) {
        top.clear = 1;
        simulation.step();
        top.clear = 0;
        swaps = rejected = stalls = 0;
        REQUIRE(top.swaps == 0);
        REQUIRE(sim::get_bits(top.phase_clocks, 0, 32) == 0);
      }
    }
  });
}
