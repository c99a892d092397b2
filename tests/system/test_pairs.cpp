// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/program/csv_reader.hpp>
#include <cchip/program/usage_error.hpp>
#include <nlohmann/json.hpp>

#include "support.hpp"

using namespace cchip;
using namespace cchip::app;
using namespace cchip::test;

namespace {

const std::vector<std::string> partners = {b_through, b_above, b_touching, b_just_above, b_coplanar};
const std::vector<std::string> answers = {"1", "0", "1", "0", "1"};

/// The hand-made pairs with their answers in column "touches" and a number in column "id".
std::string hand_made() {
  std::string text = "id," + header + ",touches\n";
  for (std::size_t i = 0; i < partners.size(); ++i) {
    text += std::to_string(i) + "," + tri_a + "," + partners[i] + "," + answers[i] + "\n";
  }
  return text;
}

std::vector<CsvRow> parse_csv(const std::string& text) {
  std::istringstream in(text);
  CsvReader reader(in, "output");
  std::vector<CsvRow> rows;
  for (CsvRow row; reader.next(row);) rows.push_back(row);
  return rows;
}

}  // namespace

TEST_CASE("pairs: hand-made pairs on every engine", "[system][pairs]") {
  const std::string engine = GENERATE("rtl", "model", "eigen", "exact");
  const Outcome outcome = run_cchip({"pairs", "-", "--engine", engine, "--expect", "touches"}, hand_made());
  CAPTURE(engine, outcome.out, outcome.err);
  CHECK(outcome.code == exit_ok);
  CHECK(outcome.err.empty());
  const std::string summary = last_line(outcome.out);
  CHECK(count(summary, "pairs") == 5);
  CHECK(count(summary, "hits") == 3);
  CHECK(count(summary, "mismatches") == 0);
  CHECK(count(summary, "indefinite") >= 1);  // the lifted one lies between two grid steps
}

TEST_CASE("pairs: what the hardware says of the hand-made pairs", "[system][pairs]") {
  const std::string engine = GENERATE("rtl", "model");
  const Outcome outcome = run_cchip({"pairs", "-", "--engine", engine, "--format", "csv"}, hand_made());
  CAPTURE(engine);
  REQUIRE(outcome.code == exit_ok);
  CHECK(lines(outcome.err).size() == 1);
  CHECK(count(last_line(outcome.err), "pairs") == 5);
  const std::vector<CsvRow> rows = parse_csv(outcome.out);
  REQUIRE(rows.size() == 6);
  CHECK(rows[0].fields == std::vector<std::string>{"id", "touches", "hit", "hw_hit", "hw_grid", "hw_definite", "axis",
                                                   "beats", "clock_in", "clock_out"});
  using Fields = std::vector<std::string>;
  const auto answer = [&](std::size_t pair) {
    return Fields(rows.at(pair + 1).fields.begin() + 2, rows.at(pair + 1).fields.begin() + 8);
  };
  //                         hit  hw_hit grid definite axis          beats
  CHECK(answer(0) == Fields{"1", "1", "1", "1", "none", "11"});
  CHECK(answer(1) == Fields{"0", "0", "0", "1", "normal of A", "11"});
  CHECK(answer(2) == Fields{"1", "1", "1", "1", "none", "11"});
  CHECK(answer(3) == Fields{"0", "1", "1", "0", "none", "11"});
  CHECK(answer(4).at(0) == "1");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    CHECK(rows[i].fields[0] == std::to_string(i - 1));
    CHECK(std::stoull(rows[i].fields[9]) > std::stoull(rows[i].fields[8]));
  }
}

TEST_CASE("pairs: no answer depends on what the RTL holds at power-up", "[system][pairs]") {
  const auto run = [](const std::string& seed) {
    return run_cchip({"pairs", "-", "--engine", "rtl", "--format", "csv", "--seed", seed}, hand_made());
  };
  const Outcome first = run("1");
  CHECK(first.code == exit_ok);
  for (const std::string seed : {"2", "12345"}) {
    CHECK(run(seed).out == first.out);
    CHECK(run(seed).err == first.err);
  }
}

