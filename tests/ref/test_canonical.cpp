// SPDX-License-Identifier: Apache-2.0
// Quads on small grids, all or sampled: the hull stays, the form is canonical. The hull is judged by the exact
// oracle, with a point as partner.
#include <catch2/catch.hpp>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/coplanar.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <set>

#include "random_pairs.hpp"

using namespace cchip_test;
using cchip::canonical_order;
using cchip::canonical_quad;
using cchip::is_canonical;

namespace {

using Vec3l = Eigen::Matrix<std::int64_t, 3, 1>;

GridPrimitive quad(const Vec3i& v0, const Vec3i& v1, const Vec3i& v2, const Vec3i& v3) {
  return {Kind::quad, {v0, v1, v2, v3}};
}

/// Point number n of the grid 0..size-1 in each direction.
Vec3i grid_point(int n, int size) { return {n % size, n / size % size, n / (size * size)}; }

bool holds(const GridPrimitive& p, const Vec3i& point) {
  return cchip::exact_intersects(GridPair{p, {Kind::tri, {point, point, point, point}}, 0});
}

bool holds_all(const GridPrimitive& p, const GridPrimitive& vertices) {
  for (const Vec3i& v : vertices.v) {
    if (!holds(p, v)) return false;
  }
  return true;
}

std::string text_of(const GridPrimitive& p) { return describe({p, p, 0}); }

/// The definition of canonical: V1 off the plane; or all on one line; or a planar outline whose four corner triangles
/// and diagonals turn the same way.
bool is_canonical_by_definition(const GridPrimitive& p) {
  const auto cross = [&](std::size_t from, std::size_t to, std::size_t from2, std::size_t to2) {
    const Vec3l e = (p.v[to] - p.v[from]).cast<std::int64_t>();
    const Vec3l f = (p.v[to2] - p.v[from2]).cast<std::int64_t>();
    return Vec3l(e.y() * f.z() - e.z() * f.y(), e.z() * f.x() - e.x() * f.z(), e.x() * f.y() - e.y() * f.x());
  };
  const Vec3l normal = cross(0, 2, 1, 3);
  if (normal.dot((p.v[1] - p.v[0]).cast<std::int64_t>()) != 0) return true;
  if (normal.isZero()) return cchip::is_degenerate(p);
  for (std::size_t i = 0; i < 4; ++i) {
    if (cross(i, (i + 1) % 4, (i + 1) % 4, (i + 2) % 4).dot(normal) < 0) return false;
  }
  return true;
}

void check_quad(const GridPrimitive& p) {
  const GridPrimitive c = canonical_quad(p);
  if (is_canonical(p) != is_canonical_by_definition(p)) FAIL(text_of(p));
  if (!is_canonical_by_definition(c) || !holds_all(p, c) || !holds_all(c, p)) FAIL(text_of(p) + " ->" + text_of(c));
  if (is_canonical(p) && c.v != p.v) FAIL(text_of(p));
  if (canonical_quad(c).v != c.v) FAIL(text_of(p));
}

}  // namespace

TEST_CASE("canonical: every quad of the 0..1 grid", "[ref][canonical]") {
  std::size_t changed = 0;
  for (int n = 0; n < 8 * 8 * 8 * 8; ++n) {
    const GridPrimitive p =
        quad(grid_point(n % 8, 2), grid_point(n / 8 % 8, 2), grid_point(n / 64 % 8, 2), grid_point(n / 512, 2));
    check_quad(p);
    changed += !is_canonical(p);
  }
  CHECK(changed > 0);
}

TEST_CASE("canonical: every planar quad of a 4 x 4 grid", "[ref][canonical]") {
  std::size_t doubled = 0;
  for (int n = 0; n < 16 * 16 * 16 * 16; ++n) {
    GridPrimitive p;
    p.kind = Kind::quad;
    int rest = n;
    for (Vec3i& v : p.v) {
      v = {rest % 4, rest / 4 % 4, rest % 4 + rest / 4 % 4};  // the plane z = x + y
      rest /= 16;
    }
    check_quad(p);
    const std::set<std::size_t> used = [&] {
      const auto order = canonical_order(p);
      return std::set<std::size_t>(order.begin(), order.end());
    }();
    doubled += used.size() == 3;
  }
  CHECK(doubled > 0);
}

TEST_CASE("canonical: quads of the -1..1 grid and of wide grids, sampled", "[ref][canonical]") {
  for (const int limit : {1, 3, 1000, 32767}) {
    PairSource source(-limit, limit, static_cast<std::uint64_t>(limit));
    for (int i = 0; i < 20000; ++i) {
      for (const PairClass c : pair_classes) check_quad(source.pair(c, Kind::quad, Kind::quad).a);
    }
  }
}

TEST_CASE("canonical: at the ends of the widest grid", "[ref][canonical]") {
  const int low = -(1 << (cchip::defs::coord_w_max - 1));
  const int high = -low - 1;
  for (int n = 0; n < 4096; ++n) {
    GridPrimitive p;
    p.kind = Kind::quad;
    for (int i = 0; i < 12; ++i) p.v[static_cast<std::size_t>(i / 3)][i % 3] = (n >> i & 1) != 0 ? high : low;
    // a test in 32 bits would overflow; the same quad on the 0..1 grid must give the same order
    GridPrimitive small = p;
    for (Vec3i& v : small.v) v = v.unaryExpr([](int c) { return c > 0 ? 1 : 0; });
    REQUIRE(canonical_order(p) == canonical_order(small));
  }
}

TEST_CASE("canonical: what becomes of some quads", "[ref][canonical]") {
  const Vec3i o(0, 0, 0);
  const Vec3i x(2, 0, 0);
  const Vec3i y(0, 2, 0);
  const Vec3i xy(2, 2, 0);
  const Vec3i z(0, 0, 2);
  using Order = std::array<std::size_t, 4>;
  CHECK(canonical_order(quad(o, x, xy, y)) == Order{0, 1, 2, 3});
  CHECK(canonical_order(quad(o, y, xy, x)) == Order{0, 1, 2, 3});
  CHECK(canonical_order(quad(o, x, xy, xy)) == Order{0, 1, 2, 3});  // the triangle as a quad
  CHECK(canonical_order(quad(o, x, y, z)) == Order{0, 1, 2, 3});    // warped, in any order
  CHECK(canonical_order(quad(o, o, x, x)) == Order{0, 1, 2, 3});    // a segment
  CHECK(canonical_order(quad(o, xy, x, y)) != Order{0, 1, 2, 3});   // crosses itself
  CHECK(is_canonical(canonical_quad(quad(o, xy, x, y))));
  CHECK(canonical_order(quad(o, x, xy, x)) != Order{0, 1, 2, 3});  // V1 = V3: folded
  const Vec3i inside(1, 1, 0);
  const Vec3i far(8, 0, 0);
  const Vec3i top(0, 8, 0);
  CHECK(canonical_order(quad(o, far, inside, top)) == Order{0, 1, 3, 3});
  CHECK(canonical_order(quad(inside, o, far, top)) == Order{1, 2, 3, 3});
  const GridPrimitive triangle{Kind::tri, {o, x, y, z}};
  CHECK(is_canonical(triangle));
  CHECK(canonical_quad(triangle).v == triangle.v);
}
