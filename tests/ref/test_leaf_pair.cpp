// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cchip/internal/model/leaf_pair.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/sim/int128.hpp>
#include <cmath>
#include <random>
#include <vector>

using namespace cchip;
using bvh::LeafLine;
using bvh::NodeKind;
using sim::Int128;

namespace {

using Random = std::mt19937_64;

/// Positions of this test are integers of 2^-88 of B's unit: everything is a multiple of that, so nothing is rounded.
constexpr int fraction = 88;
Int128 at(std::int64_t value, int exponent) { return Int128{value} << (fraction + exponent); }

int number(Random& random, int least, int most) {
  return least + static_cast<int>(random() % static_cast<std::uint64_t>(most - least + 1));
}

/// A leaf that reaches 2^-shrink of its extent, which is 2^-size of its object.
LeafLine random_leaf(Random& random, NodeKind kind, int size, bool exact, int shrink) {
  const int width = kind == NodeKind::quad ? 24 : 20;
  const int most = (1 << (width - 1 - shrink)) - 1;
  LeafLine leaf;
  leaf.extent = 24 - size;
  leaf.rounded = !exact && random() % 8 != 0;
  const int zeros = leaf.rounded ? 0 : number(random, exact ? width - 8 : 0, width - 4);
  for (auto& o : leaf.origin) o = number(random, -(1 << 22), 1 << 22) >> (exact ? 20 : 0) << (exact ? 20 : 0);
  for (std::size_t n = 0; n < bvh::vertices_in(kind); ++n) {
    for (auto& x : leaf.vertex[n]) x = number(random, -most, most) >> zeros << zeros;
  }
  for (std::size_t n = 0; n < bvh::vertices_in(kind); n += 3) leaf.vertex[n][random() % 3] = most >> zeros << zeros;
  leaf.id = {1, 2};
  return leaf;
}

Query random_query(Random& random, int shift, bool exact) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Eigen::Matrix3d m =
      Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized().toRotationMatrix();
  if (exact) m = Eigen::Matrix3d::Identity();
  Query query;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double entry = m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      query.m[i][j] = static_cast<std::int32_t>(std::lround(entry * 0x1p30));
    }
  }
  query.shift = shift;
  query.error = exact || random() % 4 == 0 ? 0 : static_cast<std::uint32_t>(random() % (random() % 8 == 0 ? 4096 : 64));
  return query;
}

/// Where a coordinate of the true vertex may lie.
struct Range {
  Int128 least;
  Int128 most;
};
using Ranges = std::array<Range, 3>;

/// Of a vertex of A: within half a step of that of the leaf on each axis, the map within the query's error.
Ranges range_a(const LeafLine& leaf, NodeKind kind, std::size_t n, const Query& query) {
  Ranges ranges;
  const int step = bvh::leaf_step(kind, leaf.extent);
  for (std::size_t i = 0; i < 3; ++i) {
    Int128 exact = at(query.t[i], -query_t_fraction);
    Int128 off = at(query.error, -query_error_fraction);
    for (std::size_t j = 0; j < 3; ++j) {
      const Int128 m = query.m[i][j];
      exact += m * at(leaf.origin[j], -24 - query_m_fraction - query.shift);
      exact += m * at(leaf.vertex[n][j], step - query_m_fraction - query.shift);
      if (leaf.rounded) off += (m < 0 ? -m : m) * at(1, step - 1 - query_m_fraction - query.shift);
    }
    ranges[i] = {exact - off, exact + off};
  }
  return ranges;
}

Ranges range_b(const LeafLine& leaf, NodeKind kind, std::size_t n) {
  Ranges ranges;
  const int step = bvh::leaf_step(kind, leaf.extent);
  for (std::size_t i = 0; i < 3; ++i) {
    const Int128 exact = at(leaf.origin[i], -24) + at(leaf.vertex[n][i], step);
    const Int128 off = leaf.rounded ? at(1, step - 1) : 0;
    ranges[i] = {exact - off, exact + off};
  }
  return ranges;
}

}  // namespace

