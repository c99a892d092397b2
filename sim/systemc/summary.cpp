// SPDX-License-Identifier: Apache-2.0
#include <fmt/ostream.h>

#include <algorithm>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/levels/summary.hpp>

namespace cchip::levels {

std::vector<std::uint8_t> reference_answers(const Stimulus& stimulus) {
  std::vector<std::uint8_t> answers;
  answers.reserve(stimulus.size());
  for (const StimulusPair& pair : stimulus) answers.push_back(eigen_intersects(placed(pair), coord_w) ? 1 : 0);
  return answers;
}

std::vector<std::size_t> differences(const std::vector<std::uint8_t>& expected,
                                     const std::vector<std::uint8_t>& answers) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (i >= answers.size() || answers[i] != expected[i]) result.push_back(i);
  }
  return result;
}

std::size_t Summary::mismatches() const {
  std::size_t sum = 0;
  for (const LevelRun& run : runs_) sum += differences(expected_, run.result.answers).size();
  return sum;
}

bool Summary::swaps_agree() const {
  return std::all_of(runs_.begin(), runs_.end(), [&](const LevelRun& run) {
    return !run.reconfigures || !run.error.empty() || run.result.swaps == swaps();
  });
}

std::uint64_t Summary::swaps() const {
  const auto first = std::find_if(runs_.begin(), runs_.end(),
                                  [](const LevelRun& run) { return run.reconfigures && run.error.empty(); });
  return first == runs_.end() ? 0 : first->result.swaps;
}

void Summary::print(std::ostream& out) const {
  fmt::print(out, "{:<6}{:<44}{:>8}{:>8}{:>8}{:>11}{:>14}{:>9}{:>10}{:>11}\n", "level", "", "pairs", "hits", "swaps",
             "mismatches", "simulated [s]", "wall [s]", "us / pair", "deltas");
  for (const LevelRun& run : runs_) print_run(out, run);
  for (const LevelRun& run : runs_) print_differences(out, run);
  if (!swaps_agree()) fmt::print(out, "the levels do not swap equally often\n");
  fmt::print(out, "levels={} pairs={} swaps={} mismatches={} added_deltas={}\n", runs_.size(), stimulus_.size(),
             swaps(), mismatches(), added_deltas_);
}

void Summary::print_run(std::ostream& out, const LevelRun& run) const {
  const LevelResult& r = run.result;
  fmt::print(out, "{:<6}{:<44}{:>8}{:>8}{:>8}{:>11}{:>14.6f}{:>9.2f}{:>10.2f}{:>11}\n", run.name, run.description,
             r.answers.size(), std::count(r.answers.begin(), r.answers.end(), 1), r.swaps,
             differences(expected_, r.answers).size(), r.simulated_seconds, r.wall_seconds,
             1e6 * r.wall_seconds / static_cast<double>(stimulus_.size()), r.deltas);
}

void Summary::print_differences(std::ostream& out, const LevelRun& run) const {
  if (!run.error.empty()) {
    fmt::print(out, "{}: {}\n", run.name, run.error);
    return;
  }
  constexpr std::size_t shown = 3;
  const std::vector<std::size_t> all = differences(expected_, run.result.answers);
  for (std::size_t i = 0; i < std::min(all.size(), shown); ++i) {
    fmt::print(out, "{}: primitive pair {} of object pair {} should be {}\n", run.name, all[i],
               stimulus_[all[i]].object_pair, expected_[all[i]] == 1 ? "a hit" : "no hit");
  }
}

}  // namespace cchip::levels
