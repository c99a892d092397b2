// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_fifo.hpp>

#include "stream_bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_fifo: every output on every clock is the model's", "[unit][cchip_fifo]",
                        cchip_fifo_configs) {
  sweep_stream_module<typename TestType::Model, TestType::WIDTH>(
      [] { return model::Fifo<std::uint64_t>(TestType::DEPTH); });
}

TEMPLATE_LIST_TEST_CASE("cchip_fifo: throughput, room for DEPTH + 2 beats, no path through", "[unit][cchip_fifo]",
                        cchip_fifo_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    // two clocks to the other side; the only word of a memory is free again a clock after it was taken
    const std::uint64_t expected = TestType::DEPTH == 1 ? 99 : 198;
    REQUIRE(beats_passed<Model>(options, sim::Pattern::always(), 200) == expected);
    REQUIRE(beats_until_full<Model>(options) == TestType::DEPTH + 2);
    require_registered_outputs<Model, TestType::WIDTH>(options);
  });
}
