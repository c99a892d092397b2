// SPDX-License-Identifier: Apache-2.0
// Reports in words, and rules out of them.
#include <cchip/assembly.hpp>
#include <cstddef>
#include <string>

#include "texts.hpp"

namespace cchip {
namespace {

using RuleKind = AssemblyRule::Kind;

std::string length_text(const Assembly& assembly, double x) {
  return assembly::rounded_text(x) + (assembly.unit.empty() ? "" : " " + assembly.unit);
}

std::string point_text(const Vec3d& p) {
  return '(' + assembly::rounded_text(p.x()) + ", " + assembly::rounded_text(p.y()) + ", " +
         assembly::rounded_text(p.z()) + ')';
}

std::string verdict_text(const Assembly& assembly, const AssemblyPair& pair) {
  const std::string& a = assembly.parts[pair.a].name;
  const std::string& b = assembly.parts[pair.b].name;
  switch (pair.verdict) {
    case PairVerdict::apart:
      return a + " and " + b + " are apart";
    case PairVerdict::too_near:
      return a + " and " + b + " are " + length_text(assembly, pair.distance_lower) + " apart, at " +
             point_text(pair.nearest[0]) + " and " + point_text(pair.nearest[1]);
    case PairVerdict::touching:
      return a + " and " + b + " touch";
    case PairVerdict::overlap:
      break;
    case PairVerdict::a_in_b:
      return a + " is inside " + b;
    case PairVerdict::b_in_a:
      return b + " is inside " + a;
    case PairVerdict::duplicate:
      return a + " and " + b + " are the same part in the same place";
  }
  return a + " and " + b + " overlap";
}

std::string way_text(const Assembly& assembly, const AssemblyPair& pair) {
  if (!pair.way) return pair.verdict == PairVerdict::overlap ? "; no move along a normal of a contact parts them" : "";
  return "; " + assembly.parts[pair.b].name + " moved by " + length_text(assembly, pair.way->depth) + " along " +
         point_text(pair.way->direction) + " is clear";
}

std::string rule_text(const Assembly& assembly, const AssemblyPair& pair) {
  if (!pair.rule) {
    if (pair.verdict == PairVerdict::too_near) {
      return "the assembly wants " + length_text(assembly, assembly.clearance);
    }
    return "no rule allows it";
  }
  const AssemblyRule& rule = assembly.rules[*pair.rule];
  const std::string at = rule.place.empty() ? "rule " + std::to_string(*pair.rule) : rule.place;
  switch (rule.kind) {
    case RuleKind::nothing:
    case RuleKind::touching:
      return at + " allows " + name_of(rule.kind);
    case RuleKind::overlap:
      return at + " allows an overlap up to " + length_text(assembly, rule.limit);
    case RuleKind::anything:
      return at + " allows anything: " + rule.reason;
    case RuleKind::clearance:
      return at + " wants " + length_text(assembly, rule.limit) + " between them";
    case RuleKind::inside:
      return at + " wants " + (rule.parts.empty() ? rule.groups[0] : rule.parts[0]) + " inside " +
             (rule.parts.empty() ? rule.groups[1] : rule.parts[1]);
    case RuleKind::same:
      return at + " wants them to be the same";
  }
  return at;
}

std::string rule_head(const std::string& a, const std::string& b) {
  return "\n[[rule]]\nparts = [" + assembly::toml_text(a) + ", " + assembly::toml_text(b) + "]\n";
}

std::string accepting_rule(const Assembly& assembly, const AssemblyPair& pair) {
  const std::string& a = assembly.parts[pair.a].name;
  const std::string& b = assembly.parts[pair.b].name;
  switch (pair.verdict) {
    case PairVerdict::apart:
      return "";  // a rule that wants more is wrong, and the assembly must be mended or the rule
    case PairVerdict::too_near:
      return rule_head(a, b) + "clearance = " + assembly::number_text(pair.distance_lower) + "\n";
    case PairVerdict::touching:
      return rule_head(a, b) + "allow = \"touching\"\n";
    case PairVerdict::overlap:
      if (!pair.way) break;
      return rule_head(a, b) + "allow = \"overlap\"\neps = " + assembly::number_text(pair.way->depth) + "\n";
    case PairVerdict::a_in_b:
      return rule_head(a, b) + "want = \"inside\"\n";
    case PairVerdict::b_in_a:
      return rule_head(b, a) + "want = \"inside\"\n";
    case PairVerdict::duplicate:
      return rule_head(a, b) + "want = \"same\"\n";
  }
  return rule_head(a, b) + "allow = \"anything\"\nreason = \"they overlap as they were accepted\"\n";
}

}  // namespace

const char* name_of(PairVerdict verdict) {
  switch (verdict) {
    case PairVerdict::apart:
      return "apart";
    case PairVerdict::too_near:
      return "too_near";
    case PairVerdict::touching:
      return "touching";
    case PairVerdict::overlap:
      return "overlap";
    case PairVerdict::a_in_b:
      return "a_in_b";
    case PairVerdict::b_in_a:
      return "b_in_a";
    case PairVerdict::duplicate:
      return "duplicate";
  }
  return "";
}

std::string sentence(const Assembly& assembly, const AssemblyPair& pair) {
  std::string text = verdict_text(assembly, pair) + way_text(assembly, pair);
  if (pair.verdict != PairVerdict::apart || pair.is_violation) text += "; " + rule_text(assembly, pair);
  return text + (pair.note.empty() ? "" : " (" + pair.note + ")");
}

std::string why_unused(const Assembly& assembly, std::size_t rule) {
  const AssemblyRule& of = assembly.rules.at(rule);
  const std::string at = (of.place.empty() ? "rule " + std::to_string(rule) : of.place) + ": this rule never counted";
  for (const std::string& name : of.parts) {
    bool is_there = false;
    for (const AssemblyPart& part : assembly.parts) is_there = is_there || part.name == name;
    if (!is_there) return at + ", for no part is named '" + name + "'; correct the name or remove the rule";
  }
  for (const std::string& name : of.groups) {
    bool is_there = false;
    for (const AssemblyPart& part : assembly.parts) {
      for (const std::string& group : part.groups) is_there = is_there || group == name;
    }
    if (!is_there) return at + ", for no part is in the group '" + name + "'; correct the name or remove the rule";
  }
  return at + ": no pair does what it allows, or a more special or later rule counts; remove it";
}

std::string accepting_rules(const Assembly& assembly, const AssemblyReport& report) {
  std::string text = "# What parts do today, accepted. Written by cchip clash --accept.\n";
  for (const AssemblyPair& pair : report.pairs) text += accepting_rule(assembly, pair);
  return text;
}

}  // namespace cchip
