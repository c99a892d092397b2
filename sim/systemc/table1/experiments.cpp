// SPDX-License-Identifier: Apache-2.0
#include "experiments.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace cchip::table1 {
namespace {

using sc_core::sc_time;

/// Work per swap: 0.1 ms to 10 s, 20 values per decade of three digits.
std::vector<sc_time> sweep() {
  constexpr int per_decade = 20, decades = 5;
  std::vector<sc_time> works;
  std::uint64_t decade_ps = 1'000'000;  // of a hundredth of 0.1 ms
  for (int i = 0; i <= per_decade * decades; ++i) {
    const int step = i % per_decade;
    if (i > 0 && step == 0) decade_ps *= 10;
    const auto digits = static_cast<std::uint64_t>(std::lround(100 * std::pow(10.0, double(step) / per_decade)));
    works.push_back(rc::from_picoseconds(digits * decade_ps));
  }
  return works;
}

std::vector<Row> rows() {
  const rc::bitstream_timing paper;
  std::vector<Row> list = {{"Two static primitive tests", {0, true, paper}, {}, {}, {}},
                           {"Reconfiguration using a single bus", {1, true, paper}, {}, {}, {}},
                           {"  configuration path of its own", {1, false, paper}, {}, {}, {}},
                           {"  two slots, single bus", {2, true, paper}, {}, {}, {}},
                           {"  two slots, configuration path of its own", {2, false, paper}, {}, {}, {}}};
  for (const rc::bit_path& port : {ports[1], ports[2]}) {
    list.push_back({fmt::format("  single bus, port {} bit at {} MHz", port.width, port.clock / 1'000'000),
                    {1, true, rc::bitstream_timing(port)},
                    {},
                    {},
                    {}});
  }
  return list;
}

/// A pair whose test is loaded already, then a swap for each pair.
constexpr unsigned sweep_swaps = 6;
constexpr unsigned sweep_kinds = 3;  // triangles, quads, both
constexpr std::size_t points = 3;    // in test_kinds

Job sweep_job(const sc_time& work) {
  Job job;
  for (unsigned i = 0; i <= sweep_swaps; ++i) job.pairs.push_back({i % sweep_kinds, work, 0});
  job.first_loaded = true;
  return job;
}

/// From the first answer on: as many swaps as pairs.
sc_time steady(const JobResult& result) { return result.answers.back() - result.answers.front(); }

/// Name of the row or curve in an error message.
void expect_loads(const JobResult& result, unsigned loads, const std::string& what) {
  if (result.loads != loads) {
    throw std::runtime_error(fmt::format("{}: {} loads instead of {}", what, result.loads, loads));
  }
}

}  // namespace

Figures run_experiments(std::uint64_t data_bits) {
  Figures figures{data_bits, rc::bitstream_timing().transmission(data_bits), {}, rows(), {}};
  const sc_time share = rc::from_picoseconds(1000 * paper_static_ns / 2);  // of an object pair
  if (figures.transmission >= share) {
    throw std::invalid_argument(
        fmt::format("{} bits take {} on the bus, but an object pair of the paper's static run takes only {}; "
                    "give fewer bits",
                    data_bits, figures.transmission.to_string(), share.to_string()));
  }
  figures.tests = share - figures.transmission;

  const std::vector<ObjectPair> pairs = {{0, figures.tests, data_bits}, {1, figures.tests, data_bits}};
  std::vector<ObjectPair> three = pairs;
  three.push_back({points, figures.tests, data_bits});
  std::vector<Series> series;
  for (const Row& row : figures.rows) {
    series.push_back({row.platform, {{pairs, false}, {pairs, true}, {three, false}}});
  }
  Series static_sweep{{0, true, rc::bitstream_timing()}, {}};
  for (const sc_time& work : sweep()) static_sweep.jobs.push_back(sweep_job(work));
  series.push_back(static_sweep);
  for (unsigned slots : {1u, 2u}) {
    for (const rc::bit_path& port : ports) {
      series.push_back({{slots, true, rc::bitstream_timing(port)}, static_sweep.jobs});
    }
  }

  const auto results = simulate(series);
  for (std::size_t r = 0; r < figures.rows.size(); ++r) {
    Row& row = figures.rows[r];
    const unsigned loads = row.platform.slots == 0 ? 0 : 2;
    expect_loads(results[r][0], loads, row.name);
    expect_loads(results[r][1], loads == 0 ? 0 : loads - 1, row.name);
    row.counted = results[r][0].answers.back();
    row.loaded = results[r][1].answers.back();
    expect_loads(results[r][2], loads == 0 ? 0 : loads + 1, row.name);
    row.three = results[r][2].answers.back();
  }
  const std::size_t first = figures.rows.size();
  for (std::size_t s = first + 1; s < series.size(); ++s) {
    const Platform& platform = series[s].platform;
    for (std::size_t j = 0; j < static_sweep.jobs.size(); ++j) {
      expect_loads(results[s][j], sweep_swaps, "work per swap");
      figures.points.push_back({platform.slots, platform.timing.port(), static_sweep.jobs[j].pairs[0].tests,
                                sweep_swaps, steady(results[first][j]), steady(results[s][j])});
    }
  }
  return figures;
}

double percent_longer(const sc_time& run, const sc_time& reference) {
  return 100 * (run.to_seconds() - reference.to_seconds()) / reference.to_seconds();
}

}  // namespace cchip::table1
