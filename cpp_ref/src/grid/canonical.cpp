// SPDX-License-Identifier: Apache-2.0
// Every product below is a component of a cross product of two differences, at most 2 (2^W - 1)^2, or a 3x3
// determinant of differences, at most 4 (2^W - 1)^3 with its partial sums: 63 bits for W = 20.
#include <Eigen/Geometry>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/coplanar.hpp>

namespace cchip {
namespace {

using Vec3l = Eigen::Matrix<std::int64_t, 3, 1>;
using Order = std::array<std::size_t, 4>;

Vec3l difference(const Vec3i& p, const Vec3i& q) { return p.cast<std::int64_t>() - q.cast<std::int64_t>(); }

Vec3l quad_normal(const std::array<Vec3i, 4>& v) { return difference(v[2], v[0]).cross(difference(v[3], v[1])); }

/// A component of a normal that is not zero; the plane's points keep their order if it is dropped.
int nonzero_component(const Vec3l& normal) { return normal[0] != 0 ? 0 : normal[1] != 0 ? 1 : 2; }

int sign(std::int64_t value) { return (value > 0) - (value < 0); }

/// Turn from p over q to r in a plane whose normals have a component d.
int turn(const Vec3i& p, const Vec3i& q, const Vec3i& r, int d) {
  return sign(difference(q, p).cross(difference(r, q))[d]);
}

/// Planar quad with a normal that is not zero: no turn against it.
bool is_weakly_convex(const std::array<Vec3i, 4>& v, const Vec3l& normal) {
  const int d = nonzero_component(normal);
  for (std::size_t i = 0; i < 4; ++i) {
    if (turn(v[i], v[(i + 1) % 4], v[(i + 2) % 4], d) * sign(normal[d]) < 0) return false;
  }
  return true;
}

/// p in the plane of v[i], v[j], v[k], inside their triangle and on none of its edges.
bool is_inside(const Vec3i& p, const Vec3i& a, const Vec3i& b, const Vec3i& c) {
  const Vec3l normal = difference(b, a).cross(difference(c, a));
  if (normal.isZero()) return false;
  const int d = nonzero_component(normal);
  const int around = sign(normal[d]);
  return turn(a, b, p, d) == around && turn(b, c, p, d) == around && turn(c, a, p, d) == around;
}

GridPrimitive reordered(const GridPrimitive& p, const Order& order) {
  return {p.kind, {p.v[order[0]], p.v[order[1]], p.v[order[2]], p.v[order[3]]}};
}

}  // namespace

bool is_canonical(const GridPrimitive& p) {
  if (p.kind == Kind::tri) return true;
  const Vec3l normal = quad_normal(p.v);
  if (normal.isZero()) return is_degenerate(p);
  return normal.dot(difference(p.v[1], p.v[0])) != 0 || is_weakly_convex(p.v, normal);
}

std::array<std::size_t, 4> canonical_order(const GridPrimitive& p) {
  constexpr std::array<Order, 3> cycles = {{{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 1, 3, 2}}};
  for (const Order& order : cycles) {
    if (is_canonical(reordered(p, order))) return order;
  }
  // No cyclic order of four points in a plane is weakly convex: one lies inside the triangle of the others.
  constexpr std::array<Order, 4> triangles = {{{1, 2, 3, 3}, {0, 2, 3, 3}, {0, 1, 3, 3}, {0, 1, 2, 2}}};
  std::size_t inner = 0;
  while (inner < 3 &&
         !is_inside(p.v[inner], p.v[triangles[inner][0]], p.v[triangles[inner][1]], p.v[triangles[inner][2]])) {
    ++inner;
  }
  return triangles[inner];
}

GridPrimitive canonical_quad(const GridPrimitive& p) { return reordered(p, canonical_order(p)); }

}  // namespace cchip
