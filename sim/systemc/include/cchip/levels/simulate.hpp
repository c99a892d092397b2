// SPDX-License-Identifier: Apache-2.0
/// \file
/// Running an elaborated level.
#ifndef CCHIP_LEVELS_SIMULATE_HPP
#define CCHIP_LEVELS_SIMULATE_HPP

#include <cchip/levels/api.hpp>
#include <cchip/levels/level.hpp>

namespace cchip::levels {

/// Simulates until `api` has all answers; swaps are left 0.
/// \throws std::runtime_error the simulation ended without them
LevelResult simulate(const Api& api);

}  // namespace cchip::levels

#endif
