// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/model/sat.hpp>
#include <cstdlib>

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

std::int64_t norm1(const Word3& v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }

/// Smallest n with 2^n >= v, for v >= 1.
int ceil_log2(std::int64_t v) {
  int n = 0;
  while ((std::int64_t{1} << n) < v) ++n;
  return n;
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

namespace {

/// End points of edge k of a primitive with n vertices and the vertices off it.
struct EdgeOf {
  std::size_t from, to;
  std::array<std::size_t, 2> others;
};
EdgeOf edge_of(std::size_t n, std::size_t k) {
  if (k == 4) return {0, 2, {1, 3}};
  if (k == 5) return {1, 3, {0, 2}};
  return {k % n, (k + 1) % n, {(k + 2) % n, (k + 3) % n}};
}

}  // namespace

Selection sat_select(const Shape& shape, const AxisCode& code, const GridPrimitive& a, const GridPrimitive& b) {
  const bool own_is_b = code.cls == AxisClass::normal_b || code.cls == AxisClass::in_plane_b;
  const GridPrimitive& own = own_is_b ? b : a;
  const GridPrimitive& other = own_is_b ? a : b;
  const std::size_t n = own_is_b ? shape.b : shape.a;
  const std::size_t m = own_is_b ? shape.a : shape.b;
  const std::size_t slots = shape.points();
  Selection s;
  if (code.cls == AxisClass::cross) {
    const EdgeOf e = edge_of(shape.a, code.k);
    const EdgeOf f = edge_of(shape.b, code.l);
    s.e_from = a.v[e.from];
    s.e_to = a.v[e.to];
    s.f_from = b.v[f.from];
    s.f_to = b.v[f.to];
    std::size_t slot = 0;
    for (std::size_t i = 0; i + 2 < shape.a; ++i) {
      s.own[slot] = true;
      s.points[slot++] = a.v[e.others[i]];
    }
    s.points[slot++] = s.f_from;
    for (std::size_t i = 0; i + 2 < shape.b; ++i) s.points[slot++] = b.v[f.others[i]];
    return s;
  }
  for (std::size_t j = 0; j < m; ++j) s.points[slots - m + j] = other.v[j];
  if (slots > m) s.points[0] = other.v[0];  // a surplus slot repeats a point
  if (code.cls == AxisClass::in_plane_a || code.cls == AxisClass::in_plane_b) {
    const EdgeOf e = edge_of(n, code.k);
    s.e_from = own.v[e.from];
    s.e_to = own.v[e.to];
    s.f_from = Vec3i::Zero();
    s.f_to = Vec3i::Unit(code.l % 3);
    return s;
  }
  if (n == 3) {
    s.e_from = own.v[0];
    s.e_to = own.v[1];
    s.f_from = own.v[0];
    s.f_to = own.v[2];
    return s;
  }
  s.own[0] = true;
  if (code.k == 0) {
    s.e_from = own.v[0];
    s.e_to = own.v[2];
    s.f_from = own.v[1];
    s.f_to = own.v[3];
    s.points[0] = own.v[1];
    return s;
  }
  // face without vertex k - 1
  const std::size_t apex = code.k - 1U;
  const std::size_t i = apex == 0 ? 1 : 0;
  const std::size_t j = apex <= 1 ? 2 : 1;
  const std::size_t l = apex <= 2 ? 3 : 2;
  s.e_from = own.v[i];
  s.e_to = own.v[j];
  s.f_from = own.v[i];
  s.f_to = own.v[l];
  s.points[0] = own.v[apex];
  return s;
}

int error_shift(int eta) { return eta <= 1 ? 0 : ceil_log2(eta); }

Axis sat_axis(const Selection& s, int coord_w) {
  const Word3 e = difference(s.e_to, s.e_from);
  const Word3 f = difference(s.f_to, s.f_from);
  return {cross3(e, f, defs::edge_w(coord_w)), norm1(e) + norm1(f)};
}

Projections sat_project(const Shape& shape, const Axis& axis, const Selection& selection, int error_shift,
                        int coord_w) {
  Projections out;
  const std::int64_t axis_norm = norm1(axis.axis);
  const std::int64_t twice_error = std::int64_t{2} << error_shift;
  out.gap_bound = axis_norm << error_shift;
  for (std::size_t i = 0; i < shape.points(); ++i) {
    const Word3 c = difference(selection.points[i], selection.e_from);
    out.p[i] = dot3(c, axis.axis, defs::edge_w(coord_w), defs::axis_w(coord_w));
    if (i == sign_slot(shape)) {
      const int n = ceil_log2(norm1(c) + twice_error);
      out.sign_bound = (axis_norm + ((axis.edge_norm + twice_error) << n)) << error_shift;
    }
  }
  for (std::size_t d = 0; d < 3; ++d) {
    out.axis_negative[d] = axis.axis[d] < 0;
    out.axis_zero[d] = axis.axis[d] == 0;
    if (std::abs(axis.axis[d]) > std::abs(axis.axis[static_cast<std::size_t>(out.axis_largest)])) {
      out.axis_largest = static_cast<int>(d);
    }
  }
  return out;
}

Comparison sat_compare(const Shape& shape, const AxisBeat& beat, const std::array<bool, 2>& own, const Projections& in,
                       int coord_w) {
  const int proj_w = defs::proj_w(coord_w);
  bool above = beat.allow_above, below = beat.allow_below;
  bool certain_above = above, certain_below = below;
  bool clear = true;
  bool deep_above = false, deep_below = false;
  const auto require = [&](std::int64_t d, bool negative) {
    clear = clear && (negative ? d < -in.gap_bound : d > in.gap_bound);
    deep_above = deep_above || d > in.gap_bound;
    deep_below = deep_below || d < -in.gap_bound;
    above = above && d > 0;
    below = below && d < 0;
    certain_above = certain_above && d > in.gap_bound;
    certain_below = certain_below && d < -in.gap_bound;
  };
  Comparison out;
  for (std::size_t i = 0; i < shape.points(); ++i) {
    out.negative[i] = in.p[i] < 0;
    out.zero[i] = in.p[i] == 0;
    if (i < 2 && own[i]) continue;
    require(in.p[i], in.p[i] < 0);
    if (own[0]) require(wrap(bits(in.p[i]) - bits(in.p[0]), proj_w), in.p[i] < 0);
    if (own[1]) require(wrap(bits(in.p[i]) - bits(in.p[1]), proj_w), in.p[i] < 0);
  }
  const std::int64_t signed_one = in.p[sign_slot(shape)];
  out.certain = signed_one > in.sign_bound || signed_one < -in.sign_bound;
  out.separated = above || below;
  out.certain_gap = certain_above || certain_below;
  out.clear = clear;
  out.deep = deep_above && deep_below;
  return out;
}

BoxComparison box_compare(const Shape& shape, const GridPrimitive& a, const GridPrimitive& b, std::size_t component,
                          int error_shift) {
  const auto range = [component](const GridPrimitive& p, std::size_t n) {
    const auto d = static_cast<Eigen::Index>(component);
    std::pair<std::int64_t, std::int64_t> r(p.v[0][d], p.v[0][d]);
    for (std::size_t i = 1; i < n; ++i) {
      r.first = std::min<std::int64_t>(r.first, p.v[i][d]);
      r.second = std::max<std::int64_t>(r.second, p.v[i][d]);
    }
    return r;
  };
  const auto [low_a, high_a] = range(a, shape.a);
  const auto [low_b, high_b] = range(b, shape.b);
  const std::int64_t gap = std::max(low_a - high_b, low_b - high_a);
  return {gap > 0, gap > (std::int64_t{1} << error_shift)};
}

Verdict sat_pipeline(const Shape& shape, const AxisBeat& beat, const GridPrimitive& a, const GridPrimitive& b,
                     int coord_w) {
  const int shift = error_shift(beat.err);
  const Selection s = sat_select(shape, beat.code, a, b);
  const Projections projections = sat_project(shape, sat_axis(s, coord_w), s, shift, coord_w);
  Verdict v;
  v.compare = sat_compare(shape, beat, s.own, projections, coord_w);
  const unsigned component = beat.code.l & 3U;  // the hardware looks at two bits
  v.box = box_compare(shape, a, b, component == 3 ? 0 : component, shift);
  v.axis_negative = projections.axis_negative;
  v.axis_zero = projections.axis_zero;
  v.axis_largest = projections.axis_largest;
  return v;
}

}  // namespace cchip::model
