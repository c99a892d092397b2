// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cchip/program/usage_error.hpp>
#include <cchip/stimulus/pair_columns.hpp>
#include <optional>
#include <stdexcept>

namespace cchip {
namespace {

std::string coordinate_name(char letter, int vertex, int component) {
  return fmt::format("{}{}{}", letter, vertex, "xyz"[component]);
}

}  // namespace

PairColumns::PairColumns(const CsvRow& header, std::string file, const ColumnOptions& options)
    : file_(std::move(file)), names_(header.fields), known_(header.fields.size(), false) {
  a_ = find_primitive(header, 'a');
  b_ = find_primitive(header, 'b');
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (known_[i] && !options.pass_all) continue;
    passed_.push_back(i);
    passed_names_.push_back(names_[i]);
  }
  if (options.expect.empty()) return;
  expect_ = find(header, options.expect);
  if (!expect_) {
    throw row_error(file_, header.line,
                    fmt::format("column {} of --expect is missing; name a column of the file that holds 0 or 1",
                                quoted_field(options.expect)));
  }
}

PairColumns::PrimitiveColumns PairColumns::find_primitive(const CsvRow& header, char letter) {
  PrimitiveColumns columns;
  columns.letter = letter;
  columns.kind = find(header, fmt::format("kind_{}", letter));
  for (int vertex = 0; vertex < 4; ++vertex) {
    for (int component = 0; component < 3; ++component) {
      const std::string name = coordinate_name(letter, vertex, component);
      auto& column = columns.coordinate.at(static_cast<std::size_t>(vertex)).at(static_cast<std::size_t>(component));
      column = find(header, name);
      if (!column && vertex < 3) {
        throw missing_column(file_, header, name,
                             "the first row must name the columns a0x,a0y,a0z to a2z and b0x,b0y,b0z to b2z");
      }
    }
  }
  return columns;
}

PairColumns::Column PairColumns::find(const CsvRow& header, const std::string& name) {
  Column found;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (trimmed_field(names_[i]) != name) continue;
    if (found) {
      throw row_error(file_, header.line, fmt::format("column {} is there twice; rename or remove one of them", name));
    }
    found = i;
    known_[i] = true;
  }
  return found;
}

PairJob PairColumns::parse(CsvRow&& row) const {
  if (row.fields.size() != names_.size()) {
    throw row_error(file_, row.line,
                    fmt::format("the row has {} fields, but the header names {} columns; write one field per column",
                                row.fields.size(), names_.size()));
  }
  PairJob job;
  job.row = row.line;
  job.a = parse_primitive(row, a_);
  job.b = parse_primitive(row, b_);
  if (expect_) job.expected = parse_expected(row);
  job.passed.reserve(passed_.size());
  for (const std::size_t i : passed_) job.passed.push_back(std::move(row.fields[i]));
  return job;
}

Primitive PairColumns::parse_primitive(const CsvRow& row, const PrimitiveColumns& columns) const {
  Primitive primitive;
  primitive.kind = parse_kind(row, columns);
  for (std::size_t vertex = 0; vertex < primitive.vertex_count(); ++vertex) {
    for (std::size_t component = 0; component < 3; ++component) {
      const Column column = columns.coordinate.at(vertex).at(component);
      const std::string name = coordinate_name(columns.letter, static_cast<int>(vertex), static_cast<int>(component));
      if (!column) {
        throw row_error(file_, row.line,
                        fmt::format("kind_{} is quad, but column {} is missing; add the columns {}3x, {}3y and {}3z",
                                    columns.letter, name, columns.letter, columns.letter, columns.letter));
      }
      try {
        primitive.v.at(vertex)[static_cast<Eigen::Index>(component)] = parse_coordinate(row.fields[*column]);
      } catch (const std::invalid_argument& error) {
        throw row_error(file_, row.line, fmt::format("column {}: {}", name, error.what()));
      }
    }
  }
  return primitive;
}

Kind PairColumns::parse_kind(const CsvRow& row, const PrimitiveColumns& columns) const {
  if (!columns.kind) return Kind::tri;
  const std::string_view text = trimmed_field(row.fields[*columns.kind]);
  if (text.empty() || text == "tri") return Kind::tri;
  if (text == "quad") return Kind::quad;
  throw row_error(
      file_, row.line,
      fmt::format("column kind_{}: {} is not a known kind; write tri or quad", columns.letter, quoted_field(text)));
}

bool PairColumns::parse_expected(const CsvRow& row) const {
  const std::string_view text = trimmed_field(row.fields[*expect_]);
  if (text == "0" || text == "1") return text == "1";
  throw row_error(file_, row.line,
                  fmt::format("column {}: {} is not an answer; write 0 or 1", names_[*expect_], quoted_field(text)));
}

}  // namespace cchip