TEST_CASE("leaf pairs: differences of vertices are within eta of every true one, exactly", "[ref]") {
  Random random(sim::seed_from_environment());
  std::array<std::size_t, 16> etas = {};
  std::array<std::size_t, 16> alike = {};  // of leaves of about the same size, small errors of the query
  std::size_t tight = 0;                   // eta - 1 would have been wrong
  std::size_t exact = 0;
  for (int shift = 0; shift <= query_shift_max; ++shift) {
    for (int size_a = 4; size_a <= 16; ++size_a) {
      for (int n = 0; n < 60; ++n) {
        const auto kind_a = static_cast<NodeKind>(number(random, 1, 3));
        const auto kind_b = static_cast<NodeKind>(number(random, 1, 3));
        const bool whole = n % 8 == 7;  // nothing needs to be rounded
        // Primitives much smaller than their leaves could be: their errors take many steps of the grid.
        const int shrink = n % 8 < 3 ? number(random, 1, 10) : 0;
        const bool same = n % 2 == 0 && size_a + shift <= 16;
        const int size_b = same ? size_a + shift : number(random, 4, 16);
        const LeafLine a = random_leaf(random, kind_a, size_a, whole, shrink);
        const LeafLine b = random_leaf(random, kind_b, size_b, whole, shrink);
        Query query = random_query(random, shift, whole);
        // The leaves lie at each other, give or take their size.
        for (std::size_t i = 0; i < 3; ++i) {
          double moved = 0;
          for (std::size_t j = 0; j < 3; ++j) moved += query.m[i][j] * 0x1p-30 * std::ldexp(a.origin[j], -24 - shift);
          const double between = std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random),
                                            -std::min(size_a + shift, size_b) - shrink);
          query.t[i] = std::llround((b.origin[i] * 0x1p-24 - moved + between) * 0x1p32);
          if (whole) query.t[i] = query.t[i] >> 16 << 16;
        }
        const model::MovedLeaves moved = model::move_leaves(a, kind_a, b, kind_b, query);
        for (std::size_t p = 0; p < bvh::primitives_in(kind_a); ++p) {
          for (std::size_t q = 0; q < bvh::primitives_in(kind_b); ++q) {
            const GridPair pair = model::normalise(moved, kind_a, p, kind_b, q, 16);
            struct Vertex {
              Ranges truth;
              std::array<std::int64_t, 3> units;
              Vec3i grid;
            };
            std::vector<Vertex> vertices;
            for (std::size_t v = 0; v < pair.a.vertex_count(); ++v) {
              vertices.push_back({range_a(a, kind_a, 3 * p + v, query), moved.a.vertex[3 * p + v], pair.a.v[v]});
            }
            for (std::size_t v = 0; v < pair.b.vertex_count(); ++v) {
              vertices.push_back({range_b(b, kind_b, 3 * q + v), moved.b.vertex[3 * q + v], pair.b.v[v]});
            }
            std::int64_t span = 0;
            for (const Vertex& x : vertices) {
              for (const Vertex& y : vertices) {
                for (std::size_t i = 0; i < 3; ++i) span = std::max(span, x.units[i] - y.units[i]);
              }
            }
            int least = 0;
            while ((least > 0 ? span + (std::int64_t{1} << (least - 1)) : span) >> least > 65535) ++least;
            const int extent = std::max({a.extent - shift, b.extent, model::extent_least});
            const Int128 step = at(1, least + extent - 48);
            Int128 worst = 0;
            for (const Vertex& x : vertices) {
              for (std::size_t i = 0; i < 3; ++i) {
                const auto axis = static_cast<Eigen::Index>(i);
                REQUIRE(x.grid[axis] >= -32768);
                REQUIRE(x.grid[axis] <= 32767);
                for (const Vertex& y : vertices) {
                  if (&x == &y) continue;
                  const Int128 grid = (x.grid[axis] - y.grid[axis]) * step;
                  worst = std::max(worst, grid - (x.truth[i].least - y.truth[i].most));
                  worst = std::max(worst, x.truth[i].most - y.truth[i].least - grid);
                }
              }
            }
            if (pair.eta < 15) REQUIRE(worst <= pair.eta * step);  // 15: unknown
            if (pair.eta > 0 && pair.eta < 15) tight += worst > (pair.eta - 1) * step ? 1 : 0;
            exact += worst == 0 ? 1 : 0;
            ++etas[static_cast<std::size_t>(pair.eta)];
            if (same && shrink == 0 && !whole && query.error < 64) ++alike[static_cast<std::size_t>(pair.eta)];
          }
        }
      }
    }
  }
  WARN("eta 0: " << etas[0] << ", 1: " << etas[1] << ", 2: " << etas[2] << ", 3: " << etas[3] << ", 4: " << etas[4]
                 << ", 15: " << etas[15] << "; leaves of one size and errors below 64: " << alike[0] << ", " << alike[1]
                 << ", " << alike[2] << ", " << alike[3] << ", " << alike[4] << ", " << alike[5] << "; tight=" << tight
                 << " exact=" << exact);
  REQUIRE(etas[0] > 10);
  REQUIRE(etas[2] > 1000);
  REQUIRE(tight > 100);
}
