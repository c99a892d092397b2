// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/levels/added_deltas.hpp>
#include <cchip/levels/generator.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/levels/summary.hpp>
#include <cchip/program/seed.hpp>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <random>
#include <sstream>

using namespace cchip;
using namespace cchip::levels;

namespace {

LevelOptions short_bitstreams() {
  LevelOptions options;
  options.payload_bytes = 128;
  options.seed = sim::seed_from_environment();
  return options;
}

/// The first object pair of one kind.
Stimulus of_one_kind(const Stimulus& stimulus, ModuleId test) {
  for (const ObjectPair& objects : object_pairs(stimulus)) {
    if (objects.test != test) continue;
    const auto first = stimulus.begin() + static_cast<std::ptrdiff_t>(objects.first);
    return {first, first + static_cast<std::ptrdiff_t>(objects.count)};
  }
  FAIL("no object pair of this kind");
  return {};
}

constexpr std::array<ModuleId, 3> tests = {ModuleId::tri_tri, ModuleId::tri_quad, ModuleId::quad_quad};

}  // namespace

TEST_CASE("levels: each agrees with the reference, each reconfiguring one swaps once per object pair",
          "[systemc][levels]") {
  const Stimulus stimulus = generate({900, 9, sim::seed_from_environment()});
  const std::vector<std::uint8_t> expected = reference_answers(stimulus);
  for (const auto run : {run_l0, run_l1, run_l2, run_l3, run_l4}) {
    const LevelResult result = in_child([&] { return run(stimulus, short_bitstreams()); });
    CHECK(differences(expected, result.answers).empty());
    CHECK(result.swaps == (run == run_l0 ? 0 : 9));
  }
}

TEST_CASE("levels: quads may have their vertices in any order", "[systemc][levels]") {
  std::mt19937_64 random(sim::seed_from_environment());
  Stimulus stimulus = generate({1200, 6, sim::seed_from_environment()});
  for (StimulusPair& pair : stimulus) {
    for (GridPrimitive* p : {&pair.a, &pair.b}) {
      std::shuffle(p->v.begin(), p->v.begin() + static_cast<std::ptrdiff_t>(p->vertex_count()), random);
    }
  }
  const std::vector<std::uint8_t> expected = reference_answers(stimulus);
  for (const auto run : {run_l0, run_l3, run_l4}) {
    CHECK(differences(expected, in_child([&] { return run(stimulus, short_bitstreams()); }).answers).empty());
  }
}

TEST_CASE("levels: object pairs of the same kind one after the other need no swap", "[systemc][levels]") {
  Stimulus stimulus = of_one_kind(generate({120, 6, sim::seed_from_environment()}), ModuleId::tri_quad);
  for (std::size_t i = 0; i < stimulus.size(); ++i) stimulus[i].object_pair = i / 5;
  const std::vector<std::uint8_t> expected = reference_answers(stimulus);
  for (const auto run : {run_l1, run_l2, run_l3, run_l4}) {
    const LevelResult result = in_child([&] { return run(stimulus, short_bitstreams()); });
    CHECK(differences(expected, result.answers).empty());
    CHECK(result.swaps == 1);
  }
}

TEST_CASE("levels: without reset on configuration level 3 is wrong or hangs, with it it is right",
          "[systemc][levels][A.5]") {
  const Stimulus stimulus = generate({600, 6, sim::seed_from_environment()});
  const std::vector<std::uint8_t> expected = reference_answers(stimulus);
  for (std::uint64_t seed = sim::seed_from_environment(); seed < sim::seed_from_environment() + 4; ++seed) {
    LevelOptions options = short_bitstreams();
    options.seed = seed;
    INFO("power-up seed " << seed);
    CHECK(differences(expected, in_child([&] { return run_l3(stimulus, options); }).answers).empty());
    options.reset_on_configuration = false;
    bool failed = false;
    try {
      failed = !differences(expected, in_child([&] { return run_l3(stimulus, options); }).answers).empty();
    } catch (const std::runtime_error& error) {
      failed = true;
      INFO(error.what());
    }
    CHECK(failed);
  }
}

TEST_CASE("levels: portals of level 3 add no delta and no time, and change no answer", "[systemc][levels][A.4]") {
  const Stimulus stimulus = generate({900, 9, sim::seed_from_environment()});
  for (const ModuleId test : tests) {
    INFO("test " << static_cast<int>(test));
    const Stimulus part = of_one_kind(stimulus, test);
    const LevelResult portals = in_child([&] { return run_l3_preloaded(part, short_bitstreams()); });
    const LevelResult direct = in_child([&] { return run_l3_direct(part, short_bitstreams()); });
    CHECK(differences(reference_answers(part), direct.answers).empty());
    CHECK(portals.answers == direct.answers);
    CHECK(portals.deltas == direct.deltas);
    CHECK(portals.simulated_seconds == direct.simulated_seconds);
  }
  CHECK(added_deltas(stimulus, short_bitstreams()) == 0);
}

