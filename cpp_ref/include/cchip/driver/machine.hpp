// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a host can do with a machine: registers, memory, interrupt, and for some streams of pairs. The drivers of this
/// folder use nothing else, so they work on the simulated RTL and on a board alike.
#ifndef CCHIP_DRIVER_MACHINE_HPP
#define CCHIP_DRIVER_MACHINE_HPP

#include <cchip/internal/wire/bitstream.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace cchip {

/// How a refit ended.
struct RefitEnd {
  RefitCode code = RefitCode::ok;
  std::uint32_t line = 0;    ///< of the image, at work then; 0: none
  std::uint32_t lines = 0;   ///< lines read
  std::uint64_t clocks = 0;  ///< from the command to the end
  /// Memory still owes answers (`outstanding` of cchip_refit_axi): beats of a write may reach the image at any time
  bool outstanding = false;
};

/// Accesses to registers and memory take effect in the order of the calls: what was written to memory before a register
/// is there when the machine sees the register, and a read returns what memory held after every earlier call returned.
/// The words of one call have no order. Not thread-safe.
class Machine {
 public:
  virtual ~Machine() = default;

  /// Registers by their offset in bytes (registers.hpp).
  /// \throws std::runtime_error the machine refuses the access or does not answer it in time
  virtual std::uint32_t read_register(std::uint32_t offset) = 0;
  virtual void write_register(std::uint32_t offset, std::uint32_t value) = 0;

  /// Writes bytes to the machine's memory from byte `address` on, a multiple of 4. If their number is none, the bytes
  /// up to the next multiple of 4 may change, too.
  /// \throws std::runtime_error the machine has no memory there
  virtual void write_memory(std::uint64_t address, const Bytes& bytes) = 0;
  /// Reads `size` bytes of the machine's memory from byte `address` on, both multiples of 4. Memory that nothing wrote
  /// may hold anything.
  /// \throws std::runtime_error as above
  virtual Bytes read_memory(std::uint64_t address, std::size_t size) = 0;

  /// True if a cchip_refit_axi works on the same memory.
  virtual bool has_refit() const { return false; }
  /// Runs it on an image and waits for its end, then, not without a bound, until memory owes no answer. The machine
  /// goes on meanwhile; a query that uses these lines finds anything.
  /// \param base, root  lines of 64 bytes: address of the header / 64; number within the image
  virtual RefitEnd refit(std::uint32_t /*base*/, std::uint32_t /*lines*/, std::uint32_t /*root*/) {
    return {RefitCode::command, 0, 0, 0};
  }

  /// Level of the interrupt line.
  virtual bool interrupt() = 0;
  /// Advances the machine: one clock of a simulation, a short time on a board.
  virtual void proceed() = 0;
};

/// A machine whose host sends it pairs one by one.
class PairMachine : public Machine {
 public:
  /// Offers a pair on the stream s_pair.
  /// \return false: the previous pair has not been accepted yet; try again after proceed()
  virtual bool send(const KindRequest& request) = 0;
  /// The next result of the stream m_result, if there is one.
  virtual std::optional<KindResult> receive() = 0;
};

}  // namespace cchip

#endif
