// SPDX-License-Identifier: Apache-2.0
/// \file
/// The subsystems that CMakeLists.txt here builds: small, with simulated reconfiguration.
#ifndef CCHIP_BENCH_SUBSYSTEM_MODELS_HPP
#define CCHIP_BENCH_SUBSYSTEM_MODELS_HPP

#include <Vsubsystem_p1.h>
#include <Vsubsystem_p1___024root.h>
#include <Vsubsystem_s1.h>
#include <Vsubsystem_s1___024root.h>
#include <Vsubsystem_s2.h>
#include <Vsubsystem_s2___024root.h>
#include <Vsubsystem_s4.h>
#include <Vsubsystem_s4___024root.h>

namespace cchip::subsystem {

/// One slot, 32-bit port, a word per clock.
struct OneSlot {
  using Model = Vsubsystem_s1;
  static constexpr int SLOTS = 1;
  static constexpr int KINDS = 3;
  static constexpr int COORD_W = 8;
  static constexpr int QUEUE_DEPTH = 32;
  static constexpr int CFG_W = 32;
  static constexpr int CFG_DIVIDER = 1;
};

/// Two slots, 8-bit port, a byte in two clocks.
struct TwoSlots {
  using Model = Vsubsystem_s2;
  static constexpr int SLOTS = 2;
  static constexpr int KINDS = 3;
  static constexpr int COORD_W = 8;
  static constexpr int QUEUE_DEPTH = 32;
  static constexpr int CFG_W = 8;
  static constexpr int CFG_DIVIDER = 2;
};

/// Four slots with points, too, 32-bit port, a word in two clocks.
struct FourSlots {
  using Model = Vsubsystem_s4;
  static constexpr int SLOTS = 4;
  static constexpr int KINDS = 4;
  static constexpr int COORD_W = 8;
  static constexpr int QUEUE_DEPTH = 32;
  static constexpr int CFG_W = 32;
  static constexpr int CFG_DIVIDER = 2;
};

/// One slot that exchanges triangles, quads and points, 8-bit port, a byte per clock.
struct OneSlotPoints {
  using Model = Vsubsystem_p1;
  static constexpr int SLOTS = 1;
  static constexpr int KINDS = 4;
  static constexpr int COORD_W = 8;
  static constexpr int QUEUE_DEPTH = 32;
  static constexpr int CFG_W = 8;
  static constexpr int CFG_DIVIDER = 1;
};

}  // namespace cchip::subsystem

#endif
