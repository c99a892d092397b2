// SPDX-License-Identifier: Apache-2.0
// The boundary of a region: both streams as queues, everything else as the header of the RTL specifies.
#include <cchip/model/stream.hpp>
#include <models/cchip_pr_decoupler.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using Bits = std::vector<std::uint64_t>;

template <class Port>
Bits bits(const Port& port, int width) {
  Bits found;
  for (int done = 0; done < width; done += 64) {
    found.push_back(sim::get_bits(port, done, width - done < 64 ? width - done : 64));
  }
  return found;
}
bool all_zero(const Bits& bits) {
  return std::all_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word == 0; });
}

/// Pins of a decoupler, and random values on all inputs but the controls.
template <class Config>
struct Pins {
  static constexpr int pair_w = defs::request_w(Config::COORD_W);
  typename Config::Model& top;

  Bits pair_in() const { return bits(top.s_pair_data, pair_w); }
  Bits pair_out() const { return bits(top.r_pair_data, pair_w); }
  Bits result_in() const { return {top.r_result_data}; }
  Bits result_out() const { return {top.m_result_data}; }
  Bits outputs() const {
    Bits b{top.decoupled, top.s_pair_ready, top.m_result_valid, top.r_pair_valid, top.r_result_ready,
           top.rm_id,     top.idle};
    for (const Bits& more : {pair_out(), result_out()}) b.insert(b.end(), more.begin(), more.end());
    return b;
  }
  void scramble(Random& random) {
    top.s_pair_valid = random() & 1;
    sim::set_random(top.s_pair_data, pair_w, random);
    top.m_result_ready = random() & 1;
    top.r_pair_ready = random() & 1;
    top.r_result_valid = random() & 1;
    sim::set_random(top.r_result_data, defs::result_w, random);
    top.r_rm_id = chance(random, 10) ? 0 : static_cast<CData>(random());
    top.r_idle = random() & 1;
  }
};

