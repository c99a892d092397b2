// SPDX-License-Identifier: Apache-2.0
// Any bytes as a CSV file of pairs.
#include <cchip/program/usage_error.hpp>
#include <cchip/stimulus/pair_columns.hpp>
#include <sstream>
#include <utility>

#include "require.hpp"

using namespace cchip;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  try {
    CsvReader reader(in, "pairs.csv");
    CsvRow row;
    if (!reader.next(row)) return 0;
    const PairColumns columns(row, "pairs.csv", {size % 2 == 0 ? "expected" : "", size % 3 == 0});
    while (reader.next(row)) {
      const PairJob job = columns.parse(std::move(row));
      require(job.passed.size() == columns.passed_names().size(), "columns pass through");
      for (const Primitive* p : {&job.a, &job.b}) {
        for (std::size_t i = 0; i < p->vertex_count(); ++i) require(p->v[i].allFinite(), "coordinates are finite");
      }
    }
  } catch (const UsageError& error) {
    require_one_line(error);
  }
  return 0;
}
