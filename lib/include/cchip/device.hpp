// SPDX-License-Identifier: Apache-2.0
/// \file
/// Devices by name.
#ifndef CCHIP_DEVICE_HPP
#define CCHIP_DEVICE_HPP

#include <cchip/collide.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace cchip {

/// Opens a device; called for each open_device(), by any thread.
using DeviceOpener = std::function<std::unique_ptr<Device>()>;

/// Makes a device known by a name, after those that are known already. Any thread may call it, and the constructor of a
/// global object.
/// \param name of the device that `open` opens; it stays known as long as the program runs
/// \throws std::invalid_argument the name is known already, or it or `open` is empty
void add_device(const std::string& name, DeviceOpener open);

/// Names that open_device() takes, "cpu" first.
std::vector<std::string> device_names();

/// "cpu": this computer, all its cores for batches. add_device() makes others known, add_model_device() of
/// <cchip/driver/model_device.hpp> the functional model of the chip.
/// \throws std::invalid_argument no device of this name; the message lists the names
/// \throws as the opener of a device that was added
std::unique_ptr<Device> open_device(const std::string& name);

}  // namespace cchip

#endif
