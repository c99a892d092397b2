// SPDX-License-Identifier: Apache-2.0
#include <fmt/ostream.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/levels/summary.hpp>

namespace cchip::levels {
namespace {

// __extension__ (no warning about a type outside ISO C++) needs typedef.
__extension__ typedef __int128 Wide;  // NOLINT(modernize-use-using)
using Vec3l = Eigen::Matrix<std::int64_t, 3, 1>;

Wide dot(const Vec3l& x, const Vec3l& y) { return Wide{x[0]} * y[0] + Wide{x[1]} * y[1] + Wide{x[2]} * y[2]; }

/// True if the nearest point of the triangle is no farther from the point than the radius: a vertex, a point inside a
/// side, or one inside the face.
bool reaches(std::int64_t radius, const GridPair& pair) {
  std::array<Vec3l, 3> v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = (pair.b.v[i] - pair.a.v[0]).cast<std::int64_t>();
  const Wide square = Wide{radius} * radius;
  const Vec3l normal = (v[1] - v[0]).cross(v[2] - v[0]);
  bool over_face = !normal.isZero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3l side = v[(i + 1) % 3] - v[i];
    if (dot(v[i], v[i]) <= square) return true;
    const Wide along = -dot(v[i], side);  // of the point's foot, from v[i], times the side's length
    const Wide length = dot(side, side);
    if (along > 0 && along < length && dot(v[i], v[i]) * length - along * along <= square * length) return true;
    over_face = over_face && dot(normal, side.cross(v[i])) < 0;
  }
  const Wide height = dot(normal, v[0]);
  return over_face && height * height <= square * dot(normal, normal);
}

}  // namespace

std::vector<std::uint8_t> reference_answers(const Stimulus& stimulus) {
  std::vector<std::uint8_t> answers;
  answers.reserve(stimulus.size());
  for (const StimulusPair& pair : stimulus) {
    const bool hit = pair.radius ? reaches(*pair.radius, placed(pair)) : eigen_intersects(placed(pair), coord_w);
    answers.push_back(hit ? 1 : 0);
  }
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
