// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/model/programme.hpp>
#include <stdexcept>

namespace cchip::model {
namespace {

AxisCode axis(AxisClass cls, std::size_t k = 0, std::size_t l = 0) {
  return {cls, static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(l)};
}

int sign_of(bool negative, bool zero) { return zero ? 0 : negative ? -1 : 1; }
bool is_zero(const std::array<int, 3>& normal) { return normal[0] == 0 && normal[1] == 0 && normal[2] == 0; }

/// A normal, and the sides of it on which the other primitive's vertices lie: the last points of the verdict.
template <class Signs>
void record_normal(Sides& s, const Shape& shape, const Verdict& v, std::array<int, 3>& normal, std::size_t vertices,
                   Signs& sides) {
  const std::size_t first = shape.points() - vertices;
  for (std::size_t i = 0; i < vertices; ++i) {
    sides[i] = sign_of(v.compare.negative[first + i], v.compare.zero[first + i]);
  }
  s.certain = s.certain && v.compare.clear;
  for (std::size_t d = 0; d < 3; ++d) normal[d] = sign_of(v.axis_negative[d], v.axis_zero[d]);
}
/// First edge k of a primitive with n vertices that leads from the side `from` to its opposite.
std::size_t crossing_edge(const std::array<int, 4>& side, std::size_t n, bool from_positive) {
  bool any_negative = false;
  for (std::size_t i = 0; i < n; ++i) any_negative = any_negative || side[i] < 0;
  const auto positive = [&](std::size_t i) { return side[i] > 0 || (side[i] == 0 && any_negative); };
  for (std::size_t i = 0; i < n; ++i) {
    if (positive(i) == from_positive && positive((i + 1) % n) != from_positive) return i;
  }
  return 0;
}

bool warped(const Sides& s) { return s.warped_a || s.warped_b; }

/// The facet normals of A - B: faces of the warped quads, then all cross axes. Without a warped quad the grid's answer
/// is a hit already and only `deep` is asked for.
State tetrahedron(const Sides& s, int beats, bool deep) {
  State next;
  next.programme = Programme::tetrahedron;
  next.code = s.warped_a   ? axis(AxisClass::normal_a, 1)
              : s.warped_b ? axis(AxisClass::normal_b, 1)
                           : axis(AxisClass::cross);
  next.beats = beats;
  next.sides = s;
  next.deep = deep;
  return next;
}

/// State::deep after this verdict. Zero axes and in-plane axes are no facet normals of a solid A - B; it is flat if
/// both normals are zero.
bool still_deep(const State& s, const Verdict& v) {
  const bool in_plane = s.code.cls == AxisClass::in_plane_a || s.code.cls == AxisClass::in_plane_b;
  const bool flat = s.programme == Programme::degenerate && is_zero(s.sides.normal_a) && is_zero(s.sides.normal_b);
  return s.deep && !flat && (v.compare.deep || v.zero_axis() || in_plane);
}

/// t(k, l) is the projection of W_l; a certain hit has t > 0 on the first, t < 0 on the second crossing axis.
bool certain_crossing(const Options& o, const Verdict& v, bool second) {
  return v.compare.certain && v.compare.negative[sign_slot(o.shape)] == second;
}

/// A warped quad in the CROSSING programme: if its hit is not certain, TETRAHEDRON decides.
bool must_be_certain(const Options& o, const Sides& s) { return o.warped_exact && warped(s); }

/// Next axis of a programme; nullopt after the last.
std::optional<AxisCode> next_code(const Options& o, const State& s) {
  const AxisCode& c = s.code;
  const std::size_t k = c.k, l = c.l;
  switch (s.programme) {
    case Programme::normals:
      return axis(AxisClass::normal_b);
    case Programme::exhaustive:
      if (c.cls == AxisClass::normal_a) return axis(AxisClass::normal_b);
      if (c.cls == AxisClass::normal_b) return axis(AxisClass::cross);
      if (l + 1 < o.shape.b) return axis(AxisClass::cross, k, l + 1);
      if (k + 1 < o.shape.a) return axis(AxisClass::cross, k + 1, 0);
      return std::nullopt;
    case Programme::crossing:
      if (c == s.second) return std::nullopt;
      return s.second;
    case Programme::coplanar:
      if (c.cls == AxisClass::in_plane_a) {
        return k + 1 < o.shape.a ? axis(c.cls, k + 1, l) : axis(AxisClass::in_plane_b, 0, l);
      }
      return k + 1 < o.shape.b ? std::optional(axis(c.cls, k + 1, l)) : std::nullopt;
    case Programme::degenerate:
      if (c.cls == AxisClass::cross) {
        if (l + 1 < o.shape.b) return axis(AxisClass::cross, k, l + 1);
        if (k + 1 < o.shape.a) return axis(AxisClass::cross, k + 1, 0);
        return axis(AxisClass::in_plane_a);
      }
      if (l < 2) return axis(c.cls, k, l + 1);
      if (c.cls == AxisClass::in_plane_a) {
        return k + 1 < o.shape.a ? axis(c.cls, k + 1, 0) : axis(AxisClass::in_plane_b);
      }
      return k + 1 < o.shape.b ? std::optional(axis(c.cls, k + 1, 0)) : std::nullopt;
    case Programme::tetrahedron: {
      const std::size_t edges_a = s.sides.warped_a ? 6 : o.shape.a;
      const std::size_t edges_b = s.sides.warped_b ? 6 : o.shape.b;
      if (c.cls == AxisClass::normal_a) {
        if (k < 4) return axis(c.cls, k + 1);
        return s.sides.warped_b ? axis(AxisClass::normal_b, 1) : axis(AxisClass::cross);
      }
      if (c.cls == AxisClass::normal_b) return k < 4 ? axis(c.cls, k + 1) : axis(AxisClass::cross);
      if (l + 1 < edges_b) return axis(AxisClass::cross, k, l + 1);
      if (k + 1 < edges_a) return axis(AxisClass::cross, k + 1, 0);
      return std::nullopt;
    }
    case Programme::illegal:
      break;
  }
  return std::nullopt;
}

Outcome make_outcome(const Options& o, const State& s, bool grid, const AxisCode& witness, bool certain, int err) {
  Outcome out;
  out.grid = grid;
  out.witness = witness;
  out.beats = s.beats + 1;
  const bool open = grid && !certain && !o.warped_exact && warped(s.sides);
  out.definite = !open && (err == 0 || (err != defs::err_unknown && certain));
  return out;
}

}  // namespace

void record_normal_a(Sides& s, const Shape& shape, const Verdict& v) {
  record_normal(s, shape, v, s.normal_a, shape.b, s.b);
  s.largest = v.axis_largest;
  s.warped_a = shape.a == 4 && !v.compare.zero[0];
}
void record_normal_b(Sides& s, const Shape& shape, const Verdict& v) {
  record_normal(s, shape, v, s.normal_b, shape.a, s.a);
  s.warped_b = shape.b == 4 && !v.compare.zero[0];
}

State plan(const Options& o, const Sides& s, int beats) {
  State next;
  next.beats = beats;
  next.sides = s;
  bool all_zero = true;
  for (std::size_t j = 0; j < o.shape.b; ++j) all_zero = all_zero && s.b[j] == 0;
  if (must_be_certain(o, s) && !s.certain) {
    next = tetrahedron(s, beats, false);
  } else if (!warped(s) && (is_zero(s.normal_a) || is_zero(s.normal_b))) {
    next.programme = Programme::degenerate;
    next.code = axis(AxisClass::cross);
  } else if (!warped(s) && all_zero) {
    next.programme = Programme::coplanar;
    next.code = axis(AxisClass::in_plane_a, 0, static_cast<std::size_t>(s.largest));
  } else {
    next.programme = Programme::crossing;
    next.code = axis(AxisClass::cross, crossing_edge(s.a, o.shape.a, true), crossing_edge(s.b, o.shape.b, true));
    next.second = axis(AxisClass::cross, crossing_edge(s.a, o.shape.a, false), crossing_edge(s.b, o.shape.b, false));
    next.certain = s.certain;
  }
  return next;
}

State first_state(const Options& o, PairMode mode, int err) {
  State s;
  s.deep = o.depth && err != 0 && err != defs::err_unknown;
  if (mode == PairMode::exhaustive) s.programme = Programme::exhaustive;
  if (mode > PairMode::directed) s.programme = Programme::illegal;
  s.code = axis(s.programme == Programme::illegal ? AxisClass::illegal : AxisClass::normal_a);
  return s;
}

AxisBeat beat_of(const State& s, int err) {
  AxisBeat beat{s.code, true, true, err};
  if (s.code.cls == AxisClass::in_plane_a || s.code.cls == AxisClass::in_plane_b) {
    const int n = s.code.cls == AxisClass::in_plane_a ? s.sides.normal_a[s.code.l] : s.sides.normal_b[s.code.l];
    // the own vertices lie on the side of sign(-n_d)
    beat.allow_above = n >= 0;
    beat.allow_below = n <= 0;
  }
  return beat;
}

std::optional<State> following_beat(const Options& o, const State& s) {
  if (s.programme != Programme::exhaustive) return std::nullopt;
  const auto code = next_code(o, s);
  if (!code) return std::nullopt;
  State next = s;
  next.code = *code;
  ++next.beats;
  return next;
}

namespace {

Step advance_exhaustive(const Options& o, const State& s, const Verdict& v, int err, Exhaustive& found) {
  if (s.code.cls == AxisClass::normal_a) {
    found = {};
    found.deep = s.deep;
    record_normal_a(found.sides, o.shape, v);
    found.certain = found.sides.certain;
  } else if (s.code.cls == AxisClass::normal_b) {
    record_normal_b(found.sides, o.shape, v);
    found.plan = plan(o, found.sides, 0);
    found.certain = found.plan.certain;
  } else if (s.code == found.plan.code || s.code == found.plan.second) {
    found.certain = found.certain && certain_crossing(o, v, s.code == found.plan.second);
  }
  found.deep = found.deep && still_deep(s, v);
  if (v.compare.separated && !found.separated) {
    found.separated = true;
    found.certain_gap = v.compare.certain_gap;
    found.witness = s.code;
  }
  if (following_beat(o, s)) return {};
  if (found.separated) return {make_outcome(o, s, false, found.witness, found.certain_gap, err), std::nullopt};
  if (found.plan.programme == Programme::crossing && (found.certain || !must_be_certain(o, found.sides))) {
    State last = s;
    last.sides = found.sides;
    const bool certain = found.certain || (found.deep && !warped(found.sides));
    return {make_outcome(o, last, true, {}, certain, err), std::nullopt};
  }
  if (found.plan.programme == Programme::crossing) {
    return {std::nullopt, tetrahedron(found.sides, s.beats + 1, found.deep)};
  }
  State next = found.plan;
  next.deep = found.deep;
  next.beats = s.beats + 1;
  return {std::nullopt, next};
}

}  // namespace

Step advance(const Options& o, const State& s, const Verdict& v, int err, Exhaustive& found) {
  if (s.programme == Programme::exhaustive) return advance_exhaustive(o, s, v, err, found);
  if (s.programme == Programme::illegal) {
    Outcome out;
    out.grid = true;
    out.witness = axis(AxisClass::illegal);
    return {out, std::nullopt};
  }
  if (s.programme == Programme::degenerate && s.code.cls == AxisClass::cross && s.code.k == 0 && v.box.separated) {
    return {make_outcome(o, s, false, axis(AxisClass::box, 0, s.code.l), v.box.certain_gap, err), std::nullopt};
  }
  if (v.compare.separated) return {make_outcome(o, s, false, s.code, v.compare.certain_gap, err), std::nullopt};
  State next = s;
  next.beats = s.beats + 1;
  next.deep = still_deep(s, v);
  if (s.programme == Programme::normals) {
    if (s.code.cls == AxisClass::normal_a) {
      record_normal_a(next.sides, o.shape, v);
      next.code = axis(AxisClass::normal_b);
      return {std::nullopt, next};
    }
    record_normal_b(next.sides, o.shape, v);
    State planned = plan(o, next.sides, next.beats);
    planned.deep = next.deep;
    return {std::nullopt, planned};
  }
  if (s.programme == Programme::crossing) {
    next.certain = s.certain && certain_crossing(o, v, s.code == s.second);
    // a warped quad hits here only if it is certain
    if (must_be_certain(o, s.sides) && !next.certain) {
      return {std::nullopt, tetrahedron(s.sides, next.beats, next.deep)};
    }
    // a hit that the signs leave open: do the other axes prove it?
    if (s.code == s.second && !next.certain && next.deep && !warped(s.sides)) {
      return {std::nullopt, tetrahedron(s.sides, next.beats, true)};
    }
  }
  const bool shallow_hit = s.programme == Programme::tetrahedron && !warped(s.sides) && !next.deep;
  if (shallow_hit) return {make_outcome(o, s, true, {}, false, err), std::nullopt};
  if (const auto code = next_code(o, s)) {
    next.code = *code;
    return {std::nullopt, next};
  }
  const bool complete = s.programme == Programme::tetrahedron || s.programme == Programme::degenerate;
  const bool certain = complete ? next.deep : s.programme == Programme::crossing && next.certain;
  return {make_outcome(o, s, true, {}, certain, err), std::nullopt};
}

Outcome run_programme(const Options& o, const GridPair& pair, PairMode mode, int coord_w) {
  State s = first_state(o, mode, pair.eta);
  Exhaustive found;
  for (;;) {
    const Verdict v = sat_pipeline(o.shape, beat_of(s, pair.eta), pair.a, pair.b, coord_w);
    const Step step = advance(o, s, v, pair.eta, found);
    if (step.outcome) return *step.outcome;
    const auto next = step.next ? step.next : following_beat(o, s);
    s = *next;
  }
}

}  // namespace cchip::model
