// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random pairs on the grid, by class, for comparisons of RTL and model with the exact oracle.
#ifndef CCHIP_STIMULUS_PAIR_SOURCE_HPP
#define CCHIP_STIMULUS_PAIR_SOURCE_HPP

#include <algorithm>
#include <array>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/stimulus/quads.hpp>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace cchip::stimulus {

/// How a pair is made. `range` below is drawn per pair from 1, 2, 5, 100 and all of the grid. Quads are planar
/// and canonical in every class but the last two.
enum class PairClass {
  general_1,      ///< every coordinate in -1..1
  general_2,      ///< -2..2
  general_5,      ///< -5..5
  general_100,    ///< -100..100
  general_full,   ///< every coordinate of the grid
  near_face,      ///< a vertex of B on a grid point of A's face, or one step beside it
  near_edge,      ///< an edge of B through a grid point of an edge of A, or one step beside it
  shared_vertex,  ///< a vertex in common
  shared_edge,    ///< two vertices in common
  coplanar,       ///< all vertices in one plane
  parallel,       ///< in parallel planes, a grid step apart
  degenerate,     ///< A or both collapsed to a segment or a point, often through the other one
  collapsed,      ///< quads with two neighbouring vertices in one place, or three in a line
  warped,         ///< a pair of another class with a quad's vertex moved off its plane, by a step or anywhere
};

struct PairClassInfo {
  PairClass value;
  const char* name;
  int weight;  ///< share of a campaign, in units of the sum of all weights
};
/// The classes of every pair.
constexpr std::array<PairClassInfo, 12> pair_classes = {{{PairClass::general_1, "general -1..1", 8},
                                                         {PairClass::general_2, "general -2..2", 8},
                                                         {PairClass::general_5, "general -5..5", 10},
                                                         {PairClass::general_100, "general -100..100", 10},
                                                         {PairClass::general_full, "general full range", 14},
                                                         {PairClass::near_face, "vertex near face", 14},
                                                         {PairClass::near_edge, "edge near edge", 14},
                                                         {PairClass::shared_vertex, "shared vertex", 6},
                                                         {PairClass::shared_edge, "shared edge", 4},
                                                         {PairClass::coplanar, "coplanar", 6},
                                                         {PairClass::parallel, "parallel, one step", 6},
                                                         {PairClass::degenerate, "degenerate", 6}}};
/// Further classes of pairs with a quad.
constexpr std::array<PairClassInfo, 2> quad_classes = {
    {{PairClass::collapsed, "collapsed quad", 10}, {PairClass::warped, "warped quad", 20}}};

/// All classes of pairs of these kinds.
inline std::vector<PairClassInfo> classes_of(Kind a, Kind b) {
  std::vector<PairClassInfo> classes(pair_classes.begin(), pair_classes.end());
  if (a == Kind::quad || b == Kind::quad) classes.insert(classes.end(), quad_classes.begin(), quad_classes.end());
  return classes;
}

/// Endless source of pairs; the sequence depends on the arguments only.
class PairSource {
 public:
  /// \param coord_w bits of a coordinate, 4..20
  PairSource(int coord_w, std::uint64_t seed, Kind kind_a = Kind::tri, Kind kind_b = Kind::tri);

  /// Index into classes_of(kind_a, kind_b), drawn by weight.
  std::size_t draw_class() { return class_(random_); }
  /// A pair with eta = 0. Quads are canonical.
  GridPair draw(PairClass c);

  int integer(int least, int greatest) { return std::uniform_int_distribution<int>(least, greatest)(random_); }
  bool coin() { return integer(0, 1) == 1; }
  bool fits(const GridPair& pair) const;

