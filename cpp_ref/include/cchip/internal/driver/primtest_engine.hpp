// SPDX-License-Identifier: Apache-2.0
/// \file
/// The host's side of the primitive tests: any pairs in, the right module for each.
#ifndef CCHIP_INTERNAL_DRIVER_PRIMTEST_ENGINE_HPP
#define CCHIP_INTERNAL_DRIVER_PRIMTEST_ENGINE_HPP

#include <cchip/internal/driver/pair_engine.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace cchip {

/// A primitive test under its clock, m_result_ready = 1: the Verilated module or its model, after reset.
class PrimtestMachine {
 public:
  /// What the module shows during the present clock.
  struct Outputs {
    bool pair_ready = false;
    std::optional<PairResult> result;
    bool beat_valid = false;  ///< an axis leaves the controller
    bool pair_waits = false;  ///< a pair waits for an axis slot
  };
  virtual ~PrimtestMachine() = default;
  /// s_pair from now on; nullopt: valid = 0.
  virtual void offer(const std::optional<PairRequest>& request) = 0;
  virtual Outputs outputs() = 0;
  /// The rising edge that ends the present clock. Call outputs() first.
  virtual void clock() = 0;
};

/// Pairs for one machine, and who is told their outcome. Number n counts from 0.
struct PrimtestTraffic {
  std::size_t pairs = 0;
  /// Request n; no other pair in flight has its tag.
  std::function<PairRequest(std::size_t n)> request;
  std::function<void(std::size_t n)> accepted;
  std::function<void(std::size_t n, const PairResult& result)> answered;
  /// At the end of every clock; `offers`: a pair was on s_pair.
  std::function<void(const PrimtestMachine::Outputs& outputs, bool offers)> clock;
  /// Longest time without a pair accepted or answered, clocks.
  std::uint64_t answer_bound = 0;
};
/// An answer without a request, or a request without an answer.
struct PrimtestStreamError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// Sends the pairs back to back, a new one on every clock on which the machine is ready, until all are answered.
/// \throws PrimtestStreamError
void stream_pairs(PrimtestMachine& machine, const PrimtestTraffic& traffic);

struct PrimtestEngineOptions {
  std::string name;
  int coord_w = defs::coord_w_default;
  /// The engine gives up after this many clocks without a pair accepted or answered.
  std::uint64_t answer_bound = 0;
  /// Makes a machine when a pair needs it for the first time.
  std::function<std::unique_ptr<PrimtestMachine>(ModuleId)> make_machine;
};

/// Engine over primitive tests. A pair goes to the module of its kinds; a quad and a triangle are swapped on the way
/// in, and the witness is swapped back. Quads are made canonical, the witness names the edges of the quad as it was
/// given.
/// Each module streams its pairs in their order with valid = 1 while pairs are left, one module after the other;
/// clock_in and clock_out count the clocks of the module that answered, and go on from batch to batch.
/// run() throws std::invalid_argument for a coordinate or eta out of range, before anything is sent.
std::unique_ptr<PairEngine> make_primtest_engine(PrimtestEngineOptions options);

}  // namespace cchip

#endif
