// SPDX-License-Identifier: Apache-2.0
// The broad phase whole, under faults: queries end with their code, the others with their answers, nothing hangs.
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/internal/tree/tree.hpp>
#include <cchip/machines/simulated_broad_phase.hpp>
#include <cchip/shapes.hpp>
#include <models/cchip_broad_phase_axi.hpp>
#include <set>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;
using Answer = sim::BroadPhaseAnswer;
using sim::AxiFault;

namespace {

constexpr std::uint32_t line_a = 0x1000;
constexpr std::uint32_t line_b = 0x2000;
constexpr std::size_t most_each = 7;  ///< node pairs of a query in flight

bvh::Image image_of(const Mesh& mesh) { return bvh::make_image(mesh, bvh::build_tree(mesh)); }

/// Two objects and what may be asked of them.
struct Objects {
  bvh::Image a = image_of(make_sphere(1, 5));
  bvh::Image b = image_of(make_torus(1, 0.4, 16, 10, Kind::quad));

  Query query(Random& random, QueryMode mode) const {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto pose = [&] {
      Pose p = Pose::Identity();
      p.linear() =
          Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized().toRotationMatrix();
      return p;
    };
    for (;;) {
      Pose pose_b = pose();
      pose_b.translation() = Vec3d(unit(random), unit(random), unit(random)) * 2.2;
      std::optional<Query> query = bvh::make_query(a.header(), pose(), b.header(), pose_b);
      if (!query) continue;
      query->mode = mode;
      query->base_a = query->swapped ? line_b : line_a;
      query->base_b = query->swapped ? line_a : line_b;
      return *query;
    }
  }
  const bvh::Image& moved(const Query& query) const { return query.swapped ? b : a; }
  const bvh::Image& fixed(const Query& query) const { return query.swapped ? a : b; }
};

template <class Config>
struct Broad : sim::SimulatedBroadPhase<Config> {
  using Base = sim::SimulatedBroadPhase<Config>;
  static constexpr std::size_t stack = Config::STACK;
  Objects objects;
  explicit Broad(std::uint64_t seed) : Base(sim::without_timeout(seed)) { restore(); }
  void restore() {
    this->place(line_a, objects.a.lines);
    this->place(line_b, objects.b.lines);
  }
};

model::BroadPhaseResult expected(const Objects& objects, const Query& query,
                                 const model::BroadPhaseOptions& options = {}) {
  return run_query(query, objects.moved(query), objects.fixed(query), options);
}

using Pairs = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;
Pairs pairs_of(const std::vector<PairRecord>& records) {
  Pairs pairs;
  for (const PairRecord& x : records) pairs.emplace(x.id_a, x.id_b);
  return pairs;
}

/// The answer is the model's; or the stack was full, to which every node pair in flight adds.
template <class Machine>
void check(const Machine& bench, const Query& query, const Answer& answer) {
  REQUIRE(answer.done);
  const model::BroadPhaseResult model = expected(bench.objects, query);
  if (answer.done->code == QueryCode::stack) {
    REQUIRE(model.counts.stack_most * most_each >= Machine::stack);
    return;
  }
  REQUIRE(answer.done->answer == model.done.answer);
  REQUIRE(answer.done->code == model.done.code);
  if (query.mode == QueryMode::all || model.done.answer == QueryAnswer::no) {
    REQUIRE(answer.done->steps == model.done.steps);
    REQUIRE(answer.leaf_pairs.size() == model.counts.leaf_pairs);
    REQUIRE(answer.done->pairs == answer.pairs.size());
    REQUIRE(pairs_of(answer.pairs) == pairs_of(model.pairs));
  }
}

template <class Machine>
std::vector<Query> submit(Machine& bench, Random& random, int count) {
  std::vector<Query> queries;
  for (int i = 0; i < count; ++i) {
    queries.push_back(bench.objects.query(random, chance(random, 60) ? QueryMode::first : QueryMode::all));
    bench.submit(queries.back());
  }
  return queries;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE(
    "cchip_broad_phase_axi: answers and counts are the functional model's with any memory and receiver",
    "[unit][cchip_broad_phase_axi]", cchip_broad_phase_axi_configs) {
  Random random(sim::seed_from_environment());
  Broad<TestType> bench(random());
  std::size_t from = 0;
  for (int round = 0; round < 6; ++round) {
    sim::AxiLinesOptions& memory = bench.memory().options;
    memory.latency = round == 0 ? 1 : random() % 150;
    memory.jitter = round < 2 ? 0 : 60;
    memory.reorder = round % 2 == 1;
    memory.beat_every = round == 3 ? 3 : 1;
    memory.ready_percent = round == 4 ? 30 : 100;
    bench.receiver().jitter = round >= 3 ? 400 : 0;
    bench.done_percent = round == 5 ? 2 : 100;
    bench.at_once = round == 2 ? 1 : 0;
    bench.top().pairs_each = static_cast<CData>(1 + random() % most_each);
    const std::vector<Query> queries = submit(bench, random, 40);
    bench.run(3000000);
    for (std::size_t i = 0; i < queries.size(); ++i) check(bench, queries[i], bench.answers()[from + i]);
    from += queries.size();
  }
}

TEMPLATE_LIST_TEST_CASE(
    "cchip_broad_phase_axi: errors and silence of memory end a query with a code, later ones are right",
    "[unit][cchip_broad_phase_axi]", cchip_broad_phase_axi_configs) {
  Random random(sim::seed_from_environment());
  Broad<TestType> bench(random());
  bench.memory().options.latency = 20;
  bench.top().memory_limit = 500;
  for (const AxiFault fault : {AxiFault::slave_error, AxiFault::silence}) {
    const std::size_t from = bench.answers().size();
    unsigned share = 50;  // one read in this many
    bench.memory().read_fault = [&](std::uint64_t) { return random() % share == 0 ? fault : AxiFault::none; };
    std::vector<Query> queries = submit(bench, random, 60);
    bench.run(3000000);
    int failed = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Answer& answer = bench.answers()[from + i];
      if (answer.done->code == QueryCode::memory) {
        ++failed;
      } else {
        check(bench, queries[i], answer);
      }
    }
    REQUIRE(failed > 0);
    REQUIRE(failed < 60);
    bench.memory().read_fault = [](std::uint64_t) { return AxiFault::none; };
    bench.reset();
    const std::size_t after = bench.answers().size();
    queries = submit(bench, random, 10);
    bench.run(1000000);
    for (std::size_t i = 0; i < queries.size(); ++i) check(bench, queries[i], bench.answers()[after + i]);
  }
}

TEMPLATE_LIST_TEST_CASE("cchip_broad_phase_axi: a corrupt line has the model's code, and any bits end a query",
                        "[unit][cchip_broad_phase_axi]", cchip_broad_phase_axi_configs) {
  Random random(sim::seed_from_environment());
  Broad<TestType> bench(random());
  bench.memory().options.latency = 10;
  bench.top().pairs_each = 1;  // three of a lone query in flight: more may fill the smallest stack first
  const Query query = [&] {    // one that visits much
    for (;;) {
      const Query q = bench.objects.query(random, QueryMode::all);
      if (expected(bench.objects, q).counts.leaf_pairs > 20) return q;
    }
  }();
  const std::uint32_t base = query.base_a;
  const bvh::Image good = bench.objects.moved(query);
  const std::uint32_t root = good.header().root;
  const auto run = [&](std::uint32_t line, auto&& change) {
    bvh::Image bad = good;
    change(bad.lines[line]);
    bench.place(base, bad.lines);
    bench.reset();
    const std::size_t at = bench.submit(query);
    bench.run(3000000);
    const QueryCode code = bench.answers()[at].done->code;
    const model::BroadPhaseResult wanted = model::run_query(query, bad, bench.objects.fixed(query));
    INFO("line " << line);
    REQUIRE(code == wanted.done.code);
    bench.restore();
    return code;
  };
  using namespace bvh;
  const auto lines = static_cast<std::int64_t>(good.lines.size());
  REQUIRE(run(0, [](Line& x) { put(x, header_field::magic, 0x12345678); }) == QueryCode::bad_descriptor);
  REQUIRE(run(0, [](Line& x) { put(x, header_field::version, 2); }) == QueryCode::bad_descriptor);
  REQUIRE(run(0, [&](Line& x) { put(x, header_field::root, lines); }) == QueryCode::outside);
  REQUIRE(run(root, [](Line& x) { put(x, inner_field::step, 19); }) == QueryCode::corrupt);
  REQUIRE(run(root, [](Line& x) { put(x, inner_field::step, 31); }) == QueryCode::corrupt);
  for (std::size_t axis = 0; axis < 3; ++axis) {  // greatest < least
    REQUIRE(run(root, [axis](Line& x) {
              put(x, child_field::box, 63, 2 * axis, inner_field::child.lsb);
              put(x, child_field::box, 62, 2 * axis + 1, inner_field::child.lsb);
            }) == QueryCode::corrupt);
  }
  REQUIRE(run(root, [&](Line& x) { put(x, inner_field::first, root); }) == QueryCode::outside);
  REQUIRE(run(root, [](Line& x) { put(x, inner_field::first, 0); }) == QueryCode::outside);
  REQUIRE(run(root, [&](Line& x) {
            put(x, inner_field::first, lines - 1);
            put(x, inner_field::children, 3);
          }) == QueryCode::outside);
  REQUIRE(run(root, [](Line& x) { put(x, inner_field::first, 0xFFFFFF); }) == QueryCode::outside);
  std::uint32_t leaf = 0;  // of a pair that overlaps
  {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    model::BroadPhaseOptions options;
    options.leaf_pairs = &pairs;
    expected(bench.objects, query, options);
    leaf = pairs.front().first;
  }
  REQUIRE(run(leaf, [](Line& x) { put(x, leaf_field::extent, 25); }) == QueryCode::corrupt);

  // any bits: an end, whichever
  bench.top().step_limit = 3000;
  for (int i = 0; i < 150; ++i) {
    bvh::Image bad = good;
    for (int flips = 0; flips < 4; ++flips) {
      const auto line = static_cast<std::size_t>(random() % static_cast<std::uint64_t>(chance(random, 50) ? 8 : lines));
      bad.lines[line][random() % 64] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    bench.place(base, bad.lines);
    bench.reset();
    bench.submit(query);
    bench.run(3000000);
  }
  bench.top().step_limit = 0xffffffff;
  bench.restore();
  bench.reset();
  const std::size_t at = bench.submit(query);
  bench.run(3000000);
  check(bench, query, bench.answers()[at]);
}

TEMPLATE_LIST_TEST_CASE("cchip_broad_phase_axi: step limit, open pairs, full stack, bad descriptors",
                        "[unit][cchip_broad_phase_axi]", cchip_broad_phase_axi_configs) {
  Random random(sim::seed_from_environment());
  Broad<TestType> bench(random());
  bench.memory().options.latency = 10;
  SECTION("steps") {
    bench.top().step_limit = 7;
    const std::vector<Query> queries = submit(bench, random, 40);
    bench.run(1000000);
    int limited = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Answer& answer = bench.answers()[i];
      REQUIRE(answer.done->steps <= 7);
      if (answer.done->code == QueryCode::steps) {
        REQUIRE(answer.done->steps == 7);
        // a query for the first hit may have gone on while its hit was in flight
        if (queries[i].mode == QueryMode::all) REQUIRE(expected(bench.objects, queries[i]).counts.steps > 7);
        ++limited;
      } else {
        check(bench, queries[i], answer);
      }
    }
    REQUIRE(limited > 5);
  }
  SECTION("stack") {
    bench.receiver().jitter = 50;
    const std::vector<Query> queries = submit(bench, random, 100);
    bench.run(5000000);
    int full = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Answer& answer = bench.answers()[i];
      if (answer.done->code == QueryCode::stack) {
        ++full;
      } else {
        check(bench, queries[i], answer);
      }
    }
    REQUIRE((full > 0) == (TestType::STACK == 8));
  }
  SECTION("open pairs") {
    bench.top().open_limit = 3;
    bench.receiver().all_open = true;
    std::map<QueryCode, int> ends;
    for (int i = 0; i < 40; ++i) {
      Query query = bench.objects.query(random, QueryMode::all);
      const std::size_t pairs = expected(bench.objects, query).pairs.size();
      query.mode = QueryMode::first;
      const std::size_t at = bench.submit(query);
      bench.run(1000000);
      const Answer& answer = bench.answers()[at];
      if (TestType::STACK < 64 && answer.done->code == QueryCode::stack) continue;
      REQUIRE(answer.done->code == (pairs >= 3 ? QueryCode::host : QueryCode::ok));
      REQUIRE(answer.done->answer == (pairs > 0 ? QueryAnswer::open : QueryAnswer::no));
      REQUIRE(answer.pairs.size() >= std::min<std::size_t>(pairs, 3));
      ++ends[answer.done->code];
    }
    REQUIRE(ends.size() == 2);
  }
  SECTION("limits that change while queries are at work") {
    const std::vector<Query> queries = submit(bench, random, 40);
    for (int clock = 0; bench.unanswered() > 0; ++clock) {
      REQUIRE(clock < 3000000);
      if (chance(random, 5)) bench.top().pairs_each = static_cast<CData>(random() % (most_each + 1));
      bench.step();
    }
    for (std::size_t i = 0; i < queries.size(); ++i) check(bench, queries[i], bench.answers()[i]);
    bench.top().pairs_each = 0;  // as 1
    submit(bench, random, 40);
    bench.steps(2000);
    bench.top().step_limit = 0;
    bench.run(1000000);
    REQUIRE(bench.answers().back().done->code == QueryCode::steps);
    REQUIRE(bench.answers().back().done->steps == 0);
  }
  SECTION("descriptors") {
    for (std::size_t i = 0; i < 9; ++i) {
      Query query = bench.objects.query(random, QueryMode::first);
      query.m[i / 3][i % 3] = chance(random, 50) ? (1 << 30) + 1 : -(1 << 30) - 1;
      const std::size_t at = bench.submit(query);
      bench.run(100000);
      REQUIRE(bench.answers()[at].done->code == QueryCode::bad_descriptor);
      REQUIRE(bench.answers()[at].done->steps == 0);
    }
    for (const std::uint32_t base : {0xff000000U, 0xffffffffU}) {  // lines whose numbers could wrap
      for (const bool a : {true, false}) {
        Query query = bench.objects.query(random, QueryMode::first);
        (a ? query.base_a : query.base_b) = base;
        const std::size_t at = bench.submit(query);
        bench.run(100000);
        REQUIRE(bench.answers()[at].done->code == QueryCode::bad_descriptor);
      }
    }
    for (int bit : {478, 479}) {
      Query query = bench.objects.query(random, QueryMode::first);
      query.tag = static_cast<std::uint32_t>(bench.answers().size());
      Line line = encode(query);
      line[static_cast<std::size_t>(bit / 8)] |= static_cast<std::uint8_t>(1U << (bit % 8));
      const std::size_t at = bench.submit_line(line);
      bench.run(100000);
      REQUIRE(bench.answers()[at].done->code == QueryCode::bad_descriptor);
    }
    const std::vector<Query> queries = submit(bench, random, 5);
    bench.run(1000000);
    for (std::size_t i = 0; i < 5; ++i) check(bench, queries[i], bench.answers()[bench.answers().size() - 5 + i]);
  }
}

