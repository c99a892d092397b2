// SPDX-License-Identifier: Apache-2.0
/// \file
/// Streaming reader and field writer for comma-separated values with RFC 4180 quoting (libcsv).
#ifndef CCHIP_PROGRAM_CSV_READER_HPP
#define CCHIP_PROGRAM_CSV_READER_HPP

#include <cchip/program/usage_error.hpp>
#include <cstdint>
#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace cchip {

/// One record. `line` is the line of the file on which it starts, counted from 1.
struct CsvRow {
  std::uint64_t line = 0;
  std::vector<std::string> fields;
};

/// Reads records one at a time; memory does not grow with the stream. Lines end with LF, CRLF or CR,
/// a byte order mark is skipped, empty lines are ignored, spaces belong to the field.
class CsvReader {
 public:
  /// `name` is the file name for error messages.
  CsvReader(std::istream& in, std::string name);
  ~CsvReader();
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  /// Reads the next record. False at the end of the stream.
  /// \throws UsageError broken quoting, a record longer than 1 MiB, a read error
  bool next(CsvRow& row);
  /// Bytes taken from the stream so far.
  std::uint64_t bytes_read() const { return bytes_read_; }
  const std::string& name() const { return name_; }

 private:
  struct Parser;
  bool refill();
  void feed_line_piece();
  void feed_end();
  [[noreturn]] void fail(const std::string& message) const;

  std::istream& in_;
  std::string name_;
  std::unique_ptr<Parser> parser_;
  std::string buffer_;
  std::size_t position_ = 0;
  std::uint64_t bytes_read_ = 0;
  std::uint64_t line_ = 1;
  std::uint64_t row_line_ = 1;
  std::uint64_t row_bytes_ = 0;
  bool between_rows_ = true;
  bool after_carriage_return_ = false;
};

/// The error that a column is missing. What the header shows tells what to do: other separators, no text at all; or
/// else it is `remedy`.
UsageError missing_column(const std::string& file, const CsvRow& header, const std::string& name,
                          const std::string& remedy);

/// A field without the spaces and tabs around it.
std::string_view trimmed_field(std::string_view text);
/// What an error message repeats of the user's text: one line, not too long.
std::string quoted_field(std::string_view text);
/// Nearest double of a decimal number; spaces around it and one leading plus are allowed.
/// \throws std::invalid_argument what is wrong and what to do, without a location
double parse_coordinate(std::string_view text);

/// Appends `field` to `out`, quoted if RFC 4180 asks for it.
void append_csv_field(std::string& out, std::string_view field);

}  // namespace cchip

#endif
