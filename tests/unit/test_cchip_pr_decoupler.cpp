// SPDX-License-Identifier: Apache-2.0
// The boundary of a region: a register each way that decoupling clears.
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
  static constexpr int vertex_w = defs::vertex_w(Config::COORD_W);
  typename Config::Model& top;

  Bits vertex_in() const { return bits(top.s_vertex_data, vertex_w); }
  Bits vertex_out() const { return bits(top.r_vertex_data, vertex_w); }
  std::uint64_t result_in() const { return top.r_result_data; }
  std::uint64_t result_out() const { return top.m_result_data; }
  Bits outputs() const {
    Bits b{top.decoupled, top.m_result_valid, top.r_vertex_valid, top.rm_id, top.idle, result_out()};
    const Bits vertex = vertex_out();
    b.insert(b.end(), vertex.begin(), vertex.end());
    return b;
  }
  void scramble(Random& random) {
    top.s_vertex_valid = random() & 1;
    sim::set_random(top.s_vertex_data, vertex_w, random);
    top.r_result_valid = random() & 1;
    sim::set_random(top.r_result_data, defs::slot_result_w, random);
    top.r_rm_id = static_cast<CData>(random());
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
    bool decoupled = false, vertex_valid = false, result_valid = false, idle = true;
    Bits vertex;
    std::uint64_t result = 0;
    int rm_id = 0;
    int constant = 0, vertices = 0, results = 0;
    for (int clock = 0; clock < 8000; ++clock) {
      rig.pins.scramble(rig.random);
      top.rst = clock < 1 || chance(rig.random, 1) ? 1 : 0;
      top.decouple = clock / 100 % 4 == 2 ? 1 : 0;
      if (clock / 1000 % 2 == 1) top.decouple = chance(rig.random, 20) ? 1 : 0;  // flickers
      rig.simulation.settle();
      if (clock > 0) {
        REQUIRE((top.decoupled != 0) == decoupled);
        REQUIRE((top.r_vertex_valid != 0) == vertex_valid);
        REQUIRE(rig.pins.vertex_out() == vertex);
        REQUIRE((top.m_result_valid != 0) == result_valid);
        REQUIRE(rig.pins.result_out() == result);
        REQUIRE(int{top.rm_id} == rm_id);
        REQUIRE((top.idle != 0) == idle);
        if (decoupled) {
          ++constant;
          REQUIRE(top.r_vertex_valid == 0);
          REQUIRE(top.m_result_valid == 0);
          REQUIRE(all_zero(rig.pins.vertex_out()));
          REQUIRE(rig.pins.result_out() == 0);
          REQUIRE(int{top.rm_id} == static_cast<int>(ModuleId::blank));
          REQUIRE(top.idle == 1);
        }
        vertices += top.r_vertex_valid;
        results += top.m_result_valid;
      }
      const bool close = top.rst != 0 || top.decouple != 0;
      idle = close || (top.r_idle != 0 && top.s_vertex_valid == 0 && !vertex_valid);
      rm_id = close ? 0 : top.r_rm_id;
      decoupled = top.decouple != 0;
      vertex_valid = !close && top.s_vertex_valid != 0;
      vertex = rig.pins.vertex_in();
      if (close) std::fill(vertex.begin(), vertex.end(), 0);
      result_valid = !close && top.r_result_valid != 0;
      result = close ? 0 : rig.pins.result_in();
      rig.simulation.rise();
    }
    REQUIRE(constant > 1000);
    REQUIRE(vertices > 1000);
    REQUIRE(results > 1000);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_decoupler: reset does not couple", "[unit][cchip_pr_decoupler]",
                        cchip_pr_decoupler_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Rig<TestType> rig(options);
    auto& top = rig.top;
    rig.pins.scramble(rig.random);
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
