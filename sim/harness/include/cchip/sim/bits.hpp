// SPDX-License-Identifier: Apache-2.0
/// \file
/// Fields of flat vectors: any type that Verilator gives to a port (CData .. QData, VlWide<N>).
#ifndef CCHIP_SIM_BITS_HPP
#define CCHIP_SIM_BITS_HPP

#include <verilated.h>

#include <cchip/sim/int128.hpp>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace cchip::sim {

namespace detail {

template <class Unsigned>
constexpr Unsigned low_mask(int width) {
  return width >= static_cast<int>(8 * sizeof(Unsigned)) ? ~Unsigned{0} : (Unsigned{1} << width) - 1;
}

template <class Unsigned>
void check_width(int width) {
  if (width < 1 || width > static_cast<int>(8 * sizeof(Unsigned))) {
    throw std::invalid_argument("field of " + std::to_string(width) + " bits: use a wider type or two fields");
  }
}

}  // namespace detail

/// Bits [lsb +: width] of a port of up to 64 bits, zero-extended.
template <class Value = std::uint64_t, class Port, std::enable_if_t<std::is_integral_v<Port>, int> = 0>
Value get_bits(const Port& port, int lsb, int width) {
  detail::check_width<Value>(width);
  return static_cast<Value>(static_cast<std::uint64_t>(port) >> lsb) & detail::low_mask<Value>(width);
}

/// Bits [lsb +: width] of a wide port, zero-extended.
template <class Value = std::uint64_t, std::size_t Words>
Value get_bits(const VlWide<Words>& port, int lsb, int width) {
  detail::check_width<Value>(width);
  Value value = 0;
  for (int done = 0; done < width;) {
    const int bit = lsb + done;
    const int offset = bit % 32;
    value |= static_cast<Value>(port.at(static_cast<std::size_t>(bit / 32)) >> offset) << done;
    done += 32 - offset;
  }
  return value & detail::low_mask<Value>(width);
}

/// Bits [lsb +: width] of a port as a two's complement number of up to 64 bits.
template <class Port>
std::int64_t get_signed(const Port& port, int lsb, int width) {
  const std::uint64_t sign = std::uint64_t{1} << (width - 1);
  const std::uint64_t value = get_bits(port, lsb, width);
  return static_cast<std::int64_t>((value ^ sign) - sign);
}

/// Bits [lsb +: width] of a port as a two's complement number of up to 128 bits.
template <class Port>
Int128 get_signed_wide(const Port& port, int lsb, int width) {
  const UInt128 sign = UInt128{1} << (width - 1);
  UInt128 value = get_bits(port, lsb, width < 64 ? width : 64);
  if (width > 64) value |= static_cast<UInt128>(get_bits(port, lsb + 64, width - 64)) << 64;
  return static_cast<Int128>((value ^ sign) - sign);
}

/// Writes the low `width` (up to 64) bits of `value` to bits [lsb +: width] of a port of up to 64 bits.
template <class Port, std::enable_if_t<std::is_integral_v<Port>, int> = 0>
void set_bits(Port& port, int lsb, int width, std::uint64_t value) {
  detail::check_width<std::uint64_t>(width);
  const std::uint64_t mask = detail::low_mask<std::uint64_t>(width) << lsb;
  port = static_cast<Port>((static_cast<std::uint64_t>(port) & ~mask) | ((value << lsb) & mask));
}

/// Writes the low `width` (up to 64) bits of `value` to bits [lsb +: width] of a wide port.
template <std::size_t Words>
void set_bits(VlWide<Words>& port, int lsb, int width, std::uint64_t value) {
  detail::check_width<std::uint64_t>(width);
  for (int done = 0; done < width;) {
    const int bit = lsb + done;
    const int offset = bit % 32;
    const int count = width - done < 32 - offset ? width - done : 32 - offset;
    const std::uint32_t mask = detail::low_mask<std::uint32_t>(count) << offset;
    EData& word = port.at(static_cast<std::size_t>(bit / 32));
    word = (word & ~mask) | ((static_cast<std::uint32_t>(value >> done) << offset) & mask);
    done += count;
  }
}

/// Writes a signed number to bits [lsb +: width] (up to 64).
/// \throws std::invalid_argument it does not fit
template <class Port>
void set_signed(Port& port, int lsb, int width, std::int64_t value) {
  detail::check_width<std::uint64_t>(width);
  const std::int64_t bound = width == 64 ? 0 : std::int64_t{1} << (width - 1);
  if (width < 64 && (value < -bound || value >= bound)) {
    throw std::invalid_argument(std::to_string(value) + " does not fit into " + std::to_string(width) + " signed bits");
  }
  set_bits(port, lsb, width, static_cast<std::uint64_t>(value));
}

/// Random bits in all of the port's `width` bits (bits above stay 0, as Verilator wants them).
template <class Port>
void set_random(Port& port, int width, std::mt19937_64& random) {
  for (int done = 0; done < width; done += 64) {
    set_bits(port, done, width - done < 64 ? width - done : 64, random());
  }
}

}  // namespace cchip::sim

#endif
