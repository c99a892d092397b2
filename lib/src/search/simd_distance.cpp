// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set by Highway's foreach_target.h. Bounds: docs/cpp/exactness.md.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "search/simd_distance.cpp"
#include "simd_targets.hpp"
// foreach_target.h must come before the others.
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <limits>

#include "line_reach.hpp"
#include "simd_distance.hpp"
#include "simd_faces-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace cchip {
namespace HWY_NAMESPACE {

using D4 = hn::FixedTag<float, 4>;
using V4 = hn::Vec<D4>;
using M4 = hn::Mask<D4>;

/// Reaches of a node along the lanes.
HWY_INLINE void reach(const FrameSide& side, const SupportLine& line, float* to) {
  const hn::FixedTag<std::int16_t, 8> d16;
  const hn::Repartition<std::uint8_t, decltype(d16)> d8;
  const auto* const words = reinterpret_cast<const std::uint8_t*>(line.word.data());
  const auto bytes = [&d8](const std::array<std::uint16_t, reach_lanes>& from) {
    return hn::Load(d8, reinterpret_cast<const std::uint8_t*>(from.data()));
  };
  const auto axis = hn::BitCast(d16, hn::TableLookupBytes(hn::Load(d8, words), bytes(side.axis)));
  const auto corner = hn::BitCast(d16, hn::TableLookupBytes(hn::Load(d8, words + 16), bytes(side.corner)));
  const auto face = hn::BitCast(d16, hn::Or(hn::TableLookupBytesOr0(hn::Load(d8, words + 32), bytes(side.face_low)),
                                            hn::TableLookupBytesOr0(hn::Load(d8, words + 48), bytes(side.face_high))));
  const D8F d;
  const hn::Rebind<std::int32_t, D8F> d32;
  for (std::size_t at = 0; at < reach_lanes; at += lanes8) {
    const auto whole = [&](auto v) {
      if constexpr (lanes8 == reach_lanes) {
        return hn::ConvertTo(d, hn::PromoteTo(d32, v));
      } else {
        const hn::Half<hn::DFromV<decltype(v)>> half;
        return hn::ConvertTo(d, hn::PromoteTo(d32, at == 0 ? hn::LowerHalf(half, v) : hn::UpperHalf(half, v)));
      }
    };
    auto sum = hn::Mul(whole(axis), hn::Load(d, side.axis_factor.data() + at));
    sum = hn::MulAdd(whole(corner), hn::Load(d, side.corner_factor.data() + at), sum);
    sum = hn::MulAdd(whole(face), hn::Load(d, side.face_factor.data() + at), sum);
    hn::Store(sum, d, to + at);
  }
}

/// Four vectors as the columns of what they were the rows of.
HWY_INLINE void transpose(V4& p, V4& q, V4& r, V4& s) {
  const D4 d;
  const hn::Repartition<double, D4> d64;
  const auto wide = [&d64](V4 v) { return hn::BitCast(d64, v); };
  const V4 a = hn::InterleaveLower(d, p, q);
  const V4 b = hn::InterleaveLower(d, r, s);
  const V4 c = hn::InterleaveUpper(d, p, q);
  const V4 e = hn::InterleaveUpper(d, r, s);
  p = hn::BitCast(d, hn::InterleaveLower(d64, wide(a), wide(b)));
  q = hn::BitCast(d, hn::InterleaveUpper(d64, wide(a), wide(b)));
  r = hn::BitCast(d, hn::InterleaveLower(d64, wide(c), wide(e)));
  s = hn::BitCast(d, hn::InterleaveUpper(d64, wide(c), wide(e)));
}

/// Sum of the middles of nodes, along the axes of the frame.
HWY_INLINE std::array<float, 3> sum_of_middles(const std::array<std::array<float, reach_lanes>, 4>& reach,
                                               std::size_t count) {
  const D4 d;
  V4 low = hn::Zero(d);
  V4 high = hn::Zero(d);
  for (std::size_t i = 0; i < count; ++i) {
    low = hn::Add(low, hn::Load(d, reach[i].data()));
    high = hn::Add(high, hn::Load(d, reach[i].data() + 4));
  }
  alignas(32) std::array<float, reach_lanes> sum;
  hn::Store(low, d, sum.data());
  hn::Store(high, d, sum.data() + 4);
  return {0.5F * (sum[0] - sum[1]), 0.5F * (sum[2] - sum[3]), 0.5F * (sum[4] - sum[5])};
}

/// Gaps along the line between the middles of both, in the frame's unit.
struct MiddleLine {
  using Reach = BasicLineReach<float>;
  Reach a;
  Reach b;
  float offset = 0;

