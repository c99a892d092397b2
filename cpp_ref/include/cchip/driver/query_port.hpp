// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a host needs of one chip that answers queries: memory for images, queries in, records out. The functional model
/// implements it, and so does a driver of registers and rings.
#ifndef CCHIP_DRIVER_QUERY_PORT_HPP
#define CCHIP_DRIVER_QUERY_PORT_HPP

#include <cchip/internal/wire/definitions.hpp>
#include <cchip/internal/wire/line.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cchip {

/// What a chip has. Does not change while a port to it exists.
struct ChipCapabilities {
  /// The chip tests pairs with quads. Otherwise each comes back open.
  bool quads = true;
  /// How many queries may usefully be outstanding; at least 1.
  std::size_t queries_in_flight = 1;
  /// Lines of 64 bytes that images may use: number of the first, as in Query::base_a, and how many.
  std::uint32_t image_first = 0;
  std::uint32_t image_lines = 0;
  /// Ranges of lines that can be kept in the chip's cache.
  unsigned lock_ranges = 0;
  /// An engine beside it makes the nodes of an image from its leaves: refit().
  bool refits = false;
  /// Slots whose modules can be exchanged; 0: none.
  unsigned swap_slots = 0;
};

/// Exchanges of modules so far.
struct SwapCounts {
  std::uint64_t swaps = 0;   ///< that ended well
  std::uint64_t clocks = 0;  ///< from their beginning to their report, of all of them
};

/// The result of a query.
struct QueryOutcome {
  DoneRecord done;
  std::vector<PairRecord> pairs;  ///< in the order in which the chip wrote them, without `done`
  // 0 where the port does not know them:
  std::uint64_t box_tests = 0;        ///< pairs of children compared
  std::uint64_t primitive_pairs = 0;  ///< sent to a primitive test
};

/// One chip. Not thread-safe.
///
/// Any call may throw std::runtime_error: the chip is dead, and no other call follows but name() and the destructor.
class QueryPort {
 public:
  QueryPort() = default;
  virtual ~QueryPort() = default;
  QueryPort(const QueryPort&) = delete;
  QueryPort& operator=(const QueryPort&) = delete;

  /// Of the device that this port makes. Throws nothing.
  virtual const char* name() const = 0;
  virtual ChipCapabilities capabilities() const = 0;

  /// Writes lines of an image to memory, from line `first_line` on; when it returns, the chip reads the new ones. What
  /// the chip still holds of lines with these numbers is invalidated, locked or not.
  /// \pre the lines are among those of capabilities(), and no query in flight uses them
  virtual void store(std::uint32_t first_line, const std::vector<Line>& lines) = 0;
  /// Makes the nodes of an image in memory from its leaves, as the model of cchip_refit does; when it returns, the chip
  /// reads the new ones. Takes what bvh::make_leaves() writes. Queries in flight go on meanwhile.
  /// \param root line of the image
  /// \pre as store(); capabilities().refits
  /// \return false: the engine gave up, and the nodes hold anything; nothing that it wrote is still on its way
  /// \throws std::runtime_error memory owes the engine an answer: what it wrote may come after a store()
  virtual bool refit(std::uint32_t /*first_line*/, std::uint32_t /*lines*/, std::uint32_t /*root*/) { return false; }
  /// Lines first..last stay in the chip's cache once it has read them; first > last: none. Replaces what this range
  /// was. Changes speed only, so it may be called while queries are in flight.
  /// \pre range < capabilities().lock_ranges
  virtual void lock(unsigned range, std::uint32_t first, std::uint32_t last) = 0;

  /// Gives a query to the chip. Its tag is that of no other query in flight.
  /// \return false: no room now, and the query was not taken; try again after proceed()
  virtual bool submit(const Query& query) = 0;
  /// A query that has ended, each once, in any order; none if there is none now.
  virtual std::optional<QueryOutcome> collect() = 0;
  /// Lets time pass: some clocks of a simulation, a short time on a board.
  /// \return false: time-out, or a ring has stopped: nothing more will come of what is in flight; call recover()
  virtual bool proceed() = 0;
  /// Drops all queries in flight and resets the chip. Their outcomes may not come later. Locks and stored images need
  /// not survive it.
  /// \return false: the chip is dead, as after an exception
  virtual bool recover() = 0;
  /// Asks for a slot with this module; what it is for waits meanwhile. Nothing to do for a chip without swaps, or if a
  /// slot has it. The slot that was asked for least recently gives way.
  virtual void load(ModuleId) {}
  /// Counted on across recover(). Swaps that follow each other within some register accesses may be missed.
  virtual SwapCounts swaps() { return {}; }
  /// Clocks of the device so far, counted on across recover(); 0 for a device without a clock.
  virtual std::uint64_t clocks() const = 0;
};

}  // namespace cchip

#endif
