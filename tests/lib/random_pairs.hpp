// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random pairs on the grid, by class, and their text for failure messages.
#ifndef CCHIP_TESTS_LIB_RANDOM_PAIRS_HPP
#define CCHIP_TESTS_LIB_RANDOM_PAIRS_HPP

#include <algorithm>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>
#include <cchip/program/seed.hpp>
#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>

namespace cchip_test {

using cchip::GridPair;
using cchip::GridPrimitive;
using cchip::Kind;
using cchip::Vec3i;

/// Seed of this process.
inline std::uint64_t seed() { return cchip::sim::seed_from_environment(); }

template <class P>
using VertexOf = typename decltype(P::v)::value_type;

template <class P>
P make_triangle(const VertexOf<P>& v0, const VertexOf<P>& v1, const VertexOf<P>& v2) {
  P p;
  p.v = {v0, v1, v2, VertexOf<P>::Zero()};
  return p;
}

/// Grid primitive times 2^exponent.
inline cchip::Primitive scaled(const GridPrimitive& g, int exponent) {
  cchip::Primitive p;
  p.kind = g.kind;
  for (std::size_t i = 0; i < g.vertex_count(); ++i) {
    for (int d = 0; d < 3; ++d) p.v[i][d] = std::ldexp(g.v[i][d], exponent);
  }
  return p;
}

enum class PairClass { general, coplanar, degenerate, touching, shared };
constexpr PairClass pair_classes[] = {PairClass::general, PairClass::coplanar, PairClass::degenerate,
                                      PairClass::touching, PairClass::shared};

inline const char* name(PairClass c) {
  switch (c) {
    case PairClass::general:
      return "general";
    case PairClass::coplanar:
      return "coplanar";
    case PairClass::degenerate:
      return "degenerate";
    case PairClass::touching:
      return "touching";
    default:
      return "shared vertices";
  }
}

class PairSource {
 public:
  /// Coordinates lie in least..greatest.
  PairSource(int least, int greatest, std::uint64_t stream = 0)
      : least_(least), greatest_(greatest), random_(seed() * 1000003 + stream) {}

  int integer(int least, int greatest) { return std::uniform_int_distribution<int>(least, greatest)(random_); }
  bool coin() { return integer(0, 1) == 1; }
  Vec3i point() { return {coordinate(), coordinate(), coordinate()}; }

  GridPrimitive primitive(Kind kind) {
    GridPrimitive p;
    p.kind = kind;
    for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] = point();
    return p;
  }

  GridPair pair(PairClass c, Kind kind_a = Kind::tri, Kind kind_b = Kind::tri) {
    GridPair result{primitive(kind_a), primitive(kind_b), 0};
    switch (c) {
      case PairClass::general:
        break;
      case PairClass::coplanar:
        flatten(result);
        break;
      case PairClass::degenerate:
        if (coin()) flatten(result);
        collapse(result.a);
        if (coin()) collapse(result.b);
        if (coin()) std::swap(result.a, result.b);
        break;
      case PairClass::touching:
        touch(result);
        break;
      case PairClass::shared:
        share(result);
        break;
    }
    return result;
  }

 private:
  int coordinate() { return integer(least_, greatest_); }
  std::size_t vertex(const GridPrimitive& p) {
    return static_cast<std::size_t>(integer(0, static_cast<int>(p.vertex_count()) - 1));
  }

  /// The greatest distance that a coordinate may move to either side.
  int room(int from) const { return greatest_ - std::abs(from); }

  /// Moves every vertex into one plane: z, x or y becomes an integer linear function of the others.
  void flatten(GridPair& pair) {
    const int d = integer(0, 2);
    const int p = integer(-1, 1);
    const int q = integer(-1, 1);
    for (GridPrimitive* primitive : {&pair.a, &pair.b}) {
      for (Vec3i& v : primitive->v) {
        v /= 2;  // so that sums stay in the range
        v[d] = p * v[(d + 1) % 3] + q * v[(d + 2) % 3];
      }
    }
  }

  /// To a segment or a point.
  void collapse(GridPrimitive& p) {
    const Vec3i from = p.v[0];
    const Vec3i half = (p.v[1] - from) / 2;
    const bool to_point = integer(0, 3) == 0;
    for (std::size_t i = 1; i < p.vertex_count(); ++i) p.v[i] = to_point ? from : Vec3i(from + integer(0, 2) * half);
    std::swap(p.v[vertex(p)], p.v[0]);
  }

  /// Puts a vertex of B, or the middle of an edge, on a point of A's hull; often the rest of B stays on one side
  /// of it, and sometimes B is then moved one step. Needs least = -greatest.
  void touch(GridPair& pair) {
    for (Vec3i& v : pair.a.v) v = v / 4 * 4;
    const Vec3i target = (2 * pair.a.v[vertex(pair.a)] + pair.a.v[vertex(pair.a)] + pair.a.v[vertex(pair.a)]) / 4;
    std::array<Vec3i, 4>& b = pair.b.v;
    std::size_t next = 1;
    b[0] = target;
    if (coin()) {
      Vec3i half;
      for (int d = 0; d < 3; ++d) half[d] = integer(-room(target[d]), room(target[d]));
      b[0] = target + half;
      b[next++] = target - half;
    }
    if (coin()) {
      const int d = integer(0, 2);
      for (std::size_t i = next; i < pair.b.vertex_count(); ++i) b[i][d] = std::max(b[i][d], target[d]);
    }
    if (integer(0, 3) == 0) {
      const int d = integer(0, 2);
      const int step = coin() ? 1 : -1;
      for (Vec3i& v : b) v[d] = std::clamp(v[d] + step, least_, greatest_);
    }
  }

  void share(GridPair& pair) {
    const int count = integer(1, 3);
    for (int i = 0; i < count; ++i) pair.b.v[vertex(pair.b)] = pair.a.v[vertex(pair.a)];
    if (integer(0, 2) == 0) pair.b.v[vertex(pair.b)] = point();
  }

  int least_;
  int greatest_;
  std::mt19937_64 random_;
};

inline std::string describe(const GridPair& pair) {
  std::ostringstream text;
  for (const GridPrimitive* p : {&pair.a, &pair.b}) {
    text << (p == &pair.a ? "A" : "  B");
    for (std::size_t i = 0; i < p->vertex_count(); ++i) {
      text << " (" << p->v[i].x() << ", " << p->v[i].y() << ", " << p->v[i].z() << ")";
    }
  }
  return text.str();
}

}  // namespace cchip_test

#endif
