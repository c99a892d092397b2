// SPDX-License-Identifier: Apache-2.0
#include "float_mode.hpp"

#include <stdexcept>
#if defined(__SSE2__)
#include <xmmintrin.h>
#else
#include <limits>
#endif

namespace cchip {
namespace {

bool flushes_to_zero() {
#if defined(__SSE2__)
  constexpr unsigned flush_to_zero = 0x8000;
  constexpr unsigned denormals_are_zero = 0x0040;
  return (_mm_getcsr() & (flush_to_zero | denormals_are_zero)) != 0;
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
      "clear "
      "FTZ and DAZ, on x86 with _mm_setcsr(_mm_getcsr() & ~0x8040U)");
}

}  // namespace cchip
