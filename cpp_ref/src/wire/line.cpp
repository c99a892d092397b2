// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/wire/line.hpp>

namespace cchip {
namespace {

// A field of at most 64 bits lies within 8 bytes from byte `first_byte`: fields wider than 57 bits begin at a byte.
struct Window {
  std::size_t first_byte;
  unsigned shift;
};

Window window_of(std::size_t bit) {
  const std::size_t byte = std::min(bit / 8, line_bytes - 8);
  return {byte, static_cast<unsigned>(bit - 8 * byte)};
}

std::uint64_t load(const Line& line, std::size_t byte) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < 8; ++i) value |= std::uint64_t{line[byte + i]} << (8 * i);
  return value;
}

std::uint64_t mask_of(const Field& field) { return ~std::uint64_t{0} >> (64 - field.width); }

}  // namespace

std::int64_t get(const Line& line, const Field& field, std::size_t index, std::size_t base) {
  const Window w = window_of(base + field.lsb + index * field.width);
  const std::uint64_t value = load(line, w.first_byte) >> w.shift & mask_of(field);
  const std::uint64_t sign = field.is_signed ? std::uint64_t{1} << (field.width - 1) : 0;
  return static_cast<std::int64_t>((value ^ sign) - sign);
}

void put(Line& line, const Field& field, std::int64_t value, std::size_t index, std::size_t base) {
  const Window w = window_of(base + field.lsb + index * field.width);
  std::uint64_t bits = load(line, w.first_byte) & ~(mask_of(field) << w.shift);
  bits |= (static_cast<std::uint64_t>(value) & mask_of(field)) << w.shift;
  for (unsigned i = 0; i < 8; ++i) line[w.first_byte + i] = static_cast<std::uint8_t>(bits >> (8 * i));
}

}  // namespace cchip
