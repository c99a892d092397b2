// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/program/progress.hpp>
#include <chrono>
#include <sstream>
#include <thread>

#include "pair_runner.hpp"
#include "support.hpp"

using namespace cchip;
using namespace cchip::app;
using cchip::test::answer;
using cchip::test::lines;
using cchip::test::ScriptedEngine;

namespace {

EngineAnswer definite_hit(const GridPair&) { return answer(true, true); }
EngineAnswer open_hit(const GridPair&) { return answer(true, false); }
EngineAnswer hardware_no(const GridPair&) {
  EngineAnswer hardware = answer(false, true);
  hardware.axis = {AxisClass::cross, 1, 2};
  hardware.beats = 11;
  hardware.clocks = EngineAnswer::Handshakes{5, 70};
  return hardware;
}

/// Two triangles that are `gap` apart along z.
PairJob parallel_job(std::uint64_t row, double gap) {
  PairJob job;
  job.a.v = {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d::Zero()};
  job.b.v = {Vec3d(0, 0, gap), Vec3d(1, 0, 1 + gap), Vec3d(0, 1, 1 + gap), Vec3d::Zero()};
  job.row = row;
  return job;
}

struct Bench {
  explicit Bench(ScriptedEngine::Answer answer, RunOptions options = {}, const std::vector<std::string>& names = {})
      : engine(answer),
        runner(
            engine, options, names, [](const PairJob& job) { return "f.csv:" + std::to_string(job.row); }, out, err) {}
  ScriptedEngine engine;
  std::ostringstream out;
  std::ostringstream err;
  PairRunner runner;
};

}  // namespace

TEST_CASE("pair_runner: batches bound what is kept, order stays", "[system][pair_runner]") {
  RunOptions options;
  options.format = Format::csv;
  options.batch = 4;
  Bench run(definite_hit, options, {"id"});
  for (std::uint64_t i = 1; i <= 10; ++i) {
    PairJob job = parallel_job(i, 0);
    job.passed = {std::to_string(i)};
    run.runner.add(std::move(job));
  }
  CHECK(run.engine.batches == std::vector<std::size_t>{4, 4});
  const Summary summary = run.runner.finish();
  CHECK(run.engine.batches == std::vector<std::size_t>{4, 4, 2});
  CHECK(summary.pairs == 10);
  CHECK(summary.hits == 10);
  const auto rows = lines(run.out.str());
  REQUIRE(rows.size() == 11);
  for (std::size_t i = 1; i <= 10; ++i) CHECK(rows[i] == std::to_string(i) + ",1,,,,,,,");
}

TEST_CASE("pair_runner: a definite answer stands, an open one is resolved exactly", "[system][pair_runner]") {
  Bench definite(definite_hit);
  definite.runner.add(parallel_job(2, 1e-12));  // apart, but the engine's answer counts
  CHECK(definite.runner.finish().hits == 1);
  Bench open(open_hit);
  open.runner.add(parallel_job(2, 1e-12));
  open.runner.add(parallel_job(3, 0));
  const Summary summary = open.runner.finish();
  CHECK(summary.hits == 1);
  CHECK(summary.indefinite == 2);
}

TEST_CASE("pair_runner: what the hardware did, in every format", "[system][pair_runner]") {
  RunOptions options;
  options.format = Format::csv;
  Bench csv(hardware_no, options);
  csv.runner.add(parallel_job(2, 1));
  const Summary summary = csv.runner.finish();
  CHECK(csv.out.str() ==
        "hit,hw_hit,hw_grid,hw_definite,axis,beats,clock_in,clock_out\n"
        "0,0,0,1,edge 1 of A x edge 2 of B,11,5,70\n");
  CHECK(to_line(summary) == "pairs=1 hits=0 mismatches=0 indefinite=0 beats_mean=11.00 clocks=0");

  options.format = Format::jsonl;
  Bench jsonl(hardware_no, options);
  jsonl.runner.add(parallel_job(2, 1));
  jsonl.runner.finish();
  CHECK(jsonl.out.str() ==
        "{\"hit\":0,\"hw_hit\":0,\"hw_grid\":0,\"hw_definite\":1,\"axis\":\"edge 1 of A x edge 2 of B\",\"beats\":11,"
        "\"clock_in\":5,\"clock_out\":70}\n");

  Bench table(hardware_no);
  table.runner.add(parallel_job(2, 1));
  table.runner.finish();
  CHECK(table.out.str() ==
        "hit  hw_hit  hw_grid  hw_definite  axis                       beats  clock_in  clock_out\n"
        "0    0       0        1            edge 1 of A x edge 2 of B  11     5         70\n");
}

