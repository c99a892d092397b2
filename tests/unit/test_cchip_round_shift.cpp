// SPDX-License-Identifier: Apache-2.0
#include <cchip/blocks/transform.hpp>
#include <models/cchip_round_shift.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_round_shift: every shift, corners and any value", "[unit][cchip_round_shift]",
                        cchip_round_shift_configs) {
  constexpr int d_w = TestType::D_W;
  constexpr int base = TestType::BASE;
  constexpr int q_w = TestType::Q_W;
  for_two_power_ups<typename TestType::Model>([&](auto& simulation, Random& random) {
    auto& top = simulation.top();
    model::Delay<std::optional<model::RoundShift>> delay(3);
    std::array<std::size_t, 64> lost = {};
    std::size_t halves = 0;
    for (int clock = 0; clock < 40000; ++clock) {
      const int shift = static_cast<int>(random() % (TestType::SHIFT_MAX + 1));
      std::int64_t d = random_word(random, d_w);
      const int cut = std::min(base + shift, d_w - 1);
      // Multiples of what is cut, half of it, and their neighbours.
      if (chance(random, 60)) d = model::wrap(static_cast<std::uint64_t>(d) >> cut << cut, d_w);
      if (cut > 0 && chance(random, 50))
        d = model::wrap(static_cast<std::uint64_t>(d) + (std::uint64_t{1} << (cut - 1)), d_w);
      if (chance(random, 30)) d = model::wrap(static_cast<std::uint64_t>(d) + random() % 3 - 1, d_w);
      sim::set_signed(top.d, 0, d_w, d);
      sim::set_bits(top.s, 0, 6, static_cast<std::uint64_t>(shift));
      simulation.settle();
      if (const auto& expected = delay.q()) {
        REQUIRE(sim::get_signed(top.q, 0, q_w) == model::wrap(static_cast<std::uint64_t>(expected->value), q_w));
        REQUIRE((top.lost != 0) == expected->lost);
      }
      const model::RoundShift result = model::round_shift(d, base + shift);
      lost[static_cast<std::size_t>(shift)] += result.lost ? 1 : 0;
      halves += cut > 0 && (static_cast<std::uint64_t>(d) << (64 - cut)) == std::uint64_t{1} << 63 ? 1 : 0;
      delay.clock(result);
      simulation.rise();
    }
    for (int shift = base == 0 ? 1 : 0; shift <= TestType::SHIFT_MAX; ++shift)
      REQUIRE(lost[static_cast<std::size_t>(shift)] > 20);
    REQUIRE(halves > 1000);
  });
}

TEST_CASE("cchip_round_shift: the model is floor(d 2^-n + 1/2)", "[unit][cchip_round_shift]") {
  Random random(sim::seed_from_environment());
  for (int n = 0; n < 60; ++n) {
    for (int i = 0; i < 1000; ++i) {
      const std::int64_t d = random_word(random, 62);
      const model::RoundShift result = model::round_shift(d, n);
      // value 2^n - 2^(n-1) <= d < value 2^n + 2^(n-1)
      const sim::Int128 unit = sim::Int128{1} << n;
      const sim::Int128 twice = sim::Int128{2} * d - sim::Int128{2} * result.value * unit;
      REQUIRE(twice >= -unit);
      REQUIRE(twice < unit);
      REQUIRE(result.lost == (twice != 0));
    }
  }
}
