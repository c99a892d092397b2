// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/wire/bitstream.hpp>
#include <models/cchip_config_port.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_config_port: bytes in order, in their slots, with CRC and stalls",
                        "[unit][cchip_config_port]", cchip_config_port_configs) {
  using Model = typename TestType::Model;
  constexpr int width = TestType::CFG_W;
  constexpr std::uint64_t divider = TestType::CFG_DIVIDER;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    top.run = 0;
    top.length = 16;
    sim::StreamDriver<std::uint32_t> driver("s", top.s_valid, top.s_ready, [&](std::uint32_t w) { top.s_data = w; });
    simulation.add(driver);
    simulation.reset();
    for (int round = 0; round < 60; ++round) {
      // each small number of port words, then any
      const std::size_t port_words = round < 10 ? 1 + static_cast<std::size_t>(round) : 1 + random() % 40;
      Bytes bytes(port_words * width / 8);
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
      const auto patterns = sim::standard_patterns(random());
      driver.set_pattern(patterns[static_cast<std::size_t>(round) % patterns.size()]);
      top.run = 0;
      top.length = static_cast<std::uint32_t>(bytes.size());
      for (std::uint64_t clocks = 1 + random() % 3; clocks > 0; --clocks) {
        simulation.step();
        REQUIRE((top.cfg_valid == 0 && top.done == 0 && top.stall == 0));  // the device is left alone
      }
      for (std::size_t i = 0; i < bytes.size(); i += 4) {
        std::uint32_t word = static_cast<std::uint32_t>(random());
        for (std::size_t j = 0; j < 4 && i + j < bytes.size(); ++j) {
          word = (word & ~(0xFFU << 8 * j)) | static_cast<std::uint32_t>(bytes[i + j]) << 8 * j;
        }
        driver.push(word);
      }
      top.run = 1;
      Bytes passed;
      std::uint64_t clock = 0;
      std::uint64_t first = 0;
      std::uint64_t last = 0;
      std::uint64_t stalls = 0;
      do {
        if (first == 0 && clock > 0 && (top.s_valid != 0 || driver.waiting() < (bytes.size() + 3) / 4)) first = clock;
        simulation.step();
        ++clock;
        if (top.stall != 0) ++stalls;
        if (top.cfg_valid != 0) {
          REQUIRE((last == 0 || (clock - last) % divider == 0));
          last = clock;
          for (int i = 0; i < width; i += 8) {
            passed.push_back(static_cast<std::uint8_t>(sim::get_bits(top.cfg_data, i, 8)));
          }
        }
        REQUIRE(clock < 10000);
      } while (top.done == 0);
      REQUIRE(passed == bytes);
      REQUIRE(driver.waiting() == 0);
      REQUIRE(last == clock);
      // first slot: begins a clock after the first word has arrived
      REQUIRE(clock == first + divider * (bytes.size() * 8 / width + stalls));
      simulation.steps(1);
      REQUIRE(top.crc == crc32(bytes));
      for (std::uint64_t after = 0; after < 2 * divider + 2; ++after) {  // no slot follows the last word
        REQUIRE(top.done == 1);
        REQUIRE(top.cfg_valid == 0);
        REQUIRE(top.stall == 0);
        simulation.step();
      }
      REQUIRE(top.crc == crc32(bytes));
    }
  });
}
