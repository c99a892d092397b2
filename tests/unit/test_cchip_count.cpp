// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_count.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_count: count, some and room follow every step up and down", "[unit][cchip_count]",
                        cchip_count_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    top.up = top.down = 0;
    simulation.reset();
    int count = 0;
    int empty = 0, full = 0, both = 0;
    for (int clock = 0; clock < 4000; ++clock) {
      const int drift = clock / 100 % 2 == 0 ? 70 : 30;
      top.up = count < TestType::LIMIT && chance(random, drift) ? 1 : 0;
      top.down = count > 0 && chance(random, 100 - drift) ? 1 : 0;
      top.rst = chance(random, 1) ? 1 : 0;
      simulation.settle();
      REQUIRE(int{top.count} == count);
      REQUIRE((top.some != 0) == (count > 0));
      REQUIRE((top.room != 0) == (count < TestType::LIMIT));
      empty += count == 0 ? 1 : 0;
      full += count == TestType::LIMIT ? 1 : 0;
      both += top.up & top.down;
      count = top.rst != 0 ? 0 : count + top.up - top.down;
      simulation.rise();
    }
    REQUIRE(empty > 100);
    REQUIRE(full > 100);
    if (TestType::LIMIT > 1) REQUIRE(both > 100);
  });
}
