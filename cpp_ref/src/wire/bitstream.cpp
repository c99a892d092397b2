// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <boost/crc.hpp>
#include <cchip/internal/wire/bitstream.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>

namespace cchip {
namespace {

void append(Bytes& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

std::uint32_t word_at(const Bytes& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word |= std::uint32_t{bytes[at + i]} << (8 * i);
  return word;
}

std::string hex(std::uint32_t word) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%08X", word);
  return text.data();
}

/// \param byte where the field begins
[[noreturn]] void refuse(SwapCode code, int byte, const std::string& field, const std::string& what) {
  throw BitstreamError(code, "bitstream byte " + std::to_string(byte) + ", " + field + ": " + what);
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

BitstreamHeader decode_bitstream(const Bytes& bytes, int port_w) {
  constexpr std::size_t header_bytes = defs::bitstream_header;
  constexpr const char* again = "; generate or copy the file again";
  if (bytes.size() < header_bytes) {
    refuse(SwapCode::magic, 0, "header",
           "the file ends after " + std::to_string(bytes.size()) + " bytes, the header has 16" + again);
  }
  BitstreamHeader header;
  header.magic = word_at(bytes, 0);
  const std::uint32_t names = word_at(bytes, 4);
  header.length = word_at(bytes, 8);
  header.crc = word_at(bytes, 12);
  if (header.magic != defs::bitstream_magic) {
    refuse(SwapCode::magic, 0, "magic",
           hex(header.magic) + " is not " + hex(defs::bitstream_magic) +
               "; give a file that begins with the header of a bitstream");
  }
  if (names >> 16U != 0) refuse(SwapCode::magic, 6, "reserved", std::string("two bytes are not 0") + again);
  header.slot = static_cast<std::uint8_t>(names >> 8U);
  const std::uint32_t module = names & 0xFFU;
  if (module > static_cast<std::uint32_t>(defs::kinds_max)) {
    refuse(SwapCode::module, 4, "module", "there is no module " + std::to_string(module) + again);
  }
  header.module_id = static_cast<ModuleId>(module);
  const std::size_t payload = bytes.size() - header_bytes;
  if (header.length != payload) {
    refuse(
        SwapCode::length, 8, "length",
        std::to_string(header.length) + " bytes announced, " + std::to_string(payload) + " follow the header" + again);
  }
  if (payload < defs::bitstream_payload_min) {
    refuse(SwapCode::length, 8, "length",
           "a payload of " + std::to_string(payload) + " bytes is too short; make it " +
               std::to_string(defs::bitstream_payload_min) + " or longer");
  }
  const auto word = static_cast<std::size_t>(port_w / 8);
  if (payload % word != 0) {
    refuse(SwapCode::length, 8, "length",
           std::to_string(payload) + " bytes are no whole words of the configuration port; append zeros up to a " +
               "multiple of " + std::to_string(word) + " before the CRC is computed");
  }
  const std::uint32_t crc = crc32(bytes.data() + header_bytes, payload);
  if (header.crc != crc) {
    refuse(SwapCode::crc, 12, "CRC", hex(header.crc) + " is not that of the payload, " + hex(crc) + again);
  }
  return header;
}

BitstreamHeader check_bitstream(const Bytes& bytes, std::uint8_t slot, ModuleId module_id, int port_w) {
  const BitstreamHeader header = decode_bitstream(bytes, port_w);
  if (header.slot != slot) {
    refuse(SwapCode::slot, 5, "slot",
           "it is for slot " + std::to_string(header.slot) + ", not " + std::to_string(slot) +
               "; give the file that was made for this slot");
  }
  if (header.module_id != module_id) {
    refuse(SwapCode::module, 4, "module",
           std::string("it is ") + to_name(header.module_id) + ", not " + to_name(module_id) +
               "; give the file of that module");
  }
  return header;
}

std::uint64_t transfer_clocks(std::size_t payload_bytes, int port_w, int clocks_per_word) {
  const auto word = static_cast<std::uint64_t>(port_w / 8);
  return (payload_bytes + word - 1) / word * static_cast<std::uint64_t>(clocks_per_word);
}

}  // namespace cchip
