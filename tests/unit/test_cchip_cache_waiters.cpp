// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_cache_waiters.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

// A scoreboard: which place sleeps on which slot, and who is to be served.
TEMPLATE_LIST_TEST_CASE("cchip_cache_waiters: each that waits for a line is served once with it, and no other place is",
                        "[unit][cchip_cache_waiters]", cchip_cache_waiters_configs) {
  constexpr int places = TestType::PLACES;
  constexpr int slots = TestType::MISSES;
  constexpr int frame_w = TestType::FRAME_W;
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    for (const int accepts : {100, 40}) {
      top.look = top.sleep = top.retry = top.collect = top.serve_ready = 0;
      simulation.reset();
      std::array<int, places> asleep;  // slot, -1: it does not wait
      asleep.fill(-1);
      std::set<int> awake;
      std::uint64_t retried = 0;
      int decided = -1;  // place that is decided upon on this clock
      int since_collect = 2;
      std::size_t served = 0, slept = 0, most = 0;
      for (int clock = 0; clock < 20000; ++clock) {
        // the decision about the lookup of the clock before
        const bool sleeps = decided >= 0 && chance(random, 80);
        const int slot = static_cast<int>(random() % slots);
        const bool retry = decided >= 0 && !sleeps && chance(random, 50);
        top.sleep = sleeps;
        top.sleep_slot = static_cast<std::uint8_t>(slot);
        top.retry = retry;
        // the next lookup
        const int place = static_cast<int>(random() % places);
        const bool free = asleep[static_cast<std::size_t>(place)] < 0 && awake.count(place) == 0 && place != decided;
        const bool looks = free && chance(random, clock / 500 % 2 != 0 ? 90 : 20);
        top.look = looks;
        top.look_place = static_cast<std::uint8_t>(place);
        top.serve_ready = chance(random, accepts);
        simulation.settle();
        std::uint64_t waiting = 0;
        for (int i = 0; i < places; ++i)
          waiting |= asleep[static_cast<std::size_t>(i)] >= 0 || awake.count(i) != 0 ? std::uint64_t{1} << i : 0;
        // a place leaves `waiting` as it is loaded to be served, a clock or more before it is
        const std::uint64_t shown = sim::get_bits(top.waiting, 0, places);
        REQUIRE((shown & ~waiting) == 0);
        for (int i = 0; i < places; ++i) {
          if (asleep[static_cast<std::size_t>(i)] >= 0) REQUIRE((shown >> i & 1U) != 0);
        }
        REQUIRE(sim::get_bits(top.retried, 0, places) == retried);
        if (!awake.empty() && since_collect >= 2) REQUIRE(top.serve_valid == 1);
        if (awake.empty()) REQUIRE(top.serve_valid == 0);
        const bool last = awake.size() == 1 && top.serve_valid != 0 && top.serve_ready != 0;
        REQUIRE((top.serving != 0) == (!awake.empty() && !last));
        // a line comes when none is served
        const bool collects = top.serving == 0 && since_collect >= 2 && chance(random, 20);
        if (top.serve_valid != 0 && top.serve_ready != 0) {
          REQUIRE(top.serve_place == *awake.begin());
          REQUIRE(top.serve_code == top.collect_code);
          REQUIRE(sim::get_bits(top.serve_frame, 0, frame_w) == sim::get_bits(top.collect_frame, 0, frame_w));
          awake.erase(awake.begin());
          ++served;
        }
        ++since_collect;
        const int collected = static_cast<int>(random() % slots);
        top.collect = collects;
        top.collect_slot = static_cast<std::uint8_t>(collected);
        simulation.settle();
        // all that slept before this clock
        if (collects) {
          for (int i = 0; i < places; ++i) {
            if (asleep[static_cast<std::size_t>(i)] != collected) continue;
            awake.insert(i);
            asleep[static_cast<std::size_t>(i)] = -1;
          }
          since_collect = 0;
          most = std::max(most, awake.size());
        }
        if (decided >= 0) {
          const std::uint64_t bit = std::uint64_t{1} << decided;
          retried = retry ? retried | bit : retried & ~bit;
          if (sleeps) asleep[static_cast<std::size_t>(decided)] = slot;
          slept += sleeps ? 1 : 0;
        }
        decided = looks ? place : -1;
        simulation.rise();
        top.collect = 0;
        if (collects) {
          top.collect_code = static_cast<std::uint8_t>(random() % 4);
          sim::set_bits(top.collect_frame, 0, frame_w, random() & ((std::uint64_t{1} << frame_w) - 1));
        }
      }
      REQUIRE(slept > 1000);
      REQUIRE(served > slept / 2);
      REQUIRE(most >= 2);
    }
  });
}
