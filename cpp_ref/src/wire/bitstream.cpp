// SPDX-License-Identifier: Apache-2.0
#include <boost/crc.hpp>
#include <cchip/wire/bitstream.hpp>
#include <random>
#include <stdexcept>
#include <string>

namespace cchip {
namespace {

void append(Bytes& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

}  // namespace

std::uint32_t crc32(const Bytes& bytes) { return crc32(bytes.data(), bytes.size()); }

std::uint32_t crc32(const std::uint8_t* bytes, std::size_t count) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes, count);
  return crc.checksum();
}

std::size_t default_payload_bytes(ModuleId module_id, int port_w) {
  const std::size_t bits = module_id == ModuleId::quad_quad ? 5409976 : 5504088;
  const auto word = static_cast<std::size_t>(port_w / 8);
  return (bits / 8 + word - 1) / word * word;
}

Bytes make_payload(std::uint8_t slot, ModuleId module_id, std::size_t bytes, std::uint32_t seed) {
  if (bytes < defs::bitstream_payload_min) {
    throw std::invalid_argument("payload of " + std::to_string(bytes) + " bytes: make it " +
                                std::to_string(defs::bitstream_payload_min) + " or longer");
  }
  std::mt19937 random(seed);
  for (;;) {
    Bytes payload;
    payload.reserve(bytes);
    append(payload, defs::bitstream_sync);
    append(payload, slot | static_cast<std::uint32_t>(module_id) << 8U);
    // without the sync word's first byte no sync begins in the filler
    while (payload.size() < bytes - 4) {
      const auto byte = static_cast<std::uint8_t>(random());
      payload.push_back(byte == (defs::bitstream_sync & 0xFFU) ? std::uint8_t{0} : byte);
    }
    const std::uint32_t crc = crc32(payload);
    append(payload, crc);
    if (crc != defs::bitstream_sync) return payload;
  }
}

Bytes make_bitstream(std::uint8_t slot, ModuleId module_id, const Bytes& payload) {
  return join_bitstream(
      {defs::bitstream_magic, slot, module_id, static_cast<std::uint32_t>(payload.size()), crc32(payload)}, payload);
}

Bytes join_bitstream(const BitstreamHeader& header, const Bytes& payload) {
  Bytes bytes;
  bytes.reserve(payload.size() + defs::bitstream_header);
  append(bytes, header.magic);
  append(bytes, static_cast<std::uint32_t>(header.module_id) | static_cast<std::uint32_t>(header.slot) << 8U);
  append(bytes, header.length);
  append(bytes, header.crc);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

std::uint64_t transfer_clocks(std::size_t payload_bytes, int port_w, int clocks_per_word) {
  const auto word = static_cast<std::uint64_t>(port_w / 8);
  return (payload_bytes + word - 1) / word * static_cast<std::uint64_t>(clocks_per_word);
}

}  // namespace cchip
