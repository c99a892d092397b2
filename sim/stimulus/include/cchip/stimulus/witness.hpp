// SPDX-License-Identifier: Apache-2.0
/// \file
/// Witnesses checked by hand: the axis of a code from the definitions in docs/develop/architecture.md, written out in
/// wide integers, and the intervals of all vertices on it.
#ifndef CCHIP_STIMULUS_WITNESS_HPP
#define CCHIP_STIMULUS_WITNESS_HPP

#include <algorithm>
#include <array>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/sim/int128.hpp>
#include <stdexcept>

namespace cchip::stimulus {

using WideVector = std::array<sim::Int128, 3>;

namespace detail {

inline WideVector from_to(const GridPrimitive& p, std::size_t from, std::size_t to) {
  const Vec3i d = p.v[to] - p.v[from];
  return {d.x(), d.y(), d.z()};
}
inline WideVector cross(const WideVector& e, const WideVector& f) {
  return {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
}
inline WideVector unit(std::size_t d) {
  WideVector u{};
  u.at(d) = 1;
  return u;
}
/// Sides 0..n-1; of a quad also 4 = V0V2, 5 = V1V3.
inline WideVector edge(const GridPrimitive& p, std::size_t k) {
  const std::size_t n = p.vertex_count();
  if (k < n) return from_to(p, k, (k + 1) % n);
  if (n == 4 && k == 4) return from_to(p, 0, 2);
  if (n == 4 && k == 5) return from_to(p, 1, 3);
  throw std::invalid_argument("axis_vector: no edge " + std::to_string(k));
}
/// k = 0 of the primitive, 1..4 of the face without vertex k - 1.
inline WideVector normal(const GridPrimitive& p, std::size_t k) {
  if (k == 0 && p.kind == Kind::tri) return cross(from_to(p, 0, 1), from_to(p, 0, 2));
  if (k == 0) {  // of the canonical quad: zero for some orders of the vertices in a plane, but the plane is the same
    const GridPrimitive c = canonical_quad(p);
    return cross(from_to(c, 0, 2), from_to(c, 1, 3));
  }
  if (k > 4 || p.kind == Kind::tri) throw std::invalid_argument("axis_vector: no face " + std::to_string(k));
  std::array<std::size_t, 3> face{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i != k - 1) face[count++] = i;
  }
  return cross(from_to(p, face[0], face[1]), from_to(p, face[0], face[2]));
}

}  // namespace detail

/// \throws std::invalid_argument the code names no axis of this pair
inline WideVector axis_of(const AxisCode& code, const GridPair& pair) {
  switch (code.cls) {
    case AxisClass::normal_a:
      return detail::normal(pair.a, code.k);
    case AxisClass::normal_b:
      return detail::normal(pair.b, code.k);
    case AxisClass::cross:
      return detail::cross(detail::edge(pair.a, code.k), detail::edge(pair.b, code.l));
    case AxisClass::in_plane_a:
      return detail::cross(detail::edge(pair.a, code.k), detail::unit(code.l));
    case AxisClass::in_plane_b:
      return detail::cross(detail::edge(pair.b, code.k), detail::unit(code.l));
    case AxisClass::box:
      return detail::unit(code.l);
    default:
      throw std::invalid_argument("axis_of: class " + std::to_string(static_cast<int>(code.cls)));
  }
}

/// True if the projections of all vertices of A and all of B onto the axis are disjoint intervals.
inline bool witness_separates(const AxisCode& code, const GridPair& pair) {
  const WideVector axis = axis_of(code, pair);
  const auto interval = [&](const GridPrimitive& p) {
    std::array<sim::Int128, 4> s{};
    const auto n = static_cast<std::ptrdiff_t>(p.vertex_count());
    for (std::size_t i = 0; i < p.vertex_count(); ++i) {
      s[i] = axis[0] * p.v[i].x() + axis[1] * p.v[i].y() + axis[2] * p.v[i].z();
    }
    return std::pair(*std::min_element(s.begin(), s.begin() + n), *std::max_element(s.begin(), s.begin() + n));
  };
  const auto a = interval(pair.a);
  const auto b = interval(pair.b);
  return a.second < b.first || b.second < a.first;
}

}  // namespace cchip::stimulus

#endif
