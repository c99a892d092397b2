// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/model/stream.hpp>
#include <deque>
#include <models/cchip_cache_fill.hpp>
#include <set>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

constexpr int log2(int n) { return n <= 1 ? 0 : 1 + log2((n + 1) / 2); }

struct Line {
  int slot = 0;
  std::uint64_t frame = 0;
  unsigned code = 0;
  std::array<std::uint32_t, 16> data{};
  int beats = 0;  // that have come
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_cache_fill: lines leave whole, in the order of their last beats, a slot is one line's",
                        "[unit][cchip_cache_fill]", cchip_cache_fill_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int misses = TestType::MISSES, width = TestType::DATA_W, beats = 512 / width, words = width / 32;
    for (const int busy : {100, 60, 10}) {  // per cent of the clocks on which something comes
      auto& top = simulation.top();
      top.free_take = top.allocate = top.s_read_valid = top.serving = 0;
      simulation.reset();
      std::set<int> used;                        // slots
      std::optional<Line> taken;                 // on the clock before
      std::vector<Line> reads;                   // outstanding
      std::deque<std::pair<int, Line>> filling;  // clock of fill_valid
      std::deque<std::pair<int, Line>> arrived;  // clock from which on it may leave
      bool fills = false;                        // on the clock before
      model::Fifo<Line> queue(misses);
      std::optional<Line> served;
      bool collects = false, collected = false, serving = false;  // on this clock; on the one before
      int losses = 0, all_lost = 0,
          some_lost = 0;                    // reads that memory kept; clocks for which all slots, no slot are lost
      int serves = 0, lines = 0, most = 0;  // clocks left, lines done
      std::array<bool, misses> held{}, filled{};
      std::array<int, misses> owed{};  // clocks until the slot's response is no longer outstanding
      std::size_t lost = 0;            // slots out of use
      for (int clock = 0; clock < 6000; ++clock) {
        // the slot taken a clock ago gets its frame
        top.allocate = taken ? 1 : 0;
        std::optional<int> starts;
        sim::set_random(top.allocate_slot, log2(misses), random);
        sim::set_random(top.allocate_frame, TestType::FRAME_W, random);
        if (taken) {
          top.allocate_slot = static_cast<CData>(taken->slot);
          taken->frame = top.allocate_frame;
          starts = taken->slot;
        }
        // memory
        std::optional<Line> comes;
        top.s_read_valid = 0;
        sim::set_random(top.s_read_data, width, random);
        if (!reads.empty() && chance(random, busy)) {
          const auto read = reads.begin() + static_cast<std::ptrdiff_t>(random() % reads.size());
          const bool fails = chance(random, 5);
          top.s_read_valid = 1;
          top.s_read_slot = static_cast<CData>(read->slot);
          top.s_read_beat = static_cast<CData>(read->beats);
          for (int w = 0; w < words; ++w)
            read->data[static_cast<std::size_t>(read->beats * words + w)] =
                static_cast<std::uint32_t>(sim::get_bits(top.s_read_data, 32 * w, 32));
          ++read->beats;
          top.s_read_last = fails || read->beats == beats ? 1 : 0;
          top.s_read_code = static_cast<CData>(fails ? 1 + random() % 3 : top.s_read_last != 0 ? 0 : random() % 4);
          if (top.s_read_last != 0) {
            read->code = top.s_read_code;
            comes = *read;
            reads.erase(read);
          }
        } else {
          top.s_read_last = random() & 1;
          sim::set_random(top.s_read_slot, log2(misses), random);
          sim::set_random(top.s_read_beat, 3, random);
        }
        top.serving = static_cast<CData>(serves > 0 ? 1 + random() % 3 : 0);
        for (int s = 0; s < misses; ++s) {
          int& clocks = owed[static_cast<std::size_t>(s)];
          if (clocks > 0 && --clocks == 0) --lost;
          sim::set_bits(top.s_read_outstanding, s, 1,
                        clocks > 0 ? 1 : static_cast<unsigned>(held[static_cast<std::size_t>(s)]));
        }
        const bool take = top.free_valid != 0 && chance(random, busy);
        top.free_take = take ? 1 : 0;
        top.free = !fills && chance(random, 70) ? 1 : 0;
        fills = top.free != 0 && !arrived.empty() && arrived.front().first <= clock;
        if (fills) {
          filling.emplace_back(clock, arrived.front().second);
          arrived.pop_front();
        }
        simulation.settle();

        std::optional<Line> fill;
        std::optional<Line> written, filled_now, queued;
        for (const auto& [at, line] : filling) {
          if (at == clock) fill = line;
          if (at + 5 == clock) written = line;
          if (at + 6 == clock) filled_now = queued = line;
        }
        // every slot is lost, and has been for two clocks; none is, and the last one has had time to come back
        all_lost = lost == misses ? all_lost + 1 : 0;
        if (all_lost > 2) REQUIRE(top.exhausted == 1);
        if (all_lost == 0 && lost == 0) REQUIRE((top.exhausted == 0 || some_lost < misses + 4));
        some_lost = lost == 0 ? some_lost + 1 : 0;
        REQUIRE((top.fill_valid != 0) == fill.has_value());
        if (fill) {
          REQUIRE(top.fill_slot == fill->slot);
          REQUIRE(top.fill_code == fill->code);
          REQUIRE(top.fill_frame == fill->frame);
        }
        for (const auto& [line, half] : {std::pair(&written, 0U), std::pair(&filled_now, 8U)}) {
          for (unsigned w = 0; *line && (*line)->code == 0 && w < 8; ++w)
            REQUIRE(sim::get_bits(top.fill_data, static_cast<int>(32 * w), 32) == (*line)->data[half + w]);
        }
        for (int s = 0; s < misses; ++s) {
          REQUIRE((top.held >> s & 1) == (held[static_cast<std::size_t>(s)] ? 1 : 0));
          if (held[static_cast<std::size_t>(s)])
            REQUIRE((top.filled >> s & 1) == (filled[static_cast<std::size_t>(s)] ? 1 : 0));
        }
        const bool release = served && !collects && !collected && !serving;
        REQUIRE((top.collect != 0) == collects);
        if (collects) REQUIRE(top.collect_slot == served->slot);
        if (served) {
          REQUIRE(top.serve_code == served->code);
          REQUIRE(top.serve_frame == served->frame);
        }

        // what the clock does
        if (release) {
          held[static_cast<std::size_t>(served->slot)] = false;
          used.erase(served->slot);
          const auto code = static_cast<ReadCode>(served->code);
          if (code == ReadCode::timeout || code == ReadCode::owed) {
            owed[static_cast<std::size_t>(served->slot)] = 1 + static_cast<int>(random() % 300);
            ++lost;
            ++losses;
          }
          served.reset();
          ++lines;
        }
        if (starts) {
          held[static_cast<std::size_t>(*starts)] = true;
          filled[static_cast<std::size_t>(*starts)] = false;
          reads.push_back(*taken);
          taken.reset();
        }
        if (written && written->code == 0) filled[static_cast<std::size_t>(written->slot)] = true;
        if (serves > 0 && !collects) --serves;
        serving = top.serving != 0;
        collected = collects;
        const bool next = !served;
        collects = next && queue.m_valid();
        if (collects) {
          served = queue.m_data();
          serves = chance(random, 70) ? 1 : static_cast<int>(random() % 8);
        }
        queue.clock(queued.has_value(), queued.value_or(Line{}), next);
        while (!filling.empty() && filling.front().first + 6 <= clock) filling.pop_front();
        if (comes) arrived.emplace_back(clock + 2, *comes);
        if (take) {
          taken = Line{top.free_slot};
          REQUIRE(used.insert(taken->slot).second);
          REQUIRE(owed[static_cast<std::size_t>(taken->slot)] == 0);
        }
        most = std::max(most, static_cast<int>(used.size() + lost));
        simulation.rise();
      }
      REQUIRE(lines > 6000 * busy / 100 / (beats + 9 * misses) / 4);
      REQUIRE(losses > 0);
      if (busy == 100) REQUIRE(most == misses);
    }
  });
}

