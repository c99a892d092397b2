// SPDX-License-Identifier: Apache-2.0
/// \file
/// Integers of a fixed number of bits, for exact predicates whose results are known to fit.
#ifndef CCHIP_EXACT_WIDE_INT_HPP
#define CCHIP_EXACT_WIDE_INT_HPP

#include <array>
#include <cstddef>
#include <cstdint>

namespace cchip::exact {

__extension__ using UInt128 = unsigned __int128;
__extension__ using SInt128 = __int128;

/// An integer in two's complement of N words of 64 bits. Results are right if they fit, also if intermediate ones do
/// not: all is modulo 2^(64 N). No allocation and no loop whose length depends on the value.
template <std::size_t N>
class WideInt {
 public:
  static constexpr int bits = 64 * static_cast<int>(N);

  WideInt() = default;  // not initialised: hulls hold many that are never read
  /// value * 2^shift. \pre 0 <= shift < bits
  WideInt(SInt128 value, int shift) {
    word_.fill(0);
    add(value, shift);
  }

  /// Adds value * 2^shift. \pre 0 <= shift < bits
  void add(SInt128 value, int shift) {
    const int rest = shift % 64;
    const auto low = static_cast<std::uint64_t>(value);
    const auto high = static_cast<std::uint64_t>(value >> 64);
    const std::uint64_t sign = value < 0 ? ~std::uint64_t{0} : 0;
    // 192 bits, and the sign above them. A shift by 64 is none that C++ defines, so it is made of two.
    const std::array<std::uint64_t, 3> part = {low << rest, high << rest | low >> 1U >> (63 - rest),
                                               sign << rest | high >> 1U >> (63 - rest)};
    UInt128 carry = 0;
    std::size_t from = 0;
    for (std::size_t i = static_cast<std::size_t>(shift / 64); i < N; ++i, ++from) {
      carry += UInt128{word_[i]} + (from < 3 ? part[from] : sign);
      word_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
  }

  int sign() const {
    if (word_[N - 1] >> 63U != 0) return -1;
    std::uint64_t any = 0;
    for (const std::uint64_t w : word_) any |= w;
    return any != 0 ? 1 : 0;
  }

  friend WideInt operator+(const WideInt& x, const WideInt& y) {
    WideInt sum;
    UInt128 carry = 0;
    for (std::size_t i = 0; i < N; ++i) {
      carry += UInt128{x.word_[i]} + y.word_[i];
      sum.word_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return sum;
  }
  friend WideInt operator-(const WideInt& x, const WideInt& y) {
    WideInt difference;
    UInt128 borrow = 0;
    for (std::size_t i = 0; i < N; ++i) {
      const UInt128 word = UInt128{x.word_[i]} - y.word_[i] - borrow;
      difference.word_[i] = static_cast<std::uint64_t>(word);
      borrow = word >> 127;
    }
    return difference;
  }
  friend WideInt operator*(const WideInt& x, const WideInt& y) {
    WideInt product;
    product.word_.fill(0);
    for (std::size_t i = 0; i < N; ++i) {
      UInt128 carry = 0;
      for (std::size_t k = 0; i + k < N; ++k) {
        carry += UInt128{x.word_[i]} * y.word_[k] + product.word_[i + k];
        product.word_[i + k] = static_cast<std::uint64_t>(carry);
        carry >>= 64;
      }
    }
    return product;
  }
  WideInt& operator+=(const WideInt& x) { return *this = *this + x; }

  friend bool operator<(const WideInt& x, const WideInt& y) { return (x - y).sign() < 0; }
  friend bool operator<=(const WideInt& x, const WideInt& y) { return (x - y).sign() <= 0; }
  friend bool operator>=(const WideInt& x, const WideInt& y) { return (x - y).sign() >= 0; }

 private:
  std::array<std::uint64_t, N> word_;  ///< the lowest first
};

}  // namespace cchip::exact

#endif
