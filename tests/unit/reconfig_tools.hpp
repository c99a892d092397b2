// SPDX-License-Identifier: Apache-2.0
/// \file
/// Payloads for the simulated configuration memory and what it makes of them, with zlib's CRC-32.
#ifndef CCHIP_TESTS_UNIT_RECONFIG_TOOLS_HPP
#define CCHIP_TESTS_UNIT_RECONFIG_TOOLS_HPP

#include <zlib.h>

#include <cchip/internal/wire/definitions.hpp>
#include <cstdint>
#include <optional>
#include <vector>

#include "bench.hpp"

namespace cchip::test {

using Bytes = std::vector<std::uint8_t>;

inline std::uint32_t word_at(const Bytes& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word |= std::uint32_t{bytes.at(at + i)} << (8 * i);
  return word;
}
inline void put_word(Bytes& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
}
inline std::uint32_t zlib_crc(const Bytes& bytes, std::size_t count) {
  return static_cast<std::uint32_t>(crc32(0, bytes.data(), static_cast<uInt>(count)));
}
/// A second synchronisation word would begin another payload.
inline bool has_one_sync(const Bytes& bytes) {
  int found = 0;
  for (std::size_t i = 0; i + 4 <= bytes.size(); ++i) found += word_at(bytes, i) == defs::bitstream_sync ? 1 : 0;
  return found == 1;
}

/// A complete, correct payload. \param length bytes, >= 16; for a 32-bit port a multiple of 4
inline Bytes make_payload(int slot, int module, std::size_t length, Random& random) {
  Bytes bytes;
  do {
    bytes.clear();
    put_word(bytes, defs::bitstream_sync);
    bytes.push_back(static_cast<std::uint8_t>(slot));
    bytes.push_back(static_cast<std::uint8_t>(module));
    bytes.push_back(0);
    bytes.push_back(0);
    while (bytes.size() + 4 < length) bytes.push_back(static_cast<std::uint8_t>(random()));
    put_word(bytes, zlib_crc(bytes, bytes.size()));
  } while (!has_one_sync(bytes));
  return bytes;
}

/// Replaces the last four bytes by the CRC of those before.
inline void repair_crc(Bytes& bytes) {
  bytes.resize(bytes.size() - 4);
  put_word(bytes, zlib_crc(bytes, bytes.size()));
}

/// cchip_pr_config_memory: keeps the bytes since the last synchronisation word and judges all of them after each word.
class ConfigMemoryModel {
 public:
  /// \param kinds the modules are 0..kinds
  ConfigMemoryModel(int slot, int module, int port_bytes, int kinds)
      : slot_(slot), select_(module), port_bytes_(port_bytes), kinds_(kinds) {}
  bool garbage() const { return garbage_; }
  /// Defined while !garbage().
  int select() const { return select_; }

  void write(std::uint32_t word) {
    for (int i = 0; i < port_bytes_; ++i) bytes_.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
    const std::size_t n = bytes_.size();
    if (n >= 4 && word_at(bytes_, n - 4) == defs::bitstream_sync) bytes_.erase(bytes_.begin(), bytes_.end() - 4);
    if (bytes_.size() < 8 || word_at(bytes_, 0) != defs::bitstream_sync || bytes_[4] != slot_) return;
    garbage_ = true;
    // complete, perhaps followed by the first bytes of synchronisation words, cut off or incomplete
    const std::size_t most = port_bytes_ == 1 ? std::min<std::size_t>(bytes_.size() - 8, 64) : 0;
    for (std::size_t more = 0; more <= most && garbage_; ++more) {
      garbage_ = !(complete(bytes_.size() - more) && begins_sync(more));
    }
    if (!garbage_) select_ = bytes_[5];
  }

 private:
  bool begins_sync(std::size_t count) const {
    unsigned byte = 0;  // of the word
    for (auto it = bytes_.end() - static_cast<std::ptrdiff_t>(count); it != bytes_.end(); ++it) {
      if (*it != (defs::bitstream_sync >> (8 * byte) & 255)) byte = 0;
      if (*it != (defs::bitstream_sync >> (8 * byte) & 255)) return false;
      ++byte;
    }
    return true;
  }
  bool complete(std::size_t n) const {
    return n >= static_cast<std::size_t>(defs::bitstream_payload_min) && bytes_[5] <= kinds_ && bytes_[6] == 0 &&
           bytes_[7] == 0 && word_at(bytes_, n - 4) == zlib_crc(bytes_, n - 4);
  }

  int slot_;
  int select_;
  int port_bytes_;
  int kinds_;
  bool garbage_ = false;
  Bytes bytes_;
};

/// Ways to corrupt a payload.
enum class Fault { none, crc, truncated, overlong, module, unused_bits, other_slot, too_short, filler, cut_sync };
constexpr int faults = 10;

/// \param slot the slot it would be for
inline Bytes spoil(Bytes bytes, Fault fault, int slot, Random& random) {
  switch (fault) {
    case Fault::none:
      break;
    case Fault::crc:
      bytes.back() = static_cast<std::uint8_t>(bytes.back() ^ 0x10);
      break;
    case Fault::filler:
      bytes.at(9) = static_cast<std::uint8_t>(bytes.at(9) ^ 1);
      break;
    case Fault::truncated:
      bytes.resize(bytes.size() - 4);
      break;
    case Fault::overlong:
      put_word(bytes, static_cast<std::uint32_t>(random()) & 0x7FFFFFFF);
      break;
    case Fault::cut_sync:  // of a transfer to any slot
      bytes.resize(1 + random() % 3);
      break;
    case Fault::module:
      bytes.at(5) = static_cast<std::uint8_t>(defs::kinds_max + 1 + static_cast<int>(random() % 251));
      repair_crc(bytes);
      break;
    case Fault::unused_bits:
      bytes.at(6 + random() % 2) = static_cast<std::uint8_t>(1 + random() % 255);
      repair_crc(bytes);
      break;
    case Fault::other_slot:
      bytes.at(4) = static_cast<std::uint8_t>(slot + 1);
      repair_crc(bytes);
      break;
    case Fault::too_short:
      bytes.resize(12);
      repair_crc(bytes);
      break;
  }
  return bytes;
}

}  // namespace cchip::test

#endif
