// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bit-exact models of rtl/arith and rtl/sat: what each block computes, as values. Arithmetic is modular
/// like the hardware's; the latencies are those of <cchip/defs.hpp>.
#ifndef CCHIP_MODEL_SAT_HPP
#define CCHIP_MODEL_SAT_HPP

#include <array>
#include <cchip/defs.hpp>
#include <cchip/engine.hpp>
#include <cchip/geometry.hpp>
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

/// Outputs of macro stage 1 (cchip_sat_select), in grid steps.
struct Selection {
  Vec3i e_from, e_to, f_from, f_to;
  std::array<Vec3i, 3> points;
};
/// Outputs of macro stage 3 (cchip_sat_project).
struct Projections {
  Word3 p;
  bool axis_zero;
};
/// Outputs of macro stage 4 (cchip_sat_compare) and, with axis_zero, of cchip_sat_pipeline.
struct Verdict {
  bool separated = false;
  bool axis_zero = false;
  std::array<bool, 3> negative = {};
  std::array<bool, 3> zero = {};
};

Selection sat_select(const AxisCode& code, const GridPrimitive& a, const GridPrimitive& b);
Word3 sat_axis(const Selection& s, int coord_w);
Projections sat_project(const Word3& axis, const Vec3i& reference, const std::array<Vec3i, 3>& points, int coord_w);
/// Separated and signs; `axis_zero` is left false.
Verdict sat_compare(bool cross, const Word3& p, int proj_w);
/// The whole pipeline: one axis of one pair.
Verdict sat_pipeline(const AxisCode& code, const GridPrimitive& a, const GridPrimitive& b, int coord_w);

/// Numeric form of an axis code, {class, k, l} as in `m_result_axis`.
std::uint16_t to_bits(const AxisCode& code);
AxisCode axis_code_from_bits(std::uint16_t bits);

/// Axis `beat` (0..10) of the EXHAUSTIVE programme: nA, nB, e_k x f_l with l running first.
AxisCode exhaustive_axis(int beat);

/// What a programme finds out about a pair; beats in axes.
struct Outcome {
  bool grid = false;     ///< no axis separates
  bool special = false;  ///< coplanar or degenerate: `grid` = true is not proven by these axes
  AxisCode witness;      ///< first separating axis
  int beats = 0;
};
/// The EXHAUSTIVE programme on two triangles.
Outcome exhaustive(const GridPair& pair, int coord_w);

}  // namespace cchip::model

#endif
