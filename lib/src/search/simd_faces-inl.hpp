// SPDX-License-Identifier: Apache-2.0
/// \file
/// Primitives of two leaves against each other in single precision, with a bound on every rounding.
/// Included by simd_search.cpp once for each instruction set.
#if defined(CCHIP_CPU_SIMD_FACES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef CCHIP_CPU_SIMD_FACES_INL_HPP
#undef CCHIP_CPU_SIMD_FACES_INL_HPP
#else
#define CCHIP_CPU_SIMD_FACES_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "relative_pose.hpp"
#include "search.hpp"
#include "simd_task.hpp"

HWY_BEFORE_NAMESPACE();
namespace cchip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace simd;  // NOLINT: names of this search

using D8F = hn::CappedTag<float, 8>;
constexpr std::size_t lanes8 = hn::MaxLanes(D8F());

/// Normals of the primitives from their diagonals, and what their errors grow with.
HWY_INLINE void finish_side(LeafSide& side, float error) {
  const D8F d;
  for (std::size_t at = 0; at < 8; at += lanes8) {
    const auto x = hn::Load(d, side.x.data() + at);
    const auto y = hn::Load(d, side.y.data() + at);
    const auto z = hn::Load(d, side.z.data() + at);
    const auto ex = hn::Sub(hn::Shuffle1032(x), x);  // lane 0: V2 - V0, lane 1: V3 - V1
    const auto ey = hn::Sub(hn::Shuffle1032(y), y);
    const auto ez = hn::Sub(hn::Shuffle1032(z), z);
    const auto fx = hn::Shuffle0321(ex);
    const auto fy = hn::Shuffle0321(ey);
    const auto fz = hn::Shuffle0321(ez);
    hn::Store(hn::MulSub(ey, fz, hn::Mul(ez, fy)), d, side.nx.data() + at);
    hn::Store(hn::MulSub(ez, fx, hn::Mul(ex, fz)), d, side.ny.data() + at);
    hn::Store(hn::MulSub(ex, fy, hn::Mul(ey, fx)), d, side.nz.data() + at);
    const auto size = hn::Add(hn::Abs(ex), hn::Add(hn::Abs(ey), hn::Abs(ez)));
    hn::Store(hn::Add(hn::Max(size, hn::Shuffle0321(size)), hn::Set(d, 8 * error)), d, side.size.data() + at);
  }
}

/// Calls `store(at, x, y, z)` with the vertices of a leaf, for its lanes from `at` on; behind one primitive follows
/// anything.
/// \param v SupportTree::vertices() of the leaf
template <class Store>
HWY_INLINE void load_leaf(const float* v, NodeRef leaf, const Store& store) {
  const D8F d;
  if (HWY_LIKELY(leaf.is_fan())) {
    for (std::size_t at = 0; at < 8; at += lanes8) {
      const auto order = hn::SetTableIndices(d, fan_corners.data() + at);
      const auto take = [&](std::size_t k) { return hn::TableLookupLanes(hn::LoadDup128(d, v + 4 * k), order); };
      store(at, take(0), take(1), take(2));
    }
    return;
  }
  const std::size_t stride = 4 * leaf.count();
  for (std::size_t at = 0; at < 8; at += lanes8) {
    store(at, hn::LoadU(d, v + at), hn::LoadU(d, v + stride + at), hn::LoadU(d, v + 2 * stride + at));
  }
}

HWY_INLINE void load_moved(const float* v, NodeRef leaf, const Placement& place, LeafSide& side) {
  using V = hn::Vec<D8F>;
  load_leaf(v, leaf, [&](std::size_t at, V x, V y, V z) {
    const D8F d;
    const auto row = [&](std::size_t i) {
      return hn::MulAdd(x, hn::Set(d, place.m[3 * i]),
                        hn::MulAdd(y, hn::Set(d, place.m[3 * i + 1]),
                                   hn::MulAdd(z, hn::Set(d, place.m[3 * i + 2]), hn::Set(d, place.t[i]))));
    };
    hn::Store(row(0), d, side.x.data() + at);
    hn::Store(row(1), d, side.y.data() + at);
    hn::Store(row(2), d, side.z.data() + at);
  });
  finish_side(side, place.moved_error);
}

