// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_block_ram.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_block_ram: a word is read two clocks after its address", "[unit][cchip_block_ram]",
                        cchip_block_ram_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    constexpr int words = TestType::WORDS, width = TestType::WIDTH;
    using Word = std::optional<std::uint64_t>;  // unknown until it is written, and when it is read on that very clock
    std::vector<Word> memory(std::size_t{1} << TestType::ADDR_W);
    std::array<Word, 2> read{};  // on the clock before, two clocks before
    int compared = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          top.write = random() & 1;
          sim::set_random(top.write_addr, words == 4 ? TestType::ADDR_W - 2 : TestType::ADDR_W, random);
          sim::set_random(top.write_data, words * width, random);
          sim::set_random(top.read_addr, TestType::ADDR_W, random);
          if (chance(random, 20)) top.read_addr = static_cast<SData>(top.write_addr * words);
        },
        [&](const sim::ClockInfo&) {
          if (read[1]) {
            expect("read_data", sim::get_bits(top.read_data, 0, width), *read[1]);
            ++compared;
          }
          read = {memory[top.read_addr], read[0]};
          if (top.write == 0) return;
          for (int i = 0; i < words; ++i) {
            const auto at = static_cast<std::size_t>(top.write_addr) * words + static_cast<std::size_t>(i);
            memory[at] = sim::get_bits(top.write_data, width * i, width);
            if (at == top.read_addr) read[0].reset();
          }
        });
    simulation.add(bench);
    simulation.steps(6000);
    REQUIRE(compared > 3000);
  });
}
