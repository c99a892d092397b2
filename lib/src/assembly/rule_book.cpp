// SPDX-License-Identifier: Apache-2.0
#include "rule_book.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace cchip {

const char* name_of(AssemblyRule::Kind kind) {
  switch (kind) {
    case AssemblyRule::Kind::nothing:
      return "nothing";
    case AssemblyRule::Kind::touching:
      return "touching";
    case AssemblyRule::Kind::overlap:
      return "overlap";
    case AssemblyRule::Kind::anything:
      return "anything";
    case AssemblyRule::Kind::clearance:
      return "clearance";
    case AssemblyRule::Kind::inside:
      return "inside";
    case AssemblyRule::Kind::same:
      return "same";
  }
  return "";
}

namespace assembly {
namespace {

using Kind = AssemblyRule::Kind;

bool is_length(double x) { return std::isfinite(x) && x >= 0; }

void check_rule(const AssemblyRule& rule, std::size_t number) {
  const auto refuse = [&rule, number](const std::string& what) {
    throw std::invalid_argument((rule.place.empty() ? "rule " + std::to_string(number) : rule.place) + ": " + what);
  };
  const std::size_t ends = rule.parts.size() + rule.groups.size();
  if (ends != 0 && !(ends == 2 && (rule.parts.empty() || rule.groups.empty()))) {
    refuse("a rule is about two parts, or two groups, or all pairs; name two, or none");
  }
  if (rule.parts.size() == 2 && rule.parts[0] == rule.parts[1]) {
    refuse("a rule is about two different parts, and both are '" + rule.parts[0] + "'; name another one");
  }
  if (!is_length(rule.limit)) refuse("the length is not finite or is below 0; give one that is at least 0");
  if (rule.kind == Kind::anything && rule.reason.empty()) refuse("to allow anything takes a reason; write it");
  if ((rule.kind == Kind::inside || rule.kind == Kind::same) && ends == 0) {
    refuse(std::string("not all pairs can be ") + name_of(rule.kind) + "; name two parts or two groups");
  }
}

}  // namespace

RuleBook::RuleBook(const Assembly& assembly)
    : assembly_(assembly), left_out_(assembly.left_out.begin(), assembly.left_out.end()) {
  if (!is_length(assembly.clearance)) {
    throw std::invalid_argument("the clearance is not finite or is below 0; give one that is at least 0");
  }
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    if (part_of_.emplace(assembly.parts[i].name, i).second) continue;
    throw std::invalid_argument("parts " + std::to_string(part_of_[assembly.parts[i].name]) + " and " +
                                std::to_string(i) + " have the same name, '" + assembly.parts[i].name +
                                "'; rename one");
  }
  for (std::size_t i = 0; i < assembly.rules.size(); ++i) {
    const AssemblyRule& rule = assembly.rules[i];
    check_rule(rule, i);
    if (!rule.parts.empty()) {
      add_parts(i);
    } else if (!rule.groups.empty()) {
      of_groups_.insert(of_groups_.begin(), i);
    } else {
      of_all_ = i;
    }
  }
}

void RuleBook::add_parts(std::size_t rule) {
  const auto first = part_of_.find(assembly_.rules[rule].parts[0]);
  const auto second = part_of_.find(assembly_.rules[rule].parts[1]);
  if (first == part_of_.end() || second == part_of_.end()) return;
  of_parts_[std::minmax(first->second, second->second)] = rule;
}

bool RuleBook::is_in(std::size_t part, const std::string& group) const {
  const std::vector<std::string>& groups = assembly_.parts[part].groups;
  return std::find(groups.begin(), groups.end(), group) != groups.end();
}

bool RuleBook::is_in_order(std::size_t rule, std::size_t a, std::size_t b) const {
  const AssemblyRule& of = assembly_.rules[rule];
  if (!of.parts.empty()) return assembly_.parts[a].name == of.parts[0] && assembly_.parts[b].name == of.parts[1];
  return of.groups.empty() || (is_in(a, of.groups[0]) && is_in(b, of.groups[1]));
}

std::optional<std::size_t> RuleBook::rule_of(std::size_t a, std::size_t b) const {
  const auto named = of_parts_.find(std::minmax(a, b));
  if (named != of_parts_.end()) return named->second;
  for (const std::size_t rule : of_groups_) {
    if (is_in_order(rule, a, b) || is_in_order(rule, b, a)) return rule;
  }
  return of_all_;
}

bool RuleBook::is_left_out(std::size_t a, std::size_t b) const {
  if (left_out_.count(std::minmax(a, b)) == 0) return false;
  const auto named = of_parts_.find(std::minmax(a, b));
  return named == of_parts_.end() || assembly_.rules[named->second].kind == Kind::anything;
}

double RuleBook::clearance_of(std::size_t a, std::size_t b) const {
  const std::optional<std::size_t> rule = rule_of(a, b);
  if (!rule) return assembly_.clearance;
  return assembly_.rules[*rule].kind == Kind::clearance ? assembly_.rules[*rule].limit : 0;
}

std::vector<double> RuleBook::clearances() const {
  std::set<double> all = {assembly_.clearance};
  for (const AssemblyRule& rule : assembly_.rules) {
    if (rule.kind == Kind::clearance) all.insert(rule.limit);
  }
  all.erase(0);
  return {all.begin(), all.end()};
}

void RuleBook::for_each_pair(std::size_t rule, const std::function<bool(std::size_t, std::size_t)>& visit) const {
  const AssemblyRule& of = assembly_.rules[rule];
  if (!of.parts.empty()) {
    const auto first = part_of_.find(of.parts[0]);
    const auto second = part_of_.find(of.parts[1]);
    if (first == part_of_.end() || second == part_of_.end()) return;
    visit(std::min(first->second, second->second), std::max(first->second, second->second));
    return;
  }
  for (std::size_t a = 0; a < assembly_.parts.size(); ++a) {
    for (std::size_t b = a + 1; b < assembly_.parts.size(); ++b) {
      if ((is_in_order(rule, a, b) || is_in_order(rule, b, a)) && !visit(a, b)) return;
    }
  }
}

}  // namespace assembly
}  // namespace cchip
