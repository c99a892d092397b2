// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/assembly_motion.hpp>
#include <cchip/distance.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "pair_judge.hpp"
#include "part_paths.hpp"
#include "rule_book.hpp"
#include "run_all.hpp"

namespace cchip {
namespace {

using assembly::PairPath;
using assembly::PartPaths;
using assembly::RuleBook;

/// Steps between configurations in contact that rules accept are not halved below this.
constexpr double least_step_in_contact = 1.0 / 64;
constexpr std::size_t most_normals = 100;

/// One pair on its path. If surfaces are d and e apart at the ends of a step, during which their distance changes by m
/// at most in all, they are never nearer than (d + e - m) / 2. A step for which this is too little is halved.
class PairSearch {
 public:
  PairSearch(const Assembly& assembly, const RuleBook& rules, const PartPaths& paths, const MotionOptions& options,
             MotionPair& pair)
      : assembly_(assembly),
        rules_(rules),
        paths_(paths),
        options_(options),
        path_(paths.path_of(pair.a, pair.b)),
        clearance_(rules.clearance_of(pair.a, pair.b)),
        part_a_(assembly.parts[pair.a]),
        part_b_(assembly.parts[pair.b]),
        pair_(pair) {}

  /// \returns the number of looks
  std::size_t run() {
    Look from = look(0);
    judge(0);
    for (std::size_t row = 0; row < path_.speed.size() && !pair_.time; ++row) {
      row_ = row;
      if (speed() == 0) {  // they stay as they are to each other
        pair_.clearance_lower = std::min(pair_.clearance_lower, from.distance);
        from.time = static_cast<double>(row + 1);
        continue;
      }
      const Look to = look(static_cast<double>(row + 1));
      search(from, to);
      from = to;
    }
    if (path_.speed.empty()) pair_.clearance_lower = from.distance;
    if (pair_.time) pair_.clearance_lower = pair_.clearance_upper = 0;
    merge_unproved();
    pair_.clearance_lower = std::min(pair_.clearance_lower, pair_.clearance_upper);
    return looks_;
  }

 private:
  struct Look {
    double time;
    double distance;  ///< a lower bound
    bool is_near;     ///< nearer than the clearance, or in contact
  };

  void place(double time) { std::tie(part_a_.pose, part_b_.pose) = paths_.poses(pair_.a, pair_.b, time); }

  double speed() const { return path_.speed.empty() ? 0 : path_.speed[row_]; }

  Look look(double time) {
    place(time);
    // More than the clearance and the least distance so far is of no use.
    const auto row = static_cast<std::size_t>(time);
    double change = 0;
    for (std::size_t i = row == 0 ? 0 : row - 1; i < std::min(row + 1, path_.speed.size()); ++i) {
      change = std::max(change, path_.speed[i]);
    }
    DistanceRequest request;
    request.stop_above = 2 * (std::max(clearance_, pair_.clearance_upper) + change + path_.rounding);
    const DistanceResult found = distance(part_a_.object, part_a_.pose, part_b_.object, part_b_.pose, request);
    ++looks_;
    pair_.clearance_upper = std::min(pair_.clearance_upper, found.upper);
    const bool is_near = clearance_ > 0 ? found.lower < clearance_ : found.lower <= 0;
    if (is_near) judge(time);
    return {time, found.lower, is_near};
  }

  /// Asks for all that the rules want. What is found between rows is a violation if it is the first.
  void judge(double time) {
    place(time);
    AssemblyPair found = assembly::judge_pair(assembly_, rules_, pair_.a, pair_.b, part_a_, part_b_, most_normals);
    if (found.is_violation && (!pair_.time || time < *pair_.time)) {
      pair_.time = time;
      pair_.violation = std::move(found);
    } else if (!found.is_judged) {
      leave_unproved(time, time);
    }
  }

  void leave_unproved(double from, double to) { pair_.unproved.push_back({from, to}); }

  void merge_unproved() {
    std::vector<std::array<double, 2>> all;
    std::sort(pair_.unproved.begin(), pair_.unproved.end());
    for (const std::array<double, 2>& one : pair_.unproved) {
      if (all.empty() || one[0] > all.back()[1]) all.push_back(one);
      all.back()[1] = std::max(all.back()[1], one[1]);
    }
    pair_.unproved = std::move(all);
  }

  bool is_proved(double least) const { return clearance_ > 0 ? least >= clearance_ : least > 0; }

  void search(const Look& from, const Look& to) {
    if (pair_.time && *pair_.time <= from.time) return;
    const double width = to.time - from.time;
    const double least =
        ((from.distance + to.distance) * (1 - 0x1p-50) - speed() * width * (1 + 0x1p-40)) / 2 - path_.rounding;
    const bool is_short = width <= options_.least_step;
    if (is_proved(least) && (is_short || least >= (1 - options_.rel_error) * pair_.clearance_upper)) {
      pair_.clearance_lower = std::min(pair_.clearance_lower, least);
      return;
    }
    if (is_short || (from.is_near && to.is_near && width <= least_step_in_contact)) {
      if (!to.is_near) judge(to.time);
      if (!pair_.time || *pair_.time > to.time) leave_unproved(from.time, to.time);
      return;
    }
    const Look middle = look(from.time + width / 2);
    search(from, middle);
    if (!pair_.time || *pair_.time > middle.time) search(middle, to);
  }

  const Assembly& assembly_;
  const RuleBook& rules_;
  const PartPaths& paths_;
  const MotionOptions& options_;
  const PairPath path_;
  const double clearance_;
  AssemblyPart part_a_;
  AssemblyPart part_b_;
  MotionPair& pair_;
  std::size_t row_ = 0;
  std::size_t looks_ = 0;
};

void check_options(const MotionOptions& options) {
  if (!(options.least_step > 0x1p-30 && options.least_step <= 1)) {
    throw std::invalid_argument("the least step is not between 1e-9 and 1; give another one");
  }
  if (!(options.rel_error > 0 && options.rel_error < 1)) {
    throw std::invalid_argument("rel_error is not between 0 and 1; give another one");
  }
}

}  // namespace

MotionReport check_motion(const Assembly& assembly, const AssemblyMotion& motion, const MotionOptions& options) {
  check_options(options);
  const RuleBook rules(assembly);
  const std::unique_ptr<PartPaths> paths = assembly::part_paths(assembly, motion);
  MotionReport report;
  report.notes = paths->notes();
  for (std::size_t a = 0; a < assembly.parts.size(); ++a) {
    for (std::size_t b = a + 1; b < assembly.parts.size(); ++b) {
      const std::optional<std::size_t> rule = rules.rule_of(a, b);
      if (rules.is_left_out(a, b) || (rule && assembly.rules[*rule].kind == AssemblyRule::Kind::anything)) continue;
      report.pairs.emplace_back();
      report.pairs.back().a = a;
      report.pairs.back().b = b;
    }
  }
  std::vector<std::size_t> looks(report.pairs.size());
  assembly::run_all(report.pairs.size(), options.threads, [&](std::size_t i) {
    looks[i] = PairSearch(assembly, rules, *paths, options, report.pairs[i]).run();
  });
  for (std::size_t i = 0; i < looks.size(); ++i) {
    report.looks += looks[i];
    report.violations += report.pairs[i].time ? 1 : 0;
    report.unproved += !report.pairs[i].time && !report.pairs[i].unproved.empty() ? 1 : 0;
  }
  return report;
}

}  // namespace cchip
