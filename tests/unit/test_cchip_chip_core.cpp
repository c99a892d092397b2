// SPDX-License-Identifier: Apache-2.0
// The whole chip, small, against the functional model: memory and hosts of every kind, faults, reset at any clock.
#include <algorithm>
#include <cchip/machines/simulated_chip_core.hpp>
#include <models/cchip_chip_core.hpp>

#include "bench.hpp"
#include "chip_objects.hpp"

using namespace cchip;
using namespace cchip::test;
using cchip::sim::ChipAnswer;
using cchip::sim::ChipOptions;
using cchip::sim::compare_answer;
using cchip::sim::SimulatedChipCore;
using cchip::testing::Objects;
using cchip::testing::queries_of;
using cchip::testing::wild;

namespace {

constexpr std::uint64_t most_clocks = 3000000;

struct Totals {
  std::size_t hits = 0, records = 0, open = 0;
  std::array<std::size_t, 8> codes{};
};

/// Runs these queries and compares every answer whose code is not one of `faults`.
template <class Bench>
Totals check(Bench& bench, const Objects& objects, const std::vector<Query>& queries,
             const std::vector<QueryCode>& faults = {}) {
  const std::size_t from = bench.answers().size();
  for (const Query& query : queries) bench.submit(query);
  REQUIRE(bench.run(most_clocks));
  CAPTURE(bench.wrong());
  REQUIRE(bench.wrong().empty());
  Totals totals;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const ChipAnswer& answer = bench.answers()[from + i];
    REQUIRE(answer.done.has_value());
    const QueryCode code = answer.done->code;
    ++totals.codes[static_cast<std::size_t>(code)];
    if (std::find(faults.begin(), faults.end(), code) != faults.end()) continue;
    const std::string wrong = compare_answer(queries[i], answer, objects.expected(queries[i]), bench.top().open_limit);
    CAPTURE(i, wrong);
    REQUIRE(wrong.empty());
    totals.hits += answer.done->answer == QueryAnswer::yes ? 1 : 0;
    totals.records += answer.pairs.size();
    for (const PairRecord& pair : answer.pairs) totals.open += pair.definite ? 0 : 1;
  }
  return totals;
}

constexpr Kind kind_of(int module) { return module == 3 ? Kind::quad : Kind::tri; }

/// After each power-up: body(bench, objects, random), with two meshes of this kind in the memory.
template <class Config, class Body>
void with_objects(Kind kind, Body body) {
  const Objects meshes(kind);
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Random random(options.seed);
    Objects objects = meshes;
    SimulatedChipCore<Config> bench(options);
    objects.place(bench);
    body(bench, objects, random);
  });
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_chip_core: every record is the model's, with any memory, ring and host",
                        "[unit][cchip_chip_core]", cchip_chip_core_configs) {
  with_objects<TestType>(kind_of(TestType::RM_ID),
                         [&](SimulatedChipCore<TestType>& bench, const Objects& objects, Random& random) {
                           Totals all;
                           const auto add = [&](const Totals& x) {
                             all.hits += x.hits;
                             all.records += x.records;
                           };
                           add(check(bench, objects, queries_of(objects, random, 24)));
                           bench.memory().options = wild();
                           for (const unsigned ring : {4U, 3U, 0U}) {
                             bench.chip().record_log2 = ring;
                             bench.chip().query_log2 = ring == 0 ? 0 : 2;
                             bench.chip().host_every = ring == 4 ? 997 : 61;
                             ++bench.chip().generation;
                             bench.reset();
                             add(check(bench, objects, queries_of(objects, random, 12)));
                           }
                           REQUIRE(all.hits > 5);
                           REQUIRE(all.records > 100);
                         });
}

