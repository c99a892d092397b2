// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tests of modules with ports s_valid/ready/data and m_valid/ready/data.
#ifndef CCHIP_TESTS_UNIT_STREAM_BENCH_HPP
#define CCHIP_TESTS_UNIT_STREAM_BENCH_HPP

#include <array>
#include <type_traits>
#include <utility>

#include "bench.hpp"

namespace cchip::test {

/// Whether a module has the input `stop`.
template <class Model, class = void>
struct HasStop : std::false_type {};
template <class Model>
struct HasStop<Model, std::void_t<decltype(std::declval<Model&>().stop)>> : std::true_type {};
template <class Model>
void set_stop(Model& top, bool stop) {
  if constexpr (HasStop<Model>::value) top.stop = stop ? 1 : 0;
}

/// Inputs under all pairs of idle and back-pressure patterns, with resets in mid traffic; compares every output
/// on every clock with the model that `make_model` returns.
template <class Model, int WIDTH, class MakeModel>
void sweep_stream_module(MakeModel make_model) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    for (const sim::Pattern& source : sim::standard_patterns(options.seed)) {
      for (const sim::Pattern& sink : sim::standard_patterns(options.seed + 100)) {
        sim::Pattern offer = source;
        sim::Pattern accept = sink;
        Random random(options.seed);
        sim::Simulation<Model> simulation(options);
        Model& top = simulation.top();
        auto model = make_model();
        bool defined = false;  // after the first clock of reset
        bool offered = false;
        std::uint64_t passed = 0;
        Bench bench(
            [&](const sim::ClockInfo&) {
              if (!offered) {
                offered = offer.next();
                sim::set_random(top.s_data, WIDTH, random);
              }
              top.s_valid = offered ? 1 : 0;
              top.m_ready = accept.next() ? 1 : 0;
            },
            [&](const sim::ClockInfo& now) {
              if (defined) {
                expect("s_ready", top.s_ready != 0, model.s_ready());
                expect("m_valid", top.m_valid != 0, model.m_valid());
                if (model.m_valid()) expect("m_data", sim::get_bits(top.m_data, 0, WIDTH), model.m_data());
              }
              if (now.in_reset) {
                model.reset();
                offered = false;
                defined = true;
                return;
              }
              if (top.s_ready != 0) offered = false;
              passed += top.m_valid != 0 && top.m_ready != 0 ? 1 : 0;
              model.clock(top.s_valid != 0, sim::get_bits(top.s_data, 0, WIDTH), top.m_ready != 0);
            });
        simulation.add(bench);
        for (int part = 0; part < 3; ++part) {
          simulation.reset(1);
          simulation.steps(400);
        }
        INFO("source " << source.name() << ", sink " << sink.name());
        REQUIRE(passed > 20);
      }
    }
  });
}

/// Beats that leave within `clocks` clocks after reset, sink always ready.
template <class Model>
std::uint64_t beats_passed(const sim::SimulationOptions& options, sim::Pattern source, std::uint64_t clocks) {
  sim::Simulation<Model> simulation(options);
  Model& top = simulation.top();
  set_stop(top, false);
  std::uint64_t passed = 0;
  bool offered = false;
  Bench bench(
      [&](const sim::ClockInfo&) {
        offered = offered || source.next();
        top.s_valid = offered ? 1 : 0;
        top.s_data = 0;
        top.m_ready = 1;
      },
      [&](const sim::ClockInfo&) {
        if (top.s_ready != 0) offered = false;
        passed += top.m_valid;
      });
  simulation.reset();
  simulation.step();  // ready rises on the first clock after reset
  simulation.add(bench);
  simulation.steps(clocks);
  return passed;
}

/// Beats accepted while m_ready stays 0.
template <class Model>
std::uint64_t beats_until_full(const sim::SimulationOptions& options, std::uint64_t clocks = 200) {
  sim::Simulation<Model> simulation(options);
  Model& top = simulation.top();
  set_stop(top, false);
  std::uint64_t accepted = 0;
  Bench bench(
      [&](const sim::ClockInfo&) {
        top.s_valid = 1;
        top.m_ready = 0;
      },
      [&](const sim::ClockInfo& now) { accepted += !now.in_reset && top.s_ready != 0 ? 1 : 0; });
  simulation.add(bench);
  simulation.reset();
  simulation.steps(clocks);
  return accepted;
}

/// No output may follow an input before the rising edge.
template <class Model, int WIDTH>
void require_registered_outputs(const sim::SimulationOptions& options) {
  Random random(options.seed);
  sim::Simulation<Model> simulation(options);
  Model& top = simulation.top();
  const auto drive = [&] {
    set_stop(top, chance(random, 20));
    top.s_valid = random() & 1;
    top.m_ready = random() & 1;
    sim::set_random(top.s_data, WIDTH, random);
  };
  const auto outputs = [&] {
    return std::array<std::uint64_t, 3>{top.s_ready, top.m_valid, sim::get_bits(top.m_data, 0, WIDTH)};
  };
  simulation.reset();
  for (int clock = 0; clock < 500; ++clock) {
    drive();
    simulation.settle();
    const auto before = outputs();
    for (int i = 0; i < 4; ++i) {
      drive();
      top.rst = random() & 1;
      top.eval();
      REQUIRE(outputs() == before);
    }
    top.rst = 0;
    top.eval();
    simulation.rise();
  }
}

}  // namespace cchip::test

#endif
