// SPDX-License-Identifier: Apache-2.0
// cchip_rtl_bench: primitive tests behind portals against the same tests bound directly.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cchip/levels/generator.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/sim/seed.hpp>
#include <iostream>
#include <systemc>
#include <vector>

namespace cchip::levels {
namespace {

using RunLevel = LevelResult (*)(const Stimulus&, const LevelOptions&);

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Runs of both in turn, each in a process of its own. Returns whether all answers agree.
bool compare(const char* name, RunLevel direct, RunLevel portals, std::size_t pairs, unsigned rounds) {
  const Stimulus stimulus = generate({pairs, 1, sim::seed_from_environment()});
  const LevelOptions options;
  std::vector<double> ratios, direct_us, portal_us;
  bool same = true;
  std::int64_t added = 0;
  for (unsigned round = 0; round < rounds; ++round) {
    const LevelResult plain = in_child([&] { return direct(stimulus, options); });
    const LevelResult behind = in_child([&] { return portals(stimulus, options); });
    const double us = 1e6 / static_cast<double>(pairs);
    direct_us.push_back(us * plain.wall_seconds);
    portal_us.push_back(us * behind.wall_seconds);
    ratios.push_back(behind.wall_seconds / plain.wall_seconds);
    added = static_cast<std::int64_t>(behind.deltas) - static_cast<std::int64_t>(plain.deltas);
    same = same && plain.answers == behind.answers;
  }
  fmt::print("{:<44}{:>8}{:>10.2f}{:>10.2f}{:>8.2f}{:>10}\n", name, pairs, median(direct_us), median(portal_us),
             median(ratios), added);
  return same;
}

int run(std::size_t pairs, unsigned rounds) {
  fmt::print(
      "Primitive tests bound directly and through portals, one object pair, median of {} runs in turn\n\n{:<44}"
      "{:>8}{:>20}{:>8}{:>10}\n{:<44}{:>8}{:>10}{:>10}{:>8}{:>10}\n",
      rounds, "", "", "wall time/pair [us]", "", "deltas", "test", "pairs", "direct", "portals", "ratio", "added");
  bool same = compare("functional, FIFO portals (L0, L1)", run_l0, run_l1, 20 * pairs, rounds);
  same = compare("Verilated RTL, 18 signal portals (L3)", run_l3_direct, run_l3_preloaded, pairs, rounds) && same;
  if (!same) std::cerr << "cchip_rtl_bench: answers differ; see cchip_levels\n";
  return same ? 0 : 3;
}

}  // namespace
}  // namespace cchip::levels

int sc_main(int argc, char** argv) {
  CLI::App app("Primitive tests in SystemC: portals against direct binding.", "cchip_rtl_bench");
  std::size_t pairs = 5'000;
  unsigned rounds = 9;
  app.add_option("--pairs", pairs, "primitive pairs of RTL; the functional tests get 20 times as many")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--rounds", rounds, "runs of each kind")->capture_default_str()->check(CLI::PositiveNumber);
  app.footer("Exit codes: 0 done, 1 a simulation failed, 2 bad arguments, 3 answers differ");
  try {
    app.parse(argc, argv);
    return cchip::levels::run(pairs, rounds);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << "cchip_rtl_bench: " << error.what() << '\n';
    return 1;
  }
}