TEST_CASE("cchip_chip_core: quads without their test come back as open pairs, none lost", "[unit][cchip_chip_core]") {
  with_objects<chip_core_tri>(
      Kind::quad, [&](SimulatedChipCore<chip_core_tri>& bench, const Objects& objects, Random& random) {
        bench.memory().options = wild();
        std::size_t records = 0;
        const std::vector<Query> queries = queries_of(objects, random, 20);
        for (const Query& query : queries) bench.submit(query);
        REQUIRE(bench.run(most_clocks));
        REQUIRE(bench.wrong().empty());
        for (std::size_t i = 0; i < queries.size(); ++i) {
          const ChipAnswer& answer = bench.answers()[i];
          const model::BroadPhaseResult expected = objects.expected(queries[i]);
          std::set<std::pair<std::uint32_t, std::uint32_t>> got;
          for (const PairRecord& pair : answer.pairs) {
            REQUIRE_FALSE(pair.definite);
            got.emplace(pair.id_a, pair.id_b);
          }
          records += got.size();
          if (queries[i].mode == QueryMode::first) {
            // one leaf pair at a time may cross the limit
            const bool limit = answer.done->code == QueryCode::host && answer.pairs.size() >= bench.top().open_limit;
            REQUIRE((limit || answer.done->code == QueryCode::ok));
            continue;
          }
          REQUIRE(answer.done->code == QueryCode::ok);
          REQUIRE(answer.pairs.size() == expected.counts.primitive_pairs);
          REQUIRE(got.size() == answer.pairs.size());
          REQUIRE(answer.done->answer == (got.empty() ? QueryAnswer::no : QueryAnswer::open));
          for (const PairRecord& pair : expected.pairs) REQUIRE(got.count({pair.id_a, pair.id_b}) == 1);
        }
        REQUIRE(records > 100);
      });
}

