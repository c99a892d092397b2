// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tests of modules with inputs a, b and output p = a * b.
#ifndef CCHIP_TESTS_UNIT_MULTIPLIER_BENCH_HPP
#define CCHIP_TESTS_UNIT_MULTIPLIER_BENCH_HPP

#include "bench.hpp"

namespace cchip::test {

/// All pairs of extreme factors, then random ones: p is their product `latency` clocks later, on every clock.
/// The product is that of 128-bit arithmetic and, up to 64 bits, also the model's.
template <class Model>
void compare_multiplier(int a_w, int b_w, int latency, std::uint64_t random_pairs) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    std::vector<std::pair<std::int64_t, std::int64_t>> corners;
    for (const std::int64_t a : extremes(a_w)) {
      for (const std::int64_t b : extremes(b_w)) corners.emplace_back(a, b);
    }
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    Model& top = simulation.top();
    struct Factors {
      std::int64_t a, b;
    };
    model::Delay<std::optional<Factors>> delay(static_cast<std::size_t>(latency));
    Factors in{};
    std::uint64_t compared = 0;
    std::size_t next_corner = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          in = next_corner < corners.size() ? Factors{corners[next_corner].first, corners[next_corner].second}
                                            : Factors{random_word(random, a_w), random_word(random, b_w)};
          ++next_corner;
          sim::set_signed(top.a, 0, a_w, in.a);
          sim::set_signed(top.b, 0, b_w, in.b);
        },
        [&](const sim::ClockInfo&) {
          if (const auto factors = delay.q()) {
            const sim::Int128 p = sim::get_signed_wide(top.p, 0, a_w + b_w);
            const std::string text = std::to_string(factors->a) + " * " + std::to_string(factors->b);
            sim::require(p == sim::Int128{factors->a} * factors->b, "wrong product of " + text);
            if (a_w + b_w <= 64) {
              sim::require(p == model::mul_wide(factors->a, factors->b, a_w, b_w), "model differs for " + text);
            }
            ++compared;
          }
          delay.clock(in);
        });
    simulation.add(bench);
    simulation.steps(corners.size() + random_pairs + static_cast<std::uint64_t>(latency));
    REQUIRE(compared == corners.size() + random_pairs);
  });
}

}  // namespace cchip::test

#endif
