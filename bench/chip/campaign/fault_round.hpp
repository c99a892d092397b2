// SPDX-License-Identifier: Apache-2.0
/// \file
/// Faults around the chip: memory, host, descriptors, images, limits, resets; and one batch of queries under them.
#ifndef CCHIP_BENCH_CHIP_FAULT_ROUND_HPP
#define CCHIP_BENCH_CHIP_FAULT_ROUND_HPP

#include <Vcchip_chip.h>

#include <array>
#include <map>
#include <set>

#include "campaign.hpp"
#include "chip_objects.hpp"
#include "port_bench.hpp"

namespace cchip::testing {

using Bench = PortBench<Vcchip_chip, 128>;
namespace regs = chip_registers;

enum class Fault : std::uint8_t {
  read_error,     ///< some lines of images are answered with an error
  read_silence,   ///< some are never answered
  read_late,      ///< all of them so late that the chip gives up
  query_error,    ///< a line of the ring of queries is answered with an error
  query_silence,  ///< or never
  write_error,    ///< a record is not written
  write_silence,  ///< or never answered
  full_ring,      ///< the host reads no record for long
  slow_consumer,  ///< the host stops again and again
  descriptor,     ///< a field of queries is another
  garbage,        ///< lines of images are others
  open_limit,     ///< the register
  step_limit,     ///< the register
  soft_reset,     ///< at any clock
};
inline constexpr std::size_t fault_count = 14;
inline constexpr const char* fault_names[fault_count] = {
    "read_error", "read_silence",  "read_late",  "query_error", "query_silence", "write_error", "write_silence",
    "full_ring",  "slow_consumer", "descriptor", "garbage",     "open_limit",    "step_limit",  "soft_reset"};
/// When a fault begins: before the first query, when some queries are answered, when all are given to the chip.
inline constexpr std::size_t phase_count = 3;
inline constexpr const char* phase_names[phase_count] = {"begin", "traffic", "end"};

struct FaultTotals {
  std::size_t queries = 0, rounds = 0, wrong = 0, hangs = 0, lost = 0, unreported = 0, resets = 0, bus_resets = 0;
  /// Answers on damaged images that are not the model's: boxes that no driver makes go beyond the formats of the box
  /// test, where the model is not exact. The chip must end such queries, not more.
  std::size_t damaged = 0;
  std::array<std::size_t, 8> codes{};
  std::array<std::array<std::array<std::size_t, 2>, phase_count>, fault_count> bins{};
};

/// One batch of queries under one or two faults, then some right ones.
class FaultRound {
 public:
  static constexpr std::size_t batch = 24;
  static constexpr std::uint32_t slow_limit = 4000;  // of memory, clocks

  FaultRound(Bench& bench, Objects& objects, Random& random, FaultTotals& totals, std::set<Fault> faults,
             std::uint64_t stop_clocks)
      : bench_(bench),
        objects_(objects),
        random_(random),
        totals_(totals),
        stop_clocks_(stop_clocks),
        all_(random() % 2 != 0) {
    for (const Fault fault : faults) pending_.push_back({fault, static_cast<std::size_t>(random() % phase_count)});
    clean_a_ = objects_.a;
    clean_b_ = objects_.b;
  }

  void run();

 private:
  struct Pending {
    Fault fault;
    std::size_t phase;
  };
  /// What may become of a query.
  struct Expectation {
    Query query;                ///< as the chip reads it
    bool ends = false;          ///< with an error code, whichever of `codes`
    std::set<QueryCode> codes;  ///< allowed besides a right answer
  };

  void set(std::uint32_t offset, std::uint32_t value) { bench_.machine().write_register(offset, value); }

  void add(std::size_t count);

  bool active(Fault fault) const { return active_.count(fault) != 0; }
  void hit(Fault fault) { ++totals_.bins[static_cast<std::size_t>(fault)][phase_of_[fault]][all_ ? 1 : 0]; }

  void begin_faults();

  void begin(Fault fault);

  /// What the host does beside its rings.
  void act();

  void spoil_images();

  /// Changes one field of a descriptor in the ring.
  void maybe_corrupt(std::size_t number, Line& line);

  /// The answer of the model for what the chip reads.
  std::string compare(const Expectation& e, const Query& sent, const ChipAnswer& answer, bool clean) const;

  bool ever(Fault fault) const { return phase_of_.count(fault) != 0; }

  void judge(bool stopped, bool late);

  std::size_t& seen_wrong() {
    static std::size_t seen = 0;
    return seen;
  }

  void report(const std::string& what) const;

  /// Everything as it was, and right queries.
  void restore(bool stopped);

  void check_after();

  Bench& bench_;
  Objects& objects_;
  Random& random_;
  FaultTotals& totals_;
  std::uint64_t stop_clocks_;
  bool all_;
  std::vector<Pending> pending_;
  std::set<Fault> active_;
  std::map<Fault, std::size_t> phase_of_;
  std::vector<Expectation> expected_;
  std::size_t from_ = 0, spoiled_from_ = 0;
  bvh::Image clean_a_, clean_b_;
  bool garbage_ = false, ring_hit_ = false, write_hit_ = false, late_hit_ = false, lost_response_ = false,
       reset_ = false;
  std::size_t silent_ = 0, late_ = 0, stops_ = 0, corrupt_ = 0;
  std::uint64_t stop_for_ = 0, reset_in_ = 0;
  std::uint32_t open_limit_ = 16;
};

}  // namespace cchip::testing

#endif
