// SPDX-License-Identifier: Apache-2.0
/// \file
/// Devices by name.
#ifndef CCHIP_DEVICE_DEVICE_HPP
#define CCHIP_DEVICE_DEVICE_HPP

#include <cchip/collide/collide.hpp>
#include <memory>
#include <string>
#include <vector>

namespace cchip {

/// Names that open_device() takes, "cpu" first.
std::vector<std::string> device_names();

/// "cpu": this computer, all its cores for batches. "model": the functional model of the chip, with the counts that the
/// chip will show. What the chip leaves to its host, and queries that it does not take, are still answered exactly.
/// \throws std::invalid_argument no device of this name; the message lists the names
std::unique_ptr<Device> open_device(const std::string& name);

}  // namespace cchip

#endif
