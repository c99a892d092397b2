// SPDX-License-Identifier: Apache-2.0
#include "text.hpp"

#include <algorithm>
#include <cchip/internal/geometry/decimal.hpp>
#include <charconv>
#include <optional>

#include "polygon_soup.hpp"

namespace cchip::mesh_io {
namespace {

constexpr std::string_view blanks = " \t\f\v";

void append_words(std::string_view line, std::vector<std::string_view>& words) {
  for (auto begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(blanks, end);
  }
}

}  // namespace

std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > 40 ? "...'" : "'");
}

std::string_view without_mark(std::string_view file) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return file.substr(0, mark.size()) == mark ? file.substr(mark.size()) : file;
}

std::string_view without_padding(std::string_view text) {
  using namespace std::string_view_literals;
  return text.substr(0, text.find_last_not_of(" \t\f\v\r\n\0\x1a"sv) + 1);  // + 1 makes 0 of npos
}

std::string_view take_line(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
  const std::string_view line = text.substr(0, end);
  const std::size_t line_end = text.substr(end, 2) == "\r\n" ? 2 : 1;
  text.remove_prefix(std::min(end + line_end, text.size()));
  return line;
}

bool Lines::next() {
  words_.clear();
  bool continued = false;
  while (!text_.empty() && (words_.empty() || continued)) {
    std::string_view line = take_line(text_);
    ++last_;
    if (words_.empty()) first_ = last_;
    if (rules_.comments) line = line.substr(0, line.find('#'));
    const auto last = line.find_last_not_of(blanks);
    continued = rules_.continuation && last != std::string_view::npos && line[last] == '\\';
    append_words(continued ? line.substr(0, last) : line, words_);
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