 private:
  /// A point and steps that keep it and its neighbours within the range.
  struct Lattice {
    Vec3i origin, u, v;
    Vec3i at(int i, int j) const { return origin + i * u + j * v; }
  };
  int draw_range();
  Vec3i point(int range);
  Lattice lattice(int range);
  /// Largest |i| and |j| to use with lattice(range).
  int lattice_size(int range) const;
  Vec3i beside() { return coin() ? Vec3i(Vec3i::Zero()) : point(1); }
  /// Rotates the order of the vertices, and may reverse it.
  GridPrimitive turned(GridPrimitive p);
  /// With its vertices anywhere on the lattice.
  GridPrimitive on_lattice(Kind kind, const Lattice& l, int size);
  GridPrimitive primitive(Kind kind, int range);
  /// Triangle or quad with the edge from p to q.
  GridPrimitive on_edge(Kind kind, const Vec3i& p, const Vec3i& q, int range);
  GridPair candidate(PairClass c);
  GridPair near_face(int range);
  GridPair near_edge(int range);
  GridPair sharing_vertex(int range);
  GridPair sharing_edge(int range);
  GridPair in_plane(int range, bool apart);
  GridPair degenerate(int range);
  GridPrimitive collapsed(int range);
  GridPair with_collapsed(int range);
  GridPair warped();

  int least_;
  int greatest_;
  Kind kind_a_;
  Kind kind_b_;
  std::discrete_distribution<std::size_t> class_;
  std::mt19937_64 random_;
};

namespace detail {

/// Largest |i| and |j| on a lattice.
constexpr int lattice_size_max = 4;

inline std::discrete_distribution<std::size_t> by_weight(const std::vector<PairClassInfo>& classes) {
  std::vector<int> weights;
  weights.reserve(classes.size());
  for (const PairClassInfo& c : classes) weights.push_back(c.weight);
  return {weights.begin(), weights.end()};
}

inline void translate(GridPrimitive& p, const Vec3i& by) {
  for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] += by;
}

}  // namespace detail

inline PairSource::PairSource(int coord_w, std::uint64_t seed, Kind kind_a, Kind kind_b)
    : least_(-(1 << (coord_w - 1))),
      greatest_((1 << (coord_w - 1)) - 1),
      kind_a_(kind_a),
      kind_b_(kind_b),
      class_(detail::by_weight(classes_of(kind_a, kind_b))),
      random_(seed) {}

inline bool PairSource::fits(const GridPair& pair) const {
  for (const GridPrimitive* p : {&pair.a, &pair.b}) {
    for (std::size_t i = 0; i < p->vertex_count(); ++i) {
      if (p->v[i].minCoeff() < least_ || p->v[i].maxCoeff() > greatest_) return false;
    }
  }
  return true;
}

inline GridPair PairSource::draw(PairClass c) {
  while (true) {
    GridPair pair = candidate(c);
    if (fits(pair)) return pair;
  }
}

inline GridPair PairSource::candidate(PairClass c) {
  const auto general = [this](int range) { return GridPair{primitive(kind_a_, range), primitive(kind_b_, range), 0}; };
  switch (c) {
    case PairClass::general_1:
      return general(1);
    case PairClass::general_2:
      return general(2);
    case PairClass::general_5:
      return general(5);
    case PairClass::general_100:
      return general(100);
    case PairClass::general_full:
      return general(-least_);
    case PairClass::near_face:
      return near_face(draw_range());
    case PairClass::near_edge:
      return near_edge(draw_range());
    case PairClass::shared_vertex:
      return sharing_vertex(draw_range());
    case PairClass::shared_edge:
      return sharing_edge(draw_range());
    case PairClass::coplanar:
      return in_plane(draw_range(), false);
    case PairClass::parallel:
      return in_plane(draw_range(), true);
    case PairClass::degenerate:
      return degenerate(draw_range());
    case PairClass::collapsed:
      return with_collapsed(draw_range());
    default:
      return warped();
  }
}

inline int PairSource::draw_range() {
  const std::array<int, 5> ranges = {1, 2, 5, 100, -least_};
  return ranges[static_cast<std::size_t>(integer(0, 4))];
}

inline Vec3i PairSource::point(int range) {
  const int least = std::max(-range, least_);
  const int greatest = std::min(range, greatest_);
  const int x = integer(least, greatest);
  const int y = integer(least, greatest);
  const int z = integer(least, greatest);
  return {x, y, z};
}

inline PairSource::Lattice PairSource::lattice(int range) {
  // |origin + i u + j v| <= (1 + 2 lattice_size_max) q, and one step is left on each side. Where even q = 1 is
  // too much for the grid, lattice_size() keeps i and j small.
  const int q = (std::min(range, greatest_) - 1) / (1 + 2 * detail::lattice_size_max);
  const int reach = std::max(q, 1);
  return {point(reach), point(reach), point(reach)};
}

