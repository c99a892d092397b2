// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <models/cchip_phase_clocks.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {
constexpr unsigned phases = 16;  // codes
}

TEST_CASE("cchip_phase_clocks: clocks of the phases of random swaps", "[unit][cchip_phase_clocks]") {
  using Model = cchip_phase_clocks::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    top.clear = 0;
    top.phase = 0;
    simulation.reset();
    const auto require_clocks = [&](const std::array<std::uint64_t, phases>& clocks) {
      for (unsigned phase = 0; phase < phases; ++phase) {
        top.read_phase = static_cast<CData>(phase);
        simulation.step();
        REQUIRE(top.read_clocks == clocks[phase]);
      }
    };
    require_clocks({});
    int cleared = 0;
    for (int round = 0; round < 500; ++round) {
      std::array<std::uint64_t, phases> clocks{};
      // Codes of no phase, too: the block knows IDLE alone.
      const auto begin = chance(random, 50) ? 1U : 1U + static_cast<unsigned>(random() % (phases - 1));
      for (unsigned phase = begin; phase < phases; ++phase) {
        if (phase > begin && chance(random, 30)) continue;
        top.phase = static_cast<CData>(phase);
        const std::uint64_t first = chance(random, 50) ? 1 : static_cast<std::uint32_t>(random());
        const std::uint64_t last = first + random() % 20;
        for (std::uint64_t clock = first; clock <= last; ++clock) {
          top.elapsed = static_cast<IData>(clock);
          top.clear = chance(random, 1) ? 1 : 0;
          simulation.step();
          clocks[phase] = static_cast<std::uint32_t>(clock);
          if (top.clear != 0) clocks.fill(0);
          // the phase in progress can be read as well
          top.read_phase = static_cast<CData>(phase);
        }
        top.clear = 0;
      }
      top.phase = 0;
      top.elapsed = static_cast<IData>(random());
      simulation.steps(1 + random() % 3);
      require_clocks(clocks);
      if (chance(random, 10)) {
        (chance(random, 50) ? top.clear : top.rst) = 1;
        simulation.step();
        top.clear = 0;
        top.rst = 0;
        require_clocks({});
        ++cleared;
      }
    }
    REQUIRE(cleared > 10);
  });
}
