// SPDX-License-Identifier: Apache-2.0
/// \file
/// Virtual partial bitstreams, as the configuration controller fetches them from memory: a header of 16 bytes, which
/// stays in the controller, and a payload, which passes the configuration port. All numbers are little endian.
///
///     byte  0  magic          4  module, slot, 0, 0    8  length of the payload    12  CRC-32 of the payload
///     payload of the simulated device:
///     byte  0  sync           4  slot, module, 0, 0    8  filler                   last 4  CRC-32 of all before
#ifndef CCHIP_INTERNAL_WIRE_BITSTREAM_HPP
#define CCHIP_INTERNAL_WIRE_BITSTREAM_HPP

#include <cchip/internal/wire/definitions.hpp>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace cchip {

using Bytes = std::vector<std::uint8_t>;

/// What the header of a bitstream says.
struct BitstreamHeader {
  std::uint32_t magic = defs::bitstream_magic;
  std::uint8_t slot = 0;
  ModuleId module_id = ModuleId::blank;
  std::uint32_t length = 0;  ///< of the payload, bytes
  std::uint32_t crc = 0;     ///< CRC-32 of the payload
};

/// CRC-32 of IEEE 802.3, that of zlib.
std::uint32_t crc32(const Bytes& bytes);
std::uint32_t crc32(const std::uint8_t* bytes, std::size_t count);

/// Default length of the payload, bytes: Table 1 of the paper, 688,011 for tri-tri and 676,247 for quad-quad; tri-quad
/// and blank, which the table does not list, are as long as tri-tri. Rounded up to words of the port.
/// \param port_w width of the configuration port, bit, 8 or 32
std::size_t default_payload_bytes(ModuleId module_id, int port_w = 8);

/// Payload that configures slot `slot` of the simulated device as `module_id`. The sync word occurs only at its
/// beginning.
/// \param bytes its length, >= defs::bitstream_payload_min
/// \param seed of the filler
/// \throws std::invalid_argument `bytes` is less
Bytes make_payload(std::uint8_t slot, ModuleId module_id, std::size_t bytes, std::uint32_t seed = 1);

/// A bitstream: the header, with length and CRC of the payload, then the payload.
Bytes make_bitstream(std::uint8_t slot, ModuleId module_id, const Bytes& payload);

/// A bitstream of any header, valid or not, and any payload.
Bytes join_bitstream(const BitstreamHeader& header, const Bytes& payload);

/// A bitstream that a swap would refuse. One line: byte and field, what is wrong, what to do.
class BitstreamError : public std::runtime_error {
 public:
  BitstreamError(SwapCode code, const std::string& what) : std::runtime_error(what), code_(code) {}
  /// What the swap would answer.
  SwapCode code() const { return code_; }

 private:
  SwapCode code_;
};

/// The header of a bitstream, after all checks of the configuration controller: magic, bytes that must be 0, a module
/// that there is, length, CRC. The payload is what follows it; only a device knows what that means.
/// \param port_w width of the configuration port, bit, 8 or 32
/// \throws BitstreamError
BitstreamHeader decode_bitstream(const Bytes& bytes, int port_w = 8);

/// The same for the bitstream that slot `slot` is to get as `module_id`.
/// \throws BitstreamError also if it is for another slot, or of another module
BitstreamHeader check_bitstream(const Bytes& bytes, std::uint8_t slot, ModuleId module_id, int port_w = 8);

/// Clocks of a transfer while memory keeps up (the paper's eq. 4): words of the port times clocks per word.
std::uint64_t transfer_clocks(std::size_t payload_bytes, int port_w, int clocks_per_word);

}  // namespace cchip

#endif
