// SPDX-License-Identifier: Apache-2.0
// cchip_rc_bench: what the library cchip::rc costs.
#include <fmt/format.h>

#include <ctime>
#include <systemc>
#include <vector>

#include "program.hpp"
#include "rigs.hpp"

namespace cchip::bench {
namespace {

/// Of one transfer.
struct Measure {
  double ns = 0;         ///< processor time
  double to_answer = 0;  ///< deltas until its answer is there
  double in_all = 0;     ///< deltas until nothing happens any more
};

Measure measure(Rig& rig, std::uint64_t count, const sc_core::sc_time& pause = sc_core::SC_ZERO_TIME) {
  rig.begin(count, pause);
  const auto deltas = sc_core::sc_delta_count();
  const std::clock_t start = std::clock();
  sc_core::sc_start();
  const double ns = 1e9 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const auto n = static_cast<double>(count);
  return {ns / n, static_cast<double>(rig.deltas_to_answers()) / n,
          static_cast<double>(sc_core::sc_delta_count() - deltas) / n};
}

/// The same rig bound directly and through portals, in turn.
class Comparison {
 public:
  Comparison(std::string name, Rig& direct, Rig& portals)
      : name_(std::move(name)), direct_(direct), portals_(portals) {}

  void run(std::uint64_t transfers, unsigned rounds) {
    measure(direct_, transfers / 10 + 1);  // warm caches
    measure(portals_, transfers / 10 + 1);
    std::vector<double> ratios, direct_ns, portal_ns;
    Measure direct, portals;
    for (unsigned round = 0; round < rounds; ++round) {
      direct = measure(direct_, transfers);
      portals = measure(portals_, transfers);
      direct_ns.push_back(direct.ns);
      portal_ns.push_back(portals.ns);
      ratios.push_back(portals.ns / direct.ns);
    }
    ratio = median(ratios);
    added_to_answer = portals.to_answer - direct.to_answer;
    const sc_core::sc_time pause(1, sc_core::SC_NS);
    added_in_all = measure(portals_, transfers, pause).in_all - measure(direct_, transfers, pause).in_all;
    fmt::print("{:<30}{:>10.0f}{:>10.0f}{:>8.2f}{:>16.3f}{:>10.3f}{:>22.3f}\n", name_, median(direct_ns),
               median(portal_ns), ratio, direct.to_answer, added_to_answer, added_in_all);
  }
  std::uint64_t faults() const { return direct_.faults() + portals_.faults(); }

  double ratio = 0;
  double added_to_answer = 0;
  double added_in_all = 0;

 private:
  std::string name_;
  Rig& direct_;
  Rig& portals_;
};

/// Exchanges per second.
double exchanges(const char* ports, Rig& rig, std::uint64_t swaps, unsigned rounds) {
  std::vector<double> times;
  Measure one;
  for (unsigned round = 0; round < rounds; ++round) {
    one = measure(rig, swaps);
    times.push_back(one.ns);
  }
  const double per_second = 1e9 / median(times);
  fmt::print("{:<30}{:>10.0f}{:>16.3f}\n", ports, per_second, one.to_answer);
  return per_second;
}

int run(std::uint64_t transfers, std::uint64_t swaps, unsigned rounds) {
  SignalRig<Direct> signal_direct("signal_direct");
  SignalRig<ThroughPortals> signal_portals("signal_portals");
  ClockedRig<Direct> clocked_direct("clocked_direct");
  ClockedRig<ThroughPortals> clocked_portals("clocked_portals");
  FifoRig<Direct> fifo_direct("fifo_direct");
  FifoRig<ThroughPortals> fifo_portals("fifo_portals");
  FifoSwapRig fifo_swap("fifo_swap");
  WideSwapRig wide_swap("wide_swap");
  Comparison signal("signal: value and answer", signal_direct, signal_portals);
  Comparison clocked("signals and clock: a period", clocked_direct, clocked_portals);
  Comparison fifo("FIFO: item and answer", fifo_direct, fifo_portals);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);

  fmt::print("The same module bound directly and through portals, {} transfers each, median of {} runs in turn\n\n",
             transfers, rounds);
  fmt::print("{:<30}{:>20}{:>8}{:>26}{:>22}\n", "", "processor time [ns]", "", "deltas to the answer",
             "deltas in all,");
  fmt::print("{:<30}{:>10}{:>10}{:>8}{:>16}{:>10}{:>22}\n", "transfer", "direct", "portals", "ratio", "direct", "added",
             "1 ns apart: added");
  for (Comparison* comparison : {&signal, &clocked, &fifo}) comparison->run(transfers, rounds);

  fmt::print("\nExchange without delays: unload one module, load and activate the other, one transfer\n\n");
  fmt::print("{:<30}{:>10}{:>16}\n", "ports", "per second", "deltas each");
  const double fifo_swaps = exchanges("2, FIFO", fifo_swap, swaps, rounds);
  const double wide_swaps = exchanges("32, signal", wide_swap, swaps, rounds);
  const std::uint64_t faults =
      signal.faults() + clocked.faults() + fifo.faults() + fifo_swap.faults() + wide_swap.faults();
  fmt::print(
      "\nfaults={} signal_added_deltas={:.3f} clocked_added_deltas={:.3f} fifo_added_deltas={:.3f} signal_ratio={:.2f} "
      "clocked_ratio={:.2f} fifo_ratio={:.2f} fifo_swaps_per_second={:.0f} signal_swaps_per_second={:.0f}\n",
      faults, signal.added_to_answer, clocked.added_to_answer, fifo.added_to_answer, signal.ratio, clocked.ratio,
      fifo.ratio, fifo_swaps, wide_swaps);
  return faults == 0 ? 0 : 3;
}

}  // namespace
}  // namespace cchip::bench

int sc_main(int argc, char** argv) {
  CLI::App app("Cost of reconfigurable modules in SystemC: portals against direct binding, exchanges per second.",
               "cchip_rc_bench");
  std::uint64_t transfers = 200'000, swaps = 20'000;
  unsigned rounds = 9;
  app.add_option("--transfers", transfers, "of each run")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--swaps", swaps, "of each run")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--rounds", rounds, "runs of each kind")->capture_default_str()->check(CLI::PositiveNumber);
  app.footer("Exit codes: 0 done, 1 the simulation failed, 2 bad arguments, 3 a wrong answer");
  return cchip::bench::run_program(app, argc, argv, [&] { return cchip::bench::run(transfers, swaps, rounds); });
}
