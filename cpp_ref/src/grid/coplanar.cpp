// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <cchip/internal/grid/coplanar.hpp>
#include <vector>

namespace cchip {
namespace {

using Vec3l = Eigen::Matrix<std::int64_t, 3, 1>;

/// Vertices relative to the first vertex of the list.
std::vector<Vec3l> relative_vertices(const std::vector<const GridPrimitive*>& primitives) {
  const Vec3l base = primitives.front()->v[0].cast<std::int64_t>();
  std::vector<Vec3l> points;
  for (const GridPrimitive* p : primitives) {
    for (std::size_t i = 0; i < p->vertex_count(); ++i) points.emplace_back(p->v[i].cast<std::int64_t>() - base);
  }
  return points;
}

/// Normal of a plane through the origin and two of the points; zero if all lie on one line.
Vec3l any_normal(const std::vector<Vec3l>& points) {
  Vec3l direction = Vec3l::Zero();
  for (const Vec3l& p : points) {
    if (direction.isZero()) direction = p;
    const Vec3l normal = direction.cross(p);
    if (!normal.isZero()) return normal;
  }
  return Vec3l::Zero();
}

}  // namespace

bool is_degenerate(const GridPrimitive& p) { return any_normal(relative_vertices({&p})).isZero(); }

bool is_coplanar(const GridPair& pair) {
  const std::vector<Vec3l> points = relative_vertices({&pair.a, &pair.b});
  const Vec3l normal = any_normal(points);
  for (const Vec3l& p : points) {
    if (normal.dot(p) != 0) return false;
  }
  return true;
}

}  // namespace cchip