inline int PairSource::lattice_size(int range) const {
  return std::min(range, greatest_) < 2 * (1 + 2 * detail::lattice_size_max) ? 1 : detail::lattice_size_max;
}

inline GridPrimitive PairSource::turned(GridPrimitive p) {
  const auto n = static_cast<std::ptrdiff_t>(p.vertex_count());
  std::rotate(p.v.begin(), p.v.begin() + integer(0, static_cast<int>(n) - 1), p.v.begin() + n);
  if (coin()) std::reverse(p.v.begin(), p.v.begin() + n);
  return p;
}

inline GridPrimitive PairSource::on_lattice(Kind kind, const Lattice& l, int size) {
  GridPrimitive p;
  p.kind = kind;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    const int along = integer(-size, size);
    p.v[i] = l.at(along, integer(-size, size));
  }
  return turned(canonical_quad(p));
}

inline GridPrimitive PairSource::primitive(Kind kind, int range) {
  GridPrimitive p;
  p.kind = kind;
  if (kind == Kind::quad && std::min(range, greatest_) > 8)
    return on_lattice(kind, lattice(range), lattice_size(range));
  do {  // planar quads are frequent enough in small ranges
    for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] = point(range);
  } while (is_warped(p));
  return canonical_quad(p);
}

inline GridPrimitive PairSource::on_edge(Kind kind, const Vec3i& p, const Vec3i& q, int range) {
  GridPrimitive result;
  result.kind = kind;
  if (kind == Kind::tri) {
    result.v = {p, q, point(range), Vec3i::Zero()};
    return turned(result);
  }
  const Vec3i across = point(std::max(range / 3, 1));
  result.v = {p, q, q + integer(0, 3) * across, p + integer(0, 3) * across};  // a trapezoid
  return turned(result);
}

inline GridPair PairSource::near_face(int range) {
  const Lattice l = lattice(range);
  const int size = lattice_size(range);
  GridPair pair;
  pair.a.kind = kind_a_;
  pair.a.v = {l.at(0, 0), l.at(size, 0), l.at(0, size), Vec3i::Zero()};
  const int i = integer(0, size);
  const Vec3i target = l.at(i, integer(0, size - i)) + beside();
  if (kind_a_ == Kind::quad) {  // the triangle and a fourth vertex that keeps it convex
    const int far = integer(0, size);
    pair.a.v = {l.at(0, 0), l.at(size, 0), l.at(size, far), l.at(0, size)};
    if (coin()) pair.a.v[2] = l.at(size, size);
  }
  pair.a = turned(pair.a);
  pair.b = primitive(kind_b_, range);
  if (kind_b_ == Kind::tri) {
    pair.b.v[static_cast<std::size_t>(integer(0, 2))] = target;
  } else {
    detail::translate(pair.b, target - pair.b.v[static_cast<std::size_t>(integer(0, 3))]);
  }
  return pair;
}

inline GridPair PairSource::near_edge(int range) {
  const Lattice l = lattice(range);
  const int size = lattice_size(range);
  const Vec3i crossing = l.at(integer(0, size), 0) + beside();
  const int reach = std::max(size / 2, 1);
  const Vec3i from = crossing + l.v * integer(1, reach);
  const Vec3i to = crossing - l.v * integer(0, reach);
  const GridPrimitive a = on_edge(kind_a_, l.at(0, 0), l.at(size, 0), range);
  return {a, on_edge(kind_b_, from, to, range), 0};
}

inline GridPair PairSource::sharing_vertex(int range) {
  GridPair pair{primitive(kind_a_, range), primitive(kind_b_, range), 0};
  const Vec3i& target = pair.a.v[static_cast<std::size_t>(integer(0, static_cast<int>(kind_a_) - 1))];
  Vec3i& vertex = pair.b.v[static_cast<std::size_t>(integer(0, static_cast<int>(kind_b_) - 1))];
  if (kind_b_ == Kind::tri) {
    vertex = target;
  } else {
    detail::translate(pair.b, target - vertex);
  }
  return pair;
}

