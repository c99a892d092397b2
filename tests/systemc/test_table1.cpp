// SPDX-License-Identifier: Apache-2.0
// The timed simulation behind Table 1 against closed formulas, in whole picoseconds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/program/seed.hpp>
#include <experiments.hpp>
#include <random>
#include <report.hpp>
#include <sstream>

using namespace cchip;
using sc_core::sc_time;

namespace {

using Picoseconds = std::uint64_t;
Picoseconds ps(const sc_time& time) { return time.value(); }  // the resolution is 1 ps

/// ceil(bits / width) clocks, rounded up; only for numbers that are small enough.
Picoseconds pass(std::uint64_t bits, const rc::bit_path& path) {
  const std::uint64_t clocks = (bits + path.width - 1) / path.width;
  return (clocks * 1'000'000 + path.clock / 1'000'000 - 1) / (path.clock / 1'000'000);  // whole MHz
}

/// When each pair is answered, from the equations alone.
std::vector<Picoseconds> expected_answers(const table1::Platform& platform, const table1::Job& job) {
  const rc::bitstream_timing& timing = platform.timing;
  constexpr std::size_t nothing = 99;
  std::vector<std::size_t> loaded(2, nothing);
  std::vector<Picoseconds> answers;
  const auto load_time = [&](std::size_t i) {  // and what the slot holds from now on
    const std::size_t kind = job.pairs[i].kind;
    if (platform.slots == 0) return Picoseconds{0};
    std::size_t& slot = loaded[i % platform.slots];
    const Picoseconds time = slot == kind ? 0 : pass(table1::test_kinds[kind].bitfile_bits, timing.port());
    slot = kind;
    return time;
  };
  if (job.first_loaded) load_time(0);
  Picoseconds now = 0;         // the host is free
  Picoseconds load_ready = 0;  // the next test is there
  for (std::size_t i = 0; i < job.pairs.size(); ++i) {
    const Picoseconds data = pass(job.pairs[i].data_bits, timing.bus());
    const bool loads_now = i == 0 || platform.slots < 2;
    if (loads_now) {
      const Picoseconds load = load_time(i);
      now += platform.single_bus ? data + load : std::max(data, load);
    } else if (platform.single_bus) {
      now = std::max(now, load_ready) + data;
    } else {
      now = std::max(now + data, load_ready);
    }
    if (platform.slots == 2 && i + 1 < job.pairs.size()) load_ready = now + load_time(i + 1);
    now += ps(job.pairs[i].tests);
    answers.push_back(now);
  }
  return answers;
}

}  // namespace

TEST_CASE("table1: one configuration per object pair adds eq. (4) for any amount of data", "[systemc][table1]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const auto data_bits = random() % 200'000'000;
  CAPTURE(data_bits);
  const table1::Figures figures = table1::run_experiments(data_bits);
  REQUIRE(figures.rows.size() > 2);
  const Picoseconds tri_tri = 688'011ull * 20'000, quad_quad = 676'247ull * 20'000;  // bytes at 50 MHz
  CHECK(ps(figures.rows[0].counted) == 1000 * table1::paper_static_ns);
  CHECK(ps(figures.rows[1].counted) == 1000 * table1::paper_static_ns + tri_tri + quad_quad);
  CHECK(ps(figures.rows[1].loaded) == 1000 * table1::paper_static_ns + quad_quad);
  for (const table1::Row& row : figures.rows) {
    CAPTURE(row.name);
    table1::Job job{{{0, figures.tests, data_bits}, {1, figures.tests, data_bits}}, false};
    CHECK(ps(row.counted) == expected_answers(row.platform, job).back());
    job.first_loaded = true;
    CHECK(ps(row.loaded) == expected_answers(row.platform, job).back());
    job.first_loaded = false;
    job.pairs.push_back({3, figures.tests, data_bits});  // points
    CHECK(ps(row.three) == expected_answers(row.platform, job).back());
  }
}

