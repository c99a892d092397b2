// SPDX-License-Identifier: Apache-2.0
// cchip_calc_result against a scoreboard of queries, leaf pairs and records; the traversal is played by the test.

#include <cchip/internal/wire/definitions.hpp>
#include <cchip/internal/wire/query.hpp>
#include <deque>
#include <map>
#include <models/cchip_calc_result.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

struct LeafPair {
  std::size_t query = 0;
  unsigned context = 0, epoch = 0;
  unsigned pairs = 1;
  unsigned faces_given = 0;
  unsigned results = 0;  // that were given, bits
  unsigned hits = 0, definite = 0;
  std::array<std::uint64_t, 4> faces{};
  unsigned code = 0;
  bool ends = false;  // without primitive pairs
  bool complete = false;
};

struct QueryState {
  std::uint32_t tag = 0;
  bool live = true;
  std::uint32_t records = 0;
};

using Record = std::array<std::uint32_t, 4>;

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_calc_result: leaf pairs, judgements and records as the scoreboard has them",
                        "[unit][cchip_calc_result]", cchip_calc_result_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr unsigned leaves = TestType::LEAVES, contexts = 1U << TestType::CONTEXT_W;
    constexpr int leaf_w = leaves == 4 ? 2 : 6;
    auto& top = simulation.top();
    for (int run = 0; run < 12; ++run) {
      const int feed = run % 3 == 0 ? 100 : 40, results = run % 3 == 1 ? 100 : 50, receiver = run % 4 == 3 ? 5 : 80;
      std::vector<QueryState> queries;
      std::vector<std::size_t> current(contexts);  // query of each context
      std::vector<unsigned> epochs(contexts, 0);
      const auto start = [&](unsigned context) {
        current[context] = queries.size();
        epochs[context] = (epochs[context] + 1) % 4;
        queries.push_back({static_cast<std::uint32_t>(random())});
      };
      for (unsigned c = 0; c < contexts; ++c) start(c);
      std::map<unsigned, LeafPair> numbers;                    // in use
      std::deque<std::pair<std::uint64_t, unsigned>> judging;  // clock of the judgement, number
      std::deque<unsigned> complete;                           // numbers, in the order in which they have all results
      std::deque<Record> pair_records;
      std::deque<std::pair<std::size_t, Record>> done_records;  // pair records that must come before it, record
      std::deque<std::uint64_t> done_clocks;
      std::size_t pairs_expected = 0, pairs_seen = 0, begun = 0, ends = 0, dead = 0;
      std::optional<unsigned> ending;
      top.s_begin_valid = top.s_end_valid = top.s_faces_valid = top.s_result_valid = 0;
      top.m_leaf_ready = top.s_judged_valid = top.s_done_valid = top.m_record_ready = 0;
      simulation.reset();
      std::optional<LeafPair> next;
      bool result_offered = false;
      unsigned result_number = 0, result_pair = 0;
      bool result_hit = false, result_definite = false;
      for (std::uint64_t clock = 0; clock < 9000; ++clock) {
        const bool drains = clock > 8000;
        // a leaf pair
        if (!next && !drains && !ending && chance(random, feed)) {
          next.emplace();
          next->context = static_cast<unsigned>(random() % contexts);
          next->query = current[next->context];
          next->epoch = epochs[next->context];
          next->ends = chance(random, 10);
          next->pairs = 1U << random() % 3;
        }
        top.s_begin_valid = next ? 1 : 0;
        top.s_begin_context = static_cast<CData>(next ? next->context : random() % contexts);
        top.s_begin_epoch = static_cast<CData>(next ? next->epoch : random() & 3);
        top.s_begin_pairs = static_cast<CData>(next ? next->pairs - 1 : random() & 3);
        top.s_end_valid = ending ? 1 : 0;
        top.s_end_number = static_cast<CData>(ending ? *ending : random() % leaves);
        if (ending) {
          const LeafPair& leaf = numbers.at(*ending);
          top.s_end_context = static_cast<CData>(leaf.context);
          top.s_end_epoch = static_cast<CData>(leaf.epoch);
          top.s_end_code = static_cast<CData>(leaf.code);
        }
        // faces, then results of pairs that have theirs
        top.s_faces_valid = 0;
        sim::set_random(top.s_faces, 64, random);
        for (auto& [number, leaf] : numbers) {
          if (leaf.ends || leaf.faces_given == leaf.pairs || !chance(random, 40)) continue;
          top.s_faces_valid = 1;
          sim::set_bits(top.s_faces_pair, 0, 2 + leaf_w, 4 * number + leaf.faces_given);
          leaf.faces[leaf.faces_given++] = top.s_faces;
          break;
        }
        const unsigned just_given = top.s_faces_valid != 0 ? top.s_faces_pair : ~0U;
        if (!result_offered && chance(random, results)) {
          for (auto& [number, leaf] : numbers) {
            for (unsigned i = 0; i < leaf.faces_given && !result_offered; ++i) {
              if ((leaf.results >> i & 1) != 0 || 4 * number + i == just_given || !chance(random, 50)) continue;
              result_offered = true;
              result_number = number;
              result_pair = i;
              result_hit = chance(random, 40);
              result_definite = chance(random, 70);
            }
          }
        }
        top.s_result_valid = result_offered ? 1 : 0;
        sim::set_bits(top.s_result_pair, 0, 2 + leaf_w,
                      result_offered ? 4 * result_number + result_pair : random() % (4 * leaves));
        top.s_result_hit = result_hit ? 1 : 0;
        top.s_result_definite = result_definite ? 1 : 0;
        // the traversal
        top.m_leaf_ready = chance(random, 50) ? 1 : 0;
        top.s_judged_valid = 0;
        top.s_judged_live = random() & 1;
        top.s_judged_tag = static_cast<IData>(random());
        if (!judging.empty() && judging.front().first <= clock) {
          const unsigned number = judging.front().second;
          judging.pop_front();
          LeafPair& leaf = numbers.at(number);
          QueryState& query = queries[leaf.query];
          top.s_judged_valid = 1;
          top.s_judged_live = query.live ? 1 : 0;
          top.s_judged_tag = query.tag;
          dead += query.live ? 0 : 1;
          if (query.live) {
            for (unsigned i = 0; i < 4; ++i) {
              if ((leaf.hits >> i & 1) == 0) continue;
              pair_records.push_back({query.tag, (leaf.definite >> i & 1) << 1,
                                      static_cast<std::uint32_t>(leaf.faces[i]),
                                      static_cast<std::uint32_t>(leaf.faces[i] >> 32)});
              ++query.records;
              ++pairs_expected;
            }
            if (leaf.code != 0 || (leaf.hits != 0 && chance(random, 30)) || chance(random, 3)) {
              query.live = false;
              done_records.emplace_back(pairs_expected,
                                        Record{query.tag, 1U | static_cast<std::uint32_t>(random() & 3) << 1,
                                               static_cast<std::uint32_t>(random()), query.records});
              done_clocks.push_back(clock + 2 + random() % 3);  // as the traversal's queue of ends
              start(leaf.context);
            }
          }
          // the number is in use until its records have left: the scoreboard drops the rest
          leaf.complete = true;
        }
        const bool done =
            !done_records.empty() && done_clocks.size() == done_records.size() && done_clocks.front() <= clock;
        static_assert(sizeof(Record) == 16);
        top.s_done_valid = done ? 1 : 0;
        for (int w = 0; w < 4; ++w)
          sim::set_bits(top.s_done_data, 32 * w, 32,
                        done ? done_records.front().second[static_cast<std::size_t>(w)] : random());
        top.m_record_ready = chance(random, drains ? 100 : receiver) ? 1 : 0;
        simulation.settle();
        CAPTURE(run, clock);

        if (top.s_begin_valid != 0 && top.s_begin_ready != 0) {
          const unsigned number = top.m_number;
          REQUIRE((numbers.count(number) == 0 || numbers.at(number).complete));
          if (next->ends) {
            next->code = 1 + static_cast<unsigned>(random() % 7);
            ending = number;
          }
          numbers[number] = *next;
          next.reset();
          ++begun;
        } else if (ending && top.s_end_ready != 0) {
          complete.push_back(*ending);
          ending.reset();
          ++ends;
        }
        if (top.s_result_valid != 0 && top.s_result_ready != 0) {
          LeafPair& leaf = numbers.at(result_number);
          leaf.results |= 1U << result_pair;
          leaf.hits |= result_hit ? 1U << result_pair : 0;
          leaf.definite |= result_hit && result_definite ? 1U << result_pair : 0;
          result_offered = false;
          if (leaf.results == (1U << leaf.pairs) - 1) complete.push_back(result_number);
        }
        if (top.m_leaf_valid != 0 && top.m_leaf_ready != 0) {
          const std::uint64_t data = sim::get_bits(top.m_leaf_data, 0, TestType::CONTEXT_W + 11);
          const unsigned context = static_cast<unsigned>(data & (contexts - 1));
          const unsigned epoch = static_cast<unsigned>(data >> TestType::CONTEXT_W & 3);
          const unsigned definite = static_cast<unsigned>(data >> (TestType::CONTEXT_W + 2) & 7);
          const unsigned open = static_cast<unsigned>(data >> (TestType::CONTEXT_W + 5) & 7);
          const unsigned code = static_cast<unsigned>(data >> (TestType::CONTEXT_W + 8) & 7);
          REQUIRE(!complete.empty());
          const unsigned number = complete.front();
          complete.pop_front();
          const LeafPair& leaf = numbers.at(number);
          REQUIRE(!leaf.complete);
          REQUIRE(leaf.context == context);
          REQUIRE(leaf.epoch == epoch);
          REQUIRE(leaf.code == code);
          if (!leaf.ends) REQUIRE(leaf.results == (1U << leaf.pairs) - 1);
          REQUIRE(definite == static_cast<unsigned>(__builtin_popcount(leaf.definite)));
          REQUIRE(open == static_cast<unsigned>(__builtin_popcount(leaf.hits & ~leaf.definite)));
          const std::uint64_t earliest = judging.empty() ? 0 : judging.back().first + 1;
          judging.emplace_back(std::max(earliest, clock + 3 + random() % 12), number);
        }
        if (top.m_record_valid != 0 && top.m_record_ready != 0) {
          Record record;
          for (int w = 0; w < 4; ++w)
            record[static_cast<std::size_t>(w)] =
                static_cast<std::uint32_t>(sim::get_bits(top.m_record_data, 32 * w, 32));
          if ((record[1] & 1) != 0) {
            REQUIRE(!done_records.empty());
            REQUIRE(record == done_records.front().second);
            REQUIRE(pairs_seen >= done_records.front().first);
            done_records.pop_front();
          } else {
            REQUIRE(!pair_records.empty());
            REQUIRE(record == pair_records.front());
            pair_records.pop_front();
            ++pairs_seen;
          }
        }
        if (top.s_done_valid != 0 && top.s_done_ready != 0) done_clocks.pop_front();
        simulation.rise();
      }
      CAPTURE(begun, ends, dead, pairs_seen);
      if (receiver > 50) {
        REQUIRE(pair_records.empty());
        REQUIRE(done_records.empty());
        REQUIRE(dead > 0);
      }
      REQUIRE(begun > leaves);
      REQUIRE(ends > 0);
      REQUIRE(pairs_seen > 20);
    }
  });
}
