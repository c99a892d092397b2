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

TEMPLATE_LIST_TEST_CASE("cchip_fifo: throughput, DEPTH beats of room, no path through", "[unit][cchip_fifo]",
                        cchip_fifo_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    // two clocks to the other side; a single place is free again a clock after that
    const std::uint64_t expected = TestType::DEPTH == 1 ? 66 : 198;
    REQUIRE(beats_passed<Model>(options, sim::Pattern::always(), 200) == expected);
    REQUIRE(beats_until_full<Model>(options, TestType::DEPTH + 100) == TestType::DEPTH);
    require_registered_outputs<Model, TestType::WIDTH>(options);
  });
}
