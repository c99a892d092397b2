// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/model/stream.hpp>
#include <models/cchip_timeout.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_timeout: outputs are the model's on every clock while the limit changes",
                        "[unit][cchip_timeout]", cchip_timeout_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    model::Timeout model(TestType::DEFAULT);
    top.restart = 1;
    top.limit = 5;
    simulation.steps(2);
    model.clock(true, 5);
    int expired = 0, restarted = 0;
    for (int clock = 0; clock < 20000; ++clock) {
      const bool ticks = clock / 5000 % 2 != 0;  // a user that restarts with each expired
      if (chance(random, clock / 1000 % 2 != 0 ? 30 : 2))
        top.limit = any_limit(random, 1 + static_cast<std::uint32_t>(random() % 12));
      top.restart = ticks ? top.expired : chance(random, 8) ? 1 : 0;
      simulation.settle();
      REQUIRE(top.expired == (model.expired() ? 1 : 0));
      REQUIRE(top.elapsed == model.elapsed());
      expired += top.expired;
      restarted += top.restart;
      model.clock(top.restart != 0, top.limit);
      simulation.rise();
    }
    REQUIRE(expired > 500);
    REQUIRE(restarted > 500);
  });
}

// Without the model: what the header says of a limit that changes.
TEMPLATE_LIST_TEST_CASE("cchip_timeout: a lower limit counts at once, a higher one or 0 expires nothing early",
                        "[unit][cchip_timeout]", cchip_timeout_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random&) {
    auto& top = simulation.top();
    // elapsed on the first clock with expired = 1; 0: none in 200 clocks. The limit changes as elapsed is `when`.
    const auto expires = [&](std::uint32_t before, std::uint32_t after, std::uint32_t when) -> std::uint32_t {
      top.restart = 1;
      top.limit = before;
      simulation.steps(3);
      top.restart = 0;
      for (std::uint32_t clock = 1; clock < 200; ++clock) {
        REQUIRE(top.elapsed == clock);
        if (top.expired != 0) return clock;
        if (clock == when) top.limit = after;
        simulation.step();
      }
      return 0;
    };
    const auto bound = [](std::uint32_t limit) -> std::uint32_t {
      return limit == 0 ? static_cast<std::uint32_t>(TestType::DEFAULT) : limit;
    };
    const auto shown = [](std::uint32_t clock) { return clock < 200 ? clock : 0; };
    for (const std::uint32_t before : {0U, 1U, 2U, 3U, 20U, 60U, 1000000U, ~0U}) {
      REQUIRE(expires(before, before, 0) == shown(bound(before) < 200 ? bound(before) + 1 : 200));
      for (const std::uint32_t after : {0U, 1U, 2U, 3U, 20U, 60U, 1000000U, ~0U}) {
        for (const std::uint32_t when : {1U, 2U, 3U, 19U, 20U, 21U, 50U, 100U}) {
          CAPTURE(before, after, when);
          // the old limit was reached on or before the clock of the change, or the new one counts
          const std::uint32_t end = bound(before) <= when ? bound(before) : std::max(bound(after), when + 1);
          REQUIRE(expires(before, after, when) == (end < 199 ? end + 1 : 0));
        }
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_timeout: each bit of a limit alone gives its time", "[unit][cchip_timeout]",
                        cchip_timeout_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random&) {
    auto& top = simulation.top();
    for (int bit = 0; bit < 16; ++bit) {
      CAPTURE(bit);
      top.restart = 1;
      top.limit = 1U << bit;
      simulation.steps(2);
      top.restart = 0;
      for (std::uint32_t clock = 1; clock <= top.limit; ++clock) {
        REQUIRE((top.expired == 0 && top.elapsed == clock));
        simulation.step();
      }
      REQUIRE(top.expired == 1);
    }
  });
}
