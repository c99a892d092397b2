// SPDX-License-Identifier: Apache-2.0
/// \file
/// The three output formats: aligned table, CSV and one JSON object per line.
#ifndef CCHIP_APP_ROW_WRITER_HPP
#define CCHIP_APP_ROW_WRITER_HPP

#include <cstdint>
#include <memory>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

namespace cchip::app {

enum class Format { table, csv, jsonl };

/// Empty, a number or a text. Of a double all digits that tell it from others are written.
using Cell = std::variant<std::monostate, std::uint64_t, double, std::string>;

/// Writes rows of equal length. Memory is bounded by the rows between two calls of flush().
class RowWriter {
 public:
  virtual ~RowWriter() = default;
  virtual void write(const std::vector<Cell>& cells) = 0;
  /// Flushes everything written so far to the stream.
  virtual void flush() = 0;
};

/// Names of the columns that are passed through, then ours. A passed name that equals one of ours, or occurs twice,
/// gets the prefix "input_".
std::vector<std::string> names_behind(std::vector<std::string> passed, const std::vector<std::string>& ours);

/// `names` are the column names. The table aligns its columns by the rows before the first flush().
std::unique_ptr<RowWriter> make_row_writer(Format format, std::ostream& out, const std::vector<std::string>& names);

}  // namespace cchip::app

#endif
