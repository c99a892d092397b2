// SPDX-License-Identifier: Apache-2.0
/// \file
/// One pair on its way from the input to the output.
#ifndef CCHIP_STIMULUS_PAIR_JOB_HPP
#define CCHIP_STIMULUS_PAIR_JOB_HPP

#include <cchip/primitive.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cchip {

struct PairJob {
  Primitive a;
  Primitive b;
  /// Line of the input file, or number of the candidate pair, counted from 1.
  std::uint64_t row = 0;
  /// Values that go to the output unchanged, in the order of the output columns.
  std::vector<std::string> passed;
  /// The answer that the input expects, if it was asked to be compared.
  std::optional<bool> expected;
};

}  // namespace cchip

#endif
