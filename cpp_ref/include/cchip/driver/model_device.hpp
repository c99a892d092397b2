// SPDX-License-Identifier: Apache-2.0
/// \file
/// The functional model of the chip as a device.
#ifndef CCHIP_DRIVER_MODEL_DEVICE_HPP
#define CCHIP_DRIVER_MODEL_DEVICE_HPP

namespace cchip {

/// Makes open_device("model") known: the functional model of the chip behind its host, with the counts that the chip
/// will show. What the chip leaves to its host, and queries that it does not take, are still answered exactly. Any
/// thread may call it; a second call does nothing.
void add_model_device();

}  // namespace cchip

#endif