TEMPLATE_LIST_TEST_CASE(
    "cchip_cache_fill: each slot is lost alone and comes back alone, exhausted only if all are lost",
    "[unit][cchip_cache_fill]", cchip_cache_fill_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int misses = TestType::MISSES;
    constexpr unsigned all = misses == 32 ? ~0U : (1U << misses) - 1;
    auto& top = simulation.top();
    top.free_take = top.allocate = top.s_read_valid = top.serving = 0;
    top.free = 1;
    unsigned outstanding = all;
    const auto step = [&] {
      sim::set_bits(top.s_read_outstanding, 0, misses, outstanding);
      simulation.step();
      top.free_take = top.allocate = top.s_read_valid = 0;
    };
    simulation.reset();
    /// Takes the slot that is offered and ends its read with a code.
    const auto use = [&](ReadCode code) {
      simulation.run_until([&] { return top.free_valid != 0; }, 2 * misses, "a slot");
      const unsigned slot = top.free_slot;
      top.free_take = 1;
      step();
      top.allocate = 1;
      top.allocate_slot = static_cast<CData>(slot);
      sim::set_random(top.allocate_frame, TestType::FRAME_W, random);
      step();
      REQUIRE((top.held >> slot & 1) == 1);
      top.s_read_valid = top.s_read_last = 1;
      top.s_read_slot = static_cast<CData>(slot);
      top.s_read_code = static_cast<CData>(code);
      step();
      for (int clock = 0; (top.held >> slot & 1) != 0; ++clock) {
        REQUIRE(clock < 20);
        step();
      }
      return slot;
    };
    /// What is lent within the bound that the header gives, one slot after the other.
    const auto lent = [&] {
      unsigned slots = 0;
      for (int clock = 0; clock < 2 * misses + 8; ++clock) {
        if (top.free_valid != 0) {
          REQUIRE((slots >> top.free_slot & 1) == 0);
          slots |= 1U << top.free_slot;
          top.free_take = 1;
        }
        step();
      }
      return slots;
    };
    for (int round = 0; round < 4; ++round) {
      unsigned lost = 0;
      for (int i = 0; i < misses; ++i) {
        REQUIRE(top.exhausted == 0);
        lost |= 1U << use(random() % 2 == 0 ? ReadCode::timeout : ReadCode::owed);
        simulation.steps(2);
      }
      REQUIRE(lost == all);
      for (int i = 0; i < misses; ++i) {
        REQUIRE(top.exhausted == 1);
        REQUIRE(lent() == 0);
        const unsigned slot = round == 0 ? static_cast<unsigned>(i) : static_cast<unsigned>(random() % misses);
        outstanding = all & ~(1U << slot);
        for (int clock = 0; top.free_valid == 0; ++clock) {
          REQUIRE(clock <= misses + 3);
          step();
        }
        REQUIRE(top.exhausted == 0);
        outstanding = all;
        REQUIRE(use(ReadCode::timeout) == slot);
        simulation.steps(2);
      }
      const unsigned some = static_cast<unsigned>(random()) & all;
      outstanding = all & ~some;
      REQUIRE(lent() == some);
      simulation.reset();
      outstanding = all;
      simulation.steps(misses);
    }
  });
}