  HWY_INLINE MiddleLine(const DistanceFrame& frame, const NodeGaps& gaps, std::size_t count_a, std::size_t count_b) {
    const std::array<float, 3> middle_a = sum_of_middles(gaps.a, count_a);
    const std::array<float, 3> middle_b =
        sum_of_middles(gaps.b, count_b);  // its lanes are along the opposite directions
    const float per_a = 1 / static_cast<float>(count_a);
    const float per_b = 1 / static_cast<float>(count_b);
    std::array<float, 3> n;
    float square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      n[i] = frame.centre_b[i] - middle_b[i] * per_b - middle_a[i] * per_a;
      square += n[i] * n[i];
    }
    if (!(square > 0x1p-40F)) return;
    const float per_length = 1 / std::sqrt(square);
    for (float& x : n) x *= per_length;
    // n . column k of the map from each object to the frame
    const auto in_object = [&n](const std::array<float, 9>& map) {
      std::array<float, 3> m;
      for (std::size_t k = 0; k < 3; ++k) m[k] = n[0] * map[k] + n[1] * map[3 + k] + n[2] * map[6 + k];
      return m;
    };
    offset = n[0] * frame.centre_b[0] + n[1] * frame.centre_b[1] + n[2] * frame.centre_b[2] - 2 * frame.slack;
    a = Reach(in_object(frame.a.vertex), 1);
    b = Reach(in_object(frame.b.vertex), 1);
  }
};

/// Lane by lane, of four nodes.
struct Lanes {
  alignas(32) std::array<std::array<float, 4>, reach_lanes> of;

  HWY_INLINE explicit Lanes(const std::array<std::array<float, reach_lanes>, 4>& reach) {
    const D4 d;
    for (std::size_t at = 0; at < reach_lanes; at += 4) {
      std::array<V4, 4> v;
      for (std::size_t k = 0; k < 4; ++k) v[k] = hn::Load(d, reach[k].data() + at);
      transpose(v[0], v[1], v[2], v[3]);
      for (std::size_t k = 0; k < 4; ++k) hn::Store(v[k], d, of[at + k].data());
    }
  }
};

/// The pairs of four nodes of A and four of B: pair 4 i + k in lane 4 i + k of `parts` vectors.
struct Pairs {
  using V = hn::Vec<D8F>;
  static constexpr std::size_t parts = 16 / lanes8;
  static constexpr auto order = [] {
    std::array<std::int32_t, 16> at = {};
    for (std::size_t pair = 0; pair < 16; ++pair) at[pair] = static_cast<std::int32_t>(pair / 4);
    return at;
  }();
  /// \param of_a four numbers of A's nodes; each pair's own
  HWY_INLINE static V of_a(const float* of_a, std::size_t part) {
    const D8F d;
    return hn::TableLookupLanes(hn::LoadDup128(d, of_a), hn::SetTableIndices(d, order.data() + part * lanes8));
  }
  HWY_INLINE static V of_b(const float* of_b) { return hn::LoadDup128(D8F(), of_b); }
};

/// Infinite where there is no pair, 0 where there is one, by the counts of nodes.
struct NoPairs {
  alignas(32) std::array<std::array<std::array<float, 16>, 5>, 5> at = {};
  constexpr NoPairs() {
    for (std::size_t a = 0; a < 5; ++a) {
      for (std::size_t b = 0; b < 5; ++b) {
        for (std::size_t pair = 0; pair < 16; ++pair) {
          at[a][b][pair] = pair / 4 < a && pair % 4 < b ? 0 : std::numeric_limits<float>::infinity();
        }
      }
    }
  }
};
constexpr NoPairs no_pairs;

