// SPDX-License-Identifier: Apache-2.0
#include <cchip/sim/axi_memory.hpp>
#include <cchip/sim/stream.hpp>
#include <models/cchip_bitstream_fetch.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// The block between a memory and a sink that keeps the words.
template <class Model>
struct FetchBench {
  explicit FetchBench(sim::Simulation<Model>& s)
      : simulation(s),
        memory(s.top()),
        sink(
            "m", s.top().m_valid, s.top().m_ready, [&s] { return s.top().m_data; }, sim::Pattern::always(),
            [this](std::uint32_t word, std::uint64_t) { got.push_back(word); }) {
    s.top().run = 0;
    s.top().limit = 1000;
    s.add(memory);
    s.add(sink);
    s.reset();
  }
  void begin(std::uint32_t address, std::size_t words) {
    got.clear();
    simulation.top().address = address;
    simulation.top().words = static_cast<IData>(words);
    simulation.top().run = 1;
  }
  /// Stops, and waits for the beats that are on their way.
  void end() {
    simulation.top().run = 0;
    simulation.step();
    simulation.run_until([&] { return simulation.top().outstanding == 0; }, 2000, "late beats");
    simulation.steps(3);
    REQUIRE(memory.owed() == 0);
    REQUIRE(simulation.top().m_valid == 0);
  }

  sim::Simulation<Model>& simulation;
  sim::AxiMemory<Model> memory;
  std::vector<std::uint32_t> got;
  sim::StreamSink<std::uint32_t> sink;
};

}  // namespace

// Faults and timeouts: test_cchip_config_controller.cpp.
TEMPLATE_LIST_TEST_CASE("cchip_bitstream_fetch: every word in order, never more than fit, stopped anywhere",
                        "[unit][cchip_bitstream_fetch]", cchip_bitstream_fetch_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    FetchBench<Model> bench(simulation);
    auto& memory = bench.memory;
    const auto& got = bench.got;
    std::size_t most = 0;
    for (int round = 0; round < 150; ++round) {
      const std::size_t words = 1 + random() % 120;
      const std::uint32_t address = static_cast<std::uint32_t>(random()) & 0x7FFFFFFCU;
      std::vector<std::uint8_t> bytes(4 * words);
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
      memory.clear();
      REQUIRE(memory.read(address, 4) == std::vector<std::uint8_t>(4));
      memory.write(address, bytes);
      REQUIRE(memory.read(address, bytes.size()) == bytes);
      const auto patterns = sim::standard_patterns(random());
      sim::AxiMemoryOptions behaviour;
      behaviour.latency = 1 + random() % 20;
      behaviour.address_ready = patterns[random() % patterns.size()];
      behaviour.beat_valid = patterns[random() % patterns.size()];
      memory.set_options(behaviour);
      bench.sink.set_pattern(patterns[random() % patterns.size()]);
      const bool stops = chance(random, 30);
      const std::size_t enough = stops ? random() % words : words;
      const std::uint64_t before = memory.beats();
      bench.begin(address, words);
      simulation.run_until(
          [&] {
            if (chance(random, 10)) top.limit = any_limit(random, 500);
            most = std::max<std::size_t>(most, memory.beats() - before + memory.owed() - got.size());
            return got.size() >= enough;
          },
          20000, "the words");
      REQUIRE(top.bus_error == 0);
      REQUIRE(top.timeout == 0);
      bench.sink.set_pattern(sim::Pattern::always());  // valid may drop when run drops
      bench.end();
      REQUIRE(got.size() >= enough);
      for (std::size_t i = 0; i < got.size(); ++i) {
        std::uint32_t word = 0;
        for (std::size_t j = 0; j < 4; ++j) word |= static_cast<std::uint32_t>(bytes[4 * i + j]) << 8 * j;
        REQUIRE(got[i] == word);
      }
      if (!stops) REQUIRE(memory.beats() - before == words);
    }
    REQUIRE(most == TestType::FIFO_DEPTH);
    REQUIRE(memory.most_outstanding() == 2);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_bitstream_fetch: a limit counts from the clock on which it changes, 0 is the default",
                        "[unit][cchip_bitstream_fetch]", cchip_bitstream_fetch_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random&) {
    auto& top = simulation.top();
    // Clocks from an address taken to the timeout if no beat comes; 0: none in `clocks`. The limit changes after
    // `when`.
    const auto clocks_to_timeout = [&](std::uint32_t before, std::uint32_t after, int when, int clocks) {
      top.limit = before;
      top.run = 0;
      top.words = 4;
      top.m_axi_arready = 1;
      top.m_axi_rvalid = 0;
      simulation.reset();
      simulation.steps(3);
      top.run = 1;
      simulation.run_until([&] { return top.m_axi_arvalid != 0; }, 20, "an address");
      for (int clock = 1; clock < clocks; ++clock) {
        if (clock == when) top.limit = after;
        simulation.step();
        if (top.timeout != 0) return clock;
      }
      return 0;
    };
    const int latency = clocks_to_timeout(10, 10, 0, 100) - 10;
    REQUIRE(latency >= 0);
    REQUIRE(latency <= 3);
    for (const std::uint32_t limit : {1U, 2U, 3U, 40U}) {
      CAPTURE(limit);
      const int bound = static_cast<int>(limit);
      REQUIRE(clocks_to_timeout(limit, limit, 0, 100) == bound + latency);
      for (const std::uint32_t high : {1000U, 0U, ~0U}) {
        CAPTURE(high);
        for (int when = 1; when < 60; when += 3) {  // lowered
          CAPTURE(when);
          const int clock = clocks_to_timeout(high, limit, when, 200);
          REQUIRE(clock >= bound + latency);
          REQUIRE(clock <= std::max(when + 3, bound + latency));
        }
        for (int when = 1; when < bound; ++when) REQUIRE(clocks_to_timeout(limit, high, when, 900) == 0);  // raised
      }
    }
    REQUIRE(clocks_to_timeout(40, 0, 20, 5000) == defs::memory_limit_default + latency);
  });
}

