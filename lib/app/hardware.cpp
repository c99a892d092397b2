// SPDX-License-Identifier: Apache-2.0
#include "hardware.hpp"

namespace cchip::app {

bool is_hardware_command(const std::string& name) {
  return name == "demo" || name == "pairs" || name == "meshpairs" || name == "reconfig";
}

bool is_hardware_device(const std::string& name) { return name == "model" || name == "sim"; }

const char* const without_hardware =
    "this cchip is built without the simulated hardware; build it with CCHIP_SIMULATION=ON";

}  // namespace cchip::app
