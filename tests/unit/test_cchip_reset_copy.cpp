// SPDX-License-Identifier: Apache-2.0
// The copy of a reset: delayed by a clock, and 1 after power-up.
#include <models/cchip_reset_copy.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_reset_copy: the reset a clock later, and in reset after power-up",
                        "[unit][cchip_reset_copy]", cchip_reset_copy_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    bool copy = true;
    for (int clock = 0; clock < 1000; ++clock) {
      const bool reset = random() & 1;
      top.rst = reset ? 1 : 0;
      simulation.settle();
      CAPTURE(clock);
      REQUIRE((top.rst_copy != 0) == copy);
      simulation.rise();
      copy = reset;
    }
  });
}
