// SPDX-License-Identifier: Apache-2.0
#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

#include <Eigen/LU>
#include <algorithm>
#include <cchip/internal/geometry/rotation.hpp>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh_io/file_content.hpp"
#include "source.hpp"

namespace cchip::assembly {

const char* const units = "um, mm, cm, m, in or ft";

double millimetres(const std::string& unit) {
  constexpr std::pair<std::string_view, double> known[] = {{"um", 0.001}, {"mm", 1},    {"cm", 10},
                                                           {"m", 1000},   {"in", 25.4}, {"ft", 304.8}};
  for (const auto& [name, length] : known) {
    if (unit == name) return length;
  }
  return 0;
}

namespace {

using RuleKind = AssemblyRule::Kind;
using Names = std::vector<std::string_view>;

/// Values of one table, with errors that name file, line and key.
class Table {
 public:
  Table(const std::string& file, const toml::table& table, std::string what)
      : file_(file), table_(table), what_(std::move(what)) {}

  [[noreturn]] void refuse(const std::string& text, const toml::node* node = nullptr) const {
    throw std::runtime_error(place(node) + ": " + what_ + (what_.empty() ? "" : ": ") + text);
  }
  /// "file:line" of a value, or of the table.
  std::string place(const toml::node* node = nullptr) const {
    const auto line = (node == nullptr ? table_.source() : node->source()).begin.line;
    return line == 0 ? file_ : file_ + ":" + std::to_string(line);
  }
  [[noreturn]] void refuse_value(std::string_view key, const std::string& text) const {
    refuse("key '" + std::string(key) + "' " + text, table_.get(key));
  }
  bool has(std::string_view key) const { return table_.contains(key); }

  void check_keys(const Names& known) const {
    for (const auto& [key, value] : table_) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      std::string names;
      for (const std::string_view name : known) names += (names.empty() ? "" : ", ") + std::string(name);
      refuse("key '" + std::string(key.str()) + "' is unknown; the keys here are " + names, &value);
    }
  }
  /// At most one of the keys; empty if none is there.
  std::string_view one_of(const Names& keys) const {
    std::string_view found;
    for (const std::string_view key : keys) {
      if (!has(key)) continue;
      if (!found.empty()) refuse_value(key, "and '" + std::string(found) + "' exclude each other; keep one of them");
      found = key;
    }
    return found;
  }
  std::string text(std::string_view key) const {
    if (!has(key)) return "";
    const auto value = table_.get(key)->value_exact<std::string>();
    if (!value || value->empty()) refuse_value(key, "must be a text in quotes, not empty; write one");
    return *value;
  }
  std::string required_text(std::string_view key) const {
    if (!has(key)) refuse("key '" + std::string(key) + "' is missing; add it");
    return text(key);
  }
  std::vector<std::string> texts(std::string_view key) const {
    std::vector<std::string> result;
    if (!has(key)) return result;
    const toml::array* array = table_.get(key)->as_array();
    if (array == nullptr) refuse_value(key, "must be a list of texts; write [\"...\"]");
    for (const toml::node& node : *array) {
      const auto value = node.value_exact<std::string>();
      if (!value || value->empty()) refuse_value(key, "must be a list of texts, none empty; put each in quotes");
      result.push_back(*value);
    }
    return result;
  }
  std::vector<std::string> two_texts(std::string_view key) const {
    const std::vector<std::string> result = texts(key);
    if (has(key) && result.size() != 2) {
      refuse_value(key, "has " + std::to_string(result.size()) + " entries; a rule names two");
    }
    return result;
  }
  double length(std::string_view key) const {
    const std::optional<double> value = number_of(*table_.get(key));
    if (!value || *value < 0) refuse_value(key, "must be a length that is at least 0; write a number, without quotes");
    return *value;
  }
  /// A list of numbers, as many as one of the counts.
  std::vector<double> numbers(std::string_view key, const std::vector<std::size_t>& counts) const {
    std::vector<double> result;
    const toml::array* array = table_.get(key)->as_array();
    bool good = array != nullptr;
    for (std::size_t i = 0; good && i < array->size(); ++i) {
      const std::optional<double> value = number_of(*array->get(i));
      good = value.has_value();
      if (good) result.push_back(*value);
    }
    if (good && std::find(counts.begin(), counts.end(), result.size()) != counts.end()) return result;
    std::string words;
    for (const std::size_t count : counts) words += (words.empty() ? "" : " or ") + std::to_string(count);
    refuse_value(key, "must be a list of " + words + " finite numbers" +
                          (good ? ", and has " + std::to_string(result.size()) : "") + "; correct it");
  }
  Vec3d vector(std::string_view key) const {
    if (!has(key)) return Vec3d::Zero();
    const std::vector<double> x = numbers(key, {3});
    return {x[0], x[1], x[2]};
  }
  std::string unit(std::string_view key) const {
    const std::string name = text(key);
    if (has(key) && millimetres(name) == 0) {
      refuse_value(key, "is '" + name + "', which is no unit here; write " + units);
    }
    return name;
  }
  /// The tables of a list [[key]].
  std::vector<Table> tables(std::string_view key, const std::string& what) const {
    std::vector<Table> result;
    if (!has(key)) return result;
    const toml::array* array = table_.get(key)->as_array();
    if (array == nullptr) refuse_value(key, "must be a list of tables; head each with [[" + std::string(key) + "]]");
    for (const toml::node& node : *array) {
      const toml::table* table = node.as_table();
      if (table == nullptr) refuse_value(key, "must be a list of tables; head each with [[" + std::string(key) + "]]");
      result.emplace_back(file_, *table, what + " " + std::to_string(result.size() + 1));
    }
    return result;
  }

