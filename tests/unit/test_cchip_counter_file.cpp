// SPDX-License-Identifier: Apache-2.0
// Every value read is compared with what was counted. A probe sets the words close to a carry: no run counts so far.
#include <array>
#include <cchip/machines/probes.hpp>
#include <cstdint>
#include <models/cchip_counter_file.hpp>

// clang-format off: after the class
#include <Vcchip_counter_file___024root.h>
// clang-format on

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using Model = cchip_counter_file::Model;
using Values = std::array<std::uint64_t, 8>;

/// The module, clock by clock, beside counters that are plain numbers.
class Counters {
 public:
  Counters(sim::Simulation<Model>& simulation, Random& random) : simulation_(simulation), random_(random) {
    Model& top = simulation.top();
    top.clear = 0;
    top.count = 0;
    top.read = 0;
    simulation.reset();
  }
  /// One clock with events of this probability, percent.
  void step(int often, bool clear = false) {
    Model& top = simulation_.top();
    unsigned count = 0;
    for (unsigned i = 0; i < 8; ++i) count |= chance(random_, often) ? 1U << i : 0U;
    top.count = static_cast<CData>(count);
    top.clear = clear ? 1 : 0;
    simulation_.step();
    for (std::size_t i = 0; i < 8; ++i) now_[i] = clear ? 0 : now_[i] + (count >> i & 1U);
    before_2_ = before_;
    before_ = last_;
    last_ = now_;
  }
  /// Reads a counter as software does. What is read is the value of 2 clocks before the answer.
  void read(unsigned counter, int often) {
    Model& top = simulation_.top();
    top.read = 1;
    top.read_high = 0;
    top.read_counter = static_cast<CData>(counter);
    int clocks = 0;
    int limit = 18;
    do {
      REQUIRE(top.ack == 0);
      REQUIRE(top.read_data == 0);
      const bool clear = chance(random_, 2);
      step(often, clear);
      limit += clear ? 16 : 0;  // the walk begins anew
      top.read = 0;
      ++clocks;
    } while (top.ack == 0 && clocks <= limit);
    REQUIRE(top.ack == 1);
    REQUIRE(clocks >= 2);
    REQUIRE(clocks <= limit);
    const std::uint64_t value = before_2_[counter];
    REQUIRE(top.read_data == static_cast<std::uint32_t>(value));
    if (counter > 3 || chance(random_, 80)) {  // else the high word is asked for on the clock of ack
      step(often);
      REQUIRE(top.ack == 0);
      if (counter > 3) return;
      for (auto wait = random_() % 20; wait > 0; --wait) step(often);
    }
    top.read = 1;
    top.read_high = 1;
    step(often);
    top.read = 0;
    REQUIRE(top.ack == 1);
    REQUIRE(top.read_data == value >> 32);
    step(often);
  }
  /// Sets the counters.
  void set(const Values& values) {
    for (int i = 0; i < 16; ++i) {
      // the word that the walk is farthest from, with nothing to be added
      const unsigned place = (probes::counter_place(simulation_.top()) + 8U) & 15U;
      probes::counter_words(simulation_.top())[place] =
          static_cast<std::uint32_t>(values[place / 2] >> (place % 2 != 0 ? 32 : 0));
      step(0);
    }
    for (int i = 0; i < 4; ++i) step(0);
    now_ = last_ = before_ = before_2_ = values;
  }

 private:
  sim::Simulation<Model>& simulation_;
  Random& random_;
  Values now_{}, last_{}, before_{}, before_2_{};
};

}  // namespace

TEST_CASE("cchip_counter_file: counts, clears and reads as plain numbers do", "[unit][cchip_counter_file]") {
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    Counters counters(simulation, random);
    for (unsigned i = 0; i < 8; ++i) counters.read(i, 0);
    for (int round = 0; round < 2000; ++round) {
      const int often = std::array{100, 50, 3}[random() % 3];
      if (chance(random, 5)) counters.step(often, true);
      for (auto clocks = random() % 40; clocks > 0; --clocks) counters.step(often);
      counters.read(static_cast<unsigned>(random() % 8), often);
    }
  });
}

TEST_CASE("cchip_counter_file: both words that are read are of one moment, also around a carry",
          "[unit][cchip_counter_file]") {
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    Counters counters(simulation, random);
    for (int round = 0; round < 500; ++round) {
      for (int i = 0; i < 40; ++i) counters.step(0);  // nothing is left to be added
      Values values{};
      for (std::uint64_t& value : values) {
        value =
            std::array<std::uint64_t, 4>{0x100000000, 0x5FFFFFFF8, 0, 0x8000000000000000}[random() % 4] - random() % 40;
      }
      counters.set(values);
      for (int reads = 0; reads < 4; ++reads) counters.read(static_cast<unsigned>(random() % 8), 90);
    }
  });
}
