// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pairs of triangles for the tests: text, witness checked by hand, pairs that one axis alone separates.
#ifndef CCHIP_TESTS_UNIT_PAIR_TOOLS_HPP
#define CCHIP_TESTS_UNIT_PAIR_TOOLS_HPP

#include <algorithm>
#include <array>
#include <cchip/exact_oracle.hpp>
#include <stdexcept>

#include "bench.hpp"

namespace cchip::test {

inline std::string describe(const GridPair& pair) {
  std::string text;
  for (const GridPrimitive* p : {&pair.a, &pair.b}) {
    text += p == &pair.a ? "A" : "  B";
    for (std::size_t i = 0; i < 3; ++i) {
      text += " (" + std::to_string(p->v[i].x()) + ", " + std::to_string(p->v[i].y()) + ", " +
              std::to_string(p->v[i].z()) + ")";
    }
  }
  return text;
}

/// By the definitions in DESIGN section 3.1, written out: the axis vector of a code.
inline std::array<sim::Int128, 3> axis_vector(const AxisCode& code, const GridPair& pair) {
  const auto edge = [](const GridPrimitive& p, std::size_t from, std::size_t to) {
    const Vec3i d = p.v[to % 3] - p.v[from];
    return std::array<sim::Int128, 3>{d.x(), d.y(), d.z()};
  };
  std::array<sim::Int128, 3> e{};
  std::array<sim::Int128, 3> f{};
  switch (code.cls) {
    case AxisClass::normal_a:
      e = edge(pair.a, 0, 1);
      f = edge(pair.a, 0, 2);
      break;
    case AxisClass::normal_b:
      e = edge(pair.b, 0, 1);
      f = edge(pair.b, 0, 2);
      break;
    case AxisClass::cross:
      if (code.k > 2 || code.l > 2) throw std::invalid_argument("axis_vector: a triangle has no edge 3");
      e = edge(pair.a, code.k, code.k + 1U);
      f = edge(pair.b, code.l, code.l + 1U);
      break;
    default:
      throw std::invalid_argument("axis_vector: class " + std::to_string(static_cast<int>(code.cls)));
  }
  return {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
}

/// True if the projections of all three vertices of A and all three of B onto the axis are disjoint intervals.
inline bool axis_separates(const AxisCode& code, const GridPair& pair) {
  const auto axis = axis_vector(code, pair);
  const auto interval = [&](const GridPrimitive& p) {
    std::array<sim::Int128, 3> s{};
    for (std::size_t i = 0; i < 3; ++i) s[i] = axis[0] * p.v[i].x() + axis[1] * p.v[i].y() + axis[2] * p.v[i].z();
    return std::pair(*std::min_element(s.begin(), s.end()), *std::max_element(s.begin(), s.end()));
  };
  const auto a = interval(pair.a);
  const auto b = interval(pair.b);
  return a.second < b.first || b.second < a.first;
}

inline bool is_special(const GridPair& pair) {
  return is_degenerate(pair.a) || is_degenerate(pair.b) || is_coplanar(pair);
}

/// A pair, not coplanar nor degenerate, that this axis of the EXHAUSTIVE programme separates and no other does.
inline GridPair pair_separated_only_by(const AxisCode& code, int coord_w, std::uint64_t seed) {
  Random random(seed);
  const int range = 1 << (coord_w - 1);
  std::uniform_int_distribution<int> coordinate(-range, range - 1);
  while (true) {
    GridPair pair;
    for (GridPrimitive* p : {&pair.a, &pair.b}) {
      for (std::size_t i = 0; i < 3; ++i) p->v[i] = {coordinate(random), coordinate(random), coordinate(random)};
    }
    if (!axis_separates(code, pair) || is_special(pair)) continue;
    int separating = 0;
    for (int beat = 0; beat < defs::exhaustive_beats_tri_tri; ++beat) {
      separating += axis_separates(model::exhaustive_axis(beat), pair) ? 1 : 0;
    }
    if (separating == 1) return pair;
  }
}

}  // namespace cchip::test

#endif
