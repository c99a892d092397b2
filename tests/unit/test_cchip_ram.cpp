// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_ram.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_ram: registered read of the old word", "[unit][cchip_ram]", cchip_ram_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    model::Ram<std::uint64_t> model(TestType::DEPTH);
    // the model gets the address with a delay of one clock and reads at once
    model::Delay<std::optional<std::uint64_t>> out(static_cast<std::size_t>(defs::ram_latency() - 1));
    bool write = false;  // on the clock before: its data come now
    std::size_t write_addr = 0;
    std::size_t read_addr = 0;  // on the clock before
    int compared = 0;
    int collisions = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          top.write = random() & 1;
          top.write_addr = static_cast<CData>(random() % TestType::DEPTH);
          top.read_addr = chance(random, 50) ? top.write_addr : static_cast<CData>(random() % TestType::DEPTH);
          sim::set_random(top.write_data, TestType::WIDTH, random);
        },
        [&](const sim::ClockInfo&) {
          if (const auto& expected = out.q()) {
            expect("read_data", sim::get_bits(top.read_data, 0, TestType::WIDTH), *expected);
            ++compared;
          }
          collisions += write && write_addr == read_addr ? 1 : 0;
          model.clock(write, write_addr, sim::get_bits(top.write_data, 0, TestType::WIDTH), read_addr);
          read_addr = top.read_addr;
          out.clock(model.read_data());
          write = top.write != 0;
          write_addr = top.write_addr;
        });
    simulation.add(bench);
    simulation.steps(2000);
    REQUIRE(compared > 1800);
    REQUIRE(collisions > 400);
  });
}
