// SPDX-License-Identifier: Apache-2.0
/// \file
/// The functional model of the chip as a device.
#ifndef CCHIP_DEVICE_MODEL_DEVICE_HPP
#define CCHIP_DEVICE_MODEL_DEVICE_HPP

#include <cchip/collide/collide.hpp>
#include <memory>

namespace cchip {

/// Runs each query in the chip's integers, on one core, and decides the pairs that the chip leaves open. The CPU
/// answers what the chip does not: poses that make_query() refuses, queries that end with an error code.
std::unique_ptr<Device> make_model_device();

}  // namespace cchip

#endif
