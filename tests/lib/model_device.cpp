// SPDX-License-Identifier: Apache-2.0
// Linked where cpp_ref is built: the tests of the library, which ask every device of device_names(), ask the model,
// too.
#include <cchip/driver/model_device.hpp>

namespace {
const bool model_added = (cchip::add_model_device(), true);  // NOLINT(cert-err58-cpp): before the tests
}