TEMPLATE_LIST_TEST_CASE("cchip_broad_phase_axi: contexts start anew while results of ended queries are held back",
                        "[unit][cchip_broad_phase_axi]", cchip_broad_phase_axi_configs) {
  Random random(sim::seed_from_environment());
  Broad<TestType> bench(random());
  bench.memory().options.latency = 5;
  std::vector<Query> queries;
  while (queries.size() < 60) {  // in contact, with leaf pairs that are not
    Query query = bench.objects.query(random, QueryMode::first);
    if (expected(bench.objects, query).done.answer != QueryAnswer::yes) continue;
    queries.push_back(query);
    bench.submit(query);
  }
  bench.receiver().only_hits = true;
  bench.steps(1000000);
  const std::size_t held = bench.unanswered();
  bench.receiver().only_hits = false;
  bench.run(3000000);
  INFO("answered while results were held back: " << 60 - held);
  REQUIRE(held < 60);
  for (std::size_t i = 0; i < queries.size(); ++i) check(bench, queries[i], bench.answers()[i]);

  bench.receiver().held = true;  // everything
  const std::size_t from = bench.answers().size();
  queries = submit(bench, random, 30);
  bench.steps(100000);
  bench.receiver().held = false;
  bench.run(3000000);
  for (std::size_t i = 0; i < queries.size(); ++i) check(bench, queries[i], bench.answers()[from + i]);

  bench.done_percent = 0;  // no answer is taken
  const std::size_t last = bench.answers().size();
  queries = submit(bench, random, 60);
  bench.steps(100000);
  REQUIRE(bench.unanswered() == 60);
  bench.done_percent = 100;
  bench.run(3000000);
  for (std::size_t i = 0; i < queries.size(); ++i) check(bench, queries[i], bench.answers()[last + i]);
}