TEST_CASE("pairs: RTL and its model agree in every byte", "[system][pairs]") {
  const std::string program = GENERATE("exhaustive", "directed");
  const std::string input = GENERATE(hand_made(), mixed_file());
  const auto run = [&](const std::string& engine) {
    return run_cchip({"pairs", "-", "--engine", engine, "--program", program, "--format", "csv"}, input);
  };
  const Outcome rtl = run("rtl");
  CHECK(rtl.code == exit_ok);
  CHECK(lines(rtl.out).size() > 5);
  CHECK(rtl.out == run("model").out);
  CHECK(rtl.err == run("model").err);
}

TEST_CASE("pairs: a file and standard input give the same bytes", "[system][pairs]") {
  const TemporaryFolder folder;
  const std::string file = folder.write("pairs.csv", hand_made());
  for (const std::string format : {"table", "csv", "jsonl"}) {
    const Outcome from_file = run_cchip({"pairs", file, "--engine", "model", "--format", format});
    const Outcome from_stream = run_cchip({"pairs", "-", "--engine", "model", "--format", format}, hand_made());
    CHECK(from_file.code == exit_ok);
    CHECK(from_file.out == from_stream.out);
    CHECK(from_file.err == from_stream.err);
    CHECK(lines(from_file.out).size() == (format == "jsonl" ? 5 : format == "csv" ? 6 : 7));
  }
}

TEST_CASE("pairs: differing answers are listed, exit code 3", "[system][pairs]") {
  std::string input = hand_made();
  input[input.size() - 2] = '0';  // row 6: coplanar, expects a no now
  const Outcome table = run_cchip({"pairs", "-", "--engine", "exact", "--expect", "touches"}, input);
  CHECK(table.code == exit_mismatch);
  const auto rows = lines(table.out);
  REQUIRE(rows.size() == 3);
  std::istringstream names(rows[0]);
  std::istringstream values(rows[1]);
  std::vector<std::string> shown;
  for (std::string name, value; names >> name && values >> value;) shown.push_back(name.append("=").append(value));
  CHECK(shown == std::vector<std::string>{"id=4", "touches=0", "row=6", "expected=0", "hit=1"});
  CHECK(count(rows[2], "mismatches") == 1);

  const Outcome csv = run_cchip({"pairs", "-", "--engine", "exact", "--expect", "touches", "--format", "csv"}, input);
  CHECK(csv.code == exit_mismatch);
  CHECK(lines(csv.out).size() == 6);
  REQUIRE(lines(csv.err).size() == 2);
  CHECK(lines(csv.err)[0] == "cchip: -:6: expected hit 0, got 1");
}

TEST_CASE("pairs: unknown columns reach the output unchanged", "[system][pairs]") {
  const std::string note = " comma, \"quote\", line\r\nbreak, \xC3\xA4 ";
  const std::string quoted = "\" comma, \"\"quote\"\", line\r\nbreak, \xC3\xA4 \"";
  const std::string input =
      "\xEF\xBB\xBF"
      "note,first col," +
      header + ",last\r\n" + quoted + ",007," + tri_a + "," + b_through + ",\r\n";
  const Outcome csv = run_cchip({"pairs", "-", "--engine", "eigen", "--format", "csv"}, input);
  const std::vector<CsvRow> rows = parse_csv(csv.out);
  REQUIRE(rows.size() == 2);
  using Fields = std::vector<std::string>;
  CHECK(Fields(rows[0].fields.begin(), rows[0].fields.begin() + 4) == Fields{"note", "first col", "last", "hit"});
  CHECK(Fields(rows[1].fields.begin(), rows[1].fields.begin() + 4) == Fields{note, "007", "", "1"});

  const Outcome jsonl = run_cchip({"pairs", "-", "--engine", "eigen", "--format", "jsonl"}, input);
  const auto object = nlohmann::ordered_json::parse(jsonl.out);
  CHECK(object.begin().key() == "note");
  CHECK(object["note"] == note);
  CHECK(object["first col"] == "007");
  CHECK(object["hit"] == 1);
  CHECK(object["hw_hit"].is_null());
}