TEMPLATE_LIST_TEST_CASE("cchip_chip_core: an error of the bus or a silent read ends its queries and no other",
                        "[unit][cchip_chip_core]", cchip_chip_core_configs) {
  with_objects<TestType>(kind_of(TestType::RM_ID), [&](SimulatedChipCore<TestType>& bench, const Objects& objects,
                                                       Random& random) {
    bench.memory().options = wild();
    bench.top().memory_limit = 3000;
    using sim::AxiFault;
    const auto image = [](std::uint64_t line) { return line >= SimulatedChipCore<TestType>::first_image; };
    bench.memory().read_fault = [&](std::uint64_t line) {
      return image(line) && chance(random, 1) ? AxiFault::slave_error : AxiFault::none;
    };
    const Totals errors = check(bench, objects, queries_of(objects, random, 20), {QueryCode::memory});
    REQUIRE(errors.codes[static_cast<std::size_t>(QueryCode::memory)] > 0);
    REQUIRE(errors.codes[static_cast<std::size_t>(QueryCode::memory)] < 20);

    // some reads are never answered: each ends the queries that wait for it; after that everything is right. The first
    // one of all is one of them, because no query has ended by then that could have given up its reads
    constexpr int silences = std::min(TestType::MISSES / 2, 4);  // 20 queries meet no more for certain
    int left = silences;
    bench.memory().read_fault = [&](std::uint64_t line) {
      return image(line) && left > 0 && (left == silences || chance(random, 5)) ? (--left, AxiFault::silence)
                                                                                : AxiFault::none;
    };
    const Totals silent = check(bench, objects, queries_of(objects, random, 20), {QueryCode::memory});
    REQUIRE(left == 0);
    REQUIRE(silent.codes[static_cast<std::size_t>(QueryCode::memory)] > 0);
    REQUIRE(bench.memory().silent() == silences);
    const Totals after = check(bench, objects, queries_of(objects, random, 20));
    REQUIRE(after.codes[static_cast<std::size_t>(QueryCode::memory)] == 0);

    // all slots are lost: every query ends with the code, at once, unless the cache has its lines
    bench.memory().read_fault = [&](std::uint64_t line) { return image(line) ? AxiFault::silence : AxiFault::none; };
    const Totals dead = check(bench, objects, queries_of(objects, random, 20), {QueryCode::memory});
    REQUIRE(dead.codes[static_cast<std::size_t>(QueryCode::memory)] > 10);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_chip_core: a ring stops at what it cannot read or write", "[unit][cchip_chip_core]",
                        cchip_chip_core_configs) {
  with_objects<TestType>(
      kind_of(TestType::RM_ID), [&](SimulatedChipCore<TestType>& bench, const Objects& objects, Random& random) {
        int ring_reads = 0;
        bench.memory().read_fault = [&](std::uint64_t line) {
          return line < SimulatedChipCore<TestType>::first_image && ++ring_reads == 6 ? sim::AxiFault::slave_error
                                                                                      : sim::AxiFault::none;
        };
        for (const Query& query : queries_of(objects, random, 12)) bench.submit(query);
        REQUIRE_FALSE(bench.run(400000));
        REQUIRE(bench.top().query_failed == 1);
        REQUIRE(bench.top().query_consumer == 5);
        REQUIRE(bench.unanswered() == 7);  // those before it have their answers
        REQUIRE(bench.wrong().empty());

        bench.memory().read_fault = [](std::uint64_t) { return sim::AxiFault::none; };
        ++bench.chip().generation;
        bench.reset();
        REQUIRE(bench.top().query_failed == 0);
        int writes = 0;
        bench.memory().write_fault = [&](std::uint64_t) {
          return ++writes == 9 ? sim::AxiFault::slave_error : sim::AxiFault::none;
        };
        for (const Query& query : queries_of(objects, random, 12)) bench.submit(query);
        REQUIRE_FALSE(bench.run(400000));
        REQUIRE(bench.top().record_failed == 1);
        REQUIRE(bench.top().record_producer == 8);
        REQUIRE(bench.wrong().empty());

        bench.memory().write_fault = [](std::uint64_t) { return sim::AxiFault::none; };
        ++bench.chip().generation;
        bench.reset();
        check(bench, objects, queries_of(objects, random, 8));
      });
}

TEMPLATE_LIST_TEST_CASE("cchip_chip_core: garbage in an image ends its queries with a code or not at all",
                        "[unit][cchip_chip_core]", cchip_chip_core_configs) {
  const Objects meshes(kind_of(TestType::RM_ID));
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Random random(options.seed);
    std::array<int, 8> codes{};
    int compared = 0;
    for (int run = 0; run < 4; ++run) {
      Objects objects = meshes;
      for (int i = 0; i < 10; ++i) {
        bvh::Image& image = chance(random, 50) ? objects.a : objects.b;
        Line& line = image.lines[1 + random() % (image.lines.size() - 1)];
        if (chance(random, 50)) {
          for (std::uint8_t& byte : line) byte = static_cast<std::uint8_t>(random());
        } else {
          line[random() % line.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
        }
      }
      SimulatedChipCore<TestType> bench(options);
      bench.top().step_limit = 2000;
      objects.place(bench);
      const std::vector<Query> queries = queries_of(objects, random, 12);
      for (const Query& query : queries) bench.submit(query);
      REQUIRE(bench.run(most_clocks));
      REQUIRE(bench.wrong().empty());
      model::BroadPhaseOptions model_options;
      model_options.step_limit = 2000;
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const ChipAnswer& answer = bench.answers()[i];
        ++codes[static_cast<std::size_t>(answer.done->code)];
        Query whole = queries[i];
        whole.mode = QueryMode::all;
        // Where a query meets several lines that end it, which comes first depends on the order. Where it meets none,
        // all must be as the model has it.
        const bool clean = objects.expected(whole, model_options).done.code == QueryCode::ok;
        CAPTURE(run, i, clean, static_cast<int>(answer.done->code));
        if (clean) {
          REQUIRE(compare_answer(queries[i], answer, objects.expected(queries[i], model_options), 16).empty());
          ++compared;
        } else if (queries[i].mode == QueryMode::all) {
          REQUIRE(answer.done->code != QueryCode::ok);
        }
      }
    }
    REQUIRE(codes[static_cast<std::size_t>(QueryCode::ok)] > 0);
    REQUIRE(codes[static_cast<std::size_t>(QueryCode::corrupt)] + codes[static_cast<std::size_t>(QueryCode::outside)] >
            0);
    REQUIRE(compared > 0);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_chip_core: reset at any clock leaves nothing of before", "[unit][cchip_chip_core]",
                        cchip_chip_core_configs) {
  with_objects<TestType>(kind_of(TestType::RM_ID),
                         [&](SimulatedChipCore<TestType>& bench, const Objects& objects, Random& random) {
                           bench.memory().options = wild();
                           for (int i = 0; i < 30; ++i) {
                             for (const Query& query : queries_of(objects, random, 6)) bench.submit(query);
                             bench.steps(random() % 6000);
                             ++bench.chip().generation;  // earlier records belong to no query
                             bench.reset();
                             REQUIRE(bench.wrong().empty());
                           }
                           check(bench, objects, queries_of(objects, random, 12));
                         });
}