inline GridPair PairSource::sharing_edge(int range) {
  const GridPrimitive a = primitive(kind_a_, range);
  const int k = integer(0, static_cast<int>(kind_a_) - 1);
  const Vec3i& p = a.v[static_cast<std::size_t>(k)];
  const Vec3i& q = a.v[static_cast<std::size_t>((k + 1) % static_cast<int>(kind_a_))];
  return {a, on_edge(kind_b_, p, q, range), 0};
}

inline GridPair PairSource::in_plane(int range, bool apart) {
  const Lattice l = lattice(range);
  const int size = lattice_size(range);
  GridPair pair{on_lattice(kind_a_, l, size), on_lattice(kind_b_, l, size), 0};
  if (apart) {
    Vec3i by = Vec3i::Zero();
    by[integer(0, 2)] = coin() ? 1 : -1;
    detail::translate(pair.b, by);
  }
  return pair;
}

inline GridPair PairSource::degenerate(int range) {
  const Lattice l = lattice(range);
  const int size = lattice_size(range);
  GridPair pair{primitive(kind_a_, range), primitive(kind_b_, range), 0};
  const auto collapse = [&](GridPrimitive& p, const Vec3i& direction) {
    const int to_point = integer(0, 3) == 0 ? 0 : 1;
    for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] = l.origin + to_point * integer(-size, size) * direction;
  };
  const bool first = coin();
  GridPrimitive& line = first ? pair.a : pair.b;
  GridPrimitive& other = first ? pair.b : pair.a;
  collapse(line, l.u);
  switch (integer(0, 2)) {
    case 0:
      break;
    case 1:  // the other one through or one step beside a point of the line
      detail::translate(other, l.at(integer(-size, size), 0) + beside() - other.v[1]);
      break;
    default:
      collapse(other, coin() ? l.v : l.u);
  }
  return pair;
}

inline GridPrimitive PairSource::collapsed(int range) {
  GridPrimitive p = primitive(Kind::tri, range);
  p.kind = Kind::quad;
  p.v[3] = p.v[2];
  if (coin()) {  // V3 between V2 and V0
    const Vec3i half = point(std::max(range / 3, 1));
    p.v[2] = p.v[0] + 2 * half;
    p.v[3] = p.v[0] + half;
  }
  return turned(p);
}

inline GridPair PairSource::with_collapsed(int range) {
  GridPair pair = coin() ? near_face(range) : GridPair{primitive(kind_a_, range), primitive(kind_b_, range), 0};
  const Vec3i corner = pair.a.v[1];
  const bool both = coin();
  if (kind_a_ == Kind::quad && (both || kind_b_ == Kind::tri)) pair.a = collapsed(range);
  if (kind_b_ == Kind::quad) pair.b = collapsed(range);
  if (coin()) detail::translate(pair.b, corner - pair.b.v[0] + beside());
  return pair;
}

inline GridPair PairSource::warped() {
  constexpr std::array<PairClass, 7> bases = {PairClass::general_5, PairClass::general_100, PairClass::general_full,
                                              PairClass::near_face, PairClass::near_edge,   PairClass::shared_vertex,
                                              PairClass::parallel};
  const PairClass base = bases[static_cast<std::size_t>(integer(0, static_cast<int>(bases.size()) - 1))];
  while (true) {
    GridPair pair = draw(base);
    const int range = draw_range();
    const bool near = coin();
    const bool both = coin();
    if (kind_a_ == Kind::quad && (both || kind_b_ == Kind::tri)) {
      Vec3i& v = pair.a.v[static_cast<std::size_t>(integer(0, 3))];
      v = near ? Vec3i(v + point(1)) : point(range);
    }
    if (kind_b_ == Kind::quad) {
      Vec3i& v = pair.b.v[static_cast<std::size_t>(integer(0, 3))];
      v = near ? Vec3i(v + point(1)) : point(range);
    }
    if (!is_warped(pair.a) && !is_warped(pair.b)) continue;
    // moving a vertex may have spoilt the order of quads that stay planar
    pair.a = canonical_quad(pair.a);
    pair.b = canonical_quad(pair.b);
    if (fits(pair)) return pair;
  }
}

}  // namespace cchip::stimulus

#endif
