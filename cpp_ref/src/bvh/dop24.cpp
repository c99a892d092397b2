// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/bvh/dop24.hpp>
#include <cmath>
#include <limits>

namespace cchip {
namespace {

/// Twice the error bound of a sum of three terms with the absolute values summing up to `magnitude`; the other half
/// covers the rounding of what this is added to.
double margin(double magnitude) { return 2 * std::numeric_limits<double>::epsilon() * magnitude; }

}  // namespace

Dop24 make_dop24(const Primitive& p) {
  Dop24 dop;
  for (std::size_t d = 0; d < dop24_directions.size(); ++d) {
    const auto& [x, y, z] = dop24_directions[d];
    const bool rounds = std::abs(x) + std::abs(y) + std::abs(z) > 1;
    for (std::size_t i = 0; i < p.vertex_count(); ++i) {
      const double position = x * p.v[i].x() + y * p.v[i].y() + z * p.v[i].z();
      const double error = rounds ? margin(p.v[i].lpNorm<1>()) : 0;
      dop.least[d] = i == 0 ? position - error : std::min(dop.least[d], position - error);
      dop.greatest[d] = i == 0 ? position + error : std::max(dop.greatest[d], position + error);
    }
  }
  return dop;
}

bool overlap(const Dop24& p, const Dop24& q) {
  for (std::size_t d = 0; d < dop24_directions.size(); ++d) {
    // not a number, where doubles overflowed, is less than nothing
    if (p.greatest[d] < q.least[d] || q.greatest[d] < p.least[d]) return false;
  }
  return true;
}

}  // namespace cchip
