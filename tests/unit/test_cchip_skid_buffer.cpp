// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_skid_buffer.hpp>

#include "stream_bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_skid_buffer: every output on every clock is the model's", "[unit][cchip_skid_buffer]",
                        cchip_skid_buffer_configs) {
  sweep_stream_module<typename TestType::Model, TestType::WIDTH>([] { return model::SkidBuffer<std::uint64_t>(); });
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
