// SPDX-License-Identifier: Apache-2.0
#include <cchip/model/sat.hpp>

namespace cchip::model {

std::int64_t wrap(std::uint64_t value, int width) {
  const int unused = 64 - width;
  return static_cast<std::int64_t>(value << unused) >> unused;
}

namespace {

std::uint64_t bits(std::int64_t value) { return static_cast<std::uint64_t>(value); }

Word3 difference(const Vec3i& to, const Vec3i& from) {
  return {std::int64_t{to.x()} - from.x(), std::int64_t{to.y()} - from.y(), std::int64_t{to.z()} - from.z()};
}

}  // namespace

std::int64_t mul_wide(std::int64_t a, std::int64_t b, int a_w, int b_w) { return wrap(bits(a) * bits(b), a_w + b_w); }

std::int64_t dot3(const Word3& a, const Word3& b, int a_w, int b_w) {
  std::uint64_t sum = 0;
  for (std::size_t d = 0; d < 3; ++d) sum += bits(a[d]) * bits(b[d]);
  return wrap(sum, a_w + b_w);
}

Word3 cross3(const Word3& a, const Word3& b, int e_w) {
  Word3 q;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t u = (d + 1) % 3;
    const std::size_t v = (d + 2) % 3;
    q[d] = wrap(bits(a[u]) * bits(b[v]) - bits(a[v]) * bits(b[u]), 2 * e_w);
  }
  return q;
}

Selection sat_select(const AxisCode& code, const GridPrimitive& a, const GridPrimitive& b) {
  const auto& v = a.v;
  const auto& w = b.v;
  if (code.cls == AxisClass::cross) {
    const std::size_t k = code.k, l = code.l;
    return {v[k], v[(k + 1) % 3], w[l], w[(l + 1) % 3], {v[(k + 2) % 3], w[l], w[(l + 2) % 3]}};
  }
  if (code.cls == AxisClass::normal_b) return {w[0], w[1], w[0], w[2], {v[0], v[1], v[2]}};
  return {v[0], v[1], v[0], v[2], {w[0], w[1], w[2]}};
}

Word3 sat_axis(const Selection& s, int coord_w) {
  return cross3(difference(s.e_to, s.e_from), difference(s.f_to, s.f_from), defs::edge_w(coord_w));
}

Projections sat_project(const Word3& axis, const Vec3i& reference, const std::array<Vec3i, 3>& points, int coord_w) {
  Projections out{{}, axis == Word3{0, 0, 0}};
  for (std::size_t i = 0; i < 3; ++i) {
    out.p[i] = dot3(difference(points[i], reference), axis, defs::edge_w(coord_w), defs::axis_w(coord_w));
  }
  return out;
}

Verdict sat_compare(bool cross, const Word3& p, int proj_w) {
  const Word3 between = cross ? Word3{wrap(bits(p[1]) - bits(p[0]), proj_w), p[1], p[2]} : p;
  const std::int64_t last = cross ? wrap(bits(p[2]) - bits(p[0]), proj_w) : p[2];
  Verdict v;
  v.separated = (between[0] < 0 && between[1] < 0 && between[2] < 0 && last < 0) ||
                (between[0] > 0 && between[1] > 0 && between[2] > 0 && last > 0);
  for (std::size_t i = 0; i < 3; ++i) {
    v.negative[i] = p[i] < 0;
    v.zero[i] = p[i] == 0;
  }
  return v;
}

Verdict sat_pipeline(const AxisCode& code, const GridPrimitive& a, const GridPrimitive& b, int coord_w) {
  const Selection s = sat_select(code, a, b);
  const Projections projections = sat_project(sat_axis(s, coord_w), s.e_from, s.points, coord_w);
  Verdict v = sat_compare(code.cls == AxisClass::cross, projections.p, defs::proj_w(coord_w));
  v.axis_zero = projections.axis_zero;
  return v;
}

std::uint16_t to_bits(const AxisCode& code) {
  return static_cast<std::uint16_t>(static_cast<unsigned>(code.cls) << 6 | unsigned{code.k} << 3 | code.l);
}

AxisCode axis_code_from_bits(std::uint16_t bits) {
  return {static_cast<AxisClass>(bits >> 6 & 7), static_cast<std::uint8_t>(bits >> 3 & 7),
          static_cast<std::uint8_t>(bits & 7)};
}

AxisCode exhaustive_axis(int beat) {
  if (beat == 0) return {AxisClass::normal_a, 0, 0};
  if (beat == 1) return {AxisClass::normal_b, 0, 0};
  return {AxisClass::cross, static_cast<std::uint8_t>((beat - 2) / 3), static_cast<std::uint8_t>((beat - 2) % 3)};
}

Outcome exhaustive(const GridPair& pair, int coord_w) {
  Outcome out;
  out.grid = true;
  out.beats = defs::exhaustive_beats_tri_tri;
  for (int beat = 0; beat < out.beats; ++beat) {
    const AxisCode code = exhaustive_axis(beat);
    const Verdict v = sat_pipeline(code, pair.a, pair.b, coord_w);
    if (v.separated && out.grid) {
      out.grid = false;
      out.witness = code;
    }
    if (beat < 2 && v.axis_zero) out.special = true;
    if (beat == 0 && v.zero[0] && v.zero[1] && v.zero[2]) out.special = true;
  }
  return out;
}

}  // namespace cchip::model
