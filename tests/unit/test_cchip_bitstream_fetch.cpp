// SPDX-License-Identifier: Apache-2.0
#include <cchip/sim/axi_memory.hpp>
#include <cchip/sim/stream.hpp>
#include <models/cchip_bitstream_fetch.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

// Faults and timeouts: test_cchip_config_controller.cpp.
TEMPLATE_LIST_TEST_CASE("cchip_bitstream_fetch: every word in order, never more than fit, stopped anywhere",
                        "[unit][cchip_bitstream_fetch]", cchip_bitstream_fetch_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    top.run = 0;
    top.limit = 1000;
    sim::AxiMemory<Model> memory(top);
    std::vector<std::uint32_t> got;
    sim::StreamSink<std::uint32_t> sink(
        "m", top.m_valid, top.m_ready, [&] { return top.m_data; }, sim::Pattern::always(),
        [&](std::uint32_t word, std::uint64_t) { got.push_back(word); });
    simulation.add(memory);
    simulation.add(sink);
    simulation.reset();
    std::size_t most = 0;
    for (int round = 0; round < 150; ++round) {
      const std::size_t words = 1 + random() % 120;
      const std::uint32_t address = static_cast<std::uint32_t>(random()) & 0x7FFFFFFCU;
      std::vector<std::uint8_t> bytes(4 * words);
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
      memory.clear();
      memory.write(address, bytes);
      const auto patterns = sim::standard_patterns(random());
      sim::AxiMemoryOptions behaviour;
      behaviour.latency = 1 + random() % 20;
      behaviour.address_ready = patterns[random() % patterns.size()];
      behaviour.beat_valid = patterns[random() % patterns.size()];
      memory.set_options(behaviour);
      sink.set_pattern(patterns[random() % patterns.size()]);
      const bool stops = chance(random, 30);
      const std::size_t enough = stops ? random() % words : words;
      got.clear();
      const std::uint64_t before = memory.beats();
      top.address = address;
      top.words = static_cast<IData>(words);
      top.run = 1;
      simulation.run_until(
          [&] {
            most = std::max<std::size_t>(most, memory.beats() - before + memory.owed() - got.size());
            return got.size() >= enough;
          },
          20000, "the words");
      REQUIRE(top.bus_error == 0);
      REQUIRE(top.timeout == 0);
      sink.set_pattern(sim::Pattern::always());  // valid may drop when run drops
      top.run = 0;
      simulation.step();
      for (std::size_t i = 0; i < got.size(); ++i) {
        std::uint32_t word = 0;
        for (std::size_t j = 0; j < 4; ++j) word |= static_cast<std::uint32_t>(bytes[4 * i + j]) << 8 * j;
        REQUIRE(got[i] == word);
      }
      if (!stops) REQUIRE(memory.beats() - before == words);
      simulation.run_until([&] { return top.owes == 0; }, 2000, "late beats");
      simulation.steps(3);
      REQUIRE(memory.owed() == 0);
      REQUIRE(top.m_valid == 0);
    }
    REQUIRE(most == TestType::FIFO_DEPTH);
    REQUIRE(memory.most_outstanding() == 2);
  });
}