unsigned nodes(const DistanceFrame& frame, const SupportLine* a, std::uint32_t count_a, const SupportLine* b,
               std::uint32_t count_b, float least, float most, NodeGaps& gaps) {
  const D8F d;
  for (std::size_t k = 0; k < 4; ++k) {
    reach(frame.a, a[k], gaps.a[k].data());
    reach(frame.b, b[k], gaps.b[k].data());
  }
  const Lanes lanes_a(gaps.a);
  const Lanes lanes_b(gaps.b);
  const auto zero = hn::Zero(d);
  const auto shrink = hn::Set(d, frame.shrink);
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  auto left_out = infinite;
  // Those that may be as near, a bit each.
  const auto near_ones = [&](hn::Vec<D8F> square, std::size_t part) {
    hn::Store(square, d, gaps.square.data() + part * lanes8);
    const auto is_near = hn::Le(square, hn::Set(d, most));
    left_out = hn::Min(left_out, hn::IfThenElse(is_near, infinite, square));
    std::array<std::uint8_t, 8> bits = {};
    hn::StoreMaskBits(d, is_near, bits.data());
    return unsigned{bits[0]} << part * lanes8;
  };
  unsigned near = 0;
  for (std::size_t part = 0; part < Pairs::parts; ++part) {
    auto square = zero;
    for (std::size_t lane = 0; lane < 6; lane += 2) {
      const auto along = [&](std::size_t l) {
        const auto left = hn::Sub(hn::Set(d, frame.offset[l]), Pairs::of_a(lanes_a.of[l].data(), part));
        return hn::Sub(left, Pairs::of_b(lanes_b.of[l].data()));
      };
      const auto gap = hn::Max(hn::Max(along(lane), along(lane + 1)), zero);
      square = hn::MulAdd(gap, gap, square);
    }
    square = hn::Max(hn::Mul(square, shrink), hn::Set(d, least));
    square = hn::Max(square, hn::Load(d, no_pairs.at[count_a][count_b].data() + part * lanes8));
    near |= near_ones(square, part);
  }
  if (near != 0) {
    const MiddleLine line(frame, gaps, count_a, count_b);
    alignas(16) std::array<float, 4> left_a;
    alignas(16) std::array<float, 4> line_b;
    for (std::size_t k = 0; k < 4; ++k) {
      left_a[k] = line.offset - line.a.along(a[k]);
      line_b[k] = line.b.against(b[k]);
    }
    unsigned still = 0;
    for (std::size_t part = 0; part < Pairs::parts; ++part) {
      const auto gap = hn::Max(hn::Sub(Pairs::of_a(left_a.data(), part), Pairs::of_b(line_b.data())), zero);
      const auto square = hn::Load(d, gaps.square.data() + part * lanes8);
      still |= near_ones(hn::Max(square, hn::Mul(hn::Mul(gap, gap), shrink)), part);
    }
    near &= still;
  }
  gaps.left_out = hn::GetLane(hn::MinOfLanes(d, left_out));
  return near;
}

struct Point {
  V4 x, y, z;
};
HWY_INLINE Point operator-(const Point& p, const Point& q) {
  return {hn::Sub(p.x, q.x), hn::Sub(p.y, q.y), hn::Sub(p.z, q.z)};
}
HWY_INLINE Point operator+(const Point& p, const Point& q) {
  return {hn::Add(p.x, q.x), hn::Add(p.y, q.y), hn::Add(p.z, q.z)};
}
HWY_INLINE Point operator*(V4 s, const Point& p) { return {hn::Mul(s, p.x), hn::Mul(s, p.y), hn::Mul(s, p.z)}; }
HWY_INLINE V4 dot(const Point& p, const Point& q) {
  return hn::MulAdd(p.x, q.x, hn::MulAdd(p.y, q.y, hn::Mul(p.z, q.z)));
}
HWY_INLINE Point cross(const Point& p, const Point& q) {
  return {hn::MulSub(p.y, q.z, hn::Mul(p.z, q.y)), hn::MulSub(p.z, q.x, hn::Mul(p.x, q.z)),
          hn::MulSub(p.x, q.y, hn::Mul(p.y, q.x))};
}
HWY_INLINE V4 sum_of_sizes(const Point& p) { return hn::Add(hn::Abs(p.x), hn::Add(hn::Abs(p.y), hn::Abs(p.z))); }
/// Between 0 and 1; NaN becomes 0.
HWY_INLINE V4 clamped(V4 x) {
  const D4 d;
  return hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), hn::Min(x, hn::Set(d, 1)));
}

