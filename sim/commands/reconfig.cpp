// SPDX-License-Identifier: Apache-2.0
#include "reconfig.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cchip/driver/reconfig_driver.hpp>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/grid/local_grid.hpp>
#include <cchip/machines/simulated_subsystem.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/usage_error.hpp>
#include <chrono>
#include <filesystem>
#include <random>

#include "candidates.hpp"
#include "demo.hpp"
#include "pair_runner.hpp"

namespace cchip::app {
namespace {

constexpr std::array<const char*, 4> kind_names = {"", "tri-tri", "tri-quad", "quad-quad"};
constexpr std::array<const char*, 9> phase_names = {"header", "shut down", "decouple", "reset", "transfer",
                                                    "check",  "ROC",       "recouple", "report"};

/// Candidate pairs of the demo's meshes by module, at most `limit` of each.
std::array<std::vector<PairRequest>, 4> mesh_pairs(std::uint64_t limit, PairMode mode) {
  std::array<std::vector<PairRequest>, 4> pairs;
  std::vector<DemoRun> runs = make_demo_runs();
  std::stable_partition(runs.begin(), runs.end(), [](const DemoRun& run) { return run.pose == "deep"; });  // hits first
  for (const DemoRun& run : runs) {
    if (run.mode != mode) continue;
    for_each_candidate(run.a, run.b, limit, [&](const PairJob& job) {
      GridPair pair = quantise(job.a, job.b, defs::coord_w_default).pair;
      if (pair.a.kind == Kind::quad && pair.b.kind == Kind::tri) std::swap(pair.a, pair.b);
      pair.a = canonical_quad(pair.a);
      pair.b = canonical_quad(pair.b);
      auto& of_kind = pairs[static_cast<std::size_t>(module_of(pair))];
      if (of_kind.size() < limit) of_kind.push_back({pair, 0, mode});
    });
  }
  return pairs;
}

/// All pairs in bursts of one kind, as a traversal of mixed meshes would send them.
std::vector<PairRequest> mixed(std::array<std::vector<PairRequest>, 4> of_kind, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<PairRequest> all;
  const auto some_left = [&] {
    return std::any_of(of_kind.begin(), of_kind.end(), [](const auto& pairs) { return !pairs.empty(); });
  };
  while (some_left()) {
    auto& pairs = of_kind[1 + random() % 3];
    for (std::uint64_t burst = 1 + random() % 16; burst > 0 && !pairs.empty(); --burst) {
      all.push_back(pairs.back());
      pairs.pop_back();
    }
  }
  return all;
}

struct Counts {
  std::array<std::uint64_t, 4> pairs{}, hits{};
  std::uint64_t mismatches = 0, lost = 0, duplicated = 0;
};

/// Compares the answers with the exact oracle: on the grid, from the right module, tested, once.
Counts judge(const std::vector<PairRequest>& pairs, const ReconfigResult& result) {
  Counts c;
  c.duplicated = result.foreign_answers;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const ReconfigAnswer& answer = result.answers[i];
    const PairResult& r = answer.result.beat;
    const auto kind = static_cast<std::size_t>(module_of(pairs[i].pair));
    const bool exact = exact_intersects(pairs[i].pair);
    ++c.pairs[kind];
    c.hits[kind] += exact ? 1 : 0;
    c.lost += answer.answers == 0 ? 1 : 0;
    c.duplicated += answer.answers > 1 ? answer.answers - 1 : 0;
    const bool right = r.axis.cls != AxisClass::illegal && r.grid == exact && (r.hit || !exact) &&
                       static_cast<std::size_t>(answer.result.kind) == kind;
    c.mismatches += answer.answers > 0 && !right ? 1 : 0;
  }
  return c;
}

void print_phases(std::ostream& out, const ReconfigResult& result, std::uint64_t equation_4) {
  fmt::print(out, "{:<12}{:>12}{:>12}{:>12}  clocks of all swaps that ended well\n", "phase", "least", "mean", "most");
  for (std::size_t p = 0; p < phase_names.size(); ++p) {
    std::uint64_t least = ~std::uint64_t{0}, most = 0, sum = 0, count = 0;
    for (const ReconfigSwap& swap : result.swaps) {
      if (swap.code != SwapCode::ok) continue;
      least = std::min<std::uint64_t>(least, swap.phases[p]);
      most = std::max<std::uint64_t>(most, swap.phases[p]);
      sum += swap.phases[p];
      ++count;
    }
    if (count == 0) continue;
    fmt::print(out, "{:<12}{:>12}{:>12.1f}{:>12}{}\n", phase_names[p], least,
               static_cast<double>(sum) / static_cast<double>(count), most,
               static_cast<SwapPhase>(p + 1) == SwapPhase::transfer ? fmt::format("  eq. (4): {}", equation_4)
                                                                    : std::string());
  }
}

/// The waveform's path, after making its folder.
std::string prepare_wave(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw UsageError(
        fmt::format("{}: the folder cannot be made ({}); give another with --waves", folder, error.message()));
  }
  return (std::filesystem::path(folder) / "sim-reconfig.fst").string();
}

}  // namespace

