// SPDX-License-Identifier: Apache-2.0
/// \file
/// A chip and its host as a device.
#ifndef CCHIP_DRIVER_CHIP_HOST_HPP
#define CCHIP_DRIVER_CHIP_HOST_HPP

#include <cchip/collide.hpp>
#include <cchip/driver/query_port.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace cchip {

/// What a chip's host keeps, and how it uses the chip.
struct ChipHostOptions {
  /// Images are kept until there are more of them, or more lines of 64 bytes in all; those used least recently go
  /// first. The two of the present query are kept in any case. An object stays in memory as long as its image does.
  std::size_t kept_images = 64;
  std::uint64_t kept_lines = std::uint64_t{1} << 25U;
  /// Lines of each of the two images, from the top of its tree, that stay in the chip's cache.
  std::uint32_t locked_lines = 512;
};

/// A device that asks the chip and answers exactly, face for face as the CPU does: it decides the pairs that the chip
/// leaves open, and the CPU answers what the chip does not (CollisionStats::fallbacks). That is: an object without an
/// image or with one that is too large for the chip's memory; quads, if the chip has no test for them; poses that
/// make_query() refuses; a query that ends with an error code or with malformed records; all queries in flight when
/// the chip stops; and everything once it is dead.
///
/// In a batch, as many queries are in flight as the port says; which of them ends first does not change any result.
/// Counts of a query: `steps` are the chip's, `box_tests` and `pairs` too if the port knows them; `clocks` are those
/// from its submission, or from the end of the query that ended before it if that was later, to its own end; the
/// first of queries that are given up together has them all. So those of a batch add up to the time in which the chip
/// had queries.
/// \param port not null
/// \throws std::invalid_argument no port
/// \throws std::runtime_error the port cannot say what the chip has
std::unique_ptr<Device> make_chip_device(std::unique_ptr<QueryPort> port, const ChipHostOptions& options = {});

}  // namespace cchip

#endif
