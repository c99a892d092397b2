// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands of cchip that need the hardware's models or the simulated hardware: pairs, meshpairs, demo, reconfig.
#ifndef CCHIP_COMMANDS_COMMANDS_HPP
#define CCHIP_COMMANDS_COMMANDS_HPP

#include <vector>

#include "hardware.hpp"

namespace cchip::app {

std::vector<Command> hardware_commands();

}  // namespace cchip::app

#endif
