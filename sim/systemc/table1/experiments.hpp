// SPDX-License-Identifier: Apache-2.0
/// Table 1 of the paper, variants of it, and overhead against work per swap: what is simulated and the results.
#ifndef CCHIP_TABLE1_EXPERIMENTS_HPP
#define CCHIP_TABLE1_EXPERIMENTS_HPP

#include <string>

#include "system.hpp"

namespace cchip::table1 {

/// Run times that the paper prints, ns.
inline constexpr std::uint64_t paper_static_ns = 274'948'800;
inline constexpr std::uint64_t paper_single_bus_ns = 274'887'700;

/// Ports of today, beside the paper's: the internal port of newer devices at its usual and at twice that clock.
inline constexpr std::array<rc::bit_path, 3> ports = {{rc::virtex2_port, {32, 100'000'000}, {32, 200'000'000}}};

/// One line of the table: two triangle objects, then two quad objects.
struct Row {
  std::string name;
  Platform platform;
  sc_core::sc_time counted;  ///< run time with the first configuration
  sc_core::sc_time loaded;   ///< run time without it: the triangle test is loaded from the beginning
  sc_core::sc_time three;    ///< as counted, with a third object pair: points against triangles
};

/// One point of the curves: object pairs of three kinds in turn, a swap each; data are not transmitted.
struct Point {
  unsigned slots;
  rc::bit_path port;
  sc_core::sc_time work;        ///< per swap
  unsigned swaps;               ///< in the time below
  sc_core::sc_time static_run;  ///< of as many object pairs
  sc_core::sc_time run;
};

struct Figures {
  std::uint64_t data_bits;        ///< per object pair
  sc_core::sc_time transmission;  ///< of these
  sc_core::sc_time tests;         ///< work per object pair, so that the static run takes the paper's time
  std::vector<Row> rows;          ///< the first is the static one, the second the paper's single bus
  std::vector<Point> points;      ///< by slots, port, work
};

/// Simulates everything, once per process. `data_bits`: sent to the tests for each object pair, an assumption.
/// Error: transmission alone would take longer than the paper's static run.
Figures run_experiments(std::uint64_t data_bits);

/// By how much `run` is longer than `reference`, percent.
double percent_longer(const sc_core::sc_time& run, const sc_core::sc_time& reference);

}  // namespace cchip::table1

#endif  // CCHIP_TABLE1_EXPERIMENTS_HPP
