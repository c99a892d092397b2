// SPDX-License-Identifier: Apache-2.0
/// \file
/// Several chips on one memory: clocks a query and use of the bus by the number of chips and the width of the bus.
#ifndef CCHIP_BENCH_CHIP_SCALING_HPP
#define CCHIP_BENCH_CHIP_SCALING_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cchip::testing {

struct ScalingOptions {
  std::vector<unsigned> chips;
  std::vector<int> widths = {128, 256, 512};  ///< of the bus, bit
  std::size_t poses = 200;  ///< of each class; a batch ends with its longest queries, when chips are idle
  double chip_mhz = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> pairs;
};

/// Prints a table in Markdown. \returns the exit code: 3 if an answer is not the CPU device's
int run_scaling(const ScalingOptions& options);

}  // namespace cchip::testing

#endif
