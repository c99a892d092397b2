// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pairs of three kinds through the Verilated cchip_primtest_subsystem: two slots, real swaps.
#ifndef CCHIP_RTL_RECONFIG_RUN_HPP
#define CCHIP_RTL_RECONFIG_RUN_HPP

#include <array>
#include <cchip/device/pair_engine.hpp>
#include <cchip/geometry/primitive.hpp>
#include <cchip/wire/definitions.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace cchip {

struct ReconfigOptions {
  /// Payload of each bitstream, bytes, >= defs::bitstream_payload_min.
  std::size_t payload_bytes = 2048;
  /// Registers of the scheduler: pairs, clocks; an age of 0: half a transfer.
  std::uint32_t minimum_batch = 64;
  std::uint32_t maximum_age = 0;
  /// Seed of what the RTL leaves undefined at power-up and of the bitstreams.
  std::uint64_t seed = 1;
  /// FST file with its layout beside it, none if empty: from reset to the end of the first swap, at most
  /// trace_clocks.
  std::string trace_path;
  std::uint64_t trace_clocks = 30000;
};

/// A pair as the stream takes it: triangle before quad, quads canonical.
struct ReconfigPair {
  GridPair pair;
  PairMode mode = PairMode::exhaustive;
};

/// Module that tests the pair.
ModuleId module_of(const GridPair& pair);

struct ReconfigAnswer {
  bool hit = false;
  bool grid = false;
  bool definite = false;
  bool tested = false;   ///< false: the subsystem had no module for it
  unsigned answers = 0;  ///< times that the tag came back
  ModuleId module_id = ModuleId::blank;
};

/// One swap, clocks.
struct ReconfigSwap {
  int slot = 0;
  ModuleId module_id = ModuleId::blank;
  SwapCode code = SwapCode::ok;
  std::uint64_t start = 0;                ///< first clock after reset with a phase
  std::array<std::uint64_t, 9> phases{};  ///< index: SwapPhase - 1
};

struct ReconfigResult {
  std::vector<ReconfigAnswer> answers;  ///< in the order of the pairs
  std::vector<ReconfigSwap> swaps;
  std::uint64_t clocks = 0;
  std::uint64_t foreign_answers = 0;  ///< tags that nobody sent
  std::uint64_t transfer_clocks = 0;  ///< clocks of phase TRANSFER
  std::uint64_t hidden_clocks = 0;    ///< of them, with pairs inside the other slot
  std::uint64_t equation_4 = 0;       ///< clocks of one transfer by eq. (4): bytes times clocks per byte of the port
};

/// Sends the pairs in their order and returns when all are answered. Slot 0 begins with tri-tri, slot 1 with quad-quad.
/// \throws std::invalid_argument a coordinate does not fit, the payload is too short
/// \throws std::runtime_error no answer in time, or an assertion of the RTL fails
ReconfigResult run_reconfig(const std::vector<ReconfigPair>& pairs, const ReconfigOptions& options);

}  // namespace cchip

#endif
