// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/added_deltas.hpp>
#include <set>

namespace cchip::levels {

std::int64_t added_deltas(const Stimulus& stimulus, const LevelOptions& options) {
  std::set<ModuleId> done;
  std::int64_t sum = 0;
  for (const ObjectPair& objects : object_pairs(stimulus)) {
    if (!done.insert(objects.test).second) continue;
    const auto first = stimulus.begin() + static_cast<std::ptrdiff_t>(objects.first);
    const Stimulus part(first, first + static_cast<std::ptrdiff_t>(objects.count));
    const LevelResult portals = in_child([&] { return run_l3_preloaded(part, options); });
    const LevelResult direct = in_child([&] { return run_l3_direct(part, options); });
    sum += static_cast<std::int64_t>(portals.deltas) - static_cast<std::int64_t>(direct.deltas);
  }
  return sum;
}

}  // namespace cchip::levels