HWY_INLINE void load_fixed(const float* v, NodeRef leaf, const Placement& place, LeafSide& side) {
  using V = hn::Vec<D8F>;
  load_leaf(v, leaf, [&](std::size_t at, V x, V y, V z) {
    const D8F d;
    hn::Store(x, d, side.x.data() + at);
    hn::Store(y, d, side.y.data() + at);
    hn::Store(z, d, side.z.data() + at);
  });
  finish_side(side, place.fixed_error);
}

/// Of eight points, which lie certainly on the positive and on the negative side of a plane: a bit each.
struct Sides {
  unsigned positive = 0;
  unsigned negative = 0;
};

template <class V>
HWY_INLINE Sides sides_of(V nx, V ny, V nz, V size, V dx, V dy, V dz, float plane_error, float both_errors) {
  const D8F d;
  const V at = hn::MulAdd(nx, dx, hn::MulAdd(ny, dy, hn::Mul(nz, dz)));
  const V distance = hn::Add(hn::Abs(dx), hn::Add(hn::Abs(dy), hn::Add(hn::Abs(dz), hn::Set(d, 2 * both_errors))));
  const V slope = hn::MulAdd(size, hn::Set(d, 10.2F * ulp), hn::Set(d, 8.16F * plane_error));
  const V error = hn::Mul(size, hn::MulAdd(distance, slope, hn::Mul(size, hn::Set(d, 1.02F * both_errors))));
  std::array<std::uint8_t, 8> bits = {};
  Sides sides;
  hn::StoreMaskBits(d, hn::Gt(at, error), bits.data());
  sides.positive = bits[0];
  hn::StoreMaskBits(d, hn::Lt(at, hn::Neg(error)), bits.data());
  sides.negative = bits[0];
  return sides;
}

/// Primitive i of one leaf against both of the other: sides of the latter's points in the plane of i, and of the points
/// of i in the latter's planes; four bits for each of the two.
HWY_INLINE void compare(const LeafSide& p, std::size_t i, const LeafSide& q, const Placement& place, Sides& of_q,
                        Sides& of_p) {
  const D8F d;
  const float both = place.both_errors();
  const std::size_t at_p = 4 * i;
  for (std::size_t at = 0; at < 8; at += lanes8) {
    const auto qx = hn::Load(d, q.x.data() + at);
    const auto qy = hn::Load(d, q.y.data() + at);
    const auto qz = hn::Load(d, q.z.data() + at);
    const auto set = [&](const std::array<float, 8>& from) { return hn::Set(d, from[at_p]); };
    const Sides first = sides_of(set(p.nx), set(p.ny), set(p.nz), set(p.size), hn::Sub(qx, set(p.x)),
                                 hn::Sub(qy, set(p.y)), hn::Sub(qz, set(p.z)), place.moved_error, both);
    const auto own = [&](const std::array<float, 8>& from) { return hn::Broadcast<0>(hn::Load(d, from.data() + at)); };
    const auto points = [&](const std::array<float, 8>& from) { return hn::LoadDup128(d, from.data() + at_p); };
    const Sides second =
        sides_of(own(q.nx), own(q.ny), own(q.nz), own(q.size), hn::Sub(points(p.x), own(q.x)),
                 hn::Sub(points(p.y), own(q.y)), hn::Sub(points(p.z), own(q.z)), place.fixed_error, both);
    of_q.positive |= first.positive << at;
    of_q.negative |= first.negative << at;
    of_p.positive |= second.positive << at;
    of_p.negative |= second.negative << at;
  }
}

