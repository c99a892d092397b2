// SPDX-License-Identifier: Apache-2.0
#include <fmt/ostream.h>

#include <cchip/levels/stimulus_file.hpp>
#include <cchip/program/csv_reader.hpp>
#include <cchip/program/usage_error.hpp>
#include <cchip/stimulus/pair_columns.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace cchip::levels {
namespace {

std::string entry_name(std::size_t i) { return fmt::format("m{}{}", i / 4, i % 4); }
std::string vertex_name(char primitive, std::size_t vertex, int component) {
  return fmt::format("{}{}{}", primitive, vertex, "xyz"[component]);
}
std::string kind_name(char primitive) { return fmt::format("kind_{}", primitive); }

std::vector<std::string> column_names() {
  std::vector<std::string> names = {"object_pair", "mode"};
  for (std::size_t i = 0; i < Matrix{}.entry.size(); ++i) names.push_back(entry_name(i));
  for (const char primitive : {'a', 'b'}) {
    names.push_back(kind_name(primitive));
    for (std::size_t vertex = 0; vertex < 4; ++vertex) {
      for (int component = 0; component < 3; ++component) names.push_back(vertex_name(primitive, vertex, component));
    }
  }
  return names;
}

/// One row by names of columns.
class Row {
 public:
  Row(const std::map<std::string, std::size_t>& columns, const CsvRow& row) : columns_(columns), row_(row) {}

  const std::string& text(const std::string& name) const {
    const std::size_t column = columns_.at(name);
    if (column < row_.fields.size()) return row_.fields[column];
    throw std::invalid_argument("column " + name + " is missing in this row; write one field per column");
  }
  double number(const std::string& name) const {
    try {
      return parse_coordinate(text(name));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("column " + name + ": " + error.what());
    }
  }
  double whole(const std::string& name, double least, double greatest) const {
    const double value = number(name);
    if (value == std::floor(value) && value >= least && value <= greatest) return value;
    throw std::invalid_argument(
        fmt::format("column {}: write a whole number from {:.0f} to {:.0f}", name, least, greatest));
  }
  /// True: the field is `yes`, false: `no`.
  bool choice(const std::string& name, const char* yes, const char* no) const {
    if (text(name) == yes) return true;
    if (text(name) == no) return false;
    throw std::invalid_argument(fmt::format("column {}: write {} or {}", name, yes, no));
  }
  GridPrimitive primitive(char letter) const {
    GridPrimitive p;
    p.kind = choice(kind_name(letter), "quad", "tri") ? Kind::quad : Kind::tri;
    read_vertices(p, letter, p.vertex_count());
    return p;
  }
  void read_vertices(GridPrimitive& p, char letter, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) {
      for (int d = 0; d < 3; ++d) {
        p.v.at(i)[d] = static_cast<std::int32_t>(whole(vertex_name(letter, i, d), -unplaced_max, unplaced_max));
      }
    }
  }
  StimulusPair pair() const {
    StimulusPair result;
    constexpr double exact_max = 9007199254740992.0;  // 2^53
    result.object_pair = static_cast<std::uint64_t>(whole("object_pair", 0, exact_max));
    result.mode = choice("mode", "directed", "exhaustive") ? PairMode::directed : PairMode::exhaustive;
    for (std::size_t i = 0; i < result.m.entry.size(); ++i) result.m.entry.at(i) = number(entry_name(i));
    if (text(kind_name('a')) == "point") {
      read_vertices(result.a, 'a', 1);
      result.radius = static_cast<std::int32_t>(whole(vertex_name('a', 1, 0), 0, unplaced_max));
    } else {
      result.a = primitive('a');
    }
    result.b = primitive('b');
    check_pair(result);
    return result;
  }

 private:
  const std::map<std::string, std::size_t>& columns_;
  const CsvRow& row_;
};

std::map<std::string, std::size_t> find_columns(const CsvRow& header, const std::string& file) {
  std::map<std::string, std::size_t> columns;
  for (std::size_t i = 0; i < header.fields.size(); ++i) columns.emplace(header.fields[i], i);
  for (const std::string& name : column_names()) {
    if (columns.count(name) != 0) continue;
    throw missing_column(file, header, name, "see docs/paper/levels.md, or write a file with --write");
  }
  return columns;
}

void write_point(std::ostream& out, const Vec3i& centre, std::int32_t radius) {
  fmt::print(out, ",point,{},{},{},{},,,,,,,,", centre.x(), centre.y(), centre.z(), radius);
}

void write_primitive(std::ostream& out, const GridPrimitive& p) {
  fmt::print(out, ",{}", p.kind == Kind::tri ? "tri" : "quad");
  for (std::size_t i = 0; i < 4; ++i) {
    const bool used = i < p.vertex_count();
    for (const std::int32_t x : p.v.at(i)) used ? fmt::print(out, ",{}", x) : fmt::print(out, ",");
  }
}

}  // namespace

void write_stimulus(std::ostream& out, const Stimulus& stimulus) {
  fmt::print(out, "{}\n", fmt::join(column_names(), ","));
  for (const StimulusPair& pair : stimulus) {
    fmt::print(out, "{},{}", pair.object_pair, pair.mode == PairMode::directed ? "directed" : "exhaustive");
    for (const double entry : pair.m.entry) fmt::print(out, ",{}", entry);  // shortest text that reads back the same
    pair.radius ? write_point(out, pair.a.v[0], *pair.radius) : write_primitive(out, pair.a);
    write_primitive(out, pair.b);
    out << '\n';
  }
}

Stimulus read_stimulus(std::istream& in, const std::string& name) {
  CsvReader reader(in, name);
  CsvRow row;
  if (!reader.next(row)) throw UsageError(name + ": the file is empty; write one with --write");
  const auto columns = find_columns(row, name);
  Stimulus stimulus;
  while (reader.next(row)) {
    try {
      StimulusPair pair = Row(columns, row).pair();
      if (!stimulus.empty()) check_order(stimulus.back(), pair);
      stimulus.push_back(pair);
    } catch (const std::invalid_argument& error) {
      throw row_error(name, row.line, error.what());
    }
  }
  if (stimulus.empty()) throw UsageError(name + ": no pairs; write a file with --write");
  return stimulus;
}

}  // namespace cchip::levels
