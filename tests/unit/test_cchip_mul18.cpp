// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <models/cchip_mul18.hpp>

#include "multiplier_bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEST_CASE("cchip_mul18: exact products after two clocks", "[unit][cchip_mul18]") {
  compare_multiplier<Vcchip_mul18>(18, 18, defs::mul18_latency, 100000);
}

TEST_CASE("cchip_mul18: exact products of unsigned factors", "[unit][cchip_mul18]") {
  for_two_power_ups<Vcchip_mul18_unsigned>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    std::deque<std::uint64_t> expected(defs::mul18_latency, 0);  // oldest first
    for (int clock = 0; clock < 20000; ++clock) {
      const auto factor = [&] { return chance(random, 30) ? 0x3FFFF - random() % 2 : random() % 0x40000; };
      const std::uint64_t a = factor();
      const std::uint64_t b = factor();
      top.a = static_cast<IData>(a);
      top.b = static_cast<IData>(b);
      expected.push_back(a * b);
      simulation.settle();
      if (clock >= defs::mul18_latency) REQUIRE(top.p == expected.front());
      expected.pop_front();
      simulation.rise();
    }
  });
}
