// SPDX-License-Identifier: Apache-2.0
/// \file
/// The mode of the processor that exact answers need, for a while.
#ifndef CCHIP_GRADUAL_UNDERFLOW_HPP
#define CCHIP_GRADUAL_UNDERFLOW_HPP

#include <cstdint>

namespace cchip {

/// While it exists the calling thread does not flush small numbers to zero; then the thread does again what it did
/// before. For programs that cannot keep other code from switching this on, such as a library linked with -ffast-math:
/// without it calls that need exact arithmetic throw. Takes a few nanoseconds. Does nothing on processors other than
/// x86-64 and 64-bit Arm.
class GradualUnderflow {
 public:
  GradualUnderflow();
  ~GradualUnderflow();
  GradualUnderflow(const GradualUnderflow&) = delete;
  GradualUnderflow& operator=(const GradualUnderflow&) = delete;

 private:
  std::uint64_t flushes_;  ///< bits of the mode that were set
};

}  // namespace cchip

#endif