 private:
  static std::optional<double> number_of(const toml::node& node) {
    if (!node.is_number()) return std::nullopt;
    const std::optional<double> value = node.value<double>();
    return value && std::isfinite(*value) ? value : std::nullopt;
  }

  const std::string& file_;
  const toml::table& table_;
  std::string what_;
};

Pose pose_of_matrix(const Table& part) {
  const std::vector<double> x = part.numbers("pose", {12, 16});
  Pose pose = Pose::Identity();
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      pose.linear()(row, column) = x[static_cast<std::size_t>(4 * row + column)];
    }
    pose.translation()[row] = x[static_cast<std::size_t>(4 * row + 3)];
  }
  if (x.size() == 16 && !(x[12] == 0 && x[13] == 0 && x[14] == 0 && x[15] == 1)) {
    const bool columns = x[3] == 0 && x[7] == 0 && x[11] == 0 && x[15] == 1;
    part.refuse_value("pose", columns ? "is written column by column; write the matrix row by row"
                                      : "has a last row other than 0, 0, 0, 1; write an affine map");
  }
  return pose;
}

Eigen::Matrix3d rotation_in(const Table& part) {
  const std::vector<double> q = part.numbers("quaternion", {4});
  const std::optional<Eigen::Matrix3d> rotation = rotation_of({q[0], q[1], q[2], q[3]});
  if (!rotation) part.refuse_value("quaternion", "has no length that can be used; write x, y, z, w of a rotation");
  return *rotation;
}

Pose pose_of(const Table& part) {
  const std::string_view kind = part.one_of({"pose", "rpy", "quaternion"});
  if (kind == "pose") {
    part.one_of({"pose", "xyz"});
    return pose_of_matrix(part);
  }
  if (kind != "quaternion") return Pose(make_pose(part.vector("xyz"), part.vector("rpy")));
  Pose pose = Pose::Identity();
  pose.linear() = rotation_in(part);
  pose.translation() = part.vector("xyz");
  return pose;
}

