// SPDX-License-Identifier: Apache-2.0
#include "text.hpp"

#include <algorithm>
#include <cchip/geometry/decimal.hpp>
#include <charconv>
#include <optional>

#include "polygon_soup.hpp"

namespace cchip::mesh_io {
namespace {

constexpr std::string_view blanks = " \t\r\f\v";

void append_words(std::string_view line, std::vector<std::string_view>& words) {
  for (auto begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(blanks, end);
  }
}

/// A word of the file for a message: short, and without bytes that a terminal would obey.
std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > 40 ? "...'" : "'");
}

}  // namespace

bool Lines::next() {
  words_.clear();
  bool continued = false;
  while (!text_.empty() && (words_.empty() || continued)) {
    const auto end = std::min(text_.find('\n'), text_.size());
    std::string_view line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++last_;
    if (words_.empty()) first_ = last_;
    if (rules_.comments) line = line.substr(0, line.find('#'));
    append_words(line, words_);
    continued = rules_.continuation && !words_.empty() && words_.back() == "\\";
    if (continued) words_.pop_back();
  }
  return !words_.empty();
}

void Lines::require_next(const std::string& what) {
  if (!next()) throw FormatError("the file ends before " + what, last_);
}

double Lines::to_number(std::size_t i) const {
  if (i >= words_.size()) {
    throw FormatError("word " + std::to_string(i + 1) + " of the line is missing", first_);
  }
  return mesh_io::to_number(words_[i], first_);
}

std::string_view Words::next() {
  if (next_ >= lines_.words().size()) {
    next_ = 0;
    if (!lines_.next()) return {};
  }
  return lines_.words()[next_++];
}

double to_number(std::string_view word, std::size_t line) {
  const std::optional<double> value = read_decimal(word);
  if (!value && has_decimal_comma(word)) {
    throw FormatError(quoted(word) + " has a decimal comma; write a decimal point", line);
  }
  if (!value) throw FormatError(quoted(word) + " is not a number", line);
  return *value;
}

std::size_t to_count(std::string_view word, std::size_t line) {
  std::size_t value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size() || value > std::size_t{1} << 53) {
    throw FormatError(quoted(word) + " is not a count", line);
  }
  return value;
}

}  // namespace cchip::mesh_io
