// SPDX-License-Identifier: Apache-2.0
/// \file
/// Driver of cchip_chip: registers, rings and images in memory (docs/hardware/programmers-guide.md).
#ifndef CCHIP_DRIVER_CHIP_DRIVER_HPP
#define CCHIP_DRIVER_CHIP_DRIVER_HPP

#include <cchip/driver/machine.hpp>
#include <cchip/driver/query_port.hpp>
#include <cchip/internal/wire/bitstream.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace cchip {

struct ChipDriverOptions {
  /// Memory that host and chip share: first byte, a multiple of 64, and bytes. It ends below 2^38, the end of what
  /// queries can name. Both rings come first, images use the rest.
  std::uint64_t memory_base = 0;
  std::uint64_t memory_bytes = std::uint64_t{1} << 28U;
  unsigned query_log2 = 8;                ///< lines of the ring of queries, logarithm to base 2: 0..15
  unsigned record_log2 = 12;              ///< records of the other one: 0..28
  std::uint32_t step_limit = 0xFFFFFFFF;  ///< node pairs of a query
  std::uint32_t memory_limit = 0;         ///< longest wait of the chip for memory, clocks; 0: its default
  std::uint8_t open_limit = 16;           ///< open pairs that end a query for the first hit
  std::uint8_t pairs_each = 3;            ///< node pairs of a query in flight, 1..4
  /// The bitstream that makes `module_id` of slot `slot`, for a chip with swaps; without it, virtual ones for the
  /// simulated chip, each with this many bytes of payload. They lie before the images, below 2^32.
  std::function<Bytes(std::uint8_t slot, ModuleId module_id)> bitstream;
  std::size_t payload_bytes = 2048;
  /// Registers of the scheduler, which swaps by itself for pairs without a requested module: pairs, clocks.
  std::uint32_t minimum_batch = 64;
  std::uint32_t maximum_age = 4096;
  /// Memory may show half of a record, as behind a port of 64 bits: wait until the register record_producer counts the
  /// record, too. One read of the register for all records that it has counted.
  bool confirm_records = false;
  /// QueryPort::proceed() says time-out after this many proceed() of the machine without a record.
  std::uint64_t patience = 20'000'000;
  /// recover() and the constructor give up after this many looks at a reset that does not end, store() at an
  /// invalidation.
  std::uint64_t reset_patience = 1'000'000;
};

/// Resets the chip softly, sets it up and enables it. Polls the ring of records in memory; registers are touched only
/// to hand over queries, to give room back and, with confirm_records, to accept a record.
/// \throws std::invalid_argument the memory is misplaced or too small for the rings, an option is out of range
/// \throws std::runtime_error no cchip_chip of a known version answers, or its reset does not end
std::unique_ptr<QueryPort> open_chip(std::unique_ptr<Machine> machine, const ChipDriverOptions& options = {});

/// Several chips as one: the next query goes to the chip with the fewest in flight. The machines share memory and
/// clock, and each has registers of its own. Rings (and bitstreams) of the chips come one behind the other from
/// memory_base on, images once behind them all. A chip that stops ends its own queries with QueryCode::memory; the
/// others continue, as long as one of them works.
/// \throws std::invalid_argument no machines; they differ in their slots; as open_chip()
/// \throws std::runtime_error as open_chip()
std::unique_ptr<QueryPort> open_chips(std::vector<std::unique_ptr<Machine>> machines,
                                      const ChipDriverOptions& options = {});

}  // namespace cchip

#endif
