// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random triangle pairs on the grid, by class, for comparisons of the model with the exact oracle.
#ifndef CCHIP_CAMPAIGN_PAIR_SOURCE_HPP
#define CCHIP_CAMPAIGN_PAIR_SOURCE_HPP

#include <algorithm>
#include <array>
#include <cchip/geometry.hpp>
#include <cstdint>
#include <random>
#include <utility>

namespace cchip::campaign {

/// How a pair is made. `range` below is drawn per pair from 1, 2, 5, 100 and all of the grid.
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
  degenerate,     ///< A or both collapsed to a segment or a point, often through the other one
};

struct PairClassInfo {
  PairClass value;
  const char* name;
  int weight;  ///< share of a campaign, in units of the sum of all weights
};
constexpr std::array<PairClassInfo, 11> pair_classes = {{{PairClass::general_1, "general -1..1", 8},
                                                         {PairClass::general_2, "general -2..2", 8},
                                                         {PairClass::general_5, "general -5..5", 10},
                                                         {PairClass::general_100, "general -100..100", 10},
                                                         {PairClass::general_full, "general full range", 14},
                                                         {PairClass::near_face, "vertex near face", 14},
                                                         {PairClass::near_edge, "edge near edge", 14},
                                                         {PairClass::shared_vertex, "shared vertex", 6},
                                                         {PairClass::shared_edge, "shared edge", 4},
                                                         {PairClass::coplanar, "coplanar", 6},
                                                         {PairClass::degenerate, "degenerate", 6}}};

/// Endless source of pairs; the sequence depends on the arguments only.
class PairSource {
 public:
  /// \param coord_w bits of a coordinate, 4..20
  PairSource(int coord_w, std::uint64_t seed);

  /// Index into pair_classes, drawn by weight.
  std::size_t draw_class();
  /// A pair with eta = 0, triangles or what is left of them.
  GridPair draw(PairClass c);

 private:
  int integer(int least, int greatest) { return std::uniform_int_distribution<int>(least, greatest)(random_); }
  bool coin() { return integer(0, 1) == 1; }
  int draw_range();
  Vec3i point(int range);
  GridPrimitive triangle(int range);
  /// A point and steps that keep it and its neighbours within the range.
  struct Lattice {
    Vec3i origin, u, v;
    Vec3i at(int i, int j) const { return origin + i * u + j * v; }
  };
  Lattice lattice(int range);
  /// Largest |i| and |j| to use with lattice(range).
  int lattice_size(int range) const;
  Vec3i beside();
  GridPair near_face();
  GridPair near_edge();
  GridPair sharing(int vertices);
  GridPair coplanar();
  GridPair degenerate();

  int least_;
  int greatest_;
  std::discrete_distribution<std::size_t> class_;
  std::mt19937_64 random_;
};

namespace detail {

/// Largest |i| and |j| on a lattice.
constexpr int lattice_size_max = 4;

inline std::discrete_distribution<std::size_t> by_weight() {
  std::array<int, pair_classes.size()> weights;
  std::transform(pair_classes.begin(), pair_classes.end(), weights.begin(), [](const auto& c) { return c.weight; });
  return {weights.begin(), weights.end()};
}

}  // namespace detail

inline PairSource::PairSource(int coord_w, std::uint64_t seed)
    : least_(-(1 << (coord_w - 1))), greatest_((1 << (coord_w - 1)) - 1), class_(detail::by_weight()), random_(seed) {}

inline std::size_t PairSource::draw_class() { return class_(random_); }

inline GridPair PairSource::draw(PairClass c) {
  const auto general = [this](int range) { return GridPair{triangle(range), triangle(range), 0}; };
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
      return near_face();
    case PairClass::near_edge:
      return near_edge();
    case PairClass::shared_vertex:
      return sharing(1);
    case PairClass::shared_edge:
      return sharing(2);
    case PairClass::coplanar:
      return coplanar();
    default:
      return degenerate();
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

inline GridPrimitive PairSource::triangle(int range) {
  GridPrimitive p;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] = point(range);
  return p;
}

