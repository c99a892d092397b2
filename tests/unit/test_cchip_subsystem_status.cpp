// SPDX-License-Identifier: Apache-2.0
// What the registers of the subsystem show of swaps.
#include <cchip/machines/swap_port.hpp>
#include <models/cchip_subsystem_status.hpp>

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
    simulation.reset();
    body(simulation, top, random);
  });
}

}  // namespace

TEST_CASE("cchip_subsystem_status: last report, its event, pairs lost", "[unit][cchip_subsystem_status]") {
  with_status([](auto& simulation, Model& top, Random& random) {
    std::uint32_t lost = 0;
    SwapReport last;
    for (int clock = 0; clock < 3000; ++clock) {
      const SwapReport report{static_cast<int>(random() % 256), static_cast<int>(random() % 256),
                              static_cast<SwapCode>(random() % 16),
                              chance(random, 50) ? 0U : static_cast<unsigned>(random() % 65536)};
      top.report_valid = chance(random, 30) ? 1 : 0;
      top.clear = chance(random, 2) ? 1 : 0;
      sim::put_swap_report(top.report_data, report);
      simulation.step();
      unsigned events = 0;
      if (top.report_valid != 0) {
        last = report;
        lost += report.lost;
        events =
            (report.lost != 0 ? 4U : 0U) | (report.code == SwapCode::ok || report.code == SwapCode::same ? 1U : 2U);
      }
      if (top.clear != 0) lost = 0;
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
