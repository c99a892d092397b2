// SPDX-License-Identifier: Apache-2.0
/// \file
/// The mode of the processor that exact answers need.
#ifndef CCHIP_EXACT_FLOAT_MODE_HPP
#define CCHIP_EXACT_FLOAT_MODE_HPP

namespace cchip {

/// Error bounds count on gradual underflow. A thread, or the start of a program that was linked with -ffast-math, may
/// have switched it off. Takes a few nanoseconds.
/// \throws std::runtime_error the calling thread flushes small numbers to zero
void check_float_mode();

}  // namespace cchip

#endif