TEST_CASE("pairs: every JSON line is an object with the same answers as CSV", "[system][pairs]") {
  const Outcome jsonl = run_cchip({"pairs", "-", "--engine", "model", "--format", "jsonl"}, hand_made());
  const std::vector<CsvRow> rows =
      parse_csv(run_cchip({"pairs", "-", "--engine", "model", "--format", "csv"}, hand_made()).out);
  const auto objects = lines(jsonl.out);
  REQUIRE(objects.size() + 1 == rows.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto object = nlohmann::ordered_json::parse(objects[i]);
    REQUIRE(object.size() == rows[0].fields.size());
    std::size_t column = 0;
    for (const auto& [name, value] : object.items()) {
      CHECK(name == rows[0].fields[column]);
      CHECK((value.is_string() ? value.get<std::string>() : value.dump()) == rows[i + 1].fields[column]);
      ++column;
    }
  }
}

TEST_CASE("pairs: the tool answers its own output", "[system][pairs]") {
  const Outcome first = run_cchip({"pairs", "-", "--engine", "model", "--format", "csv", "--all-columns"}, hand_made());
  REQUIRE(first.code == exit_ok);
  const Outcome second = run_cchip({"pairs", "-", "--engine", "exact", "--expect", "hit"}, first.out);
  CHECK(second.code == exit_ok);
  CHECK(count(last_line(second.out), "pairs") == 5);
  CHECK(count(last_line(second.out), "hits") == 3);
}

TEST_CASE("pairs: all kinds in one file, on every engine and programme", "[system][pairs]") {
  const std::string engine = GENERATE("rtl", "model", "eigen", "exact");
  const std::string program = GENERATE("exhaustive", "directed");
  const Outcome outcome =
      run_cchip({"pairs", "-", "--engine", engine, "--program", program, "--expect", "touches"}, mixed_file());
  CAPTURE(engine, program, outcome.out, outcome.err);
  CHECK(outcome.code == exit_ok);
  CHECK(count(last_line(outcome.out), "pairs") == mixed_rows.size());
  CHECK(count(last_line(outcome.out), "mismatches") == 0);
  CHECK(count(last_line(outcome.out), "indefinite") == 0);  // whole numbers
}

TEST_CASE("pairs: A and B exchanged", "[system][pairs]") {
  std::string text = mixed_file();
  // a and b change their meaning in the header
  const auto end = text.find('\n');
  for (std::size_t i = text.find(",a0x"); i < end; ++i) {
    const bool name = text[i - 1] == ',' || text[i - 1] == '_';
    if (name && (text[i] == 'a' || text[i] == 'b')) text[i] = text[i] == 'a' ? 'b' : 'a';
  }
  const std::string engine = GENERATE("model", "rtl");
  const std::string program = GENERATE("exhaustive", "directed");
  const Outcome outcome =
      run_cchip({"pairs", "-", "--engine", engine, "--program", program, "--expect", "touches"}, text);
  CAPTURE(engine, program, outcome.out, outcome.err);
  CHECK(outcome.code == exit_ok);
  CHECK(count(last_line(outcome.out), "mismatches") == 0);
}

