// SPDX-License-Identifier: Apache-2.0
#include "float_mode.hpp"

#include <cchip/gradual_underflow.hpp>
#include <stdexcept>
#if defined(__SSE2__)
#include <xmmintrin.h>
#else
#include <limits>
#endif

namespace cchip {
namespace {

// Bits of the control register that flush results, and on x86 operands, to zero; and access to it.
#if defined(__SSE2__)
constexpr std::uint64_t flush_bits = 0x8040;  // FTZ and DAZ
std::uint64_t control() { return _mm_getcsr(); }
void set_control(std::uint64_t bits) { _mm_setcsr(static_cast<unsigned>(bits)); }
#elif defined(__aarch64__)
constexpr std::uint64_t flush_bits = std::uint64_t{1} << 24U;  // FZ
std::uint64_t control() {
  std::uint64_t bits = 0;
  __asm__ volatile("mrs %0, fpcr" : "=r"(bits));
  return bits;
}
void set_control(std::uint64_t bits) { __asm__ volatile("msr fpcr, %0" : : "r"(bits)); }
#else
constexpr std::uint64_t flush_bits = 0;
std::uint64_t control() { return 0; }
void set_control(std::uint64_t) {}
#endif

bool flushes_to_zero() {
#if defined(__SSE2__)
  return (control() & flush_bits) != 0;
#else
  volatile double least = std::numeric_limits<double>::min();
  volatile double half = least / 2;
  return half + half != least;
#endif
}

}  // namespace

void check_float_mode() {
  if (!flushes_to_zero()) return;
  throw std::runtime_error(
      "this thread flushes small numbers to zero, which makes answers wrong: link without -ffast-math and -Ofast, or "
      "clear FTZ and DAZ, for a while with cchip::GradualUnderflow, on x86 with _mm_setcsr(_mm_getcsr() & ~0x8040U)");
}

GradualUnderflow::GradualUnderflow() : flushes_(control() & flush_bits) {
  if (flushes_ != 0) set_control(control() & ~flush_bits);
}

GradualUnderflow::~GradualUnderflow() {
  if (flushes_ != 0) set_control(control() | flushes_);
}

}  // namespace cchip
