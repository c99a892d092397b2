// SPDX-License-Identifier: Apache-2.0
/// \file
/// The subcommands of cchip_chip_campaign. Each prints its tables and a last line key=value, and returns the exit code.
#ifndef CCHIP_BENCH_CHIP_CAMPAIGN_HPP
#define CCHIP_BENCH_CHIP_CAMPAIGN_HPP

#include <cchip/collide.hpp>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/sim/axi_lines.hpp>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace cchip::testing {

using Random = std::mt19937_64;

/// Within which every query of a round has its answer.
inline constexpr std::uint64_t round_clocks = 6000000;

inline bool percent(Random& random, unsigned p) { return random() % 100 < p; }

/// Any memory that AXI allows, from an idle one to a crowded one.
sim::AxiLinesOptions any_memory(Random& random);
/// Rings so small that they are full all the time.
void make_rings_small(ChipDriverOptions& driver);
/// A driver with such rings and little memory at a high address.
ChipDriverOptions small_rings();

/// What a campaign has compared.
struct Totals {
  std::size_t queries = 0, hits = 0, differences = 0;
  std::uint64_t contacts = 0, open = 0, fallbacks = 0, clocks = 0;

  Totals& operator+=(const Totals& other);
  /// As "queries=10 hits=3 differences=0 ...".
  std::string summary() const;
};

/// Queries of two objects to a device whose answers are right and to one on trial: the same answer, with all contacts
/// the same ones, with the first any that holds.
void compare(Device& right, Device& tried, const Object& a, const Object& b, const std::vector<PosePair>& poses,
             bool all, Totals& totals);

struct PosesSettings {
  std::vector<std::string> meshes;
  std::size_t first = 100000;  ///< FIRST queries in all
  std::size_t all = 10000;     ///< ALL queries in all
  std::uint64_t seed = sim::seed_from_environment();
};

/// Poses of many meshes against the CPU device, face for face.
int run_poses(const PosesSettings& settings);

struct AdversarialSettings {
  std::size_t scenes = 1000;       ///< of all kinds in turn
  std::size_t poses = 100;         ///< of each; a tenth with all contacts
  std::size_t faces = 100000;      ///< of the largest object
  std::vector<std::string> kinds;  ///< only these; empty: all
  std::uint64_t seed = sim::seed_from_environment();
};

/// Scenes made to break rounding: dyadic grids, flush faces, slivers, units far apart, degenerate quads.
int run_adversarial(const AdversarialSettings& settings);

struct FaultSettings {
  std::size_t queries = 100000;
  std::vector<std::string> faults;  ///< only these; empty: all
  std::uint64_t stop = 1000000;     ///< clocks of the longest stop of the host
  std::uint64_t seed = sim::seed_from_environment();
  bool all_bins = false;
};

/// Queries under faults, alone and in pairs.
int run_faults(const FaultSettings& settings);

struct ResetSettings {
  std::size_t resets = 1000;
  std::uint64_t seed = sim::seed_from_environment();
  std::uint32_t slots = 0;  ///< of a chip with swaps, whose modules are exchanged meanwhile; 0: a chip without
};
/// Soft resets at any clock, each followed by right queries.
int run_resets(const ResetSettings& settings);

struct MixedSettings {
  unsigned slots = 1;
  std::size_t queries = 2000;
  std::string faults;  ///< empty: none; all, or one that --help names
  int busy = 25;       ///< percent of batches whose queries end early while swaps follow each other
  std::uint64_t seed = sim::seed_from_environment();
};

/// Batches of mixed objects through a chip with swaps against the CPU device.
int run_mixed(const MixedSettings& settings);

struct CurveSettings {
  std::vector<std::size_t> queries = {1, 10, 100, 1000, 10000};
  std::size_t rounds = 2;
  std::size_t triangle_bytes = 688008;  ///< payload, the paper's 5,504,088 bit but for three bytes
  std::size_t quad_bytes = 676248;      ///< 5,409,976 bit
  std::uint64_t seed = sim::seed_from_environment();
};

/// The paper's experiment: triangles, then quads, in turn.
int run_curve(const CurveSettings& settings);
/// Three modules in turn, on one slot and on two.
int run_three(const CurveSettings& settings);

}  // namespace cchip::testing

#endif
