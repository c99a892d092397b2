// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meaning of the columns of a pair file: header to column numbers, record to pair.
#ifndef CCHIP_STIMULUS_PAIR_COLUMNS_HPP
#define CCHIP_STIMULUS_PAIR_COLUMNS_HPP

#include <array>
#include <cchip/program/csv_reader.hpp>
#include <cchip/stimulus/pair_job.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cchip {

struct ColumnOptions {
  /// Column with the expected answers (0 or 1); none if empty.
  std::string expect;
  /// True: the columns with the coordinates and kinds go to the output, too.
  bool pass_all = false;
};

class PairColumns {
 public:
  /// Reads the header record.
  /// \throws UsageError a column is missing or occurs twice
  PairColumns(const CsvRow& header, std::string file, const ColumnOptions& options);

  /// \throws UsageError the record is not a pair
  PairJob parse(CsvRow&& row) const;
  /// Names of the columns that are passed through, in the order of the file.
  const std::vector<std::string>& passed_names() const { return passed_names_; }

 private:
  using Column = std::optional<std::size_t>;
  struct PrimitiveColumns {
    char letter = 'a';
    Column kind;
    std::array<std::array<Column, 3>, 4> coordinate;
  };

  PrimitiveColumns find_primitive(const CsvRow& header, char letter);
  Column find(const CsvRow& header, const std::string& name);
  Primitive parse_primitive(const CsvRow& row, const PrimitiveColumns& columns) const;
  Kind parse_kind(const CsvRow& row, const PrimitiveColumns& columns) const;
  bool parse_expected(const CsvRow& row) const;

  std::string file_;
  std::vector<std::string> names_;
  std::vector<bool> known_;
  PrimitiveColumns a_;
  PrimitiveColumns b_;
  Column expect_;
  std::vector<std::size_t> passed_;
  std::vector<std::string> passed_names_;
};

}  // namespace cchip

#endif
