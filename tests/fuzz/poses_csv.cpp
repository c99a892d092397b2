// SPDX-License-Identifier: Apache-2.0
// Any bytes as a CSV file of poses.
#include <cchip/program/usage_error.hpp>
#include <sstream>

#include "pose.hpp"
#include "require.hpp"

using namespace cchip;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  try {
    CsvReader reader(in, "poses.csv");
    CsvRow row;
    if (!reader.next(row)) return 0;
    const app::PoseColumns columns(row, "poses.csv", size % 2 == 0 ? "touches" : "");
    while (reader.next(row)) {
      const app::PoseColumns::Row pose = columns.parse(row);
      require(pose.pose.affine().allFinite(), "entries are finite");
      require(pose.passed.size() == columns.passed_names().size(), "columns pass through");
    }
  } catch (const UsageError& error) {
    require_one_line(error);
  }
  return 0;
}
