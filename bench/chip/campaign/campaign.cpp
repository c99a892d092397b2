// SPDX-License-Identifier: Apache-2.0
#include "campaign.hpp"

namespace cchip::testing {

sim::AxiLinesOptions any_memory(Random& random) {
  sim::AxiLinesOptions options;
  options.latency = random() % 150;
  options.write_latency = random() % 150;
  options.jitter = random() % 2 == 0 ? 0 : random() % 150;
  options.reorder = random() % 2 == 0;
  options.ready_percent = random() % 2 == 0 ? 100 : static_cast<unsigned>(40 + random() % 60);
  options.valid_percent = random() % 2 == 0 ? 100 : static_cast<unsigned>(40 + random() % 60);
  return options;
}

ChipDriverOptions small_rings() {
  ChipDriverOptions options;
  options.memory_base = std::uint64_t{3} << 32U;
  options.memory_bytes = std::uint64_t{1} << 24U;
  options.query_log2 = 3;
  options.record_log2 = 6;
  options.patience = 200000;
  options.reset_patience = 4000;
  return options;
}

}  // namespace cchip::testing
