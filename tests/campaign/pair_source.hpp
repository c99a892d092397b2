// SPDX-License-Identifier: Apache-2.0
/// \file
/// Random triangle pairs on the grid, by class, for comparisons of the model with the exact oracle.
#ifndef CCHIP_CAMPAIGN_PAIR_SOURCE_HPP
#define CCHIP_CAMPAIGN_PAIR_SOURCE_HPP

#include <array>
#include <cchip/geometry.hpp>
#include <cstdint>
#include <random>

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

}  // namespace cchip::campaign

#endif
