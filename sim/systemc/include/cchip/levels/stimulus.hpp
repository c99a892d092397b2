// SPDX-License-Identifier: Apache-2.0
/// \file
/// The input of all refinement levels: object pairs, each a run of primitive pairs of one kind with the matrix m that
/// places one primitive in the coordinates of the other (paper, section 3).
#ifndef CCHIP_LEVELS_STIMULUS_HPP
#define CCHIP_LEVELS_STIMULUS_HPP

#include <array>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/primitive.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <vector>

namespace cchip::levels {

/// Width of a coordinate on the grid, bit.
constexpr int coord_w = defs::coord_w_default;
/// Entries of a matrix are multiples of 1 / matrix_unit, so that doubles represent them and all sums exactly.
constexpr int matrix_unit = 1024;
/// Largest |entry| in the three left columns of a matrix.
constexpr int matrix_entry_max = 16;
/// Largest |coordinate| of a vertex before the matrix is applied, and of the matrix's right column, grid steps.
constexpr int unplaced_max = 1 << 19;

/// The matrix m: 3 rows of 4 entries, row by row; the right column is the translation in grid steps.
struct Matrix {
  std::array<double, 12> entry = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  friend bool operator==(const Matrix& x, const Matrix& y) { return x.entry == y.entry; }
  friend std::ostream& operator<<(std::ostream& out, const Matrix& m);
};

/// One primitive pair.
struct StimulusPair {
  std::uint64_t object_pair = 0;
  PairMode mode = PairMode::exhaustive;  ///< programme of the RTL; the answer does not depend on it
  Matrix m;                              ///< places a
  GridPrimitive a;
  GridPrimitive b;
  /// Without a value a is a triangle or quad. Else a is a point, `v[0]`, and this the radius of the sphere around it
  /// where it is placed, grid steps, 0..2^16 - 1; b is a triangle then.
  std::optional<std::int32_t> radius;
};

using Stimulus = std::vector<StimulusPair>;

/// Successive primitive pairs of one pair of objects; all of one kind.
struct ObjectPair {
  ModuleId test = ModuleId::blank;  ///< module that tests them
  std::size_t first = 0;            ///< index of the first
  std::size_t count = 0;
};

/// Module that tests the pair.
ModuleId test_of(const StimulusPair& pair);

/// The object pairs of a stimulus in their order.
std::vector<ObjectPair> object_pairs(const Stimulus& stimulus);

/// Vertices of a, 1 for a point.
std::size_t vertex_count_a(const StimulusPair& pair);

/// Vertices of `p` times `m`, rounded to the grid by floor(x + 1/2). Exact for pairs that pass check_pair().
GridPrimitive place(const Matrix& m, const GridPrimitive& p);

/// The pair on the grid, with a placed: the answer refers to it. A point is an operand of cchip_primtest_point_tri.
GridPair placed(const StimulusPair& pair);

/// \throws std::invalid_argument quad before triangle; a point with a quad or a radius out of range; an entry of the
/// matrix is too large or no multiple of 1 /
///         matrix_unit; a vertex is off the grid (for a: after it was placed)
void check_pair(const StimulusPair& pair);

/// \throws std::invalid_argument `next` cannot follow `last`: object pair that ended before, another kind in one
void check_order(const StimulusPair& last, const StimulusPair& next);

}  // namespace cchip::levels

#endif
