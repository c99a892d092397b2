// SPDX-License-Identifier: Apache-2.0
/// \file
/// Made-up verdicts for the tests of the programme logic.
#ifndef CCHIP_TESTS_UNIT_PROGRAMME_TOOLS_HPP
#define CCHIP_TESTS_UNIT_PROGRAMME_TOOLS_HPP

#include <cchip/internal/model/programme.hpp>

#include "bench.hpp"

namespace cchip::test {

/// Any verdict that the pipeline can give, for any axis: a zero has no sign, a certain sign is not zero, a certain
/// gap is a gap. Deep verdicts are likely, so that pairs stay deep through many of them.
/// \param zero_axes components that are zero in both normals of the pair, bit mask 0..6: where the programme looks at a
/// component of both, it is the largest of one and they are parallel
inline model::Verdict random_verdict(Random& random, int separated_percent, unsigned zero_axes) {
  model::Verdict v;
  v.compare.separated = chance(random, separated_percent);
  v.compare.certain_gap = v.compare.separated && chance(random, 50);
  v.box.separated = chance(random, separated_percent);
  v.box.certain_gap = v.box.separated && chance(random, 50);
  const int zeros = chance(random, 15) ? 100 : chance(random, 50) ? 0 : 30;
  const int certains = chance(random, 60) ? 95 : 60;
  for (std::size_t i = 0; i < model::max_points; ++i) {
    v.compare.zero[i] = chance(random, zeros);
    v.compare.negative[i] = !v.compare.zero[i] && chance(random, 50);
  }
  v.compare.certain = chance(random, certains);
  v.compare.clear = chance(random, 60);
  v.compare.deep = chance(random, 99);
  const bool no_normal = chance(random, 10);
  for (std::size_t d = 0; d < 3; ++d) {
    v.axis_zero[d] = no_normal || (zero_axes >> d & 1U) != 0;
    v.axis_negative[d] = !v.axis_zero[d] && chance(random, 50);
  }
  do {
    v.axis_largest = static_cast<int>(random() % 3);
  } while ((zero_axes >> v.axis_largest & 1U) != 0);
  return v;
}

/// For random_verdict(): mostly no component.
inline unsigned random_zero_axes(Random& random) {
  return chance(random, 60) ? 0 : static_cast<unsigned>(random() % 7);
}

/// A field of a record of up to 64 bits that holds `value`.
constexpr std::uint64_t in_field(defs::Field field, std::uint64_t value) { return value << field.lsb; }

/// Record PLAN of what the normals of a pair lead to.
inline std::uint64_t plan_bits(const model::Options& options, const model::State& plan) {
  const model::Sides& s = plan.sides;
  const auto signs = [](const std::array<int, 3>& n, bool zero) {
    std::uint64_t bits = 0;
    for (std::size_t d = 0; d < 3; ++d) bits |= (zero ? n[d] == 0 : n[d] < 0) ? 1U << d : 0U;
    return bits;
  };
  std::uint64_t info = 0;
  if (plan.programme == Programme::tetrahedron) {
    info =
        in_field(defs::info_tetrahedron_warped_a, s.warped_a) | in_field(defs::info_tetrahedron_warped_b, s.warped_b);
  } else if (plan.programme == Programme::degenerate) {
    info = in_field(defs::info_degenerate_a_negative, signs(s.normal_a, false)) |
           in_field(defs::info_degenerate_a_zero, signs(s.normal_a, true)) |
           in_field(defs::info_degenerate_b_negative, signs(s.normal_b, false)) |
           in_field(defs::info_degenerate_b_zero, signs(s.normal_b, true));
  } else if (plan.programme == Programme::coplanar) {
    const auto largest = static_cast<std::size_t>(s.largest);
    info = in_field(defs::info_coplanar_a_negative, s.normal_a[largest] < 0) |
           in_field(defs::info_coplanar_b_negative, s.normal_b[largest] < 0);
  } else {
    info = in_field(defs::info_crossing_k_up, plan.second.k) | in_field(defs::info_crossing_l_up, plan.second.l) |
           in_field(defs::info_crossing_warped_a, s.warped_a) | in_field(defs::info_crossing_warped_b, s.warped_b);
  }
  return in_field(defs::plan_programme, static_cast<std::uint64_t>(plan.programme)) |
         in_field(defs::plan_code, to_bits(plan.code)) | in_field(defs::plan_info, info) |
         in_field(defs::plan_open, !options.warped_exact && (s.warped_a || s.warped_b)) |
         in_field(defs::plan_certain, s.certain);
}

/// Writes a verdict to the pins <PREFIX>separated, ..., of which the first `points` slots exist.
#define CCHIP_PUT_VERDICT(top, PREFIX, v, points)                                            \
  do {                                                                                       \
    (top).PREFIX##separated = (v).compare.separated ? 1 : 0;                                 \
    (top).PREFIX##certain_gap = (v).compare.certain_gap ? 1 : 0;                             \
    (top).PREFIX##negative = static_cast<CData>(bit_vector((v).compare.negative, (points))); \
    (top).PREFIX##zero = static_cast<CData>(bit_vector((v).compare.zero, (points)));         \
    (top).PREFIX##certain = (v).compare.certain ? 1 : 0;                                     \
    (top).PREFIX##clear = (v).compare.clear ? 1 : 0;                                         \
    (top).PREFIX##deep = (v).compare.deep ? 1 : 0;                                           \
    (top).PREFIX##axis_negative = static_cast<CData>(bit_vector((v).axis_negative, 3));      \
    (top).PREFIX##axis_zero = static_cast<CData>(bit_vector((v).axis_zero, 3));              \
    (top).PREFIX##axis_largest = static_cast<CData>((v).axis_largest);                       \
    (top).PREFIX##box_separated = (v).box.separated ? 1 : 0;                                 \
    (top).PREFIX##box_certain = (v).box.certain_gap ? 1 : 0;                                 \
  } while (false)

/// The first n flags, number 0 in bit 0.
template <std::size_t N>
unsigned bit_vector(const std::array<bool, N>& flags, std::size_t n) {
  unsigned bits = 0;
  for (std::size_t i = 0; i < n; ++i) bits |= flags.at(i) ? 1U << i : 0U;
  return bits;
}

}  // namespace cchip::test

#endif