PartSource read_part(const Table& table) {
  table.check_keys({"name", "file", "unit", "pose", "xyz", "rpy", "quaternion", "groups"});
  PartSource part;
  part.name = table.text("name");
  part.file = table.required_text("file");
  part.unit = table.unit("unit");
  part.pose = pose_of(table);
  part.groups = table.texts("groups");
  part.place = table.place();
  const double greatest = part.pose.matrix().cwiseAbs().maxCoeff();
  if (greatest > 0x1p400) table.refuse("the pose has a number beyond 2^400; write a smaller one");
  if (part.pose.linear().determinant() == 0) {
    table.refuse("the pose flattens space, its determinant is 0; write one that does not");
  }
  return part;
}

RuleKind read_allowed(const Table& table) {
  const std::string word = table.text("allow");
  for (const RuleKind kind : {RuleKind::nothing, RuleKind::touching, RuleKind::overlap, RuleKind::anything}) {
    if (word == name_of(kind)) return kind;
  }
  table.refuse_value("allow", "is '" + word + "'; write nothing, touching, overlap or anything");
}

RuleKind read_wanted(const Table& table) {
  const std::string word = table.text("want");
  for (const RuleKind kind : {RuleKind::inside, RuleKind::same}) {
    if (word == name_of(kind)) return kind;
  }
  table.refuse_value("want", "is '" + word + "'; write inside or same");
}

AssemblyRule read_rule(const Table& table) {
  table.check_keys({"parts", "groups", "allow", "eps", "want", "clearance", "reason"});
  AssemblyRule rule;
  rule.place = table.place();
  table.one_of({"parts", "groups"});
  rule.parts = table.two_texts("parts");
  rule.groups = table.two_texts("groups");
  if (!rule.parts.empty() && rule.parts[0] == rule.parts[1]) {
    table.refuse_value("parts", "names '" + rule.parts[0] + "' twice; name two different parts");
  }
  rule.reason = table.text("reason");
  const std::string_view kind = table.one_of({"allow", "want", "clearance"});
  if (kind.empty()) table.refuse("it says nothing; add the key allow, want or clearance");
  if (kind == "clearance") {
    rule.kind = RuleKind::clearance;
    rule.limit = table.length("clearance");
  } else {
    rule.kind = kind == "allow" ? read_allowed(table) : read_wanted(table);
  }
  if (kind == "want" && rule.parts.empty() && rule.groups.empty()) {
    table.refuse_value("want", "is about all pairs here; name two with parts or groups");
  }
  if (rule.kind == RuleKind::overlap) {
    if (!table.has("eps"))
      table.refuse_value("allow", "needs eps, how far parts may overlap; add eps = 1e-4 or another");
    rule.limit = table.length("eps");
  } else if (table.has("eps")) {
    table.refuse_value("eps", "goes with allow = \"overlap\" only; remove it");
  }
  if (rule.kind == RuleKind::anything && rule.reason.empty()) {
    table.refuse_value("allow", "takes a reason here; add reason = \"...\"");
  }
  return rule;
}

toml::table parse(const std::string& path) {
  const std::string content = mesh_io::read_file(path, "assembly");
  try {
    return toml::parse(content, path);
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(path + ":" + std::to_string(error.source().begin.line) + ": " +
                             std::string(error.description()) + "; correct the TOML");
  }
}

}  // namespace

AssemblySource read_toml(const std::string& path, bool with_parts) {
  const toml::table content = parse(path);
  const Table top(path, content, "");
  AssemblySource source;
  if (with_parts) {
    top.check_keys({"unit", "clearance", "rules", "part", "rule"});
    source.unit = top.unit("unit");
    if (top.has("clearance")) source.clearance = top.length("clearance");
    source.rules_files = top.texts("rules");
    for (const Table& part : top.tables("part", "part")) source.parts.push_back(read_part(part));
    if (source.parts.empty()) top.refuse("there are no parts; add a table [[part]] with its file for each");
  } else {
    top.check_keys({"rule"});
  }
  for (const Table& rule : top.tables("rule", "rule")) source.rules.push_back(read_rule(rule));
  return source;
}

}  // namespace cchip::assembly
