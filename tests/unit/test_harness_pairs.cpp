// SPDX-License-Identifier: Apache-2.0
// Pair streams and the engine `rtl`: they must carry what they are given. test_cchip_primtest_tri_tri.cpp checks the
// answers of the hardware.
#include <catch2/catch.hpp>
#include <cchip/machines/pair_port.hpp>
#include <cchip/machines/rtl_engine.hpp>
#include <cchip/sim/scoreboard.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/sim/wave_on_failure.hpp>
#include <filesystem>
#include <models/cchip_primtest_tri_tri.hpp>
#include <random>

using namespace cchip;
using namespace cchip::sim;

namespace {

GridPair random_pair(std::mt19937_64& random, int coord_w) {
  std::uniform_int_distribution<std::int32_t> coordinate(-(1 << (coord_w - 1)), (1 << (coord_w - 1)) - 1);
  GridPair pair;
  for (GridPrimitive* primitive : {&pair.a, &pair.b}) {
    for (Vec3i& vertex : primitive->v) vertex = Vec3i::NullaryExpr([&] { return coordinate(random); });
  }
  return pair;
}

/// B is A moved up by z: touching for z = 0, apart otherwise.
GridPair stacked(int z) {
  GridPair pair;
  pair.a.v = {Vec3i(0, 0, 0), Vec3i(10, 0, 0), Vec3i(0, 10, 3), Vec3i(0, 0, 0)};
  pair.b = pair.a;
  for (Vec3i& vertex : pair.b.v) vertex.z() += z;
  return pair;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("harness: pairs come back by tag under every pattern", "[unit][harness]",
                        test::cchip_primtest_tri_tri_configs) {
  const auto body = [](const SimulationOptions& options, const Pattern& source, const Pattern& back_pressure) {
    Simulation<typename TestType::Model> simulation(options);
    PairPort<typename TestType::Model> port(simulation.top(), TestType::COORD_W);
    auto driver = port.driver(source);
    auto sink = port.sink(back_pressure);
    std::mt19937_64 random(options.seed);
    TagScoreboard<PairRequest, PairResult> board("pairs", [](const PairRequest& sent, const PairResult& got) {
      const bool reserved = sent.mode > PairMode::directed;
      return (got.axis.cls == AxisClass::illegal) == reserved && (got.beats == 0) == reserved &&
             got.hit == (got.grid || !got.definite) && !(got.definite && sent.pair.eta == defs::err_unknown);
    });
    driver.when_idle([&] { port.scramble(random); });
    driver.on_accept([&](const PairRequest& sent, std::uint64_t clock) { board.expect(sent.tag, sent, clock); });
    sink.on_item([&](const PairResult& got, std::uint64_t clock) { board.got(got.tag, got, clock); });
    constexpr int pairs = 60;
    for (int i = 0; i < pairs; ++i) {
      PairRequest request{random_pair(random, TestType::COORD_W),
                          static_cast<std::uint16_t>(64 * (random() % 1024) + static_cast<unsigned>(i)),
                          PairMode::exhaustive};
      if (i % 7 == 3) request.mode = static_cast<PairMode>(1 + i % 3);
      if (i % 5 == 2) request.pair.eta = static_cast<int>(random() % 16);
      driver.push(request);
    }
    sink.expect_count(pairs);
    simulation.add(driver);
    simulation.add(sink);
    simulation.reset();
    simulation.run_until([&] { return sink.count() == pairs; }, 20000, "all results");
    simulation.run_until([&] { return simulation->idle != 0; }, 2, "idle");
    board.finish();
  };
  const std::uint64_t seed = seed_from_environment();
  for (const Pattern& source : standard_patterns(seed)) {
    for (const Pattern& back_pressure : standard_patterns(seed + 100)) {
      with_wave_on_failure("harness_pairs",
                           [&](const SimulationOptions& options) { body(options, source, back_pressure); });
    }
  }
}

TEST_CASE("harness: results of before a reset do not appear after it", "[unit][harness]") {
  using Config = test::tt_w16_s10_rel;
  with_wave_on_failure("harness_reset", [](const SimulationOptions& options) {
    Simulation<Config::Model> simulation(options);
    PairPort<Config::Model> port(simulation.top(), Config::COORD_W);
    auto driver = port.driver();
    auto sink = port.sink(Pattern::random(0.7, options.seed));
    std::mt19937_64 random(options.seed);
    TagScoreboard<int, PairResult> board("pairs", [](int, const PairResult&) { return true; });
    driver.on_accept([&](const PairRequest& sent, std::uint64_t clock) { board.expect(sent.tag, 0, clock); });
    sink.on_item([&](const PairResult& got, std::uint64_t clock) { board.got(got.tag, got, clock); });
    for (int i = 0; i < 1000; ++i) {
      driver.push({random_pair(random, Config::COORD_W), static_cast<std::uint16_t>(i), PairMode::exhaustive});
    }
    simulation.add(driver);
    simulation.add(sink);
    simulation.reset();
    for (int resets = 0; resets < 20; ++resets) {
      simulation.steps(random() % 300);
      board.clear();
      simulation.reset(1 + static_cast<int>(random() % 3));
    }
    simulation.run_until([&] { return driver.waiting() == 0 && board.open() == 0; }, 20000, "the rest");
    require(sink.count() > 100, "resets left too few results");
  });
}

TEST_CASE("harness: engine rtl answers batches in order and counts", "[unit][harness]") {
  const auto engine = make_rtl_engine();
  CHECK(engine->coord_w() == 16);
  CHECK(engine->run({}, PairMode::exhaustive).empty());
  const auto first = engine->run({stacked(0), stacked(1), stacked(-7)}, PairMode::exhaustive);
  const auto second = engine->run(std::vector<GridPair>(100, stacked(2)), PairMode::exhaustive);
  REQUIRE(first.size() == 3);
  REQUIRE(second.size() == 100);
  CHECK(first[0].grid);
  CHECK(first[0].axis.cls == AxisClass::none);
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
    CHECK_FALSE(first[i].grid);
    CHECK(first[i].definite);
    CHECK(first[i].axis == AxisCode{AxisClass::normal_a, 0, 0});
  }
  for (const EngineAnswer& answer : second) CHECK_FALSE(answer.grid);
  for (const EngineAnswer& answer : first) {
    CHECK(answer.clocks->answered - answer.clocks->accepted >=
          static_cast<std::uint64_t>(defs::pair_latency(defs::substages_default, defs::exhaustive_beats(3, 3))));
  }
  CHECK(second[0].clocks->accepted > first[2].clocks->answered);
  const EngineStatistics statistics = engine->statistics();
  std::uint64_t beats = 0;
  for (const auto* batch : {&first, &second}) {
    for (const EngineAnswer& answer : *batch) beats += static_cast<std::uint64_t>(answer.beats);
  }
  CHECK(statistics.beats == beats);
  CHECK(second[0].beats == defs::exhaustive_beats(3, 3));
  CHECK(statistics.waiting_clocks >= statistics.beats);
  CHECK(statistics.clocks > second.back().clocks->answered);
}

TEST_CASE("harness: a lone pair takes the generated latency", "[unit][harness]") {
  const auto engine = make_rtl_engine();
  const EngineAnswer answer = engine->run({stacked(1)}, PairMode::exhaustive).front();
  CHECK(answer.clocks->answered - answer.clocks->accepted ==
        static_cast<std::uint64_t>(defs::pair_latency(defs::substages_default, defs::exhaustive_beats(3, 3))));
}

TEST_CASE("harness: engine rtl answers more pairs than there are tags", "[unit][harness]") {
  const auto engine = make_rtl_engine();
  std::vector<GridPair> pairs;
  pairs.reserve(70000);
  for (int i = 0; i < 70000; ++i) pairs.push_back(stacked(i % 3 - 1));
  const auto answers = engine->run(pairs, PairMode::exhaustive);
  for (int i = 0; i < 70000; ++i) REQUIRE(answers[static_cast<std::size_t>(i)].grid == (i % 3 == 1));
}

TEST_CASE("harness: engine rtl refuses what it cannot answer", "[unit][harness]") {
  const auto engine = make_rtl_engine();
  GridPair vague = stacked(0);
  vague.eta = 16;
  CHECK_THROWS_WITH(engine->run({stacked(0), vague}, PairMode::exhaustive),
                    Catch::Contains("pair 1") && Catch::Contains("eta"));
  CHECK_THROWS_AS(engine->run({stacked(0)}, std::vector<PairMode>{}), std::invalid_argument);
  for (const int z : {32768, -32769}) {
    GridPair far = stacked(0);
    far.a.v[1].z() = z;
    CHECK_THROWS_AS(engine->run({far}, PairMode::exhaustive), std::invalid_argument);
  }
  GridPair edge = stacked(0);
  edge.a.v[1].z() = -32768;
  CHECK_NOTHROW(engine->run({edge}, PairMode::exhaustive));
  RtlEngineOptions options;
  options.trace_path = "/dev/null/wave.fst";
  CHECK_THROWS_AS(make_rtl_engine(options), std::runtime_error);
}

TEST_CASE("harness: engine rtl writes a bounded wave", "[unit][harness]") {
  RtlEngineOptions options;
  options.trace_path = wave_folder() + "/harness_engine.fst";
  const auto traced = [&](std::uint64_t clocks) {
    std::filesystem::remove(options.trace_path);
    options.trace_clocks = clocks;
    make_rtl_engine(options)->run(std::vector<GridPair>(300, stacked(1)), PairMode::exhaustive);
    return std::filesystem::file_size(options.trace_path);
  };
  const auto small = traced(100);
  CHECK(small > 0);
  CHECK(traced(0) > small);
}
