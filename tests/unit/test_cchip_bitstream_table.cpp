// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <models/cchip_bitstream_table.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_bitstream_table: writes byte by byte, reads, look-ups, valid bits",
                        "[unit][cchip_bitstream_table]", cchip_bitstream_table_configs) {
  using Model = typename TestType::Model;
  constexpr unsigned there = 4 * TestType::SLOTS;  // entries
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    struct Entry {
      std::array<std::uint32_t, 2> words{};  // address, size
      bool valid = false;
    };
    std::array<Entry, 16> entries{};  // those of slots that are not there stay 0
    top.write = 0;
    top.look = 0;
    top.invalidate = 0;
    simulation.reset();
    const auto write = [&](unsigned entry, unsigned word, std::uint32_t data, unsigned bytes) {
      top.write_word = static_cast<CData>(4 * entry + word);
      top.write_data = data;
      top.write_bytes = static_cast<CData>(bytes);
      top.write = 1;
      if (entry >= there) return;
      if (word == 2) {
        if ((bytes & 1U) != 0) entries[entry].valid = (data & 1U) != 0;
        return;
      }
      std::uint32_t mask = 0;
      for (unsigned i = 0; i < 4; ++i) mask |= (bytes >> i & 1U) != 0 ? 0xFFU << 8 * i : 0;
      std::uint32_t& stored = entries[entry].words[word];
      stored = (stored & ~mask) | (data & mask);
    };
    REQUIRE(top.valid == 0);
    for (unsigned entry = 0; entry < 16; ++entry) {
      for (unsigned word = 0; word < 2; ++word) {
        write(entry, word, static_cast<std::uint32_t>(random()), 15);
        simulation.step();
      }
    }
    unsigned looking = 0;  // clocks since a look-up, 0: none
    std::array<std::uint32_t, 2> looked{};
    bool found = false;
    for (int clock = 0; clock < 20000; ++clock) {
      // what is looked up is read before this clock's write
      if (looking == 0 && chance(random, 30)) {
        top.look = 1;
        top.look_entry = static_cast<CData>(random() % there);
        looking = 1;
        looked[0] = entries[top.look_entry].words[0];
      } else if (looking == 1) {
        top.look = 0;
        looking = 2;
        looked[1] = entries[top.look_entry].words[1];
      } else {
        looking = 0;
      }
      top.invalidate = chance(random, 5) ? 1U << random() % there : 0;
      for (unsigned e = 0; e < there; ++e) {
        if ((top.invalidate >> e & 1U) != 0) entries[e].valid = false;
      }
      top.write = 0;
      if (chance(random, 40)) {
        write(static_cast<unsigned>(random() % 16), static_cast<unsigned>(random() % 3),
              static_cast<std::uint32_t>(random()), static_cast<unsigned>(random() % 16));
      }
      simulation.step();
      found = found || looking == 2;
      if (looking != 1 && found) {
        REQUIRE(top.address == looked[0]);
        REQUIRE(top.size == looked[1]);
      }
      for (unsigned e = 0; e < there; ++e) REQUIRE((top.valid >> e & 1U) == (entries[e].valid ? 1U : 0U));
      const auto entry = static_cast<unsigned>(random() % 16);
      const auto word = static_cast<unsigned>(random() % 3);
      top.write = 0;
      top.read_word = static_cast<CData>(4 * entry + word);
      simulation.settle();
      REQUIRE(top.read_data == (word == 2 ? std::uint32_t{entries[entry].valid} : entries[entry].words[word]));
    }
    simulation.reset();
    REQUIRE(top.valid == 0);
  });
}
