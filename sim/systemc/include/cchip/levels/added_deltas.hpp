// SPDX-License-Identifier: Apache-2.0
/// \file
/// What portals cost in delta cycles.
#ifndef CCHIP_LEVELS_ADDED_DELTAS_HPP
#define CCHIP_LEVELS_ADDED_DELTAS_HPP

#include <cchip/levels/level.hpp>

namespace cchip::levels {

/// The first object pair of each kind runs through its test of level 3 twice, behind portals and bound directly, each
/// in a child process, without a swap.
/// \return delta cycles of the runs behind portals minus those of the runs bound directly, in all
std::int64_t added_deltas(const Stimulus& stimulus, const LevelOptions& options);

}  // namespace cchip::levels

#endif
