// SPDX-License-Identifier: Apache-2.0
#include "hardware.hpp"

namespace cchip::app {

const Hardware* hardware() { return nullptr; }

}  // namespace cchip::app
