// SPDX-License-Identifier: Apache-2.0
// Both rings of the chip against scoreboards: what memory holds, what the host may rely on.
#include <cchip/internal/wire/query.hpp>
#include <deque>
#include <map>
#include <models/cchip_query_ring.hpp>
#include <models/cchip_record_ring.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

constexpr int log2(int n) { return n <= 1 ? 0 : 1 + log2((n + 1) / 2); }

std::uint32_t word_of(std::uint64_t query, int word) {
  return static_cast<std::uint32_t>((query * 16 + static_cast<std::uint64_t>(word)) * 0x9E3779B97F4A7C15U >> 32);
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_query_ring: every query once, in order, a line that cannot be read stops the ring",
                        "[unit][cchip_query_ring]", cchip_query_ring_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int width = TestType::DATA_W, beats = 512 / width, words = width / 32;
    auto& top = simulation.top();
    for (int run = 0; run < 40; ++run) {
      const unsigned size = static_cast<unsigned>(run % 9);            // of the ring, a power of two
      const std::uint64_t base = random() >> (run % 3 == 0 ? 6 : 20);  // at the very end of memory, too
      const int busy = run % 4 == 0 ? 100 : 30;                        // per cent
      const std::optional<std::uint64_t> bad =
          run % 5 == 4 ? std::optional<std::uint64_t>(random() % 50) : std::nullopt;
      struct Read {
        unsigned slot;
        std::uint64_t query;
        int sent = 0;
      };
      std::vector<Read> reads;
      std::uint64_t written = 0, asked = 0, given = 0;
      top.enable = 0;
      top.base = base & ((std::uint64_t{1} << 58) - 1);
      top.size_log2 = static_cast<CData>(size);
      top.producer = 0;
      top.s_read_valid = top.m_query_ready = 0;
      simulation.reset();
      const std::uint64_t total = bad ? 200 : 66000;  // past the end of the indices
      for (int clock = 0; clock < (bad ? 2000 : 4000); ++clock) {
        top.enable = chance(random, 95) ? 1 : 0;
        if (chance(random, busy) && written - given < (std::uint64_t{1} << size) && written < total) ++written;
        top.producer = static_cast<SData>(written);
        top.m_query_ready = chance(random, busy) ? 1 : 0;
        // memory gives beats of any line
        top.s_read_valid = 0;
        sim::set_random(top.s_read_data, width, random);
        top.s_read_last = random() & 1;
        top.s_read_code = random() & 3;
        if (!reads.empty() && chance(random, busy)) {
          auto read = reads.begin() + static_cast<std::ptrdiff_t>(random() % reads.size());
          top.s_read_valid = 1;
          sim::set_bits(top.s_read_slot, 0, log2(TestType::SLOTS), read->slot);
          const bool fails = bad && read->query == *bad && chance(random, 50);
          top.s_read_beat = static_cast<CData>(read->sent);
          for (int w = 0; w < words; ++w)
            sim::set_bits(top.s_read_data, 32 * w, 32, word_of(read->query, read->sent * words + w));
          ++read->sent;
          const bool last = fails || read->sent == beats;
          top.s_read_last = last ? 1 : 0;
          if (last) {
            const bool error = fails || (bad && read->query == *bad);
            top.s_read_code = static_cast<CData>(error ? 1 + random() % 3 : 0);
            reads.erase(read);
          }
        }
        simulation.settle();
        CAPTURE(run, clock, size, written, asked, given);
        REQUIRE(top.consumer == static_cast<SData>(given));
        REQUIRE((top.idle != 0) == (asked == given && top.m_read_valid == 0));
        if (top.m_read_valid != 0) {
          REQUIRE(asked < written);
          REQUIRE(asked - given < TestType::AHEAD);
          const std::uint64_t line =
              (top.base + (asked & ((std::uint64_t{1} << size) - 1))) & ((std::uint64_t{1} << 58) - 1);
          REQUIRE(top.m_read_line == line);
          for (const Read& read : reads) REQUIRE(read.slot != top.m_read_slot);
          reads.push_back({top.m_read_slot, asked});
          ++asked;
        }
        if (bad) REQUIRE(given <= *bad);
        if (top.m_query_valid != 0) {
          REQUIRE(given < asked);
          for (int w = 0; w < 16; ++w) REQUIRE(sim::get_bits(top.m_query_data, 32 * w, 32) == word_of(given, w));
          if (top.m_query_ready != 0) ++given;
        }
        simulation.rise();
      }
      REQUIRE((top.failed != 0) == bad.has_value());
      if (bad) {
        REQUIRE(given == *bad);
        REQUIRE(asked <= *bad + TestType::AHEAD);
      } else {
        REQUIRE(given > 80);
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_record_ring: every record once, in its place, with the phase of its round",
                        "[unit][cchip_record_ring]", cchip_record_ring_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int width = TestType::DATA_W, part = width / 128;
    auto& top = simulation.top();
    for (int run = 0; run < 40; ++run) {
      const unsigned size = static_cast<unsigned>(run % 7);
      const std::uint64_t base = random() >> (run % 3 == 0 ? 4 : 20);
      const int busy = run % 4 == 0 ? 100 : 30;
      const std::optional<std::uint64_t> bad =
          run % 5 == 4 ? std::optional<std::uint64_t>(20 + random() % 50) : std::nullopt;
      std::map<std::uint64_t, std::array<std::uint32_t, 4>> memory;  // by address / 16
      std::deque<int> writes;                                        // clocks until the answer
      std::uint64_t sent = 0, written = 0, answered = 0, held = 0, read = 0;
      bool failed = false;
      top.base = base & ((std::uint64_t{1} << 60) - 1);
      top.size_log2 = static_cast<CData>(size);
      top.consumer = 0;
      top.s_valid = top.m_ready = top.s_answer = 0;
      simulation.reset();
      bool offered = false;
      for (int clock = 0; clock < 4000; ++clock) {
        if (!offered) {
          offered = chance(random, busy);
          for (int w = 0; w < 4; ++w)
            sim::set_bits(top.s_data, 32 * w, 32, word_of(sent, w) & (w == 1 ? 0x7fffffff : ~0U));
        }
        top.s_valid = offered ? 1 : 0;
        top.m_ready = chance(random, busy) ? 1 : 0;
        for (int& left : writes) --left;
        top.s_answer = 0;
        top.s_answer_code = random() & 3;
        if (!writes.empty() && writes.front() <= 0) {
          top.s_answer = 1;
          top.s_answer_code = static_cast<CData>(
              bad && answered >= *bad && (answered == *bad || chance(random, 50)) ? 1 + random() % 3 : 0);
        }
        // the host reads what it has been promised
        if (chance(random, busy / 2)) {
          for (; read < held; ++read) {
            const auto& record =
                memory.at((top.base + (read & ((std::uint64_t{1} << size) - 1))) & ((std::uint64_t{1} << 60) - 1));
            CAPTURE(run, clock, read);
            for (int w = 0; w < 4; ++w) {
              const std::uint32_t phase = w == 1 && (read >> size & 1) == 0 ? 0x80000000U : 0U;
              REQUIRE(record[static_cast<std::size_t>(w)] ==
                      ((word_of(read, w) & (w == 1 ? 0x7fffffff : ~0U)) | phase));
            }
          }
        }
        // now and then an index that cannot be: it gives no room
        const bool wrong = chance(random, 2);
        top.consumer = static_cast<IData>(wrong ? held + 1 + random() % 5 : read);
        simulation.settle();
        REQUIRE(top.producer == static_cast<IData>(held));
        REQUIRE((top.failed != 0) == failed);
        REQUIRE((top.idle != 0) == (sent == held));
        if (top.m_valid != 0) {
          const std::uint64_t place =
              (top.base + (written & ((std::uint64_t{1} << size) - 1))) & ((std::uint64_t{1} << 60) - 1);
          REQUIRE(std::uint64_t{top.m_address} == place / static_cast<std::uint64_t>(part));
          const int lane = static_cast<int>(place % static_cast<std::uint64_t>(part));
          REQUIRE(sim::get_bits(top.m_strb, 0, width / 8) == std::uint64_t{0xffff} << 16 * lane);
          REQUIRE(written - read < (std::uint64_t{1} << size));  // it overwrites nothing that was not read
          if (top.m_ready != 0) {
            for (int w = 0; w < 4; ++w)
              memory[place][static_cast<std::size_t>(w)] =
                  static_cast<std::uint32_t>(sim::get_bits(top.m_data, 128 * lane + 32 * w, 32));
            ++written;
            writes.push_back(1 + static_cast<int>(random() % 20));
          }
        }
        if (top.s_valid != 0 && top.s_ready != 0) {
          offered = false;
          ++sent;
        }
        if (top.s_answer != 0) {
          writes.pop_front();
          ++answered;
          failed = failed || top.s_answer_code != 0;
          if (!failed) ++held;
        }
        simulation.rise();
      }
      REQUIRE(failed == bad.has_value());
      REQUIRE(sent >= written);
      REQUIRE(sent <= written + 3);
      if (bad) REQUIRE(held == *bad);
      if (!bad) REQUIRE(held > 60);
    }
  });
}