/// Two triangles whose vertices all lie on certain sides of the other's plane, not all on one: the two axes that decide
/// (docs/develop/architecture.md, "Two axes decide"), in lanes 0 and 1.
HWY_INLINE Verdict cross_test(const LeafSide& p, std::size_t at_p, unsigned negative_p, const LeafSide& q,
                              std::size_t at_q, unsigned negative_q, const Placement& place) {
  const hn::FixedTag<float, 4> d;
  const hn::FixedTag<std::int32_t, 4> di;
  using V = hn::Vec<hn::FixedTag<float, 4>>;
  const CrossingEdges& edges_p = crossing_edges[negative_p];
  const CrossingEdges& edges_q = crossing_edges[negative_q];
  const auto from_p = hn::IndicesFromVec(d, hn::Load(di, edges_p.from.data()));
  const auto to_p = hn::IndicesFromVec(d, hn::Load(di, edges_p.to.data()));
  const auto from_q = hn::IndicesFromVec(d, hn::Load(di, edges_q.from.data()));
  const auto to_q = hn::IndicesFromVec(d, hn::Load(di, edges_q.to.data()));
  const V px = hn::Load(d, p.x.data() + at_p);
  const V py = hn::Load(d, p.y.data() + at_p);
  const V pz = hn::Load(d, p.z.data() + at_p);
  const V qx = hn::Load(d, q.x.data() + at_q);
  const V qy = hn::Load(d, q.y.data() + at_q);
  const V qz = hn::Load(d, q.z.data() + at_q);
  const V px0 = hn::TableLookupLanes(px, from_p);
  const V py0 = hn::TableLookupLanes(py, from_p);
  const V pz0 = hn::TableLookupLanes(pz, from_p);
  const V qx0 = hn::TableLookupLanes(qx, from_q);
  const V qy0 = hn::TableLookupLanes(qy, from_q);
  const V qz0 = hn::TableLookupLanes(qz, from_q);
  const V ex = hn::Sub(hn::TableLookupLanes(px, to_p), px0);
  const V ey = hn::Sub(hn::TableLookupLanes(py, to_p), py0);
  const V ez = hn::Sub(hn::TableLookupLanes(pz, to_p), pz0);
  const V fx = hn::Sub(hn::TableLookupLanes(qx, to_q), qx0);
  const V fy = hn::Sub(hn::TableLookupLanes(qy, to_q), qy0);
  const V fz = hn::Sub(hn::TableLookupLanes(qz, to_q), qz0);
  const V dx = hn::Sub(qx0, px0);
  const V dy = hn::Sub(qy0, py0);
  const V dz = hn::Sub(qz0, pz0);
  const V volume =
      hn::MulAdd(hn::MulSub(ey, fz, hn::Mul(ez, fy)), dx,
                 hn::MulAdd(hn::MulSub(ez, fx, hn::Mul(ex, fz)), dy, hn::Mul(hn::MulSub(ex, fy, hn::Mul(ey, fx)), dz)));
  const auto size = [&](V x, V y, V z, float more) {
    return hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Add(hn::Abs(z), hn::Set(d, more))));
  };
  const float both_errors = place.both_errors();
  const V size_e = size(ex, ey, ez, 8 * place.moved_error);
  const V size_f = size(fx, fy, fz, 8 * place.fixed_error);
  const V size_d = size(dx, dy, dz, 2 * both_errors);
  const V area = hn::Mul(size_e, size_f);
  const V slope =
      hn::MulAdd(size_e, hn::Set(d, 4.08F * place.fixed_error),
                 hn::MulAdd(size_f, hn::Set(d, 4.08F * place.moved_error), hn::Mul(area, hn::Set(d, 10.2F * ulp))));
  const V error = hn::MulAdd(size_d, slope, hn::Mul(area, hn::Set(d, 1.02F * both_errors)));
  std::array<std::uint8_t, 8> bits = {};
  hn::StoreMaskBits(d, hn::Gt(volume, error), bits.data());
  const unsigned positive = bits[0] & 3U;
  hn::StoreMaskBits(d, hn::Lt(volume, hn::Neg(error)), bits.data());
  const unsigned negative = bits[0] & 3U;
  // Axis 0 separates if its volume is negative, axis 1 if its is positive.
  if ((negative & 1U) != 0 || (positive & 2U) != 0) return Verdict::apart;
  return positive == 1 && negative == 2 ? Verdict::cross : Verdict::open;
}

using D4F = hn::FixedTag<float, 4>;
using V4F = hn::Vec<D4F>;

/// Seeks axes that separate two primitives, four at a time.
class AxisTest {
 public:
  HWY_INLINE AxisTest(const LeafSide& p, std::size_t at_p, const LeafSide& q, std::size_t at_q, float error) {
    const D4F d;
    V4F greatest = hn::Zero(d);
    const auto place = [&](const std::array<float, 8>& of_p, const std::array<float, 8>& of_q,
                           std::array<float, 8>& to) {
      const V4F base = hn::Set(d, of_q[at_q]);
      const V4F first = hn::Sub(hn::Load(d, of_p.data() + at_p), base);
      const V4F second = hn::Sub(hn::Load(d, of_q.data() + at_q), base);
      hn::Store(first, d, to.data());
      hn::Store(second, d, to.data() + 4);
      greatest = hn::Max(greatest, hn::Max(hn::Abs(first), hn::Abs(second)));
    };
    place(p.x, q.x, x_);
    place(p.y, q.y, y_);
    place(p.z, q.z, z_);
    limit_ = hn::MulAdd(hn::MaxOfLanes(d, greatest), hn::Set(d, 1.02F * 12 * ulp), hn::Set(d, 1.02F * error));
  }

