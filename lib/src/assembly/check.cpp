// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/assembly.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/scene.hpp>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "pair_judge.hpp"
#include "rule_book.hpp"
#include "run_all.hpp"
#include "texts.hpp"

namespace cchip {
namespace {

using assembly::RuleBook;
using RuleKind = AssemblyRule::Kind;
using Numbers = std::pair<std::size_t, std::size_t>;

/// The pairs that may be more than apart, or must be.
/// \param scene of the parts: part i has the id i + 1
std::vector<Numbers> pairs_to_judge(const Assembly& assembly, Scene& scene, const RuleBook& rules, unsigned threads) {
  std::set<Numbers> pairs;
  for (const auto& [a, b] : scene.candidates()) pairs.emplace(a - 1, b - 1);
  CpuOptions cpu;
  cpu.threads = threads;
  const std::unique_ptr<Device> device = open_cpu_device(cpu);
  for (const double clearance : rules.clearances()) {
    scene.set_filter([&rules, clearance](Scene::Id a, Scene::Id b) {
      return rules.clearance_of(a - 1, b - 1) == clearance;  // NOLINT: one of them
    });
    CollisionRequest request;
    request.within = clearance;
    for (const Scene::Pair& pair : scene.contacts(*device, request)) pairs.emplace(pair.a - 1, pair.b - 1);
  }
  for (std::size_t i = 0; i < assembly.rules.size(); ++i) {
    if (assembly.rules[i].kind != RuleKind::inside && assembly.rules[i].kind != RuleKind::same) continue;
    rules.for_each_pair(i, [&pairs, &rules, i](std::size_t a, std::size_t b) {
      if (rules.rule_of(a, b) == i) pairs.emplace(a, b);
      return true;
    });
  }
  std::vector<Numbers> result;
  for (const Numbers& pair : pairs) {
    if (!rules.is_left_out(pair.first, pair.second)) result.push_back(pair);
  }
  return result;
}

/// Rules that allow something are used if a pair does it; others, if they count for a pair at all.
std::vector<std::size_t> find_unused(const Assembly& assembly, const RuleBook& rules,
                                     const std::vector<AssemblyPair>& pairs) {
  std::vector<bool> used(assembly.rules.size(), false);
  for (const AssemblyPair& pair : pairs) {
    if (pair.rule && pair.verdict != PairVerdict::apart) used[*pair.rule] = true;
  }
  std::vector<std::size_t> unused;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const RuleKind kind = assembly.rules[i].kind;
    if (kind != RuleKind::touching && kind != RuleKind::overlap && kind != RuleKind::anything) {
      rules.for_each_pair(i, [&used, &rules, i](std::size_t a, std::size_t b) {
        used[i] = used[i] || rules.rule_of(a, b) == i;
        return !used[i];
      });
    }
    if (!used[i] && !assembly.rules[i].optional) unused.push_back(i);
  }
  return unused;
}

struct Box {
  Vec3d least = Vec3d::Constant(std::numeric_limits<double>::infinity());
  Vec3d greatest = Vec3d::Constant(-std::numeric_limits<double>::infinity());
};

Box box_of(const AssemblyPart& part) {
  Box box;
  for (const Mesh::Face& face : part.object.mesh().faces) {
    for (std::size_t i = 0; i < (face.kind == Kind::quad ? 4U : 3U); ++i) {
      const Vec3d at = part.pose * part.object.mesh().vertices[face.vertex[i]];
      box.least = box.least.cwiseMin(at);
      box.greatest = box.greatest.cwiseMax(at);
    }
  }
  return box;
}

/// The boxes of the parts, as far as they are asked for: those of the scene are a little larger, and at hand.
class PartBoxes {
 public:
  PartBoxes(const Assembly& assembly, const Scene& scene)
      : assembly_(assembly), scene_(scene), boxes_(assembly.parts.size()) {}

