// SPDX-License-Identifier: Apache-2.0
/// \file
/// Driver of cchip_primtest_subsystem: pairs of three kinds through slots whose modules are exchanged at run time.
#ifndef CCHIP_DRIVER_RECONFIG_DRIVER_HPP
#define CCHIP_DRIVER_RECONFIG_DRIVER_HPP

#include <array>
#include <cchip/driver/machine.hpp>
#include <cchip/internal/wire/bitstream.hpp>
#include <cstdint>
#include <functional>
#include <vector>

namespace cchip {

struct ReconfigOptions {
  /// The bitstream that makes `module_id` of slot `slot`: header and payload, as make_bitstream() joins them. Without
  /// it, virtual ones for the simulated device.
  std::function<Bytes(std::uint8_t slot, ModuleId module_id)> bitstream;
  /// Payload of each virtual bitstream, bytes, >= defs::bitstream_payload_min.
  std::size_t payload_bytes = 2048;
  /// 0: pairs are sent in their order and the machine's scheduler exchanges modules. Else they are sorted by kind into
  /// batches of this many pairs, and the driver loads the module of the next batch into one slot while the other works.
  std::size_t batch = 0;
  /// Registers of the scheduler: pairs, clocks.
  std::uint32_t minimum_batch = 64;
  std::uint32_t maximum_age = 1024;
  /// Seed of the virtual bitstreams' payloads.
  std::uint32_t seed = 1;
  /// The driver gives up after this many proceed() without a pair accepted or answered.
  std::uint64_t patience = 1000000;
  /// Called with the number of pairs answered so far, now and then.
  std::function<void(std::uint64_t)> progress;
};

/// What came back for a pair.
struct ReconfigAnswer {
  KindResult result;     ///< of the first answer
  unsigned answers = 0;  ///< times that the tag came back
};

/// One swap, from its report and the registers phase_clocks; times in clocks.
struct ReconfigSwap {
  int slot = 0;
  ModuleId module_id = ModuleId::blank;
  SwapCode code = SwapCode::ok;
  std::array<std::uint32_t, 9> phases{};  ///< index: SwapPhase - 1
};

struct ReconfigResult {
  std::vector<ReconfigAnswer> answers;  ///< in the order of the pairs
  std::vector<ReconfigSwap> swaps;
  std::uint64_t foreign_answers = 0;  ///< answers with a tag that was never sent
};

/// Checks all bitstreams, writes them and their table, sends the pairs, exchanges modules as `batch` says and returns
/// when all are answered. Pairs must be as the stream takes them: triangle before quad, quads canonical,
/// coordinates in range; their tags are replaced. Swaps that end within the time of some twenty register accesses may
/// be missed in `swaps`.
/// \throws std::invalid_argument a coordinate does not fit the machine's width, the payload is too short
/// \throws BitstreamError a bitstream is damaged, or not the one asked for; nothing was written then
/// \throws std::runtime_error no answer in time, a register that refuses, a batch's module that cannot be loaded
ReconfigResult run_reconfig(PairMachine& machine, const std::vector<PairRequest>& pairs,
                            const ReconfigOptions& options);

}  // namespace cchip

#endif