TEST_CASE("table1: overhead against work per swap is load / work, or what the work does not hide",
          "[systemc][table1]") {
  const table1::Figures figures = table1::run_experiments(0);
  REQUIRE(figures.points.size() > 600);
  std::vector<unsigned> hidden(3, 0), seen(3, 0);
  for (const table1::Point& point : figures.points) {
    CAPTURE(point.slots, point.port.width, point.port.clock, point.work.to_string());
    const Picoseconds work = ps(point.work);
    Picoseconds run = 0;
    for (unsigned i = 0; i < point.swaps; ++i) {
      const Picoseconds load = pass(table1::test_kinds[i % 3].bitfile_bits, point.port);
      run += point.slots == 1 ? work + load : std::max(work, load);
    }
    CHECK(ps(point.static_run) == point.swaps * work);
    CHECK(ps(point.run) == run);
    ++seen[point.slots];
    if (point.run == point.static_run) ++hidden[point.slots];
  }
  CHECK(seen[1] == seen[2]);
  CHECK(hidden[1] == 0);
  CHECK(hidden[2] > 0);
  CHECK(hidden[2] < seen[2]);
}

TEST_CASE("table1: random platforms and object pairs answer when the equations say", "[systemc][table1]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const auto below = [&random](std::uint64_t limit) { return random() % limit; };
  std::vector<table1::Series> all;
  for (int s = 0; s < 24; ++s) {
    const rc::bit_path port{8u << below(3), (1 + below(300)) * 1'000'000}, bus{32, (1 + below(300)) * 1'000'000};
    table1::Series series{{static_cast<unsigned>(s % 3), below(2) == 0, rc::bitstream_timing(port, bus)}, {}};
    for (int j = 0; j < 5; ++j) {
      table1::Job job;
      job.first_loaded = below(2) == 0;
      for (std::uint64_t i = 1 + below(8); i > 0; --i) {
        const sc_time tests = rc::from_picoseconds(below(1'000'000'000) * (1 + below(100)));
        job.pairs.push_back({below(table1::test_kinds.size()), tests, below(3) == 0 ? 0 : below(10'000'000)});
      }
      series.jobs.push_back(job);
    }
    all.push_back(series);
  }
  const auto results = table1::simulate(all);
  for (std::size_t s = 0; s < all.size(); ++s) {
    for (std::size_t j = 0; j < all[s].jobs.size(); ++j) {
      const table1::Platform& platform = all[s].platform;
      CAPTURE(s, j, platform.slots, platform.single_bus, all[s].jobs[j].first_loaded);
      std::vector<Picoseconds> answers;
      for (const sc_time& answer : results[s][j].answers) answers.push_back(ps(answer));
      CHECK(answers == expected_answers(platform, all[s].jobs[j]));
    }
  }
}

TEST_CASE("table1: the report's last line holds the table", "[systemc][table1]") {
  std::ostringstream text;
  table1::print_report(table1::run_experiments(8'388'608), text);
  // 274,948,800 + 20 * (688,011 + 676,247) ns
  CHECK_THAT(text.str(), Catch::EndsWith("\nstatic_ns=274948800 single_bus_ns=302233960 overhead_percent=9.924 "
                                         "paper_static_ns=274948800 paper_single_bus_ns=274887700\n"));
}

TEST_CASE("table1: more data than the paper's run has time for is refused", "[systemc][table1]") {
  CHECK_THROWS_WITH(table1::run_experiments(300'000'000), Catch::Contains("give fewer bits"));
}

TEST_CASE("table1: platforms and jobs that there are not are refused", "[systemc][table1]") {
  const table1::Job good{{{0, sc_core::SC_ZERO_TIME, 0}}, false};
  CHECK_THROWS_WITH(table1::simulate({{{3, true, rc::bitstream_timing()}, {good}}}), Catch::Contains("3 slots"));
  CHECK_THROWS_WITH(table1::simulate({{{1, true, rc::bitstream_timing()}, {{}}}}), Catch::Contains("0 pairs"));
  const table1::Job foreign{{{4, sc_core::SC_ZERO_TIME, 0}}, false};
  CHECK_THROWS_WITH(table1::simulate({{{1, true, rc::bitstream_timing()}, {foreign}}}),
                    Catch::Contains("kind below 4"));
}
