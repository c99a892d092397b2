// SPDX-License-Identifier: Apache-2.0
/// \file
/// The functional model of the chip as a device.
#ifndef CCHIP_DEVICE_MODEL_DEVICE_HPP
#define CCHIP_DEVICE_MODEL_DEVICE_HPP

#include <cchip/collide/collide.hpp>
#include <cchip/driver/query_port.hpp>
#include <memory>

namespace cchip {

/// The host of a chip (chip_host.hpp) over the model, which runs each query in the chip's integers, on one core, when
/// it is submitted.
std::unique_ptr<Device> make_model_device();
/// The model alone. A query whose images are not stored ends with QueryCode::bad_descriptor.
std::unique_ptr<QueryPort> make_model_port();

}  // namespace cchip

#endif