TEMPLATE_LIST_TEST_CASE("cchip_broad_phase_axi: any number of node pairs of a query, with late results of ended ones",
                        "[unit][cchip_broad_phase_axi]", cchip_broad_phase_axi_configs) {
  Random random(sim::seed_from_environment());
  Broad<TestType> bench(random());
  bench.memory().options.latency = 5;
  bench.receiver().jitter = 500;
  for (unsigned pairs_each = 1; pairs_each <= 7; ++pairs_each) {
    bench.top().pairs_each = static_cast<CData>(pairs_each);
    for (int burst = 0; burst < 3; ++burst) {
      const std::size_t from = bench.answers().size();
      const std::vector<Query> queries = submit(bench, random, 20);
      bench.receiver().only_hits = true;
      bench.steps(1000);
      bench.receiver().only_hits = false;  // what was held back comes at once, in any order
      bench.run(1000000);
      for (std::size_t i = 0; i < queries.size(); ++i) check(bench, queries[i], bench.answers()[from + i]);
    }
  }
}

TEMPLATE_LIST_TEST_CASE("cchip_broad_phase_axi: locks and invalidation during traffic", "[unit][cchip_broad_phase_axi]",
                        cchip_broad_phase_axi_configs) {
  Random random(sim::seed_from_environment());
  Broad<TestType> bench(random());
  bench.memory().options = {20, 0, 30, true};
  const std::vector<Query> queries = submit(bench, random, 80);
  for (std::uint64_t i = 0; bench.unanswered() > 0; ++i) {
    REQUIRE(i < 3000000);
    bench.step();
    if (random() % 300 == 0) {
      const auto first = static_cast<std::uint32_t>((chance(random, 50) ? line_a : line_b) + random() % 40);
      bench.set_lock(static_cast<int>(random() % TestType::LOCKS), first,
                     first + static_cast<std::uint32_t>(random() % 60) - 10);
    }
    if (!bench.invalidating() && random() % 200 == 0) {
      const auto first = static_cast<std::uint32_t>((chance(random, 50) ? line_a : line_b) + random() % 40);
      bench.invalidate(first, first + static_cast<std::uint32_t>(random() % 30));
    }
  }
  for (std::size_t i = 0; i < queries.size(); ++i) check(bench, queries[i], bench.answers()[i]);
}

TEMPLATE_LIST_TEST_CASE("cchip_broad_phase_axi: reset at any clock of a query", "[unit][cchip_broad_phase_axi]",
                        cchip_broad_phase_axi_configs) {
  Random random(sim::seed_from_environment());
  Broad<TestType> bench(random());
  bench.memory().options = {8, 0, 8, true};
  const Query query = bench.objects.query(random, QueryMode::all);
  const Query other = bench.objects.query(random, QueryMode::first);
  bench.clear_counters();
  bench.submit(query);
  bench.run(1000000);
  const std::uint64_t clocks = std::min<std::uint64_t>(bench.counters().clocks, 1500);
  for (std::uint64_t clock = 0; clock < clocks; clock += 1 + clock / 300) {
    bench.reset();
    bench.submit(query);
    bench.submit(other);
    bench.steps(clock);
    bench.reset();
    const std::size_t at = bench.submit(other);
    bench.run(1000000);
    check(bench, other, bench.answers()[at]);
  }
}