/// A triangle of each lane.
struct Triangles {
  std::array<Point, 3> v;
  std::array<Point, 3> edge;     ///< from vertex i to the next
  std::array<V4, 3> per_square;  ///< 1 / square of its length
  std::array<V4, 3> square;
  Point normal;
  V4 per_normal;  ///< 1 / square of the normal

  HWY_INLINE explicit Triangles(const std::array<Point, 3>& vertices) : v(vertices) {}
  HWY_INLINE void measure_normal() {
    const D4 d;
    for (std::size_t i = 0; i < 3; ++i) edge[i] = v[(i + 1) % 3] - v[i];
    normal = cross(edge[0], edge[1]);
    per_normal = hn::Div(hn::Set(d, 1), dot(normal, normal));
  }
  /// \pre measure_normal()
  HWY_INLINE void measure_edges() {
    const D4 d;
    for (std::size_t i = 0; i < 3; ++i) {
      square[i] = dot(edge[i], edge[i]);
      per_square[i] = hn::Div(hn::Set(d, 1), square[i]);
    }
  }
  /// At most the distance from another one, by the gap along the normal.
  HWY_INLINE V4 gap(const Triangles& other, float slack) const {
    const D4 d;
    const V4 p = dot(normal, other.v[0] - v[0]);
    const V4 q = dot(normal, other.v[1] - v[0]);
    const V4 r = dot(normal, other.v[2] - v[0]);
    const V4 own = hn::Max(hn::Abs(dot(normal, edge[0])), hn::Abs(dot(normal, edge[2])));  // 0 but for rounding
    const V4 low = hn::Min(p, hn::Min(q, r));
    const V4 high = hn::Max(p, hn::Max(q, r));
    const V4 gap = hn::NegMulAdd(sum_of_sizes(normal), hn::Set(d, slack), hn::Sub(hn::Max(low, hn::Neg(high)), own));
    return hn::IfThenElseZero(hn::And(hn::Gt(gap, hn::Zero(d)), hn::Lt(per_normal, hn::Set(d, 0x1p100F))),
                              hn::Mul(gap, hn::Mul(hn::Sqrt(per_normal), hn::Set(d, 1 - relative_slack))));
  }
};

/// At most the square of the distance of two triangles, by their gaps along the axes of the frame.
HWY_INLINE V4 square_in_frame(const Triangles& a, const Triangles& b, float slack, float shrink) {
  const D4 d;
  const auto square_of_gap = [&](V4 p, V4 q, V4 r, V4 s, V4 t, V4 u) {
    const V4 before = hn::Sub(hn::Min(s, hn::Min(t, u)), hn::Max(p, hn::Max(q, r)));
    const V4 behind = hn::Sub(hn::Min(p, hn::Min(q, r)), hn::Max(s, hn::Max(t, u)));
    const V4 gap = hn::Max(hn::Sub(hn::Max(before, behind), hn::Set(d, slack)), hn::Zero(d));
    return hn::Mul(gap, gap);
  };
  const V4 x = square_of_gap(a.v[0].x, a.v[1].x, a.v[2].x, b.v[0].x, b.v[1].x, b.v[2].x);
  const V4 y = square_of_gap(a.v[0].y, a.v[1].y, a.v[2].y, b.v[0].y, b.v[1].y, b.v[2].y);
  const V4 z = square_of_gap(a.v[0].z, a.v[1].z, a.v[2].z, b.v[0].z, b.v[1].z, b.v[2].z);
  return hn::Mul(hn::Add(x, hn::Add(y, z)), hn::Set(d, shrink));
}

/// The vector between the nearest points so far.
struct Nearest {
  Point between;
  V4 square;
  HWY_INLINE void offer(const Point& p, M4 valid) {
    const V4 here = dot(p, p);
    const M4 better = hn::And(valid, hn::Lt(here, square));
    square = hn::IfThenElse(better, here, square);
    between = {hn::IfThenElse(better, p.x, between.x), hn::IfThenElse(better, p.y, between.y),
               hn::IfThenElse(better, p.z, between.z)};
  }
  HWY_INLINE void offer(const Point& p) { offer(p, hn::Eq(p.x, p.x)); }
};

