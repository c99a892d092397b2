// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/levels/exact_sat.hpp>
#include <utility>

namespace cchip::levels {
namespace {

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

}  // namespace cchip::levels
