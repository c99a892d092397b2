// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/tree/dop26.hpp>

#include "rounding.hpp"

namespace cchip::bvh {
namespace {

struct Bounds {
  double least;
  double greatest;
};

Bounds operator+(const Bounds& p, const Bounds& q) {
  return {sum_down(p.least, q.least), sum_up(p.greatest, q.greatest)};
}
Bounds operator-(const Bounds& p, const Bounds& q) {
  return {sum_down(p.least, -q.greatest), sum_up(p.greatest, -q.least)};
}

/// Positions of a point on the directions, in their order.
std::array<Bounds, directions.size()> positions(const Vec3d& point) {
  const Bounds x = {point.x(), point.x()};
  const Bounds y = {point.y(), point.y()};
  const Bounds z = {point.z(), point.z()};
  const Bounds sum = x + y;
  const Bounds difference = x - y;
  return {x, y, z, sum, difference, x + z, x - z, y + z, y - z, sum + z, sum - z, difference + z, z - difference};
}

}  // namespace

Dop26 make_dop26(const Vec3d& point) {
  const auto at = positions(point);
  Dop26 dop;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    dop.least[d] = at[d].least;
    dop.greatest[d] = at[d].greatest;
  }
  return dop;
}

Dop26 make_dop26(const Primitive& p) {
  Dop26 dop = make_dop26(p.v[0]);
  for (std::size_t i = 1; i < p.vertex_count(); ++i) dop = enclose(dop, make_dop26(p.v[i]));
  return dop;
}

Dop26 enclose(const Dop26& p, const Dop26& q) {
  Dop26 both;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    both.least[d] = std::min(p.least[d], q.least[d]);
    both.greatest[d] = std::max(p.greatest[d], q.greatest[d]);
  }
  return both;
}

bool overlap(const Dop26& p, const Dop26& q) {
  for (std::size_t d = 0; d < directions.size(); ++d) {
    // Written so that a NaN, which an overflow may leave, separates nothing.
    if (p.greatest[d] < q.least[d] || q.greatest[d] < p.least[d]) return false;
  }
  return true;
}

}  // namespace cchip::bvh
