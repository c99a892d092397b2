// SPDX-License-Identifier: Apache-2.0
#include "row_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cchip/program/csv_reader.hpp>
#include <nlohmann/json.hpp>

namespace cchip::app {
namespace {

std::string text_of(const Cell& cell) {
  if (const auto* number = std::get_if<std::uint64_t>(&cell)) return std::to_string(*number);
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  return {};
}

class CsvWriter final : public RowWriter {
 public:
  CsvWriter(std::ostream& out, const std::vector<std::string>& names) : out_(out) {
    write(std::vector<Cell>(names.begin(), names.end()));
  }
  void write(const std::vector<Cell>& cells) override {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i > 0) text_ += ',';
      append_csv_field(text_, text_of(cells[i]));
    }
    text_ += '\n';
  }
  void flush() override {
    out_ << text_ << std::flush;
    text_.clear();
  }

 private:
  std::ostream& out_;
  std::string text_;
};

class JsonlWriter final : public RowWriter {
 public:
  JsonlWriter(std::ostream& out, std::vector<std::string> names) : out_(out), names_(std::move(names)) {}
  void write(const std::vector<Cell>& cells) override {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::visit([&](const auto& value) { object[names_[i]] = to_json(value); }, cells[i]);
    }
    text_ += object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    text_ += '\n';
  }
  void flush() override {
    out_ << text_ << std::flush;
    text_.clear();
  }

 private:
  static nlohmann::ordered_json to_json(std::monostate) { return nullptr; }
  static nlohmann::ordered_json to_json(std::uint64_t number) { return number; }
  static nlohmann::ordered_json to_json(double number) { return number; }  // null if it is not finite
  static nlohmann::ordered_json to_json(const std::string& text) { return text; }

  std::ostream& out_;
  std::vector<std::string> names_;
  std::string text_;
};

class TableWriter final : public RowWriter {
 public:
  TableWriter(std::ostream& out, const std::vector<std::string>& names) : out_(out) {
    write(std::vector<Cell>(names.begin(), names.end()));
  }
  void write(const std::vector<Cell>& cells) override {
    std::vector<std::string> texts;
    texts.reserve(cells.size());
    for (const Cell& cell : cells) texts.push_back(printable(text_of(cell)));
    rows_.push_back(std::move(texts));
  }
  void flush() override {
    if (widths_.empty()) choose_widths();
    for (const auto& row : rows_) write_line(row);
    out_ << std::flush;
    rows_.clear();
  }

 private:
  /// Control characters would break the table (or talk to the terminal).
  static std::string printable(const std::string& text) {
    std::string shown;
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < ' ' || byte == 0x7f) {
        shown += fmt::format("\\x{:02x}", byte);
      } else {
        shown += c;
      }
    }
    return shown;
  }
  void choose_widths() {
    for (const auto& row : rows_) {
      widths_.resize(row.size(), 0);
      for (std::size_t i = 0; i < row.size(); ++i) widths_[i] = std::max(widths_[i], row[i].size());
    }
  }
  void write_line(const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths_[i]);
    line.erase(line.find_last_not_of(' ') + 1);
    out_ << line << '\n';
  }

  std::ostream& out_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<std::size_t> widths_;
};

}  // namespace

std::vector<std::string> names_behind(std::vector<std::string> passed, const std::vector<std::string>& ours) {
  const auto taken = [&](const std::string& name) {
    return std::count(ours.begin(), ours.end(), name) + std::count(passed.begin(), passed.end(), name);
  };
  for (std::string& name : passed) {
    while (taken(name) > 1) name.insert(0, "input_");
  }
  passed.insert(passed.end(), ours.begin(), ours.end());
  return passed;
}

std::unique_ptr<RowWriter> make_row_writer(Format format, std::ostream& out, const std::vector<std::string>& names) {
  if (format == Format::csv) return std::make_unique<CsvWriter>(out, names);
  if (format == Format::jsonl) return std::make_unique<JsonlWriter>(out, names);
  return std::make_unique<TableWriter>(out, names);
}

}  // namespace cchip::app