TEST_CASE("levels: bound directly, level 3 takes one kind only", "[systemc][levels]") {
  const Stimulus stimulus = generate({20, 2, sim::seed_from_environment()});
  CHECK_THROWS_WITH(in_child([&] { return run_l3_direct(stimulus, short_bitstreams()); }),
                    Catch::Contains("a stimulus of one kind is needed"));
}

TEST_CASE("levels: level 2 takes the times of equations (4) to (6)", "[systemc][levels]") {
  const Stimulus stimulus = generate({90, 5, sim::seed_from_environment()});
  LevelOptions options = short_bitstreams();
  options.payload_bytes = 1000;
  double expected = 0;
  for (const ObjectPair& objects : object_pairs(stimulus)) {
    const int vertices = objects.test == ModuleId::tri_tri ? 6 : objects.test == ModuleId::tri_quad ? 7 : 8;
    const auto bits = static_cast<double>(objects.count) * (12 * 32 + 3 * 16 * vertices);
    expected += 1000 / 50e6 + std::ceil(bits / 32) / 66e6;
  }
  const LevelResult result = in_child([&] { return run_l2(stimulus, options); });
  CHECK(result.simulated_seconds == Approx(expected).epsilon(1e-6));
  options.payload_bytes = 0;  // Table 1
  const double all = in_child([&] { return run_l2(stimulus, options); }).simulated_seconds;
  CHECK(all > 5 * 5409976 / 8 / 50e6);
  CHECK(all < 5 * 5504088 / 8 / 50e6 + expected);
}

TEST_CASE("levels: a child hands over results, messages and its end", "[systemc][levels]") {
  LevelResult result;
  result.answers = {1, 0, 1};
  result.swaps = 7;
  result.simulated_seconds = 0.5;
  result.wall_seconds = 0.25;
  result.deltas = 9;
  const LevelResult got = in_child([&] { return result; });
  CHECK(got.answers == result.answers);
  CHECK(got.swaps == 7);
  CHECK(got.simulated_seconds == 0.5);
  CHECK(got.wall_seconds == 0.25);
  CHECK(got.deltas == 9);
  CHECK_THROWS_WITH(in_child([]() -> LevelResult { throw std::runtime_error("what went wrong"); }), "what went wrong");
  CHECK_THROWS_WITH(in_child([]() -> LevelResult { std::_Exit(3); }), Catch::Contains("without a result"));
  CHECK_THROWS_WITH(in_child([]() -> LevelResult {
                      std::signal(SIGABRT, SIG_DFL);
                      std::abort();
                    }),
                    Catch::Contains("by signal"));
}

TEST_CASE("levels: the summary finds wrong answers, missing answers and swaps", "[systemc][levels]") {
  const Stimulus stimulus = generate({30, 3, sim::seed_from_environment()});
  LevelResult right;
  right.answers = reference_answers(stimulus);
  right.swaps = 3;
  LevelResult wrong = right;
  wrong.answers[4] ^= 1;
  LevelResult missing = right;
  missing.answers.resize(28);
  LevelResult other = right;
  other.swaps = 2;
  const auto last_line = [&](const std::vector<LevelResult>& results, std::int64_t deltas, bool good) {
    Summary summary(stimulus);
    for (const LevelResult& result : results) summary.add({"L1", "a level", true, result, {}});
    summary.set_added_deltas(deltas);
    CHECK(summary.good() == good);
    std::ostringstream out;
    summary.print(out);
    const std::string text = out.str();
    return text.substr(text.rfind('\n', text.size() - 2) + 1);
  };
  CHECK(last_line({right, right}, 0, true) == "levels=2 pairs=30 swaps=3 mismatches=0 added_deltas=0\n");
  CHECK(last_line({right, wrong}, 0, false) == "levels=2 pairs=30 swaps=3 mismatches=1 added_deltas=0\n");
  CHECK(last_line({missing}, 0, false) == "levels=1 pairs=30 swaps=3 mismatches=2 added_deltas=0\n");
  CHECK(last_line({right, other}, 0, false) == "levels=2 pairs=30 swaps=3 mismatches=0 added_deltas=0\n");
  CHECK(last_line({LevelResult()}, 0, false) == "levels=1 pairs=30 swaps=0 mismatches=30 added_deltas=0\n");
  CHECK(last_line({right}, 5, false) == "levels=1 pairs=30 swaps=3 mismatches=0 added_deltas=5\n");
}
