// SPDX-License-Identifier: Apache-2.0
// The queues of all kinds in one memory: each in order, regardless of the others.
#include <deque>
#include <models/cchip_descriptor_queues.hpp>
#include <set>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {
constexpr int bits_of(int number) { return number == 0 ? 0 : 1 + bits_of(number / 2); }
}  // namespace

TEMPLATE_LIST_TEST_CASE(
    "cchip_descriptor_queues: every queue keeps its order, places are used by one descriptor at once",
    "[unit][cchip_descriptor_queues]", cchip_descriptor_queues_configs) {
  constexpr int queues = TestType::KINDS + 1;
  constexpr int count_w = bits_of(TestType::DEPTH);
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    struct Entry {
      std::uint64_t data;
      int place;
    };
    std::array<std::deque<Entry>, queues> waiting;
    std::set<int> used;
    int full = 0, popped = 0;
    const auto put = [&](int kind, bool valid) {
      top.s_kind = static_cast<CData>(kind);
      top.s_valid = 0;
      simulation.settle();
      top.s_valid = valid && top.s_ready != 0 ? 1 : 0;
      sim::set_random(top.s_data, TestType::WIDTH, random);
    };
    top.kind = top.look = top.pop = 0;
    put(0, false);
    simulation.reset();
    // a clock with random pushes: returns after the rising edge
    const auto clock = [&](int fill) {
      put(static_cast<int>(random() % (1U << defs::kind_w)), chance(random, fill));
      simulation.settle();
      for (int k = 0; k < queues; ++k) {
        const auto& queue = waiting[static_cast<std::size_t>(k)];
        REQUIRE((top.some >> k & 1) == (queue.empty() ? 0 : 1));
        REQUIRE((top.room >> k & 1) == (queue.size() < TestType::DEPTH ? 1 : 0));
        REQUIRE(sim::get_bits(top.waiting, count_w * k, count_w) == queue.size());
        full += queue.size() == TestType::DEPTH ? 1 : 0;
      }
      const int kind = top.s_kind < queues ? top.s_kind : 0;  // no such kind: as the illegal one
      REQUIRE((top.s_ready != 0) == (waiting[static_cast<std::size_t>(kind)].size() < TestType::DEPTH));
      if (top.s_valid != 0) {
        const int place = static_cast<int>(top.s_place);
        REQUIRE(place / TestType::DEPTH == kind);
        REQUIRE(used.insert(place).second);
        waiting[static_cast<std::size_t>(kind)].push_back({sim::get_bits(top.s_data, 0, TestType::WIDTH), place});
      }
      simulation.rise();
    };
    for (int round = 0; round < 1500; ++round) {
      const int fill = round / 200 % 2 == 0 ? 90 : 5;
      if (chance(random, 1)) {
        top.rst = 1;
        top.s_valid = 0;
        simulation.step();
        top.rst = 0;
        for (auto& queue : waiting) queue.clear();
        used.clear();
      }
      const auto kind = static_cast<std::size_t>(random() % queues);
      if (waiting[kind].empty()) {
        clock(fill);
        continue;
      }
      const Entry head = waiting[kind].front();
      top.kind = static_cast<CData>(1U << kind);
      top.look = 1;
      clock(fill);
      top.look = 0;
      const bool pop = chance(random, 80);  // a look alone changes nothing
      top.pop = pop ? 1 : 0;
      if (pop) {
        REQUIRE(int{top.m_place} == head.place);
        clock(fill);  // the descriptor leaves; its place may be used from the next clock on
        top.pop = 0;
        waiting[kind].pop_front();
        used.erase(head.place);
        ++popped;
      } else {
        clock(fill);
      }
      top.kind = 0;
      clock(fill);
      for (int later = 0; later < 2; ++later) {
        simulation.settle();
        REQUIRE(sim::get_bits(top.m_data, 0, TestType::WIDTH) == head.data);
        REQUIRE(int{top.m_place} == head.place);
        clock(fill);
      }
    }
    REQUIRE(full > 50);
    REQUIRE(popped > 300);
  });
}
