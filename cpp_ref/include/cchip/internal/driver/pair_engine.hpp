// SPDX-License-Identifier: Apache-2.0
/// \file
/// One interface in front of everything that answers pairs: the Verilated RTL, its clock-exact
/// model, the Eigen reference and the exact oracle.
#ifndef CCHIP_INTERNAL_DRIVER_PAIR_ENGINE_HPP
#define CCHIP_INTERNAL_DRIVER_PAIR_ENGINE_HPP

#include <cchip/internal/wire/pair.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cchip {

/// Answer of an engine for one pair on the grid. Engines without an axis programme leave the witness and the beats at
/// none and 0.
struct EngineAnswer : PairResult {
  /// Numbers of clocks, counted from 0 after reset.
  struct Handshakes {
    std::uint64_t accepted = 0;
    std::uint64_t answered = 0;
  };
  /// Present for the engines with a clock, `rtl` and `model`.
  std::optional<Handshakes> clocks;
};

/// Totals since construction; all zero for engines without a clock.
struct EngineStatistics {
  std::uint64_t clocks = 0;          ///< clocks simulated after reset
  std::uint64_t beats = 0;           ///< axes that entered the SAT pipeline
  std::uint64_t waiting_clocks = 0;  ///< clocks on which at least one pair waited for an axis slot
};

/// Answers batches of pairs in order; triangles and quads in any mix. Not thread-safe.
class PairEngine {
 public:
  virtual ~PairEngine() = default;
  virtual const char* name() const = 0;
  /// Width of a coordinate in bits that this engine was built for.
  virtual int coord_w() const = 0;
  /// Answers every pair of the batch, answers in the order of the pairs. Any batch size; memory is
  /// proportional to it. Throws std::runtime_error if the engine does not answer within its bound.
  /// Engines without programmes ignore the mode.
  std::vector<EngineAnswer> run(const std::vector<GridPair>& pairs, PairMode mode) {
    return run(pairs, std::vector<PairMode>(pairs.size(), mode));
  }
  /// The same with a mode for each pair: modes.size() = pairs.size().
  virtual std::vector<EngineAnswer> run(const std::vector<GridPair>& pairs, const std::vector<PairMode>& modes) = 0;
  virtual EngineStatistics statistics() const { return {}; }
};

/// Engine over a function of one pair; every pair with eta = 0 is definite.
/// \throws std::invalid_argument coord_w is not in 4..20
std::unique_ptr<PairEngine> make_function_engine(const char* name, int coord_w,
                                                 std::function<bool(const GridPair&)> intersects);
/// exact_intersects()
std::unique_ptr<PairEngine> make_exact_engine(int coord_w);

}  // namespace cchip

#endif
