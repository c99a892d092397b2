// SPDX-License-Identifier: Apache-2.0
/// \file
/// The CPU as a device.
#ifndef CCHIP_DEVICE_CPU_DEVICE_HPP
#define CCHIP_DEVICE_CPU_DEVICE_HPP

#include <cchip/collide/collide.hpp>
#include <memory>
#include <string>
#include <vector>

namespace cchip {

struct CpuOptions {
  unsigned threads = 0;  ///< of a batch; 0: as many as there are cores
  std::string target;    ///< one of cpu_targets(); empty: the first of them
};

/// Instruction sets that this computer has and the device uses, best first. The last, "plain", is no instruction set:
/// bounding volumes in doubles, without SIMD. Answers are the same with all of them.
std::vector<std::string> cpu_targets();

/// \throws std::invalid_argument no target of this name; the message lists the names
std::unique_ptr<Device> open_cpu_device(const CpuOptions& options = {});

}  // namespace cchip

#endif