template <class Config>
struct Rig {
  Random random;
  sim::Simulation<typename Config::Model> simulation;
  typename Config::Model& top;
  Pins<Config> pins;
  explicit Rig(const sim::SimulationOptions& options)
      : random(options.seed), simulation(options), top(simulation.top()), pins{top} {}
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_pr_decoupler: every output on every clock, inputs of both sides random",
                        "[unit][cchip_pr_decoupler]", cchip_pr_decoupler_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Rig<TestType> rig(options);
    auto& top = rig.top;
    model::SkidBuffer<Bits> pairs;
    model::SkidBuffer<Bits> results;
    bool decoupled = false;
    int rm_id = 0;
    bool idle = true;
    int constant = 0;
    int pairs_through = 0;
    int results_through = 0;
    for (int clock = 0; clock < 8000; ++clock) {
      rig.pins.scramble(rig.random);
      top.rst = clock < 1 || chance(rig.random, 1) ? 1 : 0;
      top.stop = clock / 100 % 4 == 1 ? 1 : 0;
      top.decouple = clock / 100 % 4 == 2 ? 1 : 0;
      if (clock / 1000 % 2 == 1) top.decouple = chance(rig.random, 20) ? 1 : 0;  // flickers
      rig.simulation.settle();
      if (clock > 0) {
        REQUIRE((top.decoupled != 0) == decoupled);
        REQUIRE((top.s_pair_ready != 0) == pairs.s_ready());
        REQUIRE((top.r_pair_valid != 0) == pairs.m_valid());
        if (pairs.m_valid()) REQUIRE(rig.pins.pair_out() == pairs.m_data());
        REQUIRE((top.r_result_ready != 0) == results.s_ready());
        REQUIRE((top.m_result_valid != 0) == results.m_valid());
        if (results.m_valid()) REQUIRE(rig.pins.result_out() == results.m_data());
        REQUIRE(int{top.rm_id} == rm_id);
        REQUIRE((top.idle != 0) == idle);
        if (decoupled) {
          ++constant;
          REQUIRE(top.s_pair_ready == 0);
          REQUIRE(top.r_pair_valid == 0);
          REQUIRE(top.r_result_ready == 0);
          REQUIRE(top.m_result_valid == 0);
          REQUIRE(all_zero(rig.pins.pair_out()));
          REQUIRE(all_zero(rig.pins.result_out()));
          REQUIRE(int{top.rm_id} == static_cast<int>(ModuleId::blank));
          REQUIRE(top.idle == 1);
        }
        pairs_through += top.r_pair_valid & top.r_pair_ready;
        results_through += top.m_result_valid & top.m_result_ready;
      }
      const bool close = top.rst != 0 || top.decouple != 0;
      const bool accepted = top.s_pair_valid != 0 && pairs.s_ready();
      idle =
          close || (top.r_idle != 0 && !accepted && !pairs.m_valid() && top.r_result_valid == 0 && !results.m_valid());
      rm_id = close ? 0 : top.r_rm_id;
      decoupled = top.decouple != 0;
      pairs.clock(top.s_pair_valid != 0, rig.pins.pair_in(), top.r_pair_ready != 0, top.stop != 0 || top.r_rm_id == 0);
      results.clock(top.r_result_valid != 0, rig.pins.result_in(), top.m_result_ready != 0);
      if (close) {
        pairs.reset();
        results.reset();
      }
      rig.simulation.rise();
    }
    REQUIRE(constant > 1000);
    REQUIRE(pairs_through > 500);
    REQUIRE(results_through > 1000);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_decoupler: reset does not couple, decoupling does not wait for anything",
                        "[unit][cchip_pr_decoupler]", cchip_pr_decoupler_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Rig<TestType> rig(options);
    auto& top = rig.top;
    rig.pins.scramble(rig.random);
    top.r_rm_id = 1;
    top.stop = 0;
    top.decouple = 1;
    rig.simulation.reset();
    REQUIRE(top.decoupled == 1);
    top.rst = 1;
    rig.simulation.step();
    REQUIRE(top.decoupled == 1);
    top.rst = 0;
    top.decouple = 0;
    rig.simulation.step();
    REQUIRE(top.decoupled == 0);
    // both streams stuck: neither the region nor the static side takes anything
    top.s_pair_valid = top.r_result_valid = 1;
    top.r_pair_ready = top.m_result_ready = 0;
    rig.simulation.steps(10);
    REQUIRE(top.r_pair_valid == 1);
    REQUIRE(top.m_result_valid == 1);
    top.decouple = 1;
    rig.simulation.step();
    REQUIRE(top.decoupled == 1);
    REQUIRE(top.r_pair_valid == 0);
    REQUIRE(top.m_result_valid == 0);
    top.decouple = 0;
    top.s_pair_valid = top.r_result_valid = 0;
    top.r_pair_ready = top.m_result_ready = 1;
    for (int clock = 0; clock < 20; ++clock) {  // nothing old may come back
      rig.simulation.step();
      REQUIRE(top.r_pair_valid == 0);
      REQUIRE(top.m_result_valid == 0);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_decoupler: no output follows an input before the rising edge",
                        "[unit][cchip_pr_decoupler]", cchip_pr_decoupler_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Rig<TestType> rig(options);
    auto& top = rig.top;
    const auto drive = [&] {
      rig.pins.scramble(rig.random);
      top.rst = chance(rig.random, 5) ? 1 : 0;
      top.stop = chance(rig.random, 20) ? 1 : 0;
      top.decouple = chance(rig.random, 20) ? 1 : 0;
    };
    drive();
    top.rst = 1;
    rig.simulation.settle();
    rig.simulation.rise();
    for (int clock = 0; clock < 500; ++clock) {
      drive();
      rig.simulation.settle();
      const Bits before = rig.pins.outputs();
      for (int i = 0; i < 4; ++i) {
        drive();
        top.eval();
        REQUIRE(rig.pins.outputs() == before);
      }
      rig.simulation.rise();
    }
  });
}
