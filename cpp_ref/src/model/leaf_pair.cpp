// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/model/leaf_pair.hpp>

namespace cchip::model {
namespace {

__extension__ typedef __int128 Wide;

using bvh::NodeKind;
using Coordinates = std::array<std::int64_t, 3>;

constexpr int unit_of(int extent) { return extent - 48; }
constexpr int eta_unknown = 15;

/// value 2^exponent to nearest, halves up; `lost` is set if that rounds.
std::int64_t scaled(Wide value, int exponent, bool& lost) {
  if (exponent >= 0) return static_cast<std::int64_t>(value * (Wide{1} << exponent));
  const Wide half = Wide{1} << (-exponent - 1);
  lost = lost || (value & (2 * half - 1)) != 0;
  return static_cast<std::int64_t>((value + half) >> -exponent);
}

/// factor 2^exponent, rounded up.
std::int64_t bound(std::int64_t factor, int exponent) {
  if (exponent >= 0) return factor << exponent;
  return (factor + (std::int64_t{1} << -exponent) - 1) >> -exponent;
}

MovedVertices move_a(const bvh::LeafLine& leaf, NodeKind kind, const std::array<std::int32_t, 3>& origin_b, int extent,
                     const Query& query) {
  const int unit = unit_of(extent);
  const int step = bvh::leaf_step(kind, leaf.extent) - query.shift;  // in B's unit
  MovedVertices moved;
  Coordinates origin = {};
  for (std::size_t i = 0; i < 3; ++i) {
    Wide exact =
        query.t[i] * (Wide{1} << (22 + query.shift)) - origin_b[i] * (Wide{1} << (30 + query.shift));  // 2^-(54+shift)
    for (std::size_t j = 0; j < 3; ++j) exact += Wide{query.m[i][j]} * leaf.origin[j];
    origin[i] = scaled(exact, -54 - query.shift - unit, moved.origin_lost);
  }
  for (std::size_t n = 0; n < bvh::vertices_in(kind); ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      Wide sum = 0;
      for (std::size_t j = 0; j < 3; ++j) sum += Wide{query.m[i][j]} * leaf.vertex[n][j];
      moved.vertex[n][i] = origin[i] + scaled(sum, step - query_m_fraction - unit, moved.lost[n]);
    }
  }
  // Twice: the query's error; half a step of the leaf on each axis, where rows of |M| add up to less than 2.
  moved.error = bound(query.error, 1 - query_error_fraction - unit);
  if (leaf.rounded) moved.error += bound(1, step + 1 - unit);
  return moved;
}

MovedVertices move_b(const bvh::LeafLine& leaf, NodeKind kind, int extent) {
  const int unit = unit_of(extent);
  const int step = bvh::leaf_step(kind, leaf.extent);
  MovedVertices moved;
  for (std::size_t n = 0; n < bvh::vertices_in(kind); ++n) {
    for (std::size_t i = 0; i < 3; ++i) moved.vertex[n][i] = scaled(leaf.vertex[n][i], step - unit, moved.lost[n]);
  }
  if (leaf.rounded) moved.error += bound(1, step - unit);
  return moved;
}

/// Bound, in units, on twice the error of the vertices first .. first + count - 1. Each rounding is off by at most half
/// a unit.
std::int64_t error_of(const MovedVertices& moved, std::size_t first, std::size_t count) {
  bool lost = false;
  for (std::size_t n = first; n < first + count; ++n) lost = lost || moved.lost[n];
  return moved.error + (moved.origin_lost ? 1 : 0) + (lost ? 1 : 0);
}

Kind primitive_kind(NodeKind kind) { return kind == NodeKind::quad ? Kind::quad : Kind::tri; }

}  // namespace

MovedLeaves move_leaves(const bvh::LeafLine& a, NodeKind kind_a, const bvh::LeafLine& b, NodeKind kind_b,
                        const Query& query) {
  const int extent = std::max({a.extent - query.shift, b.extent, extent_least});
  return {move_a(a, kind_a, b.origin, extent, query), move_b(b, kind_b, extent), a.open || b.open};
}

GridPair normalise(const MovedLeaves& leaves, NodeKind kind_a, std::size_t index_a, NodeKind kind_b,
                   std::size_t index_b, int coord_w) {
  GridPair pair;
  pair.a.kind = primitive_kind(kind_a);
  pair.b.kind = primitive_kind(kind_b);
  Coordinates least = leaves.a.vertex[3 * index_a];
  Coordinates greatest = least;
  const auto each = [&](const auto& visit) {
    for (std::size_t n = 0; n < pair.a.vertex_count(); ++n) visit(leaves.a.vertex[3 * index_a + n], pair.a.v[n]);
    for (std::size_t n = 0; n < pair.b.vertex_count(); ++n) visit(leaves.b.vertex[3 * index_b + n], pair.b.v[n]);
  };
  each([&](const Coordinates& vertex, Vec3i&) {
    for (std::size_t i = 0; i < 3; ++i) {
      least[i] = std::min(least[i], vertex[i]);
      greatest[i] = std::max(greatest[i], vertex[i]);
    }
  });
  const std::int64_t span = std::max({greatest[0] - least[0], greatest[1] - least[1], greatest[2] - least[2]});
  const auto half = [](int n) { return n > 0 ? std::int64_t{1} << (n - 1) : 0; };
  int n = 0;
  while ((span + half(n)) >> n >= std::int64_t{1} << coord_w) ++n;
  bool lost = false;
  each([&](const Coordinates& vertex, Vec3i& on_grid) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t x = vertex[i] - least[i];
      lost = lost || (x & ((std::int64_t{1} << n) - 1)) != 0;
      on_grid[static_cast<Eigen::Index>(i)] =
          static_cast<std::int32_t>(((x + half(n)) >> n) - (std::int64_t{1} << (coord_w - 1)));
    }
  });
  const std::int64_t error = std::max(error_of(leaves.a, 3 * index_a, pair.a.vertex_count()),
                                      error_of(leaves.b, 3 * index_b, pair.b.vertex_count()));
  if (leaves.open) {
    pair.eta = eta_unknown;
  } else if (error > 0 || lost) {
    pair.eta = static_cast<int>(std::min<std::int64_t>(eta_unknown, 1 + bound(error, -n)));
  }
  return pair;
}

}  // namespace cchip::model