TEMPLATE_LIST_TEST_CASE(
    "cchip_bitstream_fetch: any number of words, bit by bit, and a beat with an error ends the words",
    "[unit][cchip_bitstream_fetch]", cchip_bitstream_fetch_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    FetchBench<Model> bench(simulation);
    auto& memory = bench.memory;
    const auto& got = bench.got;
    memory.write(0x1000, std::vector<std::uint8_t>(16384, 7));
    const auto begin = [&](std::uint32_t words) {
      bench.begin(0x1000 + 4 * static_cast<std::uint32_t>(random() % 1000), words);
    };
    for (unsigned bit = 0; bit < 30; ++bit) {
      const std::uint32_t words = 1U << bit;
      begin(words);
      simulation.run_until([&] { return got.size() >= std::min(words, 50U); }, 2000, "the words");
      simulation.steps(40);
      REQUIRE(top.bus_error == 0);
      REQUIRE((bit < 6 ? got.size() == words : got.size() > 60));
      bench.end();
    }
    for (int round = 0; round < 60; ++round) {
      const auto code = static_cast<sim::AxiResponse>(1 + round % 3);
      const std::size_t bad = random() % 40;  // the beat with the error
      std::size_t beats = 0;
      memory.set_fault([&](std::vector<sim::AxiBeat>& burst) {
        for (sim::AxiBeat& beat : burst) {
          if (beats++ == bad) beat.response = code;
        }
      });
      begin(200);
      simulation.run_until([&] { return top.bus_error != 0; }, 2000, "the error");
      simulation.steps(60);  // what was asked for before still comes
      CAPTURE(round, bad);
      REQUIRE(got.size() == bad);
      REQUIRE(top.bus_error == 1);
      REQUIRE(top.timeout == 0);
      memory.set_fault({});
      bench.end();
      REQUIRE(top.bus_error == 0);
    }
    begin(5);
    simulation.run_until([&] { return got.size() == 5; }, 2000, "words after errors");
    bench.end();
  });
}
