// SPDX-License-Identifier: Apache-2.0
#include "cut_polygon.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <numeric>

namespace cchip::mesh_io {
namespace {

using Integer = boost::multiprecision::cpp_int;
using Point = std::array<double, 2>;

/// Exponent of a double's last bit, 0 for zero.
int last_bit(double x) { return x == 0 ? 0 : std::ilogb(x) - 52; }

int last_bit(const Point& p) { return std::min(last_bit(p[0]), last_bit(p[1])); }

/// x 2^-exponent; `exponent` is at most last_bit(x).
Integer scaled(double x, int exponent) {
  if (x == 0) return 0;
  const int last = last_bit(x);
  return Integer(static_cast<std::int64_t>(std::scalbn(x, -last))) << static_cast<unsigned>(last - exponent);
}

/// Twice the area of the triangle a, b, c, times 2^(-2 exponent). Integers and not rationals: coordinates of very
/// different magnitudes have denominators of a thousand bits, whose common divisors cost milliseconds.
Integer exact_cross(const Point& a, const Point& b, const Point& c, int exponent) {
  const auto minus = [exponent](double x, double y) { return Integer(scaled(x, exponent) - scaled(y, exponent)); };
  return minus(b[0], a[0]) * minus(c[1], a[1]) - minus(b[1], a[1]) * minus(c[0], a[0]);
}

/// Sign of the area of the triangle a, b, c: positive if counter-clockwise. Doubles decide if their error bound
/// allows it (Shewchuk, "Adaptive Precision Floating-Point Arithmetic", 1997, section 4.3), else integers.
int turn(const Point& a, const Point& b, const Point& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]);
  const double right = (b[1] - a[1]) * (c[0] - a[0]);
  const double area = left - right;
  const double bound = 4e-16 * (std::abs(left) + std::abs(right));
  constexpr double no_underflow = 1e-280;
  if (bound > no_underflow && std::abs(area) > bound) return area > 0 ? 1 : -1;
  return exact_cross(a, b, c, std::min({last_bit(a), last_bit(b), last_bit(c)})).sign();
}

/// A power of two that brings coordinates to magnitudes near 1, where no product overflows or becomes 0.
template <class Points>
double unit_scale(const Points& points) {
  double most = 0;
  for (const Vec3d& v : points) most = std::max(most, v.cwiseAbs().maxCoeff());
  return most == 0 ? 1 : std::ldexp(1.0, std::min(1000, -std::ilogb(most)));
}

/// The polygon seen along the axis of its largest area, counter-clockwise; empty if it has no area.
std::vector<Point> project(const std::vector<Vec3d>& polygon) {
  const double scale = unit_scale(polygon);
  const auto edge = [&](std::size_t i) -> Vec3d { return polygon[i] * scale - polygon[0] * scale; };
  Vec3d normal = Vec3d::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) normal += edge(i).cross(edge(i + 1));
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  std::vector<Point> points;
  for (const Vec3d& v : polygon) points.push_back({v[(axis + 1) % 3], v[(axis + 2) % 3]});
  int exponent = 0;
  for (const Point& p : points) exponent = std::min(exponent, last_bit(p));
  Integer area = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    area += exact_cross(points[0], points[i], points[i + 1], exponent);
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

bool is_convex_quad(const std::array<Vec3d, 4>& quad) {
  std::array<Vec3d, 4> v = quad;
  const double scale = unit_scale(v);
  for (Vec3d& corner : v) corner *= scale;
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
