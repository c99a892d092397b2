// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tests of multipliers: modules whose output is a function of a and b some clocks before.
#ifndef CCHIP_TESTS_UNIT_MULTIPLIER_BENCH_HPP
#define CCHIP_TESTS_UNIT_MULTIPLIER_BENCH_HPP

#include "bench.hpp"

namespace cchip::test {

template <class Factor>
struct Factors {
  Factor a, b;
};

/// On every clock `put(top, draw())` sets the inputs; `latency` clocks later `check(top, factors)` looks at the output.
/// \return number of checks
template <class Factor, class Model, class Draw, class Put, class Check>
std::uint64_t stream_factors(sim::Simulation<Model>& simulation, int latency, std::uint64_t clocks, Draw draw, Put put,
                             Check check) {
  model::Delay<std::optional<Factors<Factor>>> delay(static_cast<std::size_t>(latency));
  Factors<Factor> in{};
  std::uint64_t checked = 0;
  Bench bench(
      [&](const sim::ClockInfo&) {
        in = draw();
        put(simulation.top(), in);
      },
      [&](const sim::ClockInfo&) {
        if (const auto factors = delay.q()) {
          check(simulation.top(), *factors);
          ++checked;
        }
        delay.clock(in);
      });
  simulation.add(bench);
  simulation.steps(clocks);
  return checked;
}

/// The same for vectors of three words, random ones with many extremes among them, of `a_w` and `b_w` bits.
template <class Model, class Check>
void stream_vectors(const sim::SimulationOptions& options, int a_w, int b_w, int latency, Check check) {
  using Vectors = Factors<model::Word3>;
  Random random(options.seed);
  sim::Simulation<Model> simulation(options);
  stream_factors<model::Word3>(
      simulation, latency, 20000,
      [&] {
        return Vectors{random_word3(random, a_w), random_word3(random, b_w)};
      },
      [&](Model& top, const Vectors& in) {
        set_word3(top.a, a_w, in.a);
        set_word3(top.b, b_w, in.b);
      },
      check);
}

/// All pairs of extreme factors, then random ones: p is their product `latency` clocks later, on every clock.
/// The product is that of 128-bit arithmetic and, up to 64 bits, also the model's.
template <class Model>
void compare_multiplier(int a_w, int b_w, int latency, std::uint64_t random_pairs) {
  using Words = Factors<std::int64_t>;
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    std::vector<Words> corners;
    for (const std::int64_t a : extremes(a_w)) {
      for (const std::int64_t b : extremes(b_w)) corners.push_back({a, b});
    }
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    std::size_t next_corner = 0;
    const std::uint64_t compared = stream_factors<std::int64_t>(
        simulation, latency, corners.size() + random_pairs + static_cast<std::uint64_t>(latency),
        [&] {
          return next_corner < corners.size() ? corners[next_corner++]
                                              : Words{random_word(random, a_w), random_word(random, b_w)};
        },
        [&](Model& top, const Words& in) {
          sim::set_signed(top.a, 0, a_w, in.a);
          sim::set_signed(top.b, 0, b_w, in.b);
        },
        [&](Model& top, const Words& factors) {
          const sim::Int128 p = sim::get_signed_wide(top.p, 0, a_w + b_w);
          const std::string text = std::to_string(factors.a) + " * " + std::to_string(factors.b);
          sim::require(p == sim::Int128{factors.a} * factors.b, "wrong product of " + text);
          if (a_w + b_w > 64) return;
          sim::require(p == model::mul_wide(factors.a, factors.b, a_w, b_w), "model differs for " + text);
        });
    REQUIRE(compared == corners.size() + random_pairs);
  });
}

}  // namespace cchip::test

#endif
