// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_bitstream_header.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

TEMPLATE_LIST_TEST_CASE("cchip_bitstream_header: verdict on headers with any of the faults",
                        "[unit][cchip_bitstream_header]", cchip_bitstream_header_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    for (int round = 0; round < 2000; ++round) {
      const bool magic = chance(random, 80);
      const bool slot = chance(random, 80);
      const bool module_id = chance(random, 80);
      const std::uint32_t payload = chance(random, 20) ? static_cast<std::uint32_t>(random() % 20)
                                                       : static_cast<std::uint32_t>(random()) & 0x7FFFFFFFU;
      const std::uint32_t length = chance(random, 80) ? payload : payload + 1;
      top.slot = static_cast<CData>(random());
      top.module_id = static_cast<CData>(random());
      top.size = payload + 16;
      const bool fits = length == payload && length >= 16 && (TestType::CFG_W == 8 || length % 4 == 0);
      const auto crc = static_cast<std::uint32_t>(random());
      const bool reserved = chance(random, 15);  // a bit that must be 0 is not
      const std::uint32_t words[4] = {magic ? 0x43434250U : 0x43434250U ^ 1U << random() % 32,
                                      static_cast<std::uint32_t>(top.module_id ^ (module_id ? 0 : 1)) |
                                          static_cast<std::uint32_t>(top.slot ^ (slot ? 0 : 4)) << 8U |
                                          (reserved ? 1U << (16 + random() % 16) : 0U),
                                      length, crc};
      top.clear = 1;
      top.s_valid = 0;
      simulation.steps(2);
      top.clear = 0;
      for (const std::uint32_t word : words) {
        while (chance(random, 40)) simulation.step();
        top.s_valid = 1;
        top.s_data = word;
        simulation.step();
        REQUIRE(top.done == 0);
        top.s_valid = 0;
      }
      simulation.step();
      REQUIRE(top.done == 0);
      simulation.step();
      REQUIRE(top.done == 1);
      REQUIRE((top.ok != 0) == (magic && !reserved && slot && module_id && fits));
      if (top.ok == 0) {
        const SwapCode code = !magic || reserved ? SwapCode::magic
                              : !slot            ? SwapCode::slot
                              : !module_id       ? SwapCode::module
                                                 : SwapCode::length;
        REQUIRE(static_cast<SwapCode>(top.code) == code);
      }
      REQUIRE(top.payload_length == length);
      REQUIRE(top.payload_crc == crc);
    }
  });
}
