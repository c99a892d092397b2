// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_skid_buffer.hpp>

#include "stream_bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_skid_buffer: every output on every clock is the model's, in reset and out of it",
                        "[unit][cchip_skid_buffer]", cchip_skid_buffer_configs) {
  constexpr int width = TestType::WIDTH;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    for (const sim::Pattern& source : sim::standard_patterns(options.seed)) {
      for (const sim::Pattern& sink : sim::standard_patterns(options.seed + 100)) {
        sim::Pattern offer = source;
        sim::Pattern accept = sink;
        Random random(options.seed);
        sim::Simulation<typename TestType::Model> simulation(options);
        auto& top = simulation.top();
        model::SkidBuffer<std::uint64_t> model;
        int passed = 0;
        int resets = 0;
        bool was_reset = false;
        for (int clock = 0; clock < 1200; ++clock) {
          top.rst = clock < 1 || (clock / 200 % 2 == 1 && clock % 40 < 5) ? 1 : 0;
          top.s_valid = offer.next() ? 1 : 0;
          sim::set_random(top.s_data, width, random);
          top.m_ready = accept.next() ? 1 : 0;
          simulation.settle();
          if (clock > 0) {
            REQUIRE((top.s_ready != 0) == model.s_ready());
            REQUIRE((top.m_valid != 0) == model.m_valid());
            const std::uint64_t data = sim::get_bits(top.m_data, 0, width);
            if (model.m_valid()) REQUIRE(data == model.m_data());
            passed += top.m_valid & top.m_ready;
            resets += was_reset ? 1 : 0;
          }
          was_reset = top.rst != 0;
          if (was_reset) {
            model.reset();
          } else {
            model.clock(top.s_valid != 0, sim::get_bits(top.s_data, 0, width), top.m_ready != 0);
          }
          simulation.rise();
        }
        INFO("source " << source.name() << ", sink " << sink.name());
        REQUIRE(passed > 20);
        REQUIRE(resets > 50);
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_skid_buffer: one beat per clock, two beats of room, no path through",
                        "[unit][cchip_skid_buffer]", cchip_skid_buffer_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    REQUIRE(beats_passed<Model>(options, sim::Pattern::always(), 200) == 199);     // latency 1
    REQUIRE(beats_passed<Model>(options, sim::Pattern::alternate(), 200) == 100);  // every offered slot is used
    REQUIRE(beats_until_full<Model>(options) == 2);
    require_registered_outputs<Model, TestType::WIDTH>(options);
  });
}
