// SPDX-License-Identifier: Apache-2.0
/// \file
/// The CPU as a device.
#ifndef CCHIP_CPU_DEVICE_HPP
#define CCHIP_CPU_DEVICE_HPP

#include <cchip/collide.hpp>
#include <memory>
#include <string>
#include <vector>

namespace cchip {

struct CpuOptions {
  unsigned threads = 0;  ///< of a batch; 0: as many as there are cores
  std::string target;    ///< one of cpu_targets(); empty: the first of them
};

/// Instruction sets that this computer has and the device uses, best first. The last, "plain", is no instruction set:
/// bounding volumes in doubles, without SIMD. Which contact
/// Contacts::first names, and stats, may differ between them; all else is equal.
std::vector<std::string> cpu_targets();

/// \throws std::invalid_argument no target of this name; the message lists the names
std::unique_ptr<Device> open_cpu_device(const CpuOptions& options = {});

/// One query without a device of one's own: each thread that calls this has a CPU device of one thread, opened by its
/// first call and closed when the thread ends. So any number of threads may call it at a time. For many queries a batch
/// on a device is faster: it has several queries in flight, and all cores. Only for pairs that are far apart one thread
/// is as fast or a little faster without.
/// \throws as Device::collide()
CollisionResult collide(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                        const CollisionRequest& request = {}, const CollisionHint& hint = {});

}  // namespace cchip

#endif
