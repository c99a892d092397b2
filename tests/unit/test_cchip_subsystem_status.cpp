// SPDX-License-Identifier: Apache-2.0
// What the registers of the subsystem show of the past. Counters of 64 bits are set close to a carry by a probe: no run
// counts so far.
#include <cchip/rtl/probes.hpp>
#include <cchip/rtl/swap_port.hpp>
#include <models/cchip_subsystem_status.hpp>

// clang-format off: after the class
#include <Vcchip_subsystem_status___024root.h>
// clang-format on

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using Model = cchip_subsystem_status::Model;

template <class Body>
void with_status(Body&& body) {
  for_two_power_ups<Model>([&](auto& simulation, Random& random) {
    Model& top = simulation.top();
    top.clear = 0;
    top.report_valid = 0;
    top.answered = 0;
    simulation.reset();
    body(simulation, top, random);
  });
}
std::uint64_t pairs(const Model& top, int module_id) { return sim::get_bits(top.pairs, 64 * module_id, 64); }

}  // namespace

TEST_CASE("cchip_subsystem_status: both halves of a counter of pairs belong together on every clock",
          "[unit][cchip_subsystem_status]") {
  with_status([](auto& simulation, Model& top, Random& random) {
    for (const std::uint64_t start : std::vector<std::uint64_t>{0xFFFFFFF0, 0x5FFFFFFF8, ~std::uint64_t{0} - 12, 7}) {
      std::array<std::uint64_t, 4> expected{};
      for (int m = 0; m < 4; ++m) {
        expected[static_cast<std::size_t>(m)] = start + static_cast<std::uint64_t>(m);
        sim::set_bits(probes::answered_pairs(top), 64 * m, 64, expected[static_cast<std::size_t>(m)]);
      }
      for (int clock = 0; clock < 200; ++clock) {
        top.answered = chance(random, 70) ? 1 : 0;
        top.answered_module = static_cast<CData>(random() % 4);
        simulation.step();
        if (top.answered != 0) ++expected[top.answered_module];
        for (int m = 0; m < 4; ++m) REQUIRE(pairs(top, m) == expected[static_cast<std::size_t>(m)]);
      }
    }
    top.clear = 1;
    simulation.step();
    for (int m = 0; m < 4; ++m) REQUIRE(pairs(top, m) == 0);
  });
}

TEST_CASE("cchip_subsystem_status: last report, its event, pairs lost", "[unit][cchip_subsystem_status]") {
  with_status([](auto& simulation, Model& top, Random& random) {
    std::uint32_t lost = 0;
    SwapReport last;
    for (int clock = 0; clock < 3000; ++clock) {
      const SwapReport report{static_cast<int>(random() % 256), static_cast<int>(random() % 256),
                              static_cast<SwapCode>(random() % 16),
                              chance(random, 50) ? 0U : static_cast<unsigned>(random() % 65536)};
      top.report_valid = chance(random, 30) ? 1 : 0;
      sim::put_swap_report(top.report_data, report);
      simulation.step();
      unsigned events = 0;
      if (top.report_valid != 0) {
        last = report;
        lost += report.lost;
        events =
            (report.lost != 0 ? 4U : 0U) | (report.code == SwapCode::ok || report.code == SwapCode::same ? 1U : 2U);
      }
      REQUIRE(unsigned{top.swap_events} == events);
      REQUIRE(top.lost == lost);
      const SwapReport got = sim::get_swap_report(top.last_report);
      REQUIRE(got.slot == last.slot);
      REQUIRE(got.module_id == last.module_id);
      REQUIRE(got.code == last.code);
      REQUIRE(got.lost == last.lost);
    }
  });
}
