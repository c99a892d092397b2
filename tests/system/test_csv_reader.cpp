// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/program/csv_reader.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/program/usage_error.hpp>
#include <random>
#include <sstream>

#include "support.hpp"

using namespace cchip;
using namespace cchip::app;
using Fields = std::vector<std::string>;

namespace {

std::vector<CsvRow> read_all(const std::string& text) {
  std::istringstream in(text);
  CsvReader reader(in, "f.csv");
  std::vector<CsvRow> rows;
  for (CsvRow row; reader.next(row);) rows.push_back(row);
  return rows;
}

void check_fields(const std::string& text, const std::vector<Fields>& expected) {
  CAPTURE(text);
  const std::vector<CsvRow> rows = read_all(text);
  REQUIRE(rows.size() == expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) CHECK(rows[i].fields == expected[i]);
}

}  // namespace

TEST_CASE("csv_reader: RFC 4180", "[system][csv_reader]") {
  check_fields("", {});
  check_fields("a,b\n1,2\n", {{"a", "b"}, {"1", "2"}});
  check_fields("a,b\n1,2", {{"a", "b"}, {"1", "2"}});
  check_fields("a,b\r\n1,2\r\n", {{"a", "b"}, {"1", "2"}});
  check_fields("a,b\r1,2\r", {{"a", "b"}, {"1", "2"}});
  check_fields(
      "\xEF\xBB\xBF"
      "a,b\n",
      {{"a", "b"}});
  check_fields("\xEF\xBB\xBF", {});
  check_fields("\"a,1\",b\n", {{"a,1", "b"}});
  check_fields("\"two\nlines\",\"two\r\nlines\"\n", {{"two\nlines", "two\r\nlines"}});
  check_fields("\"say \"\"hi\"\"\",\"\"\"\"\n", {{"say \"hi\"", "\""}});
  check_fields(",\n\"\",\n", {{"", ""}, {"", ""}});
  check_fields(" a , \tb\n", {{" a ", " \tb"}});
  check_fields("a\n\n\r\n\nb\n", {{"a"}, {"b"}});
}

TEST_CASE("csv_reader: a row has the number of the line on which it starts", "[system][csv_reader]") {
  const std::string ends = GENERATE("\n", "\r\n", "\r");
  const std::vector<CsvRow> rows = read_all("a" + ends + "\"x" + ends + "y\"" + ends + ends + "b" + ends + "c");
  REQUIRE(rows.size() == 4);
  CHECK(rows[0].line == 1);
  CHECK(rows[1].line == 2);
  CHECK(rows[2].line == 5);
  CHECK(rows[3].line == 6);
}

TEST_CASE("csv_reader: broken quoting names file and row", "[system][csv_reader]") {
  using Catch::Matchers::StartsWith;
  CHECK_THROWS_WITH(read_all("a\n1\n2\"3\"\n"), StartsWith("f.csv:3: a double quote stands inside a field;"));
  CHECK_THROWS_WITH(read_all("a\n\"1\"2\n"), StartsWith("f.csv:2: a double quote stands inside a field;"));
  CHECK_THROWS_WITH(read_all("a\n1\n\"2\n3\n"), StartsWith("f.csv:3: a quoted field is not closed;"));
  CHECK_THROWS_WITH(read_all("a\n\"" + std::string(3 << 20, 'x')),
                    StartsWith("f.csv:2: the row is longer than 1 MiB;"));
}

TEST_CASE("csv_reader: reads back every field that append_csv_field wrote", "[system][csv_reader]") {
  std::mt19937_64 random(cchip::sim::seed_from_environment());
  const std::string alphabet = "ab ,\"\r\n\t;\xC3\xA4";
  const auto number = [&](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
  };
  std::vector<Fields> expected;
  std::string text;
  for (int r = 0; r < 20000; ++r) {  // over many chunks of the reader
    Fields fields(2 + number(3));
    for (std::size_t i = 0; i < fields.size(); ++i) {
      for (std::size_t length = number(12); length > 0; --length) fields[i] += alphabet[number(alphabet.size())];
      if (i > 0) text += ',';
      append_csv_field(text, fields[i]);
    }
    text += r % 2 == 0 ? "\n" : "\r\n";
    expected.push_back(fields);
  }
  const std::vector<CsvRow> rows = read_all(text);
  REQUIRE(rows.size() == expected.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) wrong += rows[i].fields != expected[i];
  CHECK(wrong == 0);
}
