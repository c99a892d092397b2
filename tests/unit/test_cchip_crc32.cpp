// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/wire/bitstream.hpp>
#include <models/cchip_crc32.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_crc32: every clock agrees with a library's CRC", "[unit][cchip_crc32]",
                        cchip_crc32_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    Bytes bytes;
    top.clear = 1;
    top.valid = 0;
    simulation.step();
    for (int clock = 0; clock < 5000; ++clock) {
      top.clear = chance(random, 1) ? 1 : 0;
      top.valid = chance(random, 60) ? 1 : 0;
      sim::set_random(top.data, TestType::DATA_W, random);
      if (top.clear != 0) {
        bytes.clear();
      } else if (top.valid != 0) {
        for (int i = 0; i < TestType::DATA_W; i += 8) {
          bytes.push_back(static_cast<std::uint8_t>(sim::get_bits(top.data, i, 8)));
        }
      }
      simulation.step();
      REQUIRE(top.crc == crc32(bytes));
    }
  });
}
