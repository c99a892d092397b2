// SPDX-License-Identifier: Apache-2.0
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>

#include "exact/hulls.hpp"

namespace cchip {
namespace {

using exact::Hull;
using exact::Vec;

/// The grid's integer. 32-bit coordinates need 3 x 33 + 3 bits.
using Int128 = boost::multiprecision::int128_t;
Vec<Int128> to_int128(const Vec3i& p) { return {p.x(), p.y(), p.z()}; }

Hull<Int128> grid_hull(const GridPrimitive& p) {
  std::array<Vec<Int128>, 4> points;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) points[i] = to_int128(p.v[i]);
  return {points, p.vertex_count()};
}

}  // namespace

bool exact_intersects(const GridPair& pair) { return hulls_meet(grid_hull(pair.a), grid_hull(pair.b)); }

Relation exact_relation(const GridPair& pair) { return exact::relation_of(grid_hull(pair.a), grid_hull(pair.b)); }

}  // namespace cchip
