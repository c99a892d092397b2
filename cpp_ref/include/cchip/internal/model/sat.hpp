// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bit-exact models of rtl/arith and rtl/sat: what each block computes, as values. Arithmetic is modular
/// like the hardware's; the latencies are those of <cchip/internal/wire/definitions.hpp>.
#ifndef CCHIP_INTERNAL_MODEL_SAT_HPP
#define CCHIP_INTERNAL_MODEL_SAT_HPP

#include <array>
#include <cchip/internal/wire/pair.hpp>
#include <cstdint>

namespace cchip::model {

/// Three components, x first; each one the value of a signed vector in the RTL.
using Word3 = std::array<std::int64_t, 3>;

/// `value` modulo 2^width, read as a signed number of `width` bits (1..64).
std::int64_t wrap(std::uint64_t value, int width);

/// cchip_mul_wide (and cchip_mul18 with 18, 18): product of an a_w-bit and a b_w-bit signed factor,
/// a_w + b_w <= 64.
std::int64_t mul_wide(std::int64_t a, std::int64_t b, int a_w, int b_w);
/// cchip_dot3: a . b modulo 2^(a_w + b_w).
std::int64_t dot3(const Word3& a, const Word3& b, int a_w, int b_w);
/// cchip_cross3: a x b, each component modulo 2^(2 e_w).
Word3 cross3(const Word3& a, const Word3& b, int e_w);

/// Vertices of A and of B that a primitive test is built for; 3 or 4 each.
struct Shape {
  std::size_t a = 3;
  std::size_t b = 3;
  /// Point slots of the pipeline: 3, 4 or 5.
  std::size_t points() const { return a + b - 3; }
};
constexpr std::size_t max_points = 5;
/// The slot whose sign may have to be certain: W_l on a cross axis.
constexpr std::size_t sign_slot(const Shape& shape) { return shape.a - 2; }

/// One axis to be tried, as it enters the pipeline.
struct AxisBeat {
  AxisCode code;
  /// Sides of the axis' own primitive on which the other one may be found separated (in-plane axes are
  /// one-sided).
  bool allow_above = true;
  bool allow_below = true;
  /// eta of the pair, 0..15.
  int err = 0;
};

/// eta is rounded up to a power of two in every bound: 2^error_shift(eta), at most 16.
int error_shift(int eta);

/// Outputs of macro stage 1 (cchip_sat_select), in grid steps. `own[i]`: slot i holds a point of the
/// axis' own side; the points of the other primitive fill the last slots.
struct Selection {
  Vec3i e_from, e_to, f_from, f_to;
  std::array<Vec3i, max_points> points;
  std::array<bool, 2> own = {false, false};
};
/// Outputs of macro stage 2 (cchip_sat_axis).
struct Axis {
  Word3 axis = {};
  std::int64_t edge_norm = 0;  ///< |e|_1 + |f|_1
};
/// Outputs of macro stage 3 (cchip_sat_project).
struct Projections {
  std::array<std::int64_t, max_points> p = {};
  /// Bound on the error of p[sign_slot(shape)] (docs/develop/architecture.md, certainty).
  std::int64_t sign_bound = 0;
  /// Bound on the error of the difference of two projections onto this axis: 2^error_shift |axis|_1.
  std::int64_t gap_bound = 0;
  std::array<bool, 3> axis_negative = {};
  std::array<bool, 3> axis_zero = {};
  /// Component of the largest |axis|, the lowest of equals.
  int axis_largest = 0;
};
/// Outputs of macro stage 4 (cchip_sat_compare).
struct Comparison {
  bool separated = false;
  bool certain_gap = false;  ///< separated, also for the unrounded primitives
  std::array<bool, max_points> negative = {};
  std::array<bool, max_points> zero = {};
  bool certain = false;  ///< the sign of p[sign_slot(shape)] is that of the unrounded determinant
  /// Every other point lies beyond all own points by more than the gap bound, on either side.
  bool clear = false;
  /// The two sets overlap by more than the gap bound in both directions: some other point lies that far above some own
  /// point, and some other one that far below.
  bool deep = false;
};
/// Outputs of cchip_box_compare for one component.
struct BoxComparison {
  bool separated = false;
  bool certain_gap = false;
};
/// Outputs of cchip_sat_pipeline.
struct Verdict {
  Comparison compare;
  BoxComparison box;  ///< component l of the beat's code
  std::array<bool, 3> axis_negative = {};
  std::array<bool, 3> axis_zero = {};
  int axis_largest = 0;
  bool zero_axis() const { return axis_zero[0] && axis_zero[1] && axis_zero[2]; }
};

Selection sat_select(const Shape& shape, const AxisCode& code, const GridPrimitive& a, const GridPrimitive& b);
Axis sat_axis(const Selection& s, int coord_w);
Projections sat_project(const Shape& shape, const Axis& axis, const Selection& selection, int error_shift, int coord_w);
Comparison sat_compare(const Shape& shape, const AxisBeat& beat, const std::array<bool, 2>& own,
                       const Projections& projections, int coord_w);
BoxComparison box_compare(const Shape& shape, const GridPrimitive& a, const GridPrimitive& b, std::size_t component,
                          int error_shift);
/// The whole pipeline: one axis of one pair.
Verdict sat_pipeline(const Shape& shape, const AxisBeat& beat, const GridPrimitive& a, const GridPrimitive& b,
                     int coord_w);

}  // namespace cchip::model

#endif
