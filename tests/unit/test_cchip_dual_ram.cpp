// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_dual_ram.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_dual_ram: a word is read two clocks after its address, on both ports",
                        "[unit][cchip_dual_ram]", cchip_dual_ram_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    constexpr int width = TestType::WIDTH;
    using Word = std::optional<std::uint64_t>;  // unknown until it is written, and when it is read on that very clock
    std::vector<Word> memory(std::size_t{1} << TestType::ADDR_W);
    std::array<std::array<Word, 2>, 2> read{};  // of each port: on the clock before, two clocks before
    int compared = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          top.write = random() & 1;
          sim::set_random(top.addr_a, TestType::ADDR_W, random);
          sim::set_random(top.addr_b, TestType::ADDR_W, random);
          sim::set_random(top.write_data, width, random);
          if (chance(random, 20)) top.addr_b = top.addr_a;
        },
        [&](const sim::ClockInfo&) {
          if (read[0][1]) expect("read_data_a", sim::get_bits(top.read_data_a, 0, width), *read[0][1]);
          if (read[1][1]) expect("read_data_b", sim::get_bits(top.read_data_b, 0, width), *read[1][1]);
          compared += (read[0][1] ? 1 : 0) + (read[1][1] ? 1 : 0);
          read[0] = {top.write != 0 ? Word{} : memory[top.addr_a], read[0][0]};
          read[1] = {top.write != 0 && top.addr_a == top.addr_b ? Word{} : memory[top.addr_b], read[1][0]};
          if (top.write != 0) memory[top.addr_a] = sim::get_bits(top.write_data, 0, width);
        });
    simulation.add(bench);
    simulation.steps(12000);
    REQUIRE(compared > 6000);
  });
}