/// Vertices of `points` and the triangles' insides below them.
/// \param from_points `between` leads from the points to the triangles
template <bool from_points>
HWY_INLINE void offer_feet(const Triangles& face, const std::array<Point, 3>& points, Nearest& best) {
  const D4 d;
  const V4 zero = hn::Zero(d);
  const Point& u = face.edge[0];
  const Point v = face.v[2] - face.v[0];
  const Point along_u = face.per_normal * cross(v, face.normal);
  const Point along_v = face.per_normal * cross(face.normal, u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point w = points[i] - face.v[0];
    const V4 s = dot(w, along_u);
    const V4 t = dot(w, along_v);
    const M4 inside = hn::And(hn::And(hn::Ge(s, zero), hn::Ge(t, zero)), hn::Le(hn::Add(s, t), hn::Set(d, 1)));
    const Point foot = {hn::MulAdd(s, u.x, hn::Mul(t, v.x)), hn::MulAdd(s, u.y, hn::Mul(t, v.y)),
                        hn::MulAdd(s, u.z, hn::Mul(t, v.z))};
    best.offer(from_points ? foot - w : w - foot, inside);
  }
}

HWY_INLINE void offer_edges(const Triangles& a, const Triangles& b, Nearest& best) {
  const D4 d;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& u = a.edge[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& v = b.edge[k];
      const Point w = b.v[k] - a.v[i];
      const V4 uv = dot(u, v);
      const V4 uw = dot(u, w);
      const V4 vw = dot(v, w);
      const V4 determinant = hn::NegMulAdd(uv, uv, hn::Mul(a.square[i], b.square[k]));
      V4 s = clamped(hn::Div(hn::MulSub(uw, b.square[k], hn::Mul(vw, uv)), determinant));
      s = hn::IfThenElseZero(hn::Gt(determinant, hn::Zero(d)), s);
      const V4 t = clamped(hn::Mul(hn::MulSub(s, uv, vw), b.per_square[k]));
      s = clamped(hn::Mul(hn::MulAdd(t, uv, uw), a.per_square[i]));
      best.offer({hn::NegMulAdd(s, u.x, hn::MulAdd(t, v.x, w.x)), hn::NegMulAdd(s, u.y, hn::MulAdd(t, v.y, w.y)),
                  hn::NegMulAdd(s, u.z, hn::MulAdd(t, v.z, w.z))});
    }
  }
}

/// Vertices of a leaf in the frame: lane 4 i + v is vertex v of face i.
struct FrameLeaf {
  alignas(32) std::array<float, 8> x, y, z;
};

HWY_INLINE void load_frame(const FrameSide& side, const std::array<float, 3>& centre, const float* v, NodeRef leaf,
                           FrameLeaf& to) {
  using V = hn::Vec<D8F>;
  load_leaf(v, leaf, [&](std::size_t at, V x, V y, V z) {
    const D8F d;
    const auto row = [&](std::size_t i) {
      return hn::MulAdd(x, hn::Set(d, side.vertex[3 * i]),
                        hn::MulAdd(y, hn::Set(d, side.vertex[3 * i + 1]),
                                   hn::MulAdd(z, hn::Set(d, side.vertex[3 * i + 2]), hn::Set(d, centre[i]))));
    };
    hn::Store(row(0), d, to.x.data() + at);
    hn::Store(row(1), d, to.y.data() + at);
    hn::Store(row(2), d, to.z.data() + at);
  });
}

/// Vertex `at[p]` of the leaf in lane p.
HWY_INLINE Point vertices(const FrameLeaf& leaf, const std::array<std::uint8_t, 4>& at) {
  const D4 d;
  const auto take = [&](const std::array<float, 8>& from) {
    alignas(16) const std::array<float, 4> lanes = {from[at[0]], from[at[1]], from[at[2]], from[at[3]]};
    return hn::Load(d, lanes.data());
  };
  return {take(leaf.x), take(leaf.y), take(leaf.z)};
}

/// Bounds on the distances of the hulls of the points in each lane along an axis.
struct Span {
  V4 low, high;
};
HWY_INLINE Span span_of(const Point& axis, const Point& p, const Point& q, const Point& r, const Point& s) {
  const V4 at_p = dot(axis, p);
  const V4 at_q = dot(axis, q);
  const V4 at_r = dot(axis, r);
  const V4 at_s = dot(axis, s);
  return {hn::Min(hn::Min(at_p, at_q), hn::Min(at_r, at_s)), hn::Max(hn::Max(at_p, at_q), hn::Max(at_r, at_s))};
}

