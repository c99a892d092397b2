// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_norm1.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_norm1: sum of absolute values, all corners", "[unit][cchip_norm1]",
                        cchip_norm1_configs) {
  using Model = typename TestType::Model;
  constexpr int v_w = TestType::V_W;
  const auto list = extremes(v_w);
  const std::size_t corners = list.size() * list.size() * list.size();
  for_two_power_ups<Model>([&](auto& simulation, Random& random) {
    auto& top = simulation.top();
    model::Delay<std::optional<model::Word3>> delay(static_cast<std::size_t>(defs::norm1_latency()));
    model::Word3 in{};
    std::size_t next = 0;
    std::size_t compared = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          const std::size_t n = list.size();
          in = next < corners ? model::Word3{list[next % n], list[next / n % n], list[next / n / n]}
                              : random_word3(random, v_w);
          ++next;
          set_word3(top.v, v_w, in);
        },
        [&](const sim::ClockInfo&) {
          if (const auto& v = delay.q()) {
            std::uint64_t sum = 0;
            for (const std::int64_t x : *v) sum += static_cast<std::uint64_t>(x < 0 ? -x : x);
            expect("q", sim::get_bits(top.q, 0, v_w + 1), sum);
            ++compared;
          }
          delay.clock(in);
        });
    simulation.add(bench);
    simulation.steps(corners + 2000);
    REQUIRE(compared == corners + 2000 - static_cast<std::size_t>(defs::norm1_latency()));
  });
}
