// SPDX-License-Identifier: Apache-2.0
#include <csv.h>

#include <algorithm>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/program/csv_reader.hpp>
#include <cchip/program/usage_error.hpp>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>

namespace cchip {
namespace {

constexpr std::size_t chunk_bytes = 65536;
constexpr std::uint64_t row_bytes_max = 1048576;
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

bool is_line_end(char c) { return c == '\n' || c == '\r'; }
int nothing_is_space(unsigned char) { return 0; }

const char* const binary_remedy = "this looks like a binary file or UTF-16: give a CSV file in UTF-8";

bool is_binary(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return c >= 0 && c < ' ' && c != '\t' && !is_line_end(c); });
}

}  // namespace

/// The libcsv parser and the record that it is filling.
struct CsvReader::Parser {
  csv_parser csv{};
  std::vector<std::string> fields;
  bool complete = false;

  Parser() {
    if (csv_init(&csv, CSV_STRICT | CSV_STRICT_FINI) != 0) throw std::bad_alloc();
    csv_set_space_func(&csv, nothing_is_space);
  }
  ~Parser() { csv_free(&csv); }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;

  static void on_field(void* text, std::size_t size, void* self) {
    static_cast<Parser*>(self)->fields.emplace_back(static_cast<const char*>(text), size);
  }
  static void on_row(int, void* self) { static_cast<Parser*>(self)->complete = true; }
};

CsvReader::CsvReader(std::istream& in, std::string name)
    : in_(in), name_(std::move(name)), parser_(std::make_unique<Parser>()) {
  if (refill() && std::string_view(buffer_).substr(0, byte_order_mark.size()) == byte_order_mark) {
    position_ = byte_order_mark.size();
  }
}

CsvReader::~CsvReader() = default;

bool CsvReader::next(CsvRow& row) {
  parser_->fields.clear();
  parser_->complete = false;
  while (!parser_->complete && (position_ < buffer_.size() || refill())) feed_line_piece();
  if (!parser_->complete) feed_end();
  if (!parser_->complete) return false;
  row.line = row_line_;
  row.fields.swap(parser_->fields);
  return true;
}

bool CsvReader::refill() {
  buffer_.resize(chunk_bytes);
  in_.read(buffer_.data(), static_cast<std::streamsize>(chunk_bytes));
  if (in_.bad()) fail("reading fails; check the file and the disk");
  buffer_.resize(static_cast<std::size_t>(in_.gcount()));
  position_ = 0;
  bytes_read_ += buffer_.size();
  return !buffer_.empty();
}

// Feeds at most one line, so that a record ends where its last piece ends.
void CsvReader::feed_line_piece() {
  const auto begin = buffer_.begin() + static_cast<std::ptrdiff_t>(position_);
  auto end = std::find_if(begin, buffer_.end(), is_line_end);
  const bool blank = end == begin;
  if (end != buffer_.end()) ++end;
  const auto size = static_cast<std::size_t>(end - begin);

  if (between_rows_ && !blank) {
    row_line_ = line_;
    row_bytes_ = 0;
    between_rows_ = false;
  }
  row_bytes_ += size;
  if (row_bytes_ > row_bytes_max && is_binary(buffer_))
    fail(std::string("the row is longer than 1 MiB; ") + binary_remedy);
  if (row_bytes_ > row_bytes_max) fail("the row is longer than 1 MiB; look for a double quote that is not closed");
  if (csv_parse(&parser_->csv, &*begin, size, Parser::on_field, Parser::on_row, parser_.get()) != size) {
    if (is_binary(buffer_)) fail(std::string("a double quote stands inside a field; ") + binary_remedy);
    fail("a double quote stands inside a field; put the field in double quotes and double those inside it");
  }
  if (parser_->complete) between_rows_ = true;

  const char last = *(end - 1);
  if (last == '\r' || (last == '\n' && !(blank && after_carriage_return_))) ++line_;
  after_carriage_return_ = last == '\r';
  position_ += size;
}

void CsvReader::feed_end() {
  if (csv_fini(&parser_->csv, Parser::on_field, Parser::on_row, parser_.get()) != 0) {
    fail("a quoted field is not closed; end it with a double quote");
  }
  between_rows_ = true;
}

void CsvReader::fail(const std::string& message) const { throw row_error(name_, row_line_, message); }

UsageError missing_column(const std::string& file, const CsvRow& header, const std::string& name,
                          const std::string& remedy) {
  std::string todo = remedy;
  for (const std::string& field : header.fields) {
    if (field.find(';') != std::string::npos) todo = "the columns seem to be separated by semicolons: write commas";
    if (field.find('\t') != std::string::npos) todo = "the columns seem to be separated by tabs: write commas";
  }
  if (std::any_of(header.fields.begin(), header.fields.end(), is_binary)) todo = binary_remedy;
  return row_error(file, header.line, "column " + name + " is missing; " + todo);
}

std::string_view trimmed_field(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string quoted_field(std::string_view text) {
  std::string shown = "'";
  for (const char c : text.substr(0, 40)) shown += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  return shown + (text.size() > 40 ? "...'" : "'");
}

double parse_coordinate(std::string_view text) {
  const std::string_view digits = trimmed_field(text);
  if (digits.empty()) throw std::invalid_argument("the field is empty; write a finite decimal number");
  const std::optional<double> value = read_decimal(digits);
  if (!value && has_decimal_comma(digits)) {
    throw std::invalid_argument(quoted_field(text) + " has a decimal comma; write a decimal point");
  }
  if (!value) throw std::invalid_argument(quoted_field(text) + " is not a number; write a finite decimal number");
  if (std::isfinite(*value)) return *value;
  if (digits.find_first_of("0123456789") != std::string_view::npos) {
    throw std::invalid_argument(quoted_field(digits) + " is too large for a double; scale the coordinates down");
  }
  throw std::invalid_argument(quoted_field(text) + " is not finite; write a finite decimal number");
}

void append_csv_field(std::string& out, std::string_view field) {
  if (field.find_first_of(",\"\r\n") == std::string_view::npos) {
    out += field;
    return;
  }
  const std::size_t at = out.size();
  const std::size_t size = csv_write(nullptr, 0, field.data(), field.size());
  out.resize(at + size);
  csv_write(&out[at], size, field.data(), field.size());
}

}  // namespace cchip