TEST_CASE("pairs: what the hardware says of quads", "[system][pairs]") {
  const std::string engine = GENERATE("rtl", "model");
  const std::vector<CsvRow> rows = parse_csv(
      run_cchip({"pairs", "-", "--engine", engine, "--program", "directed", "--format", "csv"}, mixed_file()).out);
  REQUIRE(rows.size() == mixed_rows.size() + 1);
  // hit, axis, beats by the columns' names
  const auto answer = [&](const std::string& note) {
    const auto column = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(rows[0].fields.begin(), rows[0].fields.end(), name) -
                                      rows[0].fields.begin());
    };
    for (const CsvRow& row : rows) {
      if (row.fields.at(0) != note) continue;
      return std::vector<std::string>{row.fields.at(column("hit")), row.fields.at(column("axis")),
                                      row.fields.at(column("beats"))};
    }
    return std::vector<std::string>{};
  };
  using Fields = std::vector<std::string>;
  CHECK(answer("triangle in the square's second half") == Fields{"1", "none", "4"});
  CHECK(answer("square above square") == Fields{"0", "normal of A", "1"});
  CHECK(answer("square and triangle beside it") == Fields{"0", "normal of B", "1"});  // sent as A
}

TEST_CASE("pairs: directed needs fewer axes for the same answers", "[system][pairs]") {
  const auto summary = [](const std::string& program) {
    return last_line(
        run_cchip({"pairs", "-", "--engine", "model", "--program", program, "--format", "csv"}, mixed_file()).err);
  };
  CHECK(count(summary("directed"), "hits") == count(summary("exhaustive"), "hits"));
  CHECK(count(summary("directed"), "beats_mean") < count(summary("exhaustive"), "beats_mean"));
  CHECK(run_cchip({"pairs", "-", "--engine", "model"}, mixed_file()).out ==
        run_cchip({"pairs", "-", "--engine", "model", "--program", "exhaustive"}, mixed_file()).out);
}

TEST_CASE("pairs: a header alone is no pair and no error", "[system][pairs]") {
  const Outcome outcome = run_cchip({"pairs", "-", "--engine", "model"}, header + "\n");
  CHECK(outcome.code == exit_ok);
  CHECK(last_line(outcome.out) == "pairs=0 hits=0 mismatches=0 indefinite=0 beats_mean=0.00 clocks=0");
}

TEST_CASE("pairs: a terminal gets a sentence, programs the line", "[system][pairs]") {
  const auto run = [](const std::string& format) {
    std::istringstream in(mixed_file());
    std::ostringstream out, err;
    run_cli({"pairs", "-", "--engine", "exact", "--format", format}, {in, out, err, false, true, false}, hardware());
    return format == "table" ? last_line(out.str()) : last_line(err.str());
  };
  CHECK_THAT(run("table"), Catch::Matchers::Matches("[0-9]+ pairs, [0-9]+ touch(es)?"));
  CHECK(run("csv").rfind("pairs=", 0) == 0);
}

TEST_CASE("pairs: more than one batch, every row once and in order", "[system][pairs]") {
  const std::size_t pairs = 10000;
  std::string input = "id," + header + "\n";
  for (std::size_t i = 0; i < pairs; ++i) {
    input += std::to_string(i) + "," + tri_a + "," + (i % 3 == 0 ? b_above : b_through) + "\n";
  }
  const std::vector<CsvRow> rows =
      parse_csv(run_cchip({"pairs", "-", "--engine", "eigen", "--format", "csv"}, input).out);
  REQUIRE(rows.size() == pairs + 1);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < pairs; ++i) {
    wrong += rows[i + 1].fields[0] != std::to_string(i) || rows[i + 1].fields[1] != (i % 3 == 0 ? "0" : "1");
  }
  CHECK(wrong == 0);
}

TEST_CASE("pairs: help, version", "[system][pairs]") {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"pairs", "--help"}, {"meshpairs", "-h"}, {"demo", "--help"}}) {
    const Outcome outcome = run_cchip(arguments);
    CHECK(outcome.code == exit_ok);
    CHECK(outcome.err.empty());
    CHECK(outcome.out.find("Usage: ") != std::string::npos);
  }
  CHECK(run_cchip({"--version"}).out == run_cchip({"version"}).out);
  CHECK(run_cchip({"version"}).out.rfind("cchip ", 0) == 0);
}
