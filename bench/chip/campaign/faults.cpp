// SPDX-License-Identifier: Apache-2.0
// Rounds of queries under faults, and which fault was seen in which phase.
#include <fmt/format.h>

#include "fault_round.hpp"

namespace cchip::testing {

int run_faults(const FaultSettings& settings) {
  Random random(settings.seed);
  fmt::print("seed={}\n", settings.seed);
  Bench bench(sim::without_timeout(settings.seed), {}, small_rings(), 1);
  Objects objects(Kind::quad);
  objects.place(bench);
  bench.machine().write_register(regs::interrupt_status::offset, 0x1F);
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < fault_count; ++i) {
    const bool wanted = settings.faults.empty() || std::find(settings.faults.begin(), settings.faults.end(),
                                                             fault_names[i]) != settings.faults.end();
    if (wanted) faults.push_back(static_cast<Fault>(i));
  }
  FaultTotals totals;
  while (totals.queries < settings.queries) {
    std::set<Fault> now = {faults[random() % faults.size()]};
    if (random() % 2 == 0) now.insert(faults[random() % faults.size()]);
    // the longest stop is long: one of 64
    const std::uint64_t stop = random() % 64 == 0 ? settings.stop : std::min<std::uint64_t>(settings.stop, 20000);
    FaultRound(bench, objects, random, totals, now, stop).run();
    ++totals.rounds;
  }
  std::size_t bins = 0;
  fmt::print("{:<14}", "fault");
  for (const char* phase : phase_names) fmt::print(" {:>8} first {:>8} all", phase, phase);
  fmt::print("\n");
  for (const Fault fault : faults) {
    const auto& row = totals.bins[static_cast<std::size_t>(fault)];
    fmt::print("{:<14}", fault_names[static_cast<std::size_t>(fault)]);
    for (const auto& phase : row) {
      fmt::print(" {:>14} {:>12}", phase[0], phase[1]);
      bins += (phase[0] > 0 ? 1U : 0U) + (phase[1] > 0 ? 1U : 0U);
    }
    fmt::print("\n");
  }
  fmt::print("codes:");
  for (std::size_t i = 0; i < totals.codes.size(); ++i) fmt::print(" {}={}", i, totals.codes[i]);
  const std::size_t all_bins = faults.size() * phase_count * 2;
  fmt::print(
      "\nqueries={} rounds={} wrong={} hangs={} lost={} unreported={} resets={} bus_resets={} damaged_images={} "
      "bins={}/{}\n",
      totals.queries, totals.rounds, totals.wrong, totals.hangs, totals.lost, totals.unreported, totals.resets,
      totals.bus_resets, totals.damaged, bins, all_bins);
  const bool clean = totals.wrong == 0 && totals.hangs == 0 && totals.lost == 0 && totals.unreported == 0;
  return clean && (!settings.all_bins || bins == all_bins) ? 0 : 3;
}

}  // namespace cchip::testing