  /// True only if the intervals of the primitives are disjoint on one of the axes. Any axis is valid, so an axis needs
  /// no error bound; but the products of a very short one would underflow.
  HWY_INLINE bool any_separates(V4F nx, V4F ny, V4F nz) const {
    const D4F d;
    const auto along = [&](std::size_t v) {
      return hn::MulAdd(nx, hn::Set(d, x_[v]), hn::MulAdd(ny, hn::Set(d, y_[v]), hn::Mul(nz, hn::Set(d, z_[v]))));
    };
    V4F low[2];
    V4F high[2];
    for (std::size_t side = 0; side < 2; ++side) {
      low[side] = high[side] = along(4 * side);
      for (std::size_t v = 1; v < 4; ++v) {
        const V4F at = along(4 * side + v);
        low[side] = hn::Min(low[side], at);
        high[side] = hn::Max(high[side], at);
      }
    }
    const V4F gap = hn::Max(hn::Sub(low[1], high[0]), hn::Sub(low[0], high[1]));
    const V4F size = hn::Add(hn::Abs(nx), hn::Add(hn::Abs(ny), hn::Abs(nz)));
    return !hn::AllFalse(d, hn::And(hn::Gt(gap, hn::Mul(size, limit_)), hn::Gt(size, hn::Set(d, shortest_axis))));
  }

  /// The normals, from the diagonals.
  HWY_INLINE bool normals_separate(const LeafSide& p, std::size_t at_p, const LeafSide& q, std::size_t at_q) const {
    const D4F d;
    const auto both = [&](const std::array<float, 8>& of_p, const std::array<float, 8>& of_q) {
      return hn::InterleaveLower(d, hn::Set(d, of_p[at_p]), hn::Set(d, of_q[at_q]));
    };
    return any_separates(both(p.nx, q.nx), both(p.ny, q.ny), both(p.nz, q.nz));
  }

  /// The cross products of the sides.
  HWY_INLINE bool sides_separate() const {
    const D4F d;
    const auto sides = [&](const std::array<float, 8>& of) {
      const V4F at = hn::Load(d, of.data() + 4);
      return hn::Sub(hn::Shuffle0321(at), at);
    };
    const V4F fx = sides(x_);
    const V4F fy = sides(y_);
    const V4F fz = sides(z_);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto side = [&](const std::array<float, 8>& of) { return hn::Set(d, of[(i + 1) % 4] - of[i]); };
      const V4F ex = side(x_);
      const V4F ey = side(y_);
      const V4F ez = side(z_);
      if (any_separates(hn::MulSub(ey, fz, hn::Mul(ez, fy)), hn::MulSub(ez, fx, hn::Mul(ex, fz)),
                        hn::MulSub(ex, fy, hn::Mul(ey, fx)))) {
        return true;
      }
    }
    return false;
  }

 private:
  alignas(16) std::array<float, 8> x_, y_, z_;  ///< vertices of p, then of q, from the first one of q
  V4F limit_;                                   ///< what a gap must exceed, a unit of the axis each
};

/// The two triangles 0 1 2 and 0 2 3 of a quad, as a leaf of their own.
HWY_INLINE void halve(const LeafSide& quads, std::size_t at, float error, LeafSide& halves) {
  const D8F d;
  const auto take = [&](const std::array<float, 8>& from, std::array<float, 8>& to) {
    for (std::size_t k = 0; k < 8; k += lanes8) {
      const auto order = hn::SetTableIndices(d, fan_corners.data() + k);
      hn::Store(hn::TableLookupLanes(hn::LoadDup128(d, from.data() + at), order), d, to.data() + k);
    }
  };
  take(quads.x, halves.x);
  take(quads.y, halves.y);
  take(quads.z, halves.z);
  finish_side(halves, error);
}

}  // namespace HWY_NAMESPACE
}  // namespace cchip
HWY_AFTER_NAMESPACE();
#endif  // CCHIP_CPU_SIMD_FACES_INL_HPP
