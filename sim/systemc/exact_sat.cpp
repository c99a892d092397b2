// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/levels/exact_sat.hpp>
#include <utility>

namespace cchip::levels {
namespace {

// __extension__ (no warning about a type outside ISO C++) needs typedef. The longest product here has 110 bits.
__extension__ typedef __int128 Wide;  // NOLINT(modernize-use-using)

constexpr std::array<Integers, 3> units = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

Integers minus(const Integers& x, const Integers& y) { return {x[0] - y[0], x[1] - y[1], x[2] - y[2]}; }
Integers cross(const Integers& x, const Integers& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}
std::int64_t dot(const Integers& x, const Integers& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }

/// Equations (2) and (3): least and greatest projection.
std::pair<std::int64_t, std::int64_t> interval(const SatPrimitive& p, const Integers& axis) {
  std::pair<std::int64_t, std::int64_t> result(dot(p.vertices[0], axis), dot(p.vertices[0], axis));
  for (std::size_t i = 1; i < p.vertices.size(); ++i) {
    const std::int64_t projection = dot(p.vertices[i], axis);
    result.first = std::min(result.first, projection);
    result.second = std::max(result.second, projection);
  }
  return result;
}

bool separates(const Integers& axis, const SatPrimitive& a, const SatPrimitive& b) {
  const auto on_a = interval(a, axis);
  const auto on_b = interval(b, axis);
  return on_a.second < on_b.first || on_b.second < on_a.first;
}

}  // namespace

SatPrimitive make_sat_primitive(std::vector<Integers> vertices) {
  SatPrimitive p;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t j = i + 1; j < vertices.size(); ++j) {
      p.edges.push_back(minus(vertices[j], vertices[i]));
      for (std::size_t k = j + 1; k < vertices.size(); ++k) {
        p.normals.push_back(cross(p.edges.back(), minus(vertices[k], vertices[i])));
      }
    }
  }
  p.vertices = std::move(vertices);
  return p;
}

bool sat_intersects(const SatPrimitive& a, const SatPrimitive& b) {
  const auto is_separating = [&](const Integers& axis) { return separates(axis, a, b); };
  const auto one_separates = [&](const auto& axes) { return std::any_of(axes.begin(), axes.end(), is_separating); };
  const auto product_separates = [&](const auto& e, const auto& f) {
    for (const Integers& x : e) {
      for (const Integers& y : f) {
        if (is_separating(cross(x, y))) return true;
      }
    }
    return false;
  };
  return !(one_separates(a.normals) || one_separates(b.normals) || product_separates(a.edges, b.edges) ||
           product_separates(a.edges, units) || product_separates(b.edges, units) || one_separates(units));
}

bool sphere_intersects(const Integers& centre, std::int64_t radius, std::vector<Integers> triangle) {
  for (Integers& v : triangle) v = minus(v, centre);
  const std::int64_t square = radius * radius;
  const Wide wide_square = square;
  const Integers normal = cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0]));
  const Wide height = dot(normal, triangle[0]);  // times the normal's length
  Wide normal_square = 0;
  for (const std::int64_t x : normal) normal_square += Wide{x} * x;
  if (height * height > wide_square * normal_square) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Integers& v = triangle[i];
    const Integers to_next = minus(triangle[(i + 1) % 3], v);
    const Integers to_last = minus(triangle[(i + 2) % 3], v);
    // the vertex is beyond the sphere, the others are not nearer on this axis
    if (dot(v, v) > square && dot(v, to_next) >= 0 && dot(v, to_last) >= 0) return false;
    // so is the line of the side, and the third vertex; all times the square of its length
    const Wide length = dot(to_next, to_next);
    const Wide along = dot(v, to_next);
    const bool beyond = length * dot(v, v) - along * along > wide_square * length;
    if (beyond && length * dot(v, to_last) - along * dot(to_next, to_last) >= 0) return false;
  }
  return true;
}

}  // namespace cchip::levels
