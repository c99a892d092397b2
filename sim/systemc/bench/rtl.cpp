// SPDX-License-Identifier: Apache-2.0
// cchip_rtl_bench: primitive tests behind portals against the same tests bound directly; the refinement levels side by
// side.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cchip/levels/generator.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/program/seed.hpp>
#include <ctime>
#include <iostream>
#include <systemc>
#include <utility>
#include <vector>

#include "program.hpp"

namespace cchip::levels {
namespace {

using bench::median;
using RunLevel = LevelResult (*)(const Stimulus&, const LevelOptions&);

struct TimedResult {
  LevelResult level;
  double seconds = 0;  ///< processor time of its process, elaboration included: other programs disturb it less
};

TimedResult run_timed(RunLevel run, const Stimulus& stimulus) {
  LevelResult result = in_child([&] {
    LevelResult level = run(stimulus, LevelOptions());
    level.wall_seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;  // the way out of the process
    return level;
  });
  const double seconds = result.wall_seconds;
  return {std::move(result), seconds};
}

/// Runs of both in turn, each in its own process. Returns whether all answers agree.
bool compare(const char* name, RunLevel direct, RunLevel portals, std::size_t pairs, unsigned rounds) {
  const Stimulus stimulus = generate({pairs, 1, sim::seed_from_environment()});
  std::vector<double> ratios, direct_us, portal_us;
  bool same = true;
  std::int64_t added = 0;
  for (unsigned round = 0; round < rounds; ++round) {
    const auto [plain, plain_seconds] = run_timed(direct, stimulus);
    const auto [behind, behind_seconds] = run_timed(portals, stimulus);
    const double us = 1e6 / static_cast<double>(pairs);
    direct_us.push_back(us * plain_seconds);
    portal_us.push_back(us * behind_seconds);
    ratios.push_back(behind_seconds / plain_seconds);
    added = static_cast<std::int64_t>(behind.deltas) - static_cast<std::int64_t>(plain.deltas);
    same = same && plain.answers == behind.answers;
  }
  fmt::print("{:<44}{:>8}{:>10.2f}{:>10.2f}{:>8.2f}{:>10}\n", name, pairs, median(direct_us), median(portal_us),
             median(ratios), added);
  return same;
}

/// All levels on one stimulus, 51 swaps. Returns whether all answers agree.
bool compare_levels(std::size_t pairs, unsigned rounds) {
  struct Level {
    const char* name;
    RunLevel run;
  };
  constexpr std::array<Level, 5> levels = {{{"L0 functional, all tests side by side", run_l0},
                                            {"L1 the same reconfigurable", run_l1},
                                            {"L2 the same with configuration times", run_l2},
                                            {"L3 Verilated RTL behind signal portals", run_l3},
                                            {"L4 RTL slot and controller over TLM", run_l4}}};
  const std::size_t object_pairs = std::min<std::size_t>(51, pairs);
  const Stimulus stimulus = generate({pairs, object_pairs, sim::seed_from_environment()});
  fmt::print("\nLevels, {} pairs, {} object pairs, least of {} runs in turn\n\n{:<44}{:>20}{:>18}\n", pairs,
             object_pairs, rounds, "level", "processor/pair [us]", "deltas/pair");
  std::array<double, levels.size()> least{};
  std::array<std::uint64_t, levels.size()> deltas{};
  std::vector<std::uint8_t> answers;
  bool same = true;
  for (unsigned round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const auto [result, seconds] = run_timed(levels[i].run, stimulus);
      least[i] = round == 0 ? seconds : std::min(least[i], seconds);
      deltas[i] = result.deltas;
      if (answers.empty()) answers = result.answers;
      same = same && result.answers == answers;
    }
  }
  const auto n = static_cast<double>(pairs);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    fmt::print("{:<44}{:>20.2f}{:>18.2f}\n", levels[i].name, 1e6 * least[i] / n, static_cast<double>(deltas[i]) / n);
  }
  return same;
}

int run(std::size_t pairs, unsigned rounds) {
  fmt::print(
      "Primitive tests bound directly and through portals, one object pair, median of {} runs in turn\n\n{:<44}"
      "{:>8}{:>20}{:>8}{:>10}\n{:<44}{:>8}{:>10}{:>10}{:>8}{:>10}\n",
      rounds, "", "", "processor/pair [us]", "", "deltas", "test", "pairs", "direct", "portals", "ratio", "added");
  bool same = compare("functional, FIFO portals (L0, L1)", run_l0, run_l1, 20 * pairs, rounds);
  same = compare("Verilated RTL, 18 signal portals (L3)", run_l3_direct, run_l3_preloaded, pairs, rounds) && same;
  same = compare_levels(20 * pairs, std::max(1U, rounds / 3)) && same;
  if (!same) std::cerr << "cchip_rtl_bench: answers differ; see cchip_levels\n";
  return same ? 0 : 3;
}

}  // namespace
}  // namespace cchip::levels

int sc_main(int argc, char** argv) {
  CLI::App app("Primitive tests in SystemC: portals against direct binding, the refinement levels side by side.",
               "cchip_rtl_bench");
  std::size_t pairs = 5'000;
  unsigned rounds = 9;
  app.add_option("--pairs", pairs, "primitive pairs of RTL behind portals; 20 times as many for all else")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--rounds", rounds, "runs of each kind; a third as many of the levels")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.footer("Exit codes: 0 done, 1 a simulation failed, 2 bad arguments, 3 answers differ");
  return cchip::bench::run_program(app, argc, argv, [&] { return cchip::levels::run(pairs, rounds); });
}
