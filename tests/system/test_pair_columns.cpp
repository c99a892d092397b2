// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/program/usage_error.hpp>
#include <cchip/stimulus/pair_columns.hpp>
#include <cmath>
#include <limits>

using namespace cchip;

TEST_CASE("parse_coordinate: the nearest double", "[system][pair_columns]") {
  CHECK(parse_coordinate("1.5") == 1.5);
  CHECK(parse_coordinate("-2e3") == -2000.0);
  CHECK(parse_coordinate("+4") == 4.0);
  CHECK(parse_coordinate(" 7\t") == 7.0);
  CHECK(parse_coordinate(".5") == 0.5);
  CHECK(parse_coordinate("0.1") == 0.1);
  // Half-way between 2^53 and its successor rounds to even; a little more rounds up.
  CHECK(parse_coordinate("9007199254740993") == 9007199254740992.0);
  CHECK(parse_coordinate("9007199254740993.00000000000000000000000000001") == 9007199254740994.0);
  CHECK(parse_coordinate("4.9406564584124654e-324") == std::numeric_limits<double>::denorm_min());
  CHECK(parse_coordinate("1e-400") == 0.0);
  CHECK(parse_coordinate("1.7976931348623157e308") == std::numeric_limits<double>::max());
}

TEST_CASE("parse_coordinate: everything else is refused", "[system][pair_columns]") {
  for (const char* text :
       {"",   " ",     "x",      "1x",  "1,5", "1 2",    "--1", "+-1",  "++1",      "+",     "0x10",
        "1e", "1e999", "-1e999", "nan", "NaN", "nan(1)", "inf", "-inf", "Infinity", "1.5.2", "\"1\""}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_coordinate(text), std::invalid_argument);
  }
}

TEST_CASE("pair_columns: columns by name, in any order", "[system][pair_columns]") {
  CsvRow header{1, {"note", "kind_b", "b3z", "b3y", "b3x"}};
  CsvRow row{2, {"n", "quad", "33", "32", "31"}};
  int value = 0;
  for (const char* letter : {"b", "a"}) {
    for (int vertex = 2; vertex >= 0; --vertex) {
      for (const char* component : {"z", "x", "y"}) {
        header.fields.push_back(letter + std::to_string(vertex) + component);
        row.fields.push_back(std::to_string(++value));
      }
    }
  }
  const PairColumns columns(header, "f.csv", {});
  CHECK(columns.passed_names() == std::vector<std::string>{"note"});
  const PairJob job = columns.parse(CsvRow(row));
  CHECK(job.row == 2);
  CHECK(job.passed == std::vector<std::string>{"n"});
  CHECK(job.a.kind == Kind::tri);
  CHECK(job.b.kind == Kind::quad);
  CHECK(job.b.v[2] == Vec3d(2, 3, 1));
  CHECK(job.b.v[0] == Vec3d(8, 9, 7));
  CHECK(job.b.v[3] == Vec3d(31, 32, 33));
  CHECK(job.a.v[2] == Vec3d(11, 12, 10));
  CHECK(job.a.v[1] == Vec3d(14, 15, 13));
  CHECK_FALSE(job.expected.has_value());

  const PairColumns all(header, "f.csv", {"", true});
  CHECK(all.passed_names() == header.fields);
  CHECK(all.parse(CsvRow(row)).passed == row.fields);
}
