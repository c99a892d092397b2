// SPDX-License-Identifier: Apache-2.0
#include "cut_polygon.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <numeric>

namespace cchip::mesh_io {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Point = std::array<double, 2>;

Rational exact_cross(const Point& a, const Point& b, const Point& c) {
  const auto minus = [](double x, double y) { return Rational(Rational(x) - Rational(y)); };
  return minus(b[0], a[0]) * minus(c[1], a[1]) - minus(b[1], a[1]) * minus(c[0], a[0]);
}

/// Sign of the area of the triangle a, b, c: positive if counter-clockwise. Doubles decide if their error bound
/// allows it (Shewchuk, "Adaptive Precision Floating-Point Arithmetic", 1997, section 4.3), else rationals.
int turn(const Point& a, const Point& b, const Point& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]);
  const double right = (b[1] - a[1]) * (c[0] - a[0]);
  const double area = left - right;
  const double bound = 4e-16 * (std::abs(left) + std::abs(right));
  constexpr double no_underflow = 1e-280;
  if (bound > no_underflow && std::abs(area) > bound) return area > 0 ? 1 : -1;
  return exact_cross(a, b, c).sign();
}

/// The polygon seen along the axis of its largest area, counter-clockwise; empty if it has no area.
std::vector<Point> project(const std::vector<Vec3d>& polygon) {
  Vec3d normal = Vec3d::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    normal += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  std::vector<Point> points;
  for (const Vec3d& v : polygon) points.push_back({v[(axis + 1) % 3], v[(axis + 2) % 3]});
  Rational area = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) area += exact_cross(points[0], points[i], points[i + 1]);
  if (area < 0) {
    for (Point& p : points) std::swap(p[0], p[1]);
  }
  return area == 0 ? std::vector<Point>() : points;
}

bool holds(const std::array<Point, 3>& triangle, const Point& p) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto [least, greatest] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    if (p[axis] < least || p[axis] > greatest) return false;
  }
  if (std::find(triangle.begin(), triangle.end(), p) != triangle.end()) return false;
  return turn(triangle[0], triangle[1], p) >= 0 && turn(triangle[1], triangle[2], p) >= 0 &&
         turn(triangle[2], triangle[0], p) >= 0;
}

}  // namespace

bool is_convex_quad(const std::array<Vec3d, 4>& v) {
  const Vec3d normal = (v[2] - v[0]).cross(v[3] - v[1]);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d& corner = v[(i + 1) % 4];
    if ((corner - v[i]).cross(v[(i + 2) % 4] - corner).dot(normal) < 0) return false;
  }
  return true;
}

std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<Vec3d>& polygon) {
  const std::vector<Point> points = project(polygon);
  std::vector<std::size_t> left(polygon.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  const auto corner = [&](std::size_t i) { return left[i % left.size()]; };
  const auto is_ear = [&](std::size_t i) {
    if (points.empty()) return true;
    const std::array<Point, 3> triangle = {points[corner(i)], points[corner(i + 1)], points[corner(i + 2)]};
    const int side = turn(triangle[0], triangle[1], triangle[2]);
    return side == 0 || (side > 0 && std::none_of(left.begin(), left.end(),
                                                  [&](std::size_t k) { return holds(triangle, points[k]); }));
  };
  std::vector<std::array<std::size_t, 3>> triangles;
  for (std::size_t i = 0, tried = 0; left.size() > 2;) {
    if (is_ear(i)) {
      triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>((i + 1) % left.size()));
      i %= left.size();
      tried = 0;
    } else {
      i = (i + 1) % left.size();
      if (++tried == left.size()) return {};
    }
  }
  return triangles;
}

}  // namespace cchip::mesh_io