  std::size_t count() const { return boxes_.size(); }
  const Box& exact(std::size_t part) {
    if (!boxes_[part]) boxes_[part] = box_of(assembly_.parts[part]);
    return *boxes_[part];
  }
  double exact_size(std::size_t part) { return (exact(part).greatest - exact(part).least).maxCoeff(); }
  /// At least the size.
  double roomy_size(std::size_t part) const {
    const WorldBox& box = roomy(part);
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i) size = std::max(size, box.greatest[i] - box.least[i]);
    return size;
  }
  /// The least or the greatest coordinate of all parts: only those are looked at whose larger box is beyond all that
  /// were.
  double end(std::size_t axis, bool greatest) {
    const auto bound = [&](std::size_t part) {
      return greatest ? roomy(part).greatest[axis] : -roomy(part).least[axis];
    };
    std::vector<std::size_t> parts(count());
    std::iota(parts.begin(), parts.end(), 0U);
    std::sort(parts.begin(), parts.end(), [&](std::size_t x, std::size_t y) { return bound(x) > bound(y); });
    double best = -std::numeric_limits<double>::infinity();
    const auto i = static_cast<Eigen::Index>(axis);
    for (const std::size_t part : parts) {
      if (bound(part) < best) break;
      best = std::max(best, greatest ? exact(part).greatest[i] : -exact(part).least[i]);
    }
    return greatest ? best : -best;
  }

 private:
  const WorldBox& roomy(std::size_t part) const { return scene_.box(static_cast<Scene::Id>(part + 1)); }

  const Assembly& assembly_;
  const Scene& scene_;
  std::vector<std::optional<Box>> boxes_;
};

/// Notes about parts one by one, and the size of all.
void look_at_parts(const Assembly& assembly, const Scene& scene, AssemblyReport& report) {
  for (const AssemblyPart& part : assembly.parts) {
    if (const std::optional<OpenEdge> edge = part.object.open_edge()) {
      report.notes.push_back(part.name + " is an open mesh (an odd number of faces use an edge of face " +
                             std::to_string(edge->face) + "), so it is judged as a surface; close it to judge a solid");
    }
  }
  if (assembly.parts.empty()) return;
  PartBoxes boxes(assembly, scene);
  for (std::size_t i = 0; i < 3; ++i) report.size[i] = boxes.end(i, true) - boxes.end(i, false);
  constexpr double suspicious = 1000;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < boxes.count(); ++i) sizes.push_back(boxes.roomy_size(i));
  const auto [small, large] = std::minmax_element(sizes.begin(), sizes.end());
  if (*large < suspicious / 10 * *small) return;  // larger boxes are not ten times as large
  for (std::size_t i = 0; i < boxes.count(); ++i) sizes[i] = boxes.exact_size(i);
  const auto least = static_cast<std::size_t>(std::min_element(sizes.begin(), sizes.end()) - sizes.begin());
  const auto greatest = static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  if (sizes[greatest] >= suspicious * sizes[least]) {
    report.notes.push_back(assembly.parts[greatest].name + " is " + assembly::number_text(sizes[greatest]) + " long, " +
                           assembly.parts[least].name + " " + assembly::number_text(sizes[least]) +
                           ": 1,000 times or more; check the units of their files");
  }
}

}  // namespace

AssemblyReport check(const Assembly& assembly, const AssemblyCheckOptions& options) {
  const RuleBook rules(assembly);
  AssemblyReport report;
  Scene scene;
  for (const AssemblyPart& part : assembly.parts) scene.add(part.object, part.pose);
  look_at_parts(assembly, scene, report);
  const std::vector<Numbers> numbers = pairs_to_judge(assembly, scene, rules, options.threads);
  std::vector<AssemblyPair> pairs(numbers.size());
  assembly::run_all(numbers.size(), options.threads, [&](std::size_t i) {
    pairs[i] = assembly::judge_pair(assembly, rules, numbers[i].first, numbers[i].second, options.most_normals);
  });
  report.judged = pairs.size();
  report.unused_rules = find_unused(assembly, rules, pairs);
  for (AssemblyPair& pair : pairs) {
    const bool meets = pair.verdict != PairVerdict::apart;
    if (!meets && !pair.is_violation && pair.is_judged) continue;
    report.violations += pair.is_violation ? 1 : 0;
    report.accepted += meets && !pair.is_violation ? 1 : 0;
    report.not_judged += pair.is_judged ? 0 : 1;
    report.pairs.push_back(std::move(pair));
  }
  return report;
}

}  // namespace cchip