/// What an axis of any length proves of the hulls of four vertices each.
HWY_INLINE V4 proved_gap(const Point& axis, const std::array<Point, 4>& a, const std::array<Point, 4>& b, float slack) {
  const D4 d;
  const Span of_a = span_of(axis, a[0], a[1], a[2], a[3]);
  const Span of_b = span_of(axis, b[0], b[1], b[2], b[3]);
  const V4 between = hn::Max(hn::Sub(of_b.low, of_a.high), hn::Sub(of_a.low, of_b.high));
  const V4 gap = hn::NegMulAdd(sum_of_sizes(axis), hn::Set(d, slack), between);
  const V4 length = hn::Sqrt(dot(axis, axis));
  const M4 proved = hn::And(hn::Gt(gap, hn::Zero(d)), hn::Gt(length, hn::Set(d, shortest_axis)));
  return hn::IfThenElseZero(proved, hn::Mul(hn::Div(gap, length), hn::Set(d, 1 - relative_slack)));
}

/// Vectors between the nearest points of two triangles in each lane.
HWY_INLINE Nearest nearest_of(Triangles& p, Triangles& q) {
  const D4 d;
  p.measure_edges();
  q.measure_edges();
  Nearest best = {{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, hn::Set(d, std::numeric_limits<float>::max())};
  offer_edges(p, q, best);
  offer_feet<true>(q, p.v, best);
  offer_feet<false>(p, q.v, best);
  return best;
}

/// Vertices of up to two triangles of a leaf, vertex v of both in lanes 0 0 1 1, or in 0 1 0 1.
template <bool of_a>
HWY_INLINE std::array<Point, 3> spread(const FrameLeaf& leaf, bool two) {
  const D4 d;
  const auto put = [&](const std::array<float, 8>& from, auto&& take) {
    const V4 first = hn::Load(d, from.data());
    const V4 second = hn::Load(d, from.data() + (two ? 4 : 0));
    const auto both = [&](V4 p, V4 q) { return of_a ? hn::ConcatUpperLower(d, q, p) : hn::InterleaveLower(d, p, q); };
    take(0, both(hn::Broadcast<0>(first), hn::Broadcast<0>(second)));
    take(1, both(hn::Broadcast<1>(first), hn::Broadcast<1>(second)));
    take(2, both(hn::Broadcast<2>(first), hn::Broadcast<2>(second)));
  };
  std::array<Point, 3> v;
  put(leaf.x, [&](std::size_t i, V4 x) { v[i].x = x; });
  put(leaf.y, [&](std::size_t i, V4 y) { v[i].y = y; });
  put(leaf.z, [&](std::size_t i, V4 z) { v[i].z = z; });
  return v;
}

bool leaves(const DistanceFrame& frame, const float* vertices_a, NodeRef leaf_a, const float* vertices_b,
            NodeRef leaf_b, float limit, FaceGaps& gaps) {
  const D4 d;
  FrameLeaf a;
  FrameLeaf b;
  load_frame(frame.a, {0, 0, 0}, vertices_a, leaf_a, a);
  load_frame(frame.b, frame.centre_b, vertices_b, leaf_b, b);
  const auto upper_of = [&](V4 square) {
    return hn::MulAdd(hn::Sqrt(square), hn::Set(d, 1 + relative_slack), hn::Set(d, frame.slack));
  };
  if (HWY_LIKELY(!leaf_a.is_quad() && !leaf_b.is_quad())) {
    Triangles p(spread<true>(a, leaf_a.count() > 1));
    Triangles q(spread<false>(b, leaf_b.count() > 1));
    // Most pairs are apart by one of these.
    V4 lower = hn::Sqrt(square_in_frame(p, q, frame.slack, frame.shrink));
    const auto all_beyond = [&] {
      hn::Store(lower, d, gaps.lower.data());
      return hn::AllTrue(d, hn::Gt(lower, hn::Set(d, limit)));
    };
    if (all_beyond()) return false;
    const auto along = [&](const Point& axis) {
      return proved_gap(axis, {p.v[0], p.v[1], p.v[2], p.v[2]}, {q.v[0], q.v[1], q.v[2], q.v[2]}, frame.slack);
    };
    lower = hn::Max(lower, along((q.v[0] - p.v[0]) + (q.v[1] - p.v[1]) + (q.v[2] - p.v[2])));
    if (all_beyond()) return false;
    p.measure_normal();
    q.measure_normal();
    lower = hn::Max(lower, hn::Max(p.gap(q, frame.slack), q.gap(p, frame.slack)));
    if (all_beyond()) return false;
    const Nearest best = nearest_of(p, q);
    lower = hn::Max(lower, along(best.between));
    hn::Store(lower, d, gaps.lower.data());
    hn::Store(upper_of(best.square), d, gaps.upper.data());
    hn::Store(best.between.x, d, gaps.between[0].data());
    hn::Store(best.between.y, d, gaps.between[1].data());
    hn::Store(best.between.z, d, gaps.between[2].data());
    return true;
  }
  // Quads: the lanes are the triangles 0 1 2 and 0 2 3 of both.
  for (std::uint8_t i = 0; i < leaf_a.count(); ++i) {
    for (std::uint8_t k = 0; k < leaf_b.count(); ++k) {
      const auto halves = [](std::uint8_t face, bool is_quad, bool of_a) {
        const auto base = static_cast<std::uint8_t>(4 * face);
        std::array<std::array<std::uint8_t, 4>, 4> at = {};
        constexpr std::array<std::array<std::uint8_t, 4>, 2> order = {{{0, 1, 2, 3}, {0, 2, 3, 1}}};
        for (std::size_t v = 0; v < 4; ++v) {
          for (std::size_t lane = 0; lane < 4; ++lane) {
            const std::size_t half = is_quad ? (of_a ? lane / 2 : lane % 2) : 0;
            at[v][lane] = static_cast<std::uint8_t>(base + order[half][v]);
          }
        }
        return at;
      };
      const auto at_a = halves(i, leaf_a.is_quad(), true);
      const auto at_b = halves(k, leaf_b.is_quad(), false);
      std::array<Point, 4> points_a;
      std::array<Point, 4> points_b;
      for (std::size_t v = 0; v < 4; ++v) {
        points_a[v] = vertices(a, at_a[v]);
        points_b[v] = vertices(b, at_b[v]);
      }
      Triangles p({points_a[0], points_a[1], points_a[2]});
      Triangles q({points_b[0], points_b[1], points_b[2]});
      p.measure_normal();
      q.measure_normal();
      // Each lane's axis proves its bound for the whole faces; points of each are points of them.
      const V4 along_normals = hn::Max(proved_gap(p.normal, points_a, points_b, frame.slack),
                                       proved_gap(q.normal, points_a, points_b, frame.slack));
      gaps.lower[2U * i + k] = hn::GetLane(hn::MaxOfLanes(d, along_normals));
      gaps.upper[2U * i + k] = std::numeric_limits<float>::infinity();
      if (gaps.lower[2U * i + k] > limit) continue;
      const Nearest best = nearest_of(p, q);
      const V4 lower = proved_gap(best.between, points_a, points_b, frame.slack);
      gaps.lower[2U * i + k] = hn::GetLane(hn::MaxOfLanes(d, hn::Max(lower, along_normals)));
      const V4 least = hn::MinOfLanes(d, best.square);
      gaps.upper[2U * i + k] = hn::GetLane(upper_of(least));
      const auto lane = static_cast<std::size_t>(hn::FindKnownFirstTrue(d, hn::Eq(best.square, least)));
      gaps.between[0][2U * i + k] = hn::ExtractLane(best.between.x, lane);
      gaps.between[1][2U * i + k] = hn::ExtractLane(best.between.y, lane);
      gaps.between[2][2U * i + k] = hn::ExtractLane(best.between.z, lane);
    }
  }
  return true;
}

DistanceKernels kernels() { return {nodes, leaves}; }

}  // namespace HWY_NAMESPACE
}  // namespace cchip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cchip::simd {
namespace {

HWY_EXPORT(kernels);

}  // namespace

DistanceKernels distance_kernels(const std::string& target) {
  return HWY_DISPATCH_TABLE(kernels)[target_index(target, std::size(HWY_DISPATCH_TABLE(kernels)))]();
}

const DistanceKernels& distance_kernels() {
  static const DistanceKernels best = distance_kernels(simd_targets().front());
  return best;
}

}  // namespace cchip::simd
#endif  // HWY_ONCE
