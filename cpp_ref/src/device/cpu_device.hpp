// SPDX-License-Identifier: Apache-2.0
/// \file
/// This computer as a device.
#ifndef CCHIP_DEVICE_CPU_DEVICE_HPP
#define CCHIP_DEVICE_CPU_DEVICE_HPP

#include <cchip/collide/collide.hpp>
#include <memory>

namespace cchip {

/// \param threads for batches; 0: one for each core
std::unique_ptr<Device> make_cpu_device(unsigned threads = 0);

}  // namespace cchip

#endif
