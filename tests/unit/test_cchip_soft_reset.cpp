// SPDX-License-Identifier: Apache-2.0
// The reset of a core whose bus masters work on: a scoreboard of the rule in the header, on every clock.
#include <models/cchip_soft_reset.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_soft_reset: it lasts until memory has owed nothing for CLOCKS clocks",
                        "[unit][cchip_soft_reset]", cchip_soft_reset_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    top.request = top.outstanding = 0;
    simulation.reset();
    bool resetting = false, done = false;
    int quiet = 0;  // clocks in a row without anything owed since the request
    int ended = 0, anew = 0, longest = 0;
    for (int clock = 0; clock < 200 * TestType::CLOCKS + 20000; ++clock) {
      const bool cut = random() % 2000 == 0;  // rst in the middle
      top.rst = cut ? 1 : 0;
      top.request = random() % static_cast<std::uint64_t>(2 * TestType::CLOCKS) == 0 ? 1 : 0;
      top.outstanding = clock / (TestType::CLOCKS * 20) % 2 == 0 && chance(random, 20) ? 1 : 0;
      simulation.settle();
      REQUIRE((top.resetting != 0) == resetting);
      REQUIRE((top.done != 0) == done);
      const bool was = resetting;
      quiet = top.outstanding != 0 ? 0 : quiet + 1;
      done = was && quiet >= TestType::CLOCKS && top.request == 0;
      resetting = (was && quiet < TestType::CLOCKS) || top.request != 0;
      if (top.request != 0) {
        anew += was ? 1 : 0;
        quiet = 0;
      }
      if (cut) resetting = done = false;
      ended += done ? 1 : 0;
      longest = std::max(longest, quiet);
      simulation.rise();
    }
    REQUIRE(ended > 10);
    REQUIRE(anew > 10);
    // memory that never answers: it never ends
    top.rst = 0;
    top.request = 1;
    top.outstanding = 1;
    simulation.step();
    top.request = 0;
    for (int clock = 0; clock < 5000; ++clock) {
      simulation.step();
      REQUIRE(top.resetting == 1);
    }
    top.rst = 1;
    simulation.step();
    simulation.settle();
    REQUIRE(top.resetting == 0);
  });
}