int run_reconfig_job(const ReconfigJobOptions& options, std::ostream& out) {
  ReconfigOptions reconfig;
  reconfig.payload_bytes = static_cast<std::size_t>((options.bitstream_bits + 7) / 8);
  const std::uint64_t equation_4 =
      transfer_clocks(reconfig.payload_bytes, SimulatedSubsystem::port_w, SimulatedSubsystem::clocks_per_word);
  reconfig.seed = static_cast<std::uint32_t>(options.seed);
  reconfig.batch = static_cast<std::size_t>(std::max<std::uint64_t>(options.pairs / 5, 1));
  reconfig.patience = 20 * (equation_4 + 20000);
  SimulatedSubsystemOptions machine_options;
  machine_options.seed = options.seed;
  machine_options.trace_path = prepare_wave(options.wave_folder);
  const std::vector<PairRequest> pairs = mixed(mesh_pairs(options.pairs, options.mode), options.seed);
  fmt::print(
      out,
      "Pairs of triangles and quads, sorted by kind into batches, through two slots: one tests a batch while the\n"
      "other is given the module of the next. Every swap passes its bitstream of {} bits through the 8-bit "
      "configuration port, two clocks per byte (100 MHz and 50 MHz).\n\n",
      8 * reconfig.payload_bytes);
  out.flush();
  const auto start = std::chrono::steady_clock::now();
  Progress progress;
  reconfig.progress = [&](std::uint64_t answered) { progress.update_of(answered, pairs.size()); };
  SimulatedSubsystem machine(machine_options);
  const ReconfigResult result = run_reconfig(machine, pairs, reconfig);
  progress.clear();
  machine.write_layout();
  const SubsystemObservations& seen = machine.observations();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Counts c = judge(pairs, result);
  fmt::print(out, "{:<12}{:>12}{:>12}\n", "kind", "pairs", "hits");
  for (std::size_t kind = 1; kind < 4; ++kind) {
    fmt::print(out, "{:<12}{:>12}{:>12}\n", kind_names[kind], c.pairs[kind], c.hits[kind]);
  }
  out << '\n';
  print_phases(out, result, equation_4);
  const auto swaps = static_cast<std::uint64_t>(std::count_if(
      result.swaps.begin(), result.swaps.end(), [](const ReconfigSwap& swap) { return swap.code == SwapCode::ok; }));
  const double hidden = seen.transfer_clocks == 0 ? 0
                                                  : 100.0 * static_cast<double>(seen.hidden_clocks) /
                                                        static_cast<double>(seen.transfer_clocks);
  fmt::print(out,
             "\nhidden: {} of {} transfer clocks with pairs at work in the other slot.\n"
             "Simulated {} clocks in {:.2f} s.\n"
             "Look at the first swap, signals grouped by block:\n  gtkwave {} {}\n",
             seen.hidden_clocks, seen.transfer_clocks, seen.clocks, seconds, machine_options.trace_path,
             std::filesystem::path(machine_options.trace_path).replace_extension(".gtkw").string());
  fmt::print(out, "pairs={} swaps={} mismatches={} lost={} duplicated={} hidden_percent={:.1f}\n", pairs.size(), swaps,
             c.mismatches, c.lost, c.duplicated, hidden);
  return c.mismatches + c.lost + c.duplicated > 0 ? exit_mismatch : exit_ok;
}

}  // namespace cchip::app
