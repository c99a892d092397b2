// SPDX-License-Identifier: Apache-2.0
#include "pair_judge.hpp"

#include <algorithm>
#include <array>
#include <cchip/distance.hpp>
#include <cchip/solids.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "parting_way.hpp"
#include "solid_points.hpp"

namespace cchip::assembly {
namespace {

using RuleKind = AssemblyRule::Kind;

bool is_same_mesh(const Object& a, const Object& b) {
  if (a.id() == b.id()) return true;
  const Mesh& x = a.mesh();
  const Mesh& y = b.mesh();
  return x.vertices == y.vertices &&
         std::equal(x.faces.begin(), x.faces.end(), y.faces.begin(), y.faces.end(),
                    [](const Mesh::Face& p, const Mesh::Face& q) { return p.kind == q.kind && p.vertex == q.vertex; });
}

bool is_same_place(const AssemblyPart& a, const AssemblyPart& b) {
  return a.pose.linear() == b.pose.linear() && a.pose.translation() == b.pose.translation() &&
         is_same_mesh(a.object, b.object);
}

PairVerdict verdict_of(SolidRelation relation) {
  switch (relation) {
    case SolidRelation::disjoint:
      return PairVerdict::apart;
    case SolidRelation::touching:
      return PairVerdict::touching;
    case SolidRelation::overlapping:
      return PairVerdict::overlap;
    case SolidRelation::a_in_b:
      return PairVerdict::a_in_b;
    case SolidRelation::b_in_a:
      return PairVerdict::b_in_a;
    case SolidRelation::equal:
      return PairVerdict::duplicate;
  }
  throw std::logic_error("judge_pair: no such relation; please report this");
}

bool shares_volume(PairVerdict verdict) {
  return verdict != PairVerdict::apart && verdict != PairVerdict::too_near && verdict != PairVerdict::touching;
}

SolidResult relate(const AssemblyPart& a, const AssemblyPart& b, InsideRule inside) {
  SolidRequest request;
  request.inside = inside;
  try {
    return solids(a.object, a.pose, b.object, b.pose, request);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(a.name + " (A) and " + b.name + " (B): " + error.what());
  }
}

std::string shells_note(const AssemblyPart& part, const Contact& faces) {
  return "shells of " + part.name + " overlap: its faces " + std::to_string(faces.face_a) + " and " +
         std::to_string(faces.face_b) + " cross or lie on each other; ";
}

void judge_solids(const AssemblyPart& a, const AssemblyPart& b, AssemblyPair& pair) {
  const SolidResult odd = relate(a, b, InsideRule::odd);
  pair.verdict = verdict_of(odd.relation);
  if (!odd.overlap_a && !odd.overlap_b) return;
  if (odd.overlap_a) pair.note += shells_note(a, *odd.overlap_a);
  if (odd.overlap_b) pair.note += shells_note(b, *odd.overlap_b);
  if (shares_volume(pair.verdict)) {
    pair.note += "mend the mesh";
    return;
  }
  // Space that two shells share is outside by the rule odd, so the other rule may find what this one misses.
  if (a.object.twisted_edge() || b.object.twisted_edge()) {
    pair.is_judged = false;
    pair.note += "whether they clash depends on what is inside; mend the mesh";
    return;
  }
  pair.verdict = verdict_of(relate(a, b, InsideRule::nonzero).relation);
  pair.note += "judged with all that their faces wind around as inside";
}

Mesh cube_around(const Vec3d& centre, double half) {
  Mesh cube;
  for (unsigned i = 0; i < 8; ++i) {
    const auto side = [i](unsigned axis) { return (i >> axis & 1U) != 0 ? 1.0 : -1.0; };
    cube.vertices.push_back(centre + half * Vec3d(side(0), side(1), side(2)));
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> quads = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& q : quads) {
    cube.faces.push_back({Kind::tri, {q[0], q[1], q[2], 0}});
    cube.faces.push_back({Kind::tri, {q[0], q[2], q[3], 0}});
  }
  return cube;
}

enum class Side { outside, inside, both, unknown };

/// On which side of a solid are the pieces of a surface, if they share no point? A cube around a vertex of
/// each of its pieces, smaller than the distance, is on the same side as the piece.
Side side_of(const AssemblyPart& surface, const AssemblyPart& solid) {
  const double gap = distance(surface.object, surface.pose, solid.object, solid.pose).lower;
  std::size_t inside = 0;
  const std::vector<std::uint32_t> vertices = vertex_of_each_piece(surface.object.mesh());
  for (const std::uint32_t vertex : vertices) {
    const Vec3d at = surface.pose * surface.object.mesh().vertices[vertex];
    const double half = gap / 8;
    // The vertex is rounded, and so are the corners of the cube.
    if (!(half > 0x1p-40 * at.cwiseAbs().maxCoeff()) || !std::isfinite(half)) return Side::unknown;
    const Object cube(cube_around(at, half));
    const SolidRelation relation = solids(cube, Pose::Identity(), solid.object, solid.pose).relation;
    inside += relation == SolidRelation::disjoint ? 0 : 1;
  }
  return inside == 0 ? Side::outside : inside == vertices.size() ? Side::inside : Side::both;
}

void judge_surfaces(const AssemblyPart& a, const AssemblyPart& b, AssemblyPair& pair) {
  CollisionRequest request;
  request.relation = true;
  const Relation relation = collide(a.object, a.pose, b.object, b.pose, request).relation.value_or(Relation::apart);
  const bool solid_a = a.object.is_closed();
  const bool solid_b = b.object.is_closed();
  const std::string open = solid_a ? b.name + " is" : solid_b ? a.name + " is" : "both are";
  pair.note = open + " judged as a surface, for the mesh is open";
  pair.verdict = relation == Relation::crossing   ? PairVerdict::overlap
                 : relation == Relation::touching ? PairVerdict::touching
                                                  : PairVerdict::apart;
  if (is_same_place(a, b)) pair.verdict = PairVerdict::duplicate;
  if (shares_volume(pair.verdict) || (!solid_a && !solid_b)) return;
  const Side side = pair.verdict == PairVerdict::apart ? (solid_a ? side_of(b, a) : side_of(a, b)) : Side::unknown;
  if (side == Side::inside) pair.verdict = solid_a ? PairVerdict::b_in_a : PairVerdict::a_in_b;
  if (side == Side::both) pair.verdict = PairVerdict::overlap;
  if (side == Side::unknown) {
    pair.is_judged = false;
    pair.note += "; whether it runs on inside the other is not known: close the mesh";
  }
}

void measure(const AssemblyPart& a, const AssemblyPart& b, double clearance, AssemblyPair& pair) {
  DistanceRequest request;
  request.stop_above = clearance;
  const DistanceResult result = distance(a.object, a.pose, b.object, b.pose, request);
  // A distance that is a double has equal bounds; of another one that is below the clearance the lower is.
  if (!(result.lower < clearance)) return;
  pair.verdict = PairVerdict::too_near;
  pair.distance_lower = result.lower;
  pair.distance_upper = result.upper;
  pair.nearest = {result.point_a, result.point_b};
}

bool is_accepted(const Assembly& assembly, const RuleBook& rules, const AssemblyPair& pair) {
  if (!pair.rule) return pair.verdict == PairVerdict::apart;
  const AssemblyRule& rule = assembly.rules[*pair.rule];
  switch (rule.kind) {
    case RuleKind::nothing:
    case RuleKind::clearance:
      return pair.verdict == PairVerdict::apart;
    case RuleKind::touching:
      return !shares_volume(pair.verdict);
    case RuleKind::overlap:
      return !shares_volume(pair.verdict) || (pair.way && pair.way->depth <= rule.limit);
    case RuleKind::anything:
      return true;
    case RuleKind::inside:
      return (pair.verdict == PairVerdict::a_in_b && rules.is_in_order(*pair.rule, pair.a, pair.b)) ||
             (pair.verdict == PairVerdict::b_in_a && rules.is_in_order(*pair.rule, pair.b, pair.a));
    case RuleKind::same:
      return pair.verdict == PairVerdict::duplicate;
  }
  return false;
}

}  // namespace

AssemblyPair judge_pair(const Assembly& assembly, const RuleBook& rules, std::size_t a, std::size_t b,
                        std::size_t most_normals) {
  return judge_pair(assembly, rules, a, b, assembly.parts[a], assembly.parts[b], most_normals);
}

AssemblyPair judge_pair(const Assembly& assembly, const RuleBook& rules, std::size_t a, std::size_t b,
                        const AssemblyPart& part_a, const AssemblyPart& part_b, std::size_t most_normals) {
  AssemblyPair pair;
  pair.a = a;
  pair.b = b;
  pair.rule = rules.rule_of(a, b);
  if (part_a.object.is_closed() && part_b.object.is_closed()) {
    judge_solids(part_a, part_b, pair);
  } else {
    judge_surfaces(part_a, part_b, pair);
  }
  const double clearance = rules.clearance_of(a, b);
  if (pair.verdict == PairVerdict::apart && clearance > 0) measure(part_a, part_b, clearance, pair);
  const bool with_limit = pair.rule && assembly.rules[*pair.rule].kind == RuleKind::overlap;
  if (pair.verdict == PairVerdict::overlap || (with_limit && shares_volume(pair.verdict))) {
    pair.way = with_limit ? parting_way(part_a, part_b, assembly.rules[*pair.rule].limit, most_normals)
                          : rough_parting_way(part_a, part_b);
  }
  pair.is_violation = !is_accepted(assembly, rules, pair);
  // What is allowed or is wrong in any case needs no doubt.
  if (pair.is_violation || (pair.rule && assembly.rules[*pair.rule].kind == RuleKind::anything)) pair.is_judged = true;
  return pair;
}

}  // namespace cchip::assembly
