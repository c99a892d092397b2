// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_mul18_ecp5.h>
#include <Vcchip_mul18_portable.h>

#include "../unit/bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEST_CASE("MULT18X18D: the leaf on the block's model does what the portable leaf does", "[unit][gates]") {
  constexpr int width = 18;
  sim::SimulationOptions options;
  Random random(options.seed);
  sim::Simulation<Vcchip_mul18_portable> portable(options);
  sim::Simulation<Vcchip_mul18_ecp5> block(options);

  std::vector<std::pair<std::int64_t, std::int64_t>> factors;
  for (const std::int64_t a : extremes(width)) {
    for (const std::int64_t b : extremes(width)) factors.emplace_back(a, b);
  }
  for (int i = 0; i < 100000; ++i) factors.emplace_back(random_word(random, width), random_word(random, width));

  std::size_t clock = 0;
  for (const auto& [a, b] : factors) {
    sim::set_signed(portable->a, 0, width, a);
    sim::set_signed(portable->b, 0, width, b);
    sim::set_signed(block->a, 0, width, a);
    sim::set_signed(block->b, 0, width, b);
    portable.settle();
    block.settle();
    if (clock >= static_cast<std::size_t>(defs::mul18_latency) && portable->p != block->p) {
      const auto& [x, y] = factors[clock - static_cast<std::size_t>(defs::mul18_latency)];
      FAIL("clock " << clock << ", " << x << " * " << y << ": portable " << portable->p << ", block " << block->p);
    }
    portable.rise();
    block.rise();
    ++clock;
  }
  REQUIRE(clock > 100000);
}
