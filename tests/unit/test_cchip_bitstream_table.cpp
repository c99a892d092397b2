// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <models/cchip_bitstream_table.hpp>
#include <vector>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_bitstream_table: writes byte by byte, reads, look-ups, valid bits",
                        "[unit][cchip_bitstream_table]", cchip_bitstream_table_configs) {
  using Model = typename TestType::Model;
  // entries as the registers number them; those of slots and modules that are not there stay 0
  constexpr unsigned numbers = 4 * defs::table_modules;
  const auto is_there = [](unsigned entry) {
    return entry / defs::table_modules < TestType::SLOTS && entry % defs::table_modules <= TestType::KINDS;
  };
  const auto bit = [](unsigned entry) {  // of `valid` and `invalidate`
    return std::uint64_t{1} << (((entry / defs::table_modules) << defs::kind_bits(TestType::KINDS)) +
                                entry % defs::table_modules);
  };
  std::vector<unsigned> there;
  for (unsigned e = 0; e < numbers; ++e) {
    if (is_there(e)) there.push_back(e);
  }
  for_two_power_ups<Model>([&](auto& simulation, Random& random) {
    auto& top = simulation.top();
    struct Entry {
      std::array<std::uint32_t, 2> words{};  // address, size
      bool valid = false;
    };
    std::array<Entry, numbers> entries{};
    top.write = 0;
    top.look = 0;
    top.invalidate = 0;
    simulation.reset();
    const auto write = [&](unsigned entry, unsigned word, std::uint32_t data, unsigned bytes) {
      top.write_word = static_cast<CData>(4 * entry + word);
      top.write_data = data;
      top.write_bytes = static_cast<CData>(bytes);
      top.write = 1;
      if (!is_there(entry)) return;
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
    for (unsigned entry = 0; entry < numbers; ++entry) {
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
        top.look_entry = static_cast<CData>(there[random() % there.size()]);
        looking = 1;
        looked[0] = entries[top.look_entry].words[0];
      } else if (looking == 1) {
        top.look = 0;
        looking = 2;
        looked[1] = entries[top.look_entry].words[1];
      } else {
        looking = 0;
      }
      top.invalidate = 0;
      if (chance(random, 5)) {
        const unsigned e = there[random() % there.size()];
        sim::set_bits(top.invalidate, 0, TestType::SLOTS << defs::kind_bits(TestType::KINDS), bit(e));
        entries[e].valid = false;
      }
      top.write = 0;
      if (chance(random, 40)) {
        write(static_cast<unsigned>(random() % numbers), static_cast<unsigned>(random() % 3),
              static_cast<std::uint32_t>(random()), static_cast<unsigned>(random() % 16));
      }
      simulation.step();
      found = found || looking == 2;
      if (looking != 1 && found) {
        REQUIRE(top.address == looked[0]);
        REQUIRE(top.size == looked[1]);
      }
      std::uint64_t valid = 0;
      for (const unsigned e : there) valid |= entries[e].valid ? bit(e) : 0;
      REQUIRE(top.valid == valid);
      const auto entry = static_cast<unsigned>(random() % numbers);
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
