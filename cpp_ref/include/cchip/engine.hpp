// SPDX-License-Identifier: Apache-2.0
/// \file
/// One interface in front of everything that answers pairs: the Verilated RTL, its clock-exact
/// model, the Eigen reference and the exact oracle.
#ifndef CCHIP_ENGINE_HPP
#define CCHIP_ENGINE_HPP

#include <cchip/defs.hpp>
#include <cchip/geometry.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cchip {

/// Witness of a "no": `m_result_axis`, {class, k, l} of the separating axis.
struct AxisCode {
  AxisClass cls = AxisClass::none;
  std::uint8_t k = 0;
  std::uint8_t l = 0;
  friend bool operator==(const AxisCode& x, const AxisCode& y) { return x.cls == y.cls && x.k == y.k && x.l == y.l; }
};

/// The witness in words: "none", "normal of A", "normal of face 2 of B" (a warped quad's face without vertex 2),
/// "edge 0 of A x edge 2 of B", "diagonal V0V2 of A x edge 1 of B", "edge 1 of A x direction z" (an axis in A's
/// plane), "box x", ...
std::string to_words(const AxisCode& axis);

/// What the hardware (or its model) said about one pair; the fields of stream `m_result`.
struct HardwareAnswer {
  bool hit = false;
  bool grid = false;
  bool definite = false;
  AxisCode axis;
  int beats = 0;
  /// Number of the clock on which the pair was accepted / its result was accepted, counted from 0
  /// after reset.
  std::uint64_t clock_in = 0;
  std::uint64_t clock_out = 0;
};

/// Answer of an engine for one pair on the grid.
struct EngineAnswer {
  /// The engine's answer for the grid coordinates: 1 = the closed primitives share a point.
  bool grid = false;
  /// True if `grid` also is the proven answer for the unrounded primitives.
  bool definite = false;
  /// Present for the engines `rtl` and `model`.
  std::optional<HardwareAnswer> hardware;
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

std::unique_ptr<PairEngine> make_eigen_engine(int coord_w);
std::unique_ptr<PairEngine> make_exact_engine(int coord_w);
std::unique_ptr<PairEngine> make_model_engine(int coord_w);

}  // namespace cchip

#endif
