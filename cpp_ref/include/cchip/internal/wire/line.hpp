// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lines of 64 bytes, the unit in which the chip reads memory, and their fields. Bit 0 is the lowest bit of byte 0,
/// numbers are little endian, bits without a field are 0.
#ifndef CCHIP_INTERNAL_WIRE_LINE_HPP
#define CCHIP_INTERNAL_WIRE_LINE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

namespace cchip {

inline constexpr std::size_t line_bytes = 64;

/// 64 bytes, as they lie in memory.
using Line = std::array<std::uint8_t, line_bytes>;

/// `count` equal fields in a row; field i begins at bit lsb + i width. Up to 57 bits wide, or whole bytes from a byte
/// on.
struct Field {
  const char* name;
  std::size_t lsb;
  std::size_t width;
  std::size_t count = 1;
  bool is_signed = false;
  constexpr std::size_t end() const { return lsb + width * count; }
};

/// Field `index` of a line, sign-extended if it is signed. `base`: bit of the line from which the field's position
/// counts.
std::int64_t get(const Line& line, const Field& field, std::size_t index = 0, std::size_t base = 0);
/// Writes the low bits of `value` to the field.
void put(Line& line, const Field& field, std::int64_t value, std::size_t index = 0, std::size_t base = 0);

}  // namespace cchip

#endif