inline PairSource::Lattice PairSource::lattice(int range) {
  // |origin + i u + j v| <= (1 + 2 detail::lattice_size_max) q, and one step is left on each side. Where even q = 1 is
  // too much for the grid, lattice_size() keeps i and j small.
  const int q = (std::min(range, greatest_) - 1) / (1 + 2 * detail::lattice_size_max);
  const int reach = std::max(q, 1);
  return {point(reach), point(reach), point(reach)};
}

inline int PairSource::lattice_size(int range) const {
  return std::min(range, greatest_) < 2 * (1 + 2 * detail::lattice_size_max) ? 1 : detail::lattice_size_max;
}

inline Vec3i PairSource::beside() { return coin() ? Vec3i(Vec3i::Zero()) : point(1); }

inline GridPair PairSource::near_face() {
  const int range = draw_range();
  const Lattice l = lattice(range);
  GridPair pair{triangle(range), triangle(range), 0};
  const int size = lattice_size(range);
  pair.a.v = {l.at(0, 0), l.at(size, 0), l.at(0, size), Vec3i::Zero()};
  const int i = integer(0, size);
  const int j = integer(0, size - i);
  pair.b.v[static_cast<std::size_t>(integer(0, 2))] = l.at(i, j) + beside();
  return pair;
}

inline GridPair PairSource::near_edge() {
  const int range = draw_range();
  const Lattice l = lattice(range);
  GridPair pair{triangle(range), triangle(range), 0};
  const int size = lattice_size(range);
  pair.a.v[0] = l.at(0, 0);
  pair.a.v[1] = l.at(size, 0);
  const Vec3i crossing = l.at(integer(0, size), 0) + beside();
  const int reach = std::max(size / 2, 1);
  pair.b.v[0] = crossing + l.v * integer(1, reach);
  pair.b.v[1] = crossing - l.v * integer(0, reach);
  std::rotate(pair.b.v.begin(), pair.b.v.begin() + integer(0, 2), pair.b.v.begin() + 3);
  std::rotate(pair.a.v.begin(), pair.a.v.begin() + integer(0, 2), pair.a.v.begin() + 3);
  return pair;
}

inline GridPair PairSource::sharing(int vertices) {
  const int range = draw_range();
  GridPair pair{triangle(range), triangle(range), 0};
  const int k = integer(0, 2);
  const int l = integer(0, 2);
  const int turn = coin() ? 1 : 2;
  for (int i = 0; i < vertices; ++i) {
    pair.b.v[static_cast<std::size_t>((l + turn * i) % 3)] = pair.a.v[static_cast<std::size_t>((k + i) % 3)];
  }
  return pair;
}

inline GridPair PairSource::coplanar() {
  const int range = draw_range();
  const Lattice l = lattice(range);
  const int size = lattice_size(range);
  GridPair pair;
  for (GridPrimitive* p : {&pair.a, &pair.b}) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int along = integer(-size, size);
      p->v[i] = l.at(along, integer(-size, size));
    }
  }
  return pair;
}

inline GridPair PairSource::degenerate() {
  const int range = draw_range();
  const Lattice l = lattice(range);
  const int size = lattice_size(range);
  GridPair pair{triangle(range), triangle(range), 0};
  const auto collapse = [&](GridPrimitive& p, const Vec3i& direction) {
    const int to_point = integer(0, 3) == 0 ? 0 : 1;
    for (std::size_t i = 0; i < 3; ++i) p.v[i] = l.origin + to_point * integer(-size, size) * direction;
  };
  collapse(pair.a, l.u);
  switch (integer(0, 2)) {
    case 0:
      break;
    case 1:  // B through or one step beside a point of A's line
      pair.b.v[1] = l.at(integer(-size, size), 0) + beside();
      break;
    default:
      collapse(pair.b, coin() ? l.v : l.u);
  }
  if (coin()) std::swap(pair.a, pair.b);
  return pair;
}

}  // namespace cchip::campaign

#endif