TEST_CASE("pair_runner: columns with our names are renamed, not overwritten", "[system][pair_runner]") {
  RunOptions options;
  options.format = Format::csv;
  Bench run(definite_hit, options, {"hit", "note", "note", "input_hit"});
  run.runner.finish();
  CHECK(lines(run.out.str()).at(0) ==
        "input_input_hit,input_note,note,input_hit,hit,hw_hit,hw_grid,hw_definite,axis,beats,clock_in,clock_out");
}

TEST_CASE("pair_runner: expected answers", "[system][pair_runner]") {
  const auto add_both = [](Bench& run) {
    PairJob right = parallel_job(7, 0);
    right.expected = true;
    run.runner.add(std::move(right));
    PairJob wrong = parallel_job(8, 0);
    wrong.expected = false;
    run.runner.add(std::move(wrong));
    return run.runner.finish();
  };
  RunOptions options;
  options.compare = true;
  Bench table(definite_hit, options);
  CHECK(add_both(table).mismatches == 1);
  const auto rows = lines(table.out.str());
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].substr(0, 18) == "row  expected  hit");
  CHECK(rows[1] == "8    0         1");
  CHECK(table.err.str().empty());

  options.format = Format::csv;
  Bench csv(definite_hit, options);
  CHECK(add_both(csv).mismatches == 1);
  CHECK(lines(csv.out.str()).size() == 3);
  CHECK(csv.err.str() == "cchip: f.csv:8: expected hit 0, got 1\n");
}

TEST_CASE("pair_runner: the table shows control characters harmlessly", "[system][pair_runner]") {
  Bench run(definite_hit, {}, {"note"});
  PairJob job = parallel_job(2, 0);
  job.passed = {"two\nlines\x1b[31m"};
  run.runner.add(std::move(job));
  run.runner.finish();
  CHECK(lines(run.out.str()).at(1) == "two\\x0alines\\x1b[31m  1");
}

TEST_CASE("pair_runner: a summary for people", "[system][pair_runner]") {
  CHECK(to_sentence({}) == "0 pairs, 0 touch");
  CHECK(to_sentence({1, 1, 1, 1, 3, 1, 1}) ==
        "1 pair, 1 touches, 1 answer differs, 1 left to the host, 3.00 axes a pair, 1 clock, 1 face left out");
  CHECK(to_sentence({4, 2, 2, 0, 10, 300, 0}) == "4 pairs, 2 touch, 2 answers differ, 2.50 axes a pair, 300 clocks");
}

TEST_CASE("progress: an estimate after a second", "[system][pair_runner]") {
  std::ostringstream out;
  cchip::Progress progress(out, true);
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  progress.update_of(1, 2);
  CHECK(out.str().find("left") == std::string::npos);
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  progress.update_of(1, 2);
  CHECK(out.str().find(" 50 %  1 pair, 1 s left") != std::string::npos);
}

TEST_CASE("progress: one is singular", "[system][pair_runner]") {
  for (const double fraction : {-1.0, 0.5}) {
    for (const int number : {1, 2}) {
      std::ostringstream out;
      cchip::Progress progress(out, true);
      std::this_thread::sleep_for(std::chrono::milliseconds(150));  // the line is drawn ten times a second at most
      progress.update(static_cast<std::uint64_t>(number), fraction);
      CHECK((out.str() + ",").find(number == 1 ? "1 pair," : "2 pairs,") != std::string::npos);
    }
  }
}
