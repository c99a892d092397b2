// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set by Highway's foreach_target.h. Bounds: docs/cpp/collide.md.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "device/simd_search.cpp"
// Vectors of a size that only the machine knows cannot be kept in arrays.
// The emulation of 128-bit vectors serves computers without any of the instruction sets, and as a check of these. GCC
// before 12.3 miscompiles it where it vectorises, so this file is compiled without that.
#define HWY_BROKEN_EMU128 0
#ifdef CCHIP_SIMD_TARGETS  // a build that needs few of them (tests/ref)
#define HWY_DISABLED_TARGETS (~(CCHIP_SIMD_TARGETS))
#else
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_WASM | HWY_WASM_EMU256)
#endif
#include <hwy/foreach_target.h>
// foreach_target.h must come before the others.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cchip/collide/face_pairs.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "exact/ieee.hpp"
#include "far_test.hpp"
#include "relative_pose.hpp"
#include "search.hpp"

// What does not depend on the instruction set.
#ifndef CCHIP_DEVICE_SIMD_SEARCH_ONCE
#define CCHIP_DEVICE_SIMD_SEARCH_ONCE
namespace cchip {
namespace {

using bvh::NodeRef;
using bvh::SupportLine;
using bvh::SupportTree;

constexpr std::size_t words = bvh::support_words;
constexpr float radius = bvh::support_most;
constexpr float ulp = 0x1p-24F;            // greatest relative error of one operation
constexpr float shortest_axis = 0x1p-60F;  // |x| + |y| + |z|: with a shorter one products might underflow

/// A node of the moved object and one of the fixed object that may meet.
struct Item {
  NodeRef moved;
  NodeRef fixed;
  bool is_leaf_pair() const { return moved.is_leaf() && fixed.is_leaf(); }
};

/// Directions of the words, normalised; 0 for words without one.
struct Directions {
  constexpr Directions() {
    constexpr std::array<double, 4> root = {0, 1, 1.4142135623730951, 1.7320508075688772};
    for (std::size_t w = 0; w < words; ++w) {
      const std::array<int, 3> d = bvh::support_direction(w);
      const auto square = static_cast<std::size_t>(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      used[w] = square != 0;
      for (std::size_t k = 0; k < 3 && used[w]; ++k) v[k][w] = static_cast<float>(d[k] / root[square]);
    }
  }
  alignas(64) std::array<std::array<float, words>, 3> v = {};
  std::array<bool, words> used = {};
};
// A constant of the compiler: a query may come from the constructor of any global object, before those of this file.
constexpr Directions normalised;

/// Bounds the moved object's nodes on the directions of the fixed one's words. Word w: how far the moved node reaches
/// against direction w is at most the sum of three of its words times a factor each; `offset` adds the distance of the
/// centres and all that rounding may cost.
struct Planes {
  /// Bytes of the three words within their 16 bytes; 0x8080 in one of the two for faces.
  alignas(64) std::array<std::uint16_t, words> axis;
  alignas(64) std::array<std::uint16_t, words> corner;
  alignas(64) std::array<std::uint16_t, words> face_low;
  alignas(64) std::array<std::uint16_t, words> face_high;
  /// Narrow: all in 16 bits, factors times 2^15, the offset as a sum of two.
  alignas(64) std::array<std::int16_t, words> axis_factor;
  alignas(64) std::array<std::int16_t, words> face_factor;
  alignas(64) std::array<std::int16_t, words> corner_factor;
  alignas(64) std::array<std::int16_t, words> offset;
  alignas(64) std::array<std::int16_t, words> offset_rest;
  /// Wide: the same in single precision.
  alignas(64) std::array<float, words> wide_axis;
  alignas(64) std::array<float, words> wide_face;
  alignas(64) std::array<float, words> wide_corner;
  alignas(64) std::array<float, words> wide_offset;
  bool wide;
  bool tiny;  ///< wide, and the moved object is so small that it waits as a whole until the fixed one's leaves come
  float side_error;  ///< wide: what separation of a node from the plane of a face must exceed, a unit of the axis each
  float key_scale;   ///< wide: from units of the fixed object to those of the keys
};

/// Up to four primitives' planes in single precision: what a wide test compares with.
struct WideNode {
  alignas(64) std::array<std::array<float, words>, 4> plane;
};

/// The relation in single precision, and how far vertices may lie from where they are computed.
struct Placement {
  std::array<float, 9> m;
  std::array<float, 3> t;
  float moved_error;
  float fixed_error;
};

/// Two primitives of a leaf, in units of the fixed object; lane 4 i + v is vertex v of primitive i.
struct LeafSide {
  alignas(32) std::array<float, 8> x, y, z;     ///< vertices
  alignas(32) std::array<float, 8> nx, ny, nz;  ///< normal, in lane 4 i
  alignas(32) std::array<float, 8> size;        ///< what its error grows with, in lane 4 i
};

/// Bounds on rounding are strict, so that two primitives in certain contact cross.
enum class Verdict { apart, cross, open };

/// The two edges of a triangle that decide, by the mask of its vertices on the negative side: from the positive to the
/// negative side and back, in the order of the vertices. Lanes 0 and 1 of where they begin and of where they end.
struct CrossingEdges {
  alignas(16) std::array<std::int32_t, 4> from;
  alignas(16) std::array<std::int32_t, 4> to;
};
constexpr std::array<CrossingEdges, 8> crossing_edges = {{{{0, 0, 0, 0}, {0, 0, 0, 0}},    // none: not asked for
                                                          {{2, 0, 2, 0}, {0, 1, 0, 1}},    // vertex 0
                                                          {{0, 1, 0, 1}, {1, 2, 1, 2}},    // 1
                                                          {{2, 1, 2, 1}, {0, 2, 0, 2}},    // 0 and 1
                                                          {{1, 2, 1, 2}, {2, 0, 2, 0}},    // 2
                                                          {{1, 0, 1, 0}, {2, 1, 2, 1}},    // 0 and 2
                                                          {{0, 2, 0, 2}, {1, 0, 1, 0}},    // 1 and 2
                                                          {{0, 0, 0, 0}, {0, 0, 0, 0}}}};  // all: not asked for

/// A quad, or a triangle whose vertex 3 is vertex 0, as points in single precision.
struct Corners {
  std::array<std::array<float, 3>, 4> v;
};

inline std::array<float, 3> difference(const std::array<float, 3>& p, const std::array<float, 3>& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
inline std::array<float, 3> cross_product(const std::array<float, 3>& p, const std::array<float, 3>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

/// Entries that a stack needs: each step replaces one item by at most 16 that are a level deeper in one of the trees.
constexpr std::size_t stack_most = 15 * 2 * bvh::tree_depth_max + 16;

/// Pairs that single precision leaves open wait until so many have come, or until the search ends without another hit.
constexpr std::size_t open_most = 16;

/// One query on its way.
struct Task {
  Planes planes;
  Placement place;
  const SupportTree* moved;
  const SupportTree* fixed;
  bool swapped;
  std::size_t number;
  FacePairs faces;
  CollisionResult own_result;  ///< of batches
  CollisionCounts counts;
  std::array<std::array<std::uint32_t, 2>, open_most> open;  ///< faces of the moved and of the fixed object
  std::size_t open_count;
  std::size_t size;  ///< of the stack
  std::array<Item, stack_most> stack;

  void add(std::uint32_t face_moved, std::uint32_t face_fixed) {
    swapped ? faces.add(face_fixed, face_moved) : faces.add(face_moved, face_fixed);
  }
  void resolve() {
    for (std::size_t i = 0; i < open_count && !faces.done(); ++i) {
      swapped ? faces.test(open[i][1], open[i][0]) : faces.test(open[i][0], open[i][1]);
    }
    open_count = 0;
  }
  void keep_open(std::uint32_t face_moved, std::uint32_t face_fixed) {
    open[open_count++] = {face_moved, face_fixed};
    if (open_count == open_most) resolve();
  }
  void finish() {
    resolve();
    counts.open = faces.counts().open;
    faces.counts() = counts;
    faces.finish();
  }
};

/// How far a node reaches along a direction of its object's frame: at most this.
inline float reach_along(const SupportLine& line, const std::array<float, 3>& m) {
  const std::array<float, 3> size = {std::abs(m[0]), std::abs(m[1]), std::abs(m[2])};
  const std::array<std::size_t, 3> negative = {m[0] < 0 ? 1U : 0U, m[1] < 0 ? 1U : 0U, m[2] < 0 ? 1U : 0U};
  std::size_t greatest = size[1] > size[0] ? 1 : 0;
  if (size[2] > size[greatest]) greatest = 2;
  std::size_t least = greatest == 0 ? 1 : 0;  // of the other two
  const std::size_t other = 3 - greatest - least;
  if (size[other] < size[least]) least = other;
  const float a = size[greatest];
  const float b = size[3 - greatest - least];
  const float c = size[least];
  const std::size_t face = bvh::first_face_word + 4 * least + negative[(least + 1) % 3] + 2 * negative[(least + 2) % 3];
  const std::size_t corner = bvh::first_corner_word + negative[0] + 2 * negative[1] + 4 * negative[2];
  return (a - b) * line.word[2 * greatest + negative[greatest]] + 1.41421356F * (b - c) * line.word[face] +
         1.73205081F * c * line.word[corner];
}

/// True only if the node of the moved object lies beside the plane of each face of the fixed object's leaf: planes of
/// volumes leave much room around a face that is askew, in which all of a small object may lie.
inline bool beside_faces(const Task& task, const SupportLine& node, NodeRef leaf) {
  const float* const v = task.fixed->vertices(leaf.first());
  const std::size_t stride = 4 * leaf.count();
  const Placement& place = task.place;
  for (std::size_t at = 0; at < stride; at += 4) {
    Corners face;
    for (std::size_t i = 0; i < 4; ++i) face.v[i] = {v[at + i], v[stride + at + i], v[2 * stride + at + i]};
    // Any axis is valid, so it needs no error bound.
    const std::array<float, 3> axis = cross_product(difference(face.v[2], face.v[0]), difference(face.v[3], face.v[1]));
    const auto along = [&axis](const std::array<float, 3>& p) {
      return axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
    };
    float low = along(face.v[0]);
    float high = low;
    for (std::size_t i = 1; i < 4; ++i) {
      low = std::min(low, along(face.v[i]));
      high = std::max(high, along(face.v[i]));
    }
    std::array<float, 3> m;
    std::array<float, 3> against;
    for (std::size_t k = 0; k < 3; ++k) {
      m[k] = place.m[k] * axis[0] + place.m[3 + k] * axis[1] + place.m[6 + k] * axis[2];
      against[k] = -m[k];
    }
    const float centre = along(place.t);
    const float size = std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2]);
    const float gap = std::max(low - (centre + reach_along(node, m)), centre - reach_along(node, against) - high);
    if (!(gap > 1.02F * size * task.planes.side_error && size > shortest_axis)) return false;
  }
  return true;
}

}  // namespace
}  // namespace cchip
#endif  // CCHIP_DEVICE_SIMD_SEARCH_ONCE

HWY_BEFORE_NAMESPACE();
namespace cchip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D16 = hn::CappedTag<std::int16_t, words>;
using D8 = hn::Repartition<std::uint8_t, D16>;
using D32 = hn::RepartitionToWide<D16>;  // half as many lanes
using DF = hn::Rebind<float, D32>;
using V16 = hn::Vec<D16>;
using VF = hn::Vec<DF>;
constexpr std::size_t lanes16 = hn::MaxLanes(D16());
constexpr std::size_t parts = words / lanes16;
constexpr std::size_t lanes_f = hn::MaxLanes(DF());

/// A line's four times 16 bytes, each in all blocks of a vector.
struct Quarters {
  HWY_INLINE explicit Quarters(const SupportLine& line)
      : axes(quarter(line, 0)), corners(quarter(line, 1)), faces_low(quarter(line, 2)), faces_high(quarter(line, 3)) {}
  static HWY_INLINE hn::Vec<D8> quarter(const SupportLine& line, std::size_t number) {
    return hn::LoadDup128(D8(), reinterpret_cast<const std::uint8_t*>(line.word.data()) + 16 * number);
  }
  hn::Vec<D8> axes;
  hn::Vec<D8> corners;
  hn::Vec<D8> faces_low;
  hn::Vec<D8> faces_high;
};

/// Words of the moved object's line that an index names, for one part of the planes.
struct Gathered {
  V16 axis;
  V16 corner;
  V16 face;
};

template <class Array>
HWY_INLINE hn::Vec<D8> load_bytes(const Array& from, std::size_t part) {
  return hn::Load(D8(), reinterpret_cast<const std::uint8_t*>(from.data() + part * lanes16));
}

HWY_INLINE Gathered gather(const Planes& planes, std::size_t part, const Quarters& line) {
  const D16 d;
  return {hn::BitCast(d, hn::TableLookupBytes(line.axes, load_bytes(planes.axis, part))),
          hn::BitCast(d, hn::TableLookupBytes(line.corners, load_bytes(planes.corner, part))),
          hn::BitCast(d, hn::Or(hn::TableLookupBytesOr0(line.faces_low, load_bytes(planes.face_low, part)),
                                hn::TableLookupBytesOr0(line.faces_high, load_bytes(planes.face_high, part))))};
}

/// Least lane of each of four vectors, twice, in each 128 bits: 0 1 2 3 0 1 2 3, each of a quarter of its lanes.
HWY_INLINE V16 least_of_four(V16 s0, V16 s1, V16 s2, V16 s3) {
  const D16 d;
  const V16 t0 = hn::Min(hn::InterleaveLower(d, s0, s1), hn::InterleaveUpper(d, s0, s1));
  const V16 t1 = hn::Min(hn::InterleaveLower(d, s2, s3), hn::InterleaveUpper(d, s2, s3));
  const D32 d32;
  const auto p0 = hn::BitCast(d32, t0);
  const auto p1 = hn::BitCast(d32, t1);
  return hn::Min(hn::BitCast(d, hn::InterleaveLower(d32, p0, p1)), hn::BitCast(d, hn::InterleaveUpper(d32, p0, p1)));
}

/// Least of the lanes at equal places of all 128-bit blocks.
template <class D>
HWY_INLINE hn::Vec<hn::FixedTag<std::int16_t, 8>> least_block(D, hn::Vec<D> v) {
  if constexpr (hn::MaxLanes(D()) == 8) {
    return v;
  } else {
    const hn::Half<D> half;
    return least_block(half, hn::Min(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
  }
}

/// Least overlaps of moved with four fixed nodes, key 4 i + j, from the rows of least_of_four(). Rows that are missing
/// repeat the first.
/// \returns bit 4 i + j: key 4 i + j is not negative
template <std::size_t rows>
HWY_INLINE unsigned store_keys(const V16* row, std::int16_t* keys) {
  const D16 d;
  const hn::Repartition<std::int64_t, D16> d64;
  const auto pair = [&](V16 p, V16 q) {
    const auto p64 = hn::BitCast(d64, p);
    const auto q64 = hn::BitCast(d64, q);
    return least_block(d, hn::Min(hn::BitCast(d, hn::InterleaveLower(d64, p64, q64)),
                                  hn::BitCast(d, hn::InterleaveUpper(d64, p64, q64))));
  };
  const hn::FixedTag<std::int16_t, 8> d8;
  const auto low = pair(row[0], row[rows > 1 ? 1 : 0]);
  const auto high = pair(row[rows > 2 ? 2 : 0], row[rows > 3 ? 3 : 0]);
  hn::Store(low, d8, keys);
  hn::Store(high, d8, keys + 8);
  std::array<std::uint8_t, 16> bits = {};
  hn::StoreMaskBits(d8, hn::Lt(low, hn::Zero(d8)), bits.data());
  hn::StoreMaskBits(d8, hn::Lt(high, hn::Zero(d8)), bits.data() + 8);
  return 0xFFFFU ^ (bits[0] | static_cast<unsigned>(bits[8]) << 8U);
}

/// Tests the first `rows` of four moved lines with four fixed lines. A key is the least overlap in units of the fixed
/// object.
/// \returns bit 4 i + j: moved node i may meet fixed node j
template <std::size_t rows>
HWY_INLINE unsigned narrow_test(const SupportLine* moved, const SupportLine* fixed, const Planes& planes,
                                std::int16_t* keys) {
  const D16 d;
  V16 own[4][parts];
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t p = 0; p < parts; ++p) own[j][p] = hn::Load(d, fixed[j].word.data() + p * lanes16);
  }
  V16 row[rows];
  for (std::size_t i = 0; i < rows; ++i) {
    const Quarters line(moved[i]);
    V16 least[4];
    for (std::size_t p = 0; p < parts; ++p) {
      const Gathered g = gather(planes, p, line);
      const std::size_t at = p * lanes16;
      // These three do not overflow: make_planes() has looked at the sum of the factors.
      V16 reach = hn::MulFixedPoint15(g.axis, hn::Load(d, planes.axis_factor.data() + at));
      reach = hn::Add(reach, hn::MulFixedPoint15(g.corner, hn::Load(d, planes.corner_factor.data() + at)));
      reach = hn::Add(reach, hn::MulFixedPoint15(g.face, hn::Load(d, planes.face_factor.data() + at)));
      reach = hn::SaturatedAdd(reach, hn::Load(d, planes.offset.data() + at));
      reach = hn::SaturatedAdd(reach, hn::Load(d, planes.offset_rest.data() + at));
      for (std::size_t j = 0; j < 4; ++j) {
        const V16 overlap = hn::SaturatedAdd(reach, own[j][p]);
        least[j] = p == 0 ? overlap : hn::Min(least[j], overlap);
      }
    }
    row[i] = least_of_four(least[0], least[1], least[2], least[3]);
  }
  return store_keys<rows>(row, keys);
}

HWY_INLINE VF to_float(V16 v, bool upper) {
  const hn::Half<D16> half;
  return hn::ConvertTo(DF(), hn::PromoteTo(D32(), upper ? hn::UpperHalf(half, v) : hn::LowerHalf(half, v)));
}

/// The same with planes of the fixed nodes, and factors, in single precision.
template <std::size_t rows>
HWY_NOINLINE unsigned wide_test(const SupportLine* moved, const WideNode& fixed, const Planes& planes,
                                std::int16_t* keys) {
  const D16 d;
  const DF df;
  const VF most = hn::Set(df, 32767.0F);
  const VF scale = hn::Set(df, planes.key_scale);
  V16 row[rows];
  for (std::size_t i = 0; i < rows; ++i) {
    const Quarters line(moved[i]);
    VF least[4];
    for (std::size_t p = 0; p < parts; ++p) {
      const Gathered g = gather(planes, p, line);
      for (std::size_t h = 0; h < 2; ++h) {
        const bool upper = h != 0;
        const std::size_t at = p * lanes16 + h * lanes_f;
        VF reach = hn::Load(df, planes.wide_offset.data() + at);
        reach = hn::MulAdd(to_float(g.axis, upper), hn::Load(df, planes.wide_axis.data() + at), reach);
        reach = hn::MulAdd(to_float(g.corner, upper), hn::Load(df, planes.wide_corner.data() + at), reach);
        reach = hn::MulAdd(to_float(g.face, upper), hn::Load(df, planes.wide_face.data() + at), reach);
        for (std::size_t j = 0; j < 4; ++j) {
          const VF overlap = hn::Add(reach, hn::Load(df, fixed.plane[j].data() + at));
          least[j] = p + h == 0 ? overlap : hn::Min(least[j], overlap);
        }
      }
    }
    // Rounding a negative key up to 0 is safe. Each is in half the lanes of a vector of keys; the other half repeats
    // it.
    V16 key[4];
    for (std::size_t j = 0; j < 4; ++j) {
      const VF scaled = hn::Max(hn::Min(hn::Mul(least[j], scale), most), hn::Neg(most));
      const auto narrow = hn::DemoteTo(hn::Half<D16>(), hn::ConvertTo(D32(), scaled));
      key[j] = hn::Combine(d, narrow, narrow);
    }
    row[i] = least_of_four(key[0], key[1], key[2], key[3]);
  }
  return store_keys<rows>(row, keys);
}

/// Planes of the lines in single precision.
HWY_INLINE void widen(const SupportLine* lines, WideNode& node) {
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t w = 0; w < words; ++w) node.plane[j][w] = lines[j].word[w];
  }
}

/// Planes of a leaf from its vertices: finer than its line, which matters if the moved object is much smaller.
HWY_INLINE void widen(const SupportTree& tree, NodeRef leaf, const Margins& margins, WideNode& node) {
  const float* const v = tree.vertices(leaf.first());
  const std::size_t stride = 4 * leaf.count();
  // Each term is off by 3 ulp of a coordinate, their sum by 2 more; normalised, so |x| + |y| + |z| <= sqrt(3) radius.
  const float error = static_cast<float>(margins.wide) * 12 * ulp * radius;
  for (std::size_t w = 0; w < words; ++w) {
    float reach = -2 * radius;
    for (std::size_t i = 0; i < stride; ++i) {
      reach = std::max(reach, normalised.v[0][w] * v[i] + normalised.v[1][w] * v[stride + i] +
                                  normalised.v[2][w] * v[2 * stride + i]);
    }
    node.plane[0][w] = reach + error;
  }
  for (std::size_t j = 1; j < 4; ++j) node.plane[j] = node.plane[0];
}

HWY_INLINE void make_planes(const RelativePose& r, const Margins& margins, Planes& planes) {
  using DP = hn::CappedTag<float, 16>;
  using DI = hn::Rebind<std::int32_t, DP>;
  const DP d;
  const DI di;
  constexpr std::size_t lanes = hn::MaxLanes(DP());
  using V = hn::Vec<DP>;
  std::array<float, 9> m;
  for (std::size_t i = 0; i < 9; ++i) m[i] = static_cast<float>(r.m[i]);
  const std::array<float, 3> t = {static_cast<float>(r.t[0]), static_cast<float>(r.t[1]), static_cast<float>(r.t[2])};
  V most_sum = hn::Zero(d);
  V most_factor = hn::Zero(d);
  for (std::size_t at = 0; at < words; at += lanes) {
    const V dx = hn::Load(d, normalised.v[0].data() + at);
    const V dy = hn::Load(d, normalised.v[1].data() + at);
    const V dz = hn::Load(d, normalised.v[2].data() + at);
    const auto against = [&](float x, float y, float z) {
      return hn::Neg(hn::MulAdd(dx, hn::Set(d, x), hn::MulAdd(dy, hn::Set(d, y), hn::Mul(dz, hn::Set(d, z)))));
    };
    const V x = against(m[0], m[3], m[6]);
    const V y = against(m[1], m[4], m[7]);
    const V z = against(m[2], m[5], m[8]);
    const V ax = hn::Abs(x);
    const V ay = hn::Abs(y);
    const V az = hn::Abs(z);
    const V low = hn::Min(ax, ay);
    const V high = hn::Max(ax, ay);
    const V a = hn::Max(high, az);
    const V c = hn::Min(low, az);
    const V b = hn::Max(low, hn::Min(high, az));
    const V axis = hn::Sub(a, b);
    const V face = hn::Mul(hn::Sub(b, c), hn::Set(d, 1.41421356F));
    const V corner = hn::Mul(c, hn::Set(d, 1.73205081F));
    most_sum = hn::Max(most_sum, hn::Add(axis, hn::Add(face, corner)));
    most_factor = hn::Max(most_factor, hn::Max(axis, hn::Max(face, corner)));
    hn::Store(axis, d, planes.wide_axis.data() + at);
    hn::Store(face, d, planes.wide_face.data() + at);
    hn::Store(corner, d, planes.wide_corner.data() + at);
    hn::Store(against(t[0], t[1], t[2]), d, planes.wide_offset.data() + at);

    // Which words: of the greatest component's axis, of the face without the least component's axis, of the corner.
    const auto bit = [&](hn::Mask<DP> mask, int value) {
      return hn::IfThenElseZero(hn::RebindMask(di, mask), hn::Set(di, value));
    };
    const auto by_axis = [&](hn::Mask<DP> second, hn::Mask<DP> third, V first_v, V second_v, V third_v) {
      return hn::IfThenElse(third, third_v, hn::IfThenElse(second, second_v, first_v));
    };
    const auto greatest_z = hn::Gt(az, high);
    const auto greatest_y = hn::And(hn::Gt(ay, ax), hn::Not(greatest_z));
    const auto least_z = hn::Lt(az, low);
    const auto least_y = hn::And(hn::Lt(ay, ax), hn::Not(least_z));
    // Components of equal size make no difference as long as the least is not also the greatest. If all are equal,
    // "greatest" is x, and so is "least": then axis and face have factor 0, so any word will do.
    const V zero = hn::Zero(d);
    const auto sx = hn::Lt(x, zero);
    const auto sy = hn::Lt(y, zero);
    const auto sz = hn::Lt(z, zero);
    const auto sa = hn::Lt(by_axis(greatest_y, greatest_z, x, y, z), zero);
    const auto su = hn::Lt(by_axis(least_y, least_z, y, z, x), zero);
    const auto sv = hn::Lt(by_axis(least_y, least_z, z, x, y), zero);
    const auto axis_word = hn::Or(hn::Or(bit(greatest_y, 2), bit(greatest_z, 4)), bit(sa, 1));
    const auto corner_word = hn::Or(hn::Or(bit(sx, 1), bit(sy, 2)), bit(sz, 4));
    const auto face_word = hn::Or(hn::Or(bit(least_y, 4), bit(least_z, 8)), hn::Or(bit(su, 1), bit(sv, 2)));
    const auto store = [&](std::array<std::uint16_t, words>& to, hn::Vec<DI> bytes) {
      const hn::Rebind<std::int16_t, DI> d_half;
      hn::Store(hn::DemoteTo(d_half, bytes), d_half, reinterpret_cast<std::int16_t*>(to.data() + at));
    };
    const auto bytes_of = [&](hn::Vec<DI> word) {
      return hn::Add(hn::Or(hn::ShiftLeft<1>(word), hn::ShiftLeft<9>(word)), hn::Set(di, 0x0100));
    };
    const auto none = hn::Set(di, static_cast<std::int16_t>(0x8080));
    const auto is_high = hn::Gt(face_word, hn::Set(di, 7));
    store(planes.axis, bytes_of(axis_word));
    store(planes.corner, bytes_of(corner_word));
    store(planes.face_low, hn::IfThenElse(is_high, none, bytes_of(face_word)));
    store(planes.face_high, hn::IfThenElse(is_high, bytes_of(hn::Sub(face_word, hn::Set(di, 8))), none));
  }
  const auto distance = static_cast<float>(r.distance);
  const auto norm = static_cast<float>(r.norm);
  const auto plane_error = static_cast<float>(margins.relation * r.plane_error) * 1.01F;
  // 26 of the 32 words have directions of length 1, so a sum of factors is at most sqrt(3) norm, nearly.
  const float sum = hn::GetLane(hn::MaxOfLanes(d, most_sum));
  const float factor = hn::GetLane(hn::MaxOfLanes(d, most_factor));
  planes.tiny = norm < 0x1p-5F;
  planes.wide = !(sum <= 1.1296F && factor <= 1.00001F) || planes.tiny;
  if (planes.wide) {
    const float slack =
        plane_error + static_cast<float>(margins.wide) * ulp * (radius * (32 * norm + 8) + 16 * distance);
    // Keys of 16 bits: the moved object's radius becomes 2^13 or less.
    planes.key_scale = std::min(0x1p60F, 8192.0F / (radius * std::max(norm, 0x1p-100F)));
    for (std::size_t w = 0; w < words; ++w) {
      if (normalised.used[w]) {
        planes.wide_offset[w] += slack;
      } else {
        planes.wide_offset[w] = std::numeric_limits<float>::max() / 4;
      }
    }
    return;
  }
  // Rounding of three products, 1/2 each, and of three factors, 1/2 each of 2^-15, a factor of 1.00001 up to 3/2.
  const float slack =
      plane_error + static_cast<float>(margins.narrow) *
                        (1.5F + 2.5F * 0x1p-15F * radius + ulp * (radius * 16 * norm + 8 * distance + 64));
  const V slack_v = hn::Set(d, slack);
  const hn::Rebind<std::int16_t, DI> d_half;
  const auto clamp = [&](hn::Vec<DI> v) { return hn::Max(hn::Min(v, hn::Set(di, 32767)), hn::Set(di, -32768)); };
  for (std::size_t at = 0; at < words; at += lanes) {
    const auto fixed_point = [&](const std::array<float, words>& from, std::array<std::int16_t, words>& to) {
      const V scaled = hn::Mul(hn::Load(d, from.data() + at), hn::Set(d, 32768.0F));
      hn::Store(hn::DemoteTo(d_half, hn::NearestInt(scaled)), d_half, to.data() + at);  // 32768 becomes 32767
    };
    fixed_point(planes.wide_axis, planes.axis_factor);
    fixed_point(planes.wide_face, planes.face_factor);
    fixed_point(planes.wide_corner, planes.corner_factor);
    const V exact = hn::Ceil(hn::Add(hn::Load(d, planes.wide_offset.data() + at), slack_v));
    // Beyond twice the range of 16 bits every sum saturates on the side where it belongs.
    const auto offset = hn::ConvertTo(di, hn::Max(hn::Min(exact, hn::Set(d, 65534.0F)), hn::Set(d, -65536.0F)));
    const auto first = clamp(offset);
    hn::Store(hn::DemoteTo(d_half, first), d_half, planes.offset.data() + at);
    hn::Store(hn::DemoteTo(d_half, hn::Sub(offset, first)), d_half, planes.offset_rest.data() + at);
  }
  // Words without a direction must never separate: their factors are 0, and no half of a reference is below -32767.
  for (const std::size_t w : {6U, 7U, 28U, 29U, 30U, 31U}) {
    planes.offset[w] = 32767;
    planes.offset_rest[w] = 32767;
  }
}

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

HWY_INLINE void load_moved(const SupportTree& tree, NodeRef leaf, const Placement& place, LeafSide& side) {
  const D8F d;
  const float* const v = tree.vertices(leaf.first());
  const std::size_t stride = 4 * leaf.count();
  for (std::size_t at = 0; at < 8; at += lanes8) {
    const auto x = hn::LoadU(d, v + at);
    const auto y = hn::LoadU(d, v + stride + at);
    const auto z = hn::LoadU(d, v + 2 * stride + at);
    const auto row = [&](std::size_t i) {
      return hn::MulAdd(x, hn::Set(d, place.m[3 * i]),
                        hn::MulAdd(y, hn::Set(d, place.m[3 * i + 1]),
                                   hn::MulAdd(z, hn::Set(d, place.m[3 * i + 2]), hn::Set(d, place.t[i]))));
    };
    hn::Store(row(0), d, side.x.data() + at);
    hn::Store(row(1), d, side.y.data() + at);
    hn::Store(row(2), d, side.z.data() + at);
  }
  finish_side(side, place.moved_error);
}

HWY_INLINE void load_fixed(const SupportTree& tree, NodeRef leaf, const Placement& place, LeafSide& side) {
  const D8F d;
  const float* const v = tree.vertices(leaf.first());
  const std::size_t stride = 4 * leaf.count();
  for (std::size_t at = 0; at < 8; at += lanes8) {
    hn::Store(hn::LoadU(d, v + at), d, side.x.data() + at);
    hn::Store(hn::LoadU(d, v + stride + at), d, side.y.data() + at);
    hn::Store(hn::LoadU(d, v + 2 * stride + at), d, side.z.data() + at);
  }
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
HWY_INLINE void compare(const LeafSide& p, std::size_t i, float error_p, const LeafSide& q, float error_q, Sides& of_q,
                        Sides& of_p) {
  const D8F d;
  const float both = error_p + error_q;
  const std::size_t at_p = 4 * i;
  for (std::size_t at = 0; at < 8; at += lanes8) {
    const auto qx = hn::Load(d, q.x.data() + at);
    const auto qy = hn::Load(d, q.y.data() + at);
    const auto qz = hn::Load(d, q.z.data() + at);
    const auto set = [&](const std::array<float, 8>& from) { return hn::Set(d, from[at_p]); };
    const Sides first = sides_of(set(p.nx), set(p.ny), set(p.nz), set(p.size), hn::Sub(qx, set(p.x)),
                                 hn::Sub(qy, set(p.y)), hn::Sub(qz, set(p.z)), error_p, both);
    const auto own = [&](const std::array<float, 8>& from) { return hn::Broadcast<0>(hn::Load(d, from.data() + at)); };
    const auto points = [&](const std::array<float, 8>& from) { return hn::LoadDup128(d, from.data() + at_p); };
    const Sides second = sides_of(own(q.nx), own(q.ny), own(q.nz), own(q.size), hn::Sub(points(p.x), own(q.x)),
                                  hn::Sub(points(p.y), own(q.y)), hn::Sub(points(p.z), own(q.z)), error_q, both);
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
  const float both_errors = place.moved_error + place.fixed_error;
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
  alignas(32) static constexpr std::array<std::int32_t, 8> vertex = {0, 1, 2, 0, 0, 2, 3, 0};
  const auto take = [&](const std::array<float, 8>& from, std::array<float, 8>& to) {
    for (std::size_t k = 0; k < 8; k += lanes8) {
      const auto order = hn::SetTableIndices(d, vertex.data() + k);
      hn::Store(hn::TableLookupLanes(hn::LoadDup128(d, from.data() + at), order), d, to.data() + k);
    }
  };
  take(quads.x, halves.x);
  take(quads.y, halves.y);
  take(quads.z, halves.z);
  finish_side(halves, error);
}

/// Reads what the next steps need into the cache.
HWY_INLINE void prefetch(const Task& task, Item item) {
  const auto read = [](const char* from) {
    for (std::size_t line = 0; line < 4; ++line) hwy::Prefetch(from + 64 * line);
  };
  if (item.is_leaf_pair()) {
    read(reinterpret_cast<const char*>(task.moved->vertices(item.moved.first())));
    read(reinterpret_cast<const char*>(task.fixed->vertices(item.fixed.first())));
  } else {
    read(reinterpret_cast<const char*>(task.moved->lines() + item.moved.first()));
    read(reinterpret_cast<const char*>(task.fixed->lines() + item.fixed.first()));
  }
}

/// True only if the boxes of the objects, in their own frames, are apart along an edge of one of them. As is_far(), it
/// takes every map; edges are normals of faces only for rotations and scales.
HWY_INLINE bool boxes_apart(const CollisionQuery& query, const CentreLine& line, double margin) {
  constexpr std::size_t axes = 6;
  using DD = hn::CappedTag<double, 8>;
  using VD = hn::Vec<DD>;
  const DD d;
  const double* const a = query.pose_a->data();  // columns of four
  const double* const b = query.pose_b->data();
  // Component i of each axis. Blends: what was stored number by number could not be loaded at once without a stall.
  const auto component = [&](std::size_t i, std::size_t at) {
    VD v = hn::Set(d, b[8 + i]);
    const auto put = [&](std::size_t n, double x) {
      if (n >= at) v = hn::IfThenElse(hn::FirstN(d, n - at + 1), hn::Set(d, x), v);
    };
    put(4, b[4 + i]);
    put(3, b[i]);
    put(2, a[8 + i]);
    put(1, a[4 + i]);
    put(0, a[i]);
    return v;
  };
  const VD limit = hn::Set(d, margin * far_limit * line.size);
  const VD least = hn::Set(d, far_axis_least);
  bool apart = false;
  for (std::size_t at = 0; at < axes; at += hn::MaxLanes(d)) {
    const VD x = component(0, at);
    const VD y = component(1, at);
    const VD z = component(2, at);
    VD reach = hn::Zero(d);
    const auto add_reach = [&](const SupportTree& tree, const double* linear) {
      for (std::size_t k = 0; k < 3; ++k) {
        const VD m =
            hn::MulAdd(x, hn::Set(d, linear[4 * k]),
                       hn::MulAdd(y, hn::Set(d, linear[4 * k + 1]), hn::Mul(z, hn::Set(d, linear[4 * k + 2]))));
        reach = hn::MulAdd(hn::Abs(m), hn::Set(d, tree.half(k)), reach);
      }
    };
    add_reach(query.a->tree(), a);
    add_reach(query.b->tree(), b);
    const VD along = hn::MulAdd(x, hn::Set(d, line.between[0]),
                                hn::MulAdd(y, hn::Set(d, line.between[1]), hn::Mul(z, hn::Set(d, line.between[2]))));
    const VD longest = hn::Max(hn::Abs(x), hn::Max(hn::Abs(y), hn::Abs(z)));
    const VD gap = hn::Sub(hn::Abs(along), reach);
    apart |= !hn::AllFalse(d, hn::And(hn::Gt(gap, hn::Mul(longest, limit)), hn::Gt(longest, least)));
  }
  return apart && line.moderate;
}

/// One thread's search.
class SimdSearch final : public Search {
 public:
  explicit SimdSearch(const Margins& margins) : margins_(margins), plain_(make_plain_search()) {}

  void run(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) override {
    Task& task = tasks_[0];
    if (!start(task, query, request, result)) return;
    if (request.contacts == CollisionRequest::Contacts::all) {
      search_all(task);
    } else {
      search_alone(task);
    }
    task.finish();
  }

  void run(QueryFeed& feed, const CollisionRequest& request) override {
    if (request.contacts == CollisionRequest::Contacts::all) {
      Task& task = tasks_[0];
      for (CollisionQuery query; feed.next(query, task.number);) {
        run(query, request, task.own_result);
        feed.done(task.number, task.own_result);
      }
    } else {
      search_in_step(feed, request);
    }
  }

 private:
  // Queries of a batch: more of them do not fit into the first level of the cache together.
  static constexpr std::size_t together = 8;
  // Items of a search for all contacts.
  static constexpr std::size_t items_together = 16;

  /// Prepares a query.
  /// \returns false if the result is complete
  bool start(Task& task, const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) {
    const CentreLine line = centre_line(query);
    if (is_far(query, line, margins_.far) || boxes_apart(query, line, margins_.far)) {
      FacePairs::answer_apart(request, result);
      result.counts.box_tests = 1;
      return false;
    }
    RelativePose relation;
    if (!relate(query, line, relation)) {
      plain_->run(query, request, result);
      return false;
    }
    task.faces.start(query, request, result);
    task.swapped = relation.swapped;
    task.moved = &(relation.swapped ? query.b : query.a)->tree();
    task.fixed = &(relation.swapped ? query.a : query.b)->tree();
    make_planes(relation, margins_, task.planes);
    for (std::size_t i = 0; i < 9; ++i) task.place.m[i] = static_cast<float>(relation.m[i]);
    for (std::size_t i = 0; i < 3; ++i) task.place.t[i] = static_cast<float>(relation.t[i]);
    // A coordinate of a moved vertex: 1 rounding each of vertex, matrix and three products, three sums; of the offset.
    const double own = 1.01 * margins_.vertex * ulp;
    const double of_relation = 1.01 * margins_.relation * relation.vertex_error;
    task.place.moved_error =
        static_cast<float>(own * (6 * radius * relation.row + 4 * relation.distance) + of_relation);
    task.place.fixed_error = static_cast<float>(own * radius);
    const double of_plane = margins_.wide * ulp * (radius * (3 + 12 * relation.norm) + 5 * relation.distance);
    task.planes.side_error = static_cast<float>(1.01 * of_plane + of_relation) + task.place.fixed_error;
    task.counts = {};
    task.counts.box_tests = 1;  // of the whole objects, above
    task.open_count = 0;
    task.stack[0] = {task.planes.tiny ? task.moved->whole() : task.moved->root(), task.fixed->root()};
    task.size = 1;
    return true;
  }

  /// Tests the nodes below an item.
  unsigned test(const Task& task, Item item, std::int16_t* keys) {
    const SupportLine* const moved = task.moved->lines() + item.moved.first();
    const SupportLine* const fixed = task.fixed->lines() + item.fixed.first();
    if (HWY_LIKELY(!task.planes.wide)) {
      return item.moved.count() == 1 ? narrow_test<1>(moved, fixed, task.planes, keys)
                                     : narrow_test<4>(moved, fixed, task.planes, keys);
    }
    const NodeRef first = fixed->ref();
    const bool leaf = item.fixed.count() == 1 && first.is_leaf();
    if (leaf) {
      widen(*task.fixed, first, margins_, wide_);
    } else {
      widen(fixed, wide_);
    }
    unsigned hits = item.moved.count() == 1 ? wide_test<1>(moved, wide_, task.planes, keys)
                                            : wide_test<4>(moved, wide_, task.planes, keys);
    if (leaf) {  // of the hits only those of the one fixed node count
      for (std::uint32_t i = 0; i < item.moved.count(); ++i) {
        if ((hits >> 4 * i & 1U) != 0 && beside_faces(task, moved[i], first)) hits ^= 1U << 4 * i;
      }
    }
    return hits;
  }

  /// Puts the pairs that may meet onto a stack, the one that overlaps most on top.
  /// \returns how many
  template <bool best_first>
  static HWY_INLINE std::size_t push(Task& task, Item item, unsigned hits, const std::int16_t* keys, Item* stack) {
    const std::uint32_t moved_count = item.moved.count();
    const std::uint32_t fixed_count = item.fixed.count();
    ++task.counts.steps;
    task.counts.box_tests += moved_count * fixed_count;
    hits &= (0x1111U * ((1U << fixed_count) - 1)) & ((1U << 4 * moved_count) - 1);
    if (hits == 0) return 0;
    const SupportLine* const moved = task.moved->lines() + item.moved.first();
    const SupportLine* const fixed = task.fixed->lines() + item.fixed.first();
    std::size_t count = 0;
    std::size_t best = 0;
    int best_key = -1;
    do {
      const std::size_t bit = hwy::Num0BitsBelowLS1Bit_Nonzero32(hits);
      hits &= hits - 1;
      const auto i = static_cast<std::uint32_t>(bit / 4);
      const auto j = static_cast<std::uint32_t>(bit % 4);
      NodeRef a = moved[i].ref();
      NodeRef b = fixed[j].ref();
      // A leaf waits for the other one to come down: its own line is the only child.
      const bool leaf_a = a.is_leaf();
      const bool leaf_b = b.is_leaf();
      if (!leaf_b && (leaf_a || task.planes.tiny)) a = NodeRef::inner(item.moved.first() + i, 1);
      if (leaf_b && !leaf_a) b = NodeRef::inner(item.fixed.first() + j, 1);
      stack[count] = {a, b};
      if (best_first) {
        const bool better = keys[bit] > best_key;
        best_key = better ? keys[bit] : best_key;
        best = better ? count : best;
      }
      ++count;
    } while (hits != 0);
    if (best_first) std::swap(stack[best], stack[count - 1]);
    return count;
  }

  /// Tests the primitives of two leaves.
  /// \returns true if the request is fulfilled
  static HWY_INLINE bool test_leaves(Task& task, Item item) {
    const Placement& place = task.place;
    alignas(64) LeafSide p;
    alignas(64) LeafSide q;
    load_moved(*task.moved, item.moved, place, p);
    load_fixed(*task.fixed, item.fixed, place, q);
    const std::size_t count_p = item.moved.count();
    const std::size_t count_q = item.fixed.count();
    task.counts.pairs += count_p * count_q;
    const std::uint32_t* const faces_p = task.moved->faces().data() + item.moved.first();
    const std::uint32_t* const faces_q = task.fixed->faces().data() + item.fixed.first();
    if (HWY_UNLIKELY(item.moved.is_quad() || item.fixed.is_quad())) {
      for (std::size_t i = 0; i < count_p; ++i) {
        for (std::size_t k = 0; k < count_q; ++k) {
          const AxisTest test(p, 4 * i, q, 4 * k, place.moved_error + place.fixed_error);
          if (test.normals_separate(p, 4 * i, q, 4 * k)) continue;
          if (quads_cross(p, 4 * i, item.moved.is_quad(), q, 4 * k, item.fixed.is_quad(), place)) {
            task.add(faces_p[i], faces_q[k]);
          } else if (!test.sides_separate()) {
            task.keep_open(faces_p[i], faces_q[k]);
          }
          if (task.faces.done()) return true;
        }
      }
      return false;
    }
    return visit_triangles(p, count_p, q, count_q, place, [&](std::size_t i, std::size_t k, Verdict verdict) {
      if (verdict == Verdict::cross) {
        task.add(faces_p[i], faces_q[k]);
      } else {
        task.keep_open(faces_p[i], faces_q[k]);
      }
      return task.faces.done();
    });
  }

  /// Calls `visit` for the pairs of up to two by two triangles that are not apart, until it returns true.
  /// \returns whether it did
  template <class Visit>
  static HWY_INLINE bool visit_triangles(const LeafSide& p, std::size_t count_p, const LeafSide& q, std::size_t count_q,
                                         const Placement& place, const Visit& visit) {
    // Bit 8 i + 4 k: triangles i and k may touch; all their vertices lie on certain sides.
    unsigned left = 0;
    unsigned certain = 0;
    std::array<Sides, 2> of_p;
    std::array<Sides, 2> of_q;
    const auto all_three = [](unsigned bits) { return bits & bits >> 1U & bits >> 2U; };
    for (std::size_t i = 0; i < count_p; ++i) {
      compare(p, i, place.moved_error, q, place.fixed_error, of_q[i], of_p[i]);
      const unsigned apart = all_three(of_p[i].positive) | all_three(of_p[i].negative) | all_three(of_q[i].positive) |
                             all_three(of_q[i].negative);
      const unsigned known =
          all_three(of_p[i].positive | of_p[i].negative) & all_three(of_q[i].positive | of_q[i].negative);
      left |= (~apart & (count_q == 2 ? 0x11U : 0x01U)) << 8 * i;
      certain |= known << 8 * i;
    }
    for (; left != 0; left &= left - 1) {
      const std::size_t bit = hwy::Num0BitsBelowLS1Bit_Nonzero32(left);
      const std::size_t i = bit / 8;
      const std::size_t k = bit / 4 % 2;
      const Verdict verdict = (certain >> bit & 1U) != 0 ? cross_test(p, 4 * i, of_p[i].negative >> 4 * k & 7U, q,
                                                                      4 * k, of_q[i].negative >> 4 * k & 7U, place)
                                                         : Verdict::open;
      if (verdict != Verdict::apart && visit(i, k, verdict)) return true;
    }
    return false;
  }

  /// True only if a triangle of one crosses a triangle of the other.
  static bool quads_cross(const LeafSide& p, std::size_t at_p, bool quad_p, const LeafSide& q, std::size_t at_q,
                          bool quad_q, const Placement& place) {
    alignas(64) LeafSide halves_p;
    alignas(64) LeafSide halves_q;
    halve(p, at_p, place.moved_error, halves_p);
    halve(q, at_q, place.fixed_error, halves_q);
    return visit_triangles(halves_p, quad_p ? 2 : 1, halves_q, quad_q ? 2 : 1, place,
                           [](std::size_t, std::size_t, Verdict verdict) { return verdict == Verdict::cross; });
  }

  /// One query for its first contact, one item at a time.
  void search_alone(Task& task) {
    std::int16_t keys[16];
    while (task.size > 0) {
      const Item item = task.stack[--task.size];
      if (item.is_leaf_pair()) {
        if (test_leaves(task, item)) return;
        continue;
      }
      if (task.size > 0) prefetch(task, task.stack[task.size - 1]);
      const unsigned hits = test(task, item, keys);
      task.size += push<true>(task, item, hits, keys, task.stack.data() + task.size);
    }
  }

  /// One query for all contacts: several items at a time, in any order.
  void search_all(Task& task) {
    Item items[items_together];
    std::int16_t keys[items_together][16];
    std::array<unsigned, items_together> hits;
    if (deep_.size() < 1024) deep_.resize(1024);
    deep_[0] = task.stack[0];
    std::size_t size = 1;
    while (size > 0) {
      std::size_t count = 0;
      while (size > 0 && count < items_together) {
        const Item item = deep_[--size];
        if (item.is_leaf_pair()) {
          if (test_leaves(task, item)) return;
        } else {
          items[count++] = item;
        }
      }
      if (deep_.size() < size + 16 * items_together) deep_.resize(2 * deep_.size());
      for (std::size_t i = 0; i < count; ++i) hits[i] = test(task, items[i], keys[i]);
      for (std::size_t i = 0; i < count; ++i)
        size += push<false>(task, items[i], hits[i], keys[i], deep_.data() + size);
      for (std::size_t i = 1; i <= std::min(size, items_together); ++i) prefetch(task, deep_[size - i]);
    }
  }

  /// Many queries for their first contacts: one item of each in a round. All tests come first, which do not branch,
  /// then all that depends on them.
  void search_in_step(QueryFeed& feed, const CollisionRequest& request) {
    Item current[together];
    std::int16_t keys[together][16];
    std::array<unsigned, together> hits;
    std::array<std::array<std::uint8_t, together>, 2> inner;  // tasks whose item is a pair to be expanded
    std::array<std::array<std::uint8_t, together>, 2> leaves;
    std::array<std::size_t, 2> inner_count = {0, 0};
    std::array<std::size_t, 2> leaf_count = {0, 0};
    const auto pop = [&](std::size_t i, std::size_t round) {
      Task& task = tasks_[i];
      const Item item = task.stack[--task.size];
      current[i] = item;
      if (item.is_leaf_pair()) {
        leaves[round][leaf_count[round]++] = static_cast<std::uint8_t>(i);
      } else {
        inner[round][inner_count[round]++] = static_cast<std::uint8_t>(i);
      }
      prefetch(task, item);
    };
    bool more = true;
    const auto begin = [&](std::size_t i, std::size_t round) {
      Task& task = tasks_[i];
      for (CollisionQuery query; more;) {
        more = feed.next(query, task.number);
        if (!more) return;
        if (start(task, query, request, task.own_result)) return pop(i, round);
        feed.done(task.number, task.own_result);
      }
    };
    const auto end = [&](std::size_t i, std::size_t round) {
      tasks_[i].finish();
      feed.done(tasks_[i].number, tasks_[i].own_result);
      begin(i, round);
    };
    for (std::size_t i = 0; i < std::min(together, feed.at_once()); ++i) begin(i, 0);
    for (std::size_t round = 0; inner_count[round] + leaf_count[round] > 0; round ^= 1U) {
      const std::size_t next = round ^ 1U;
      inner_count[next] = leaf_count[next] = 0;
      const std::size_t count = inner_count[round];
      for (std::size_t n = 0; n < count; ++n) {
        const std::size_t i = inner[round][n];
        hits[n] = test(tasks_[i], current[i], keys[n]);
      }
      for (std::size_t n = 0; n < count; ++n) {
        const std::size_t i = inner[round][n];
        Task& task = tasks_[i];
        task.size += push<true>(task, current[i], hits[n], keys[n], task.stack.data() + task.size);
        task.size > 0 ? pop(i, next) : end(i, next);
      }
      for (std::size_t n = 0; n < leaf_count[round]; ++n) {
        const std::size_t i = leaves[round][n];
        const bool fulfilled = test_leaves(tasks_[i], current[i]);
        tasks_[i].size > 0 && !fulfilled ? pop(i, next) : end(i, next);
      }
    }
  }

  Margins margins_;
  std::unique_ptr<Search> plain_;
  WideNode wide_;
  std::vector<Item> deep_;
  std::array<Task, together> tasks_;
};

std::unique_ptr<Search> make(const Margins& margins) { return std::make_unique<SimdSearch>(margins); }

}  // namespace HWY_NAMESPACE
}  // namespace cchip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cchip {
namespace {

HWY_EXPORT(make);

/// Bits of the instruction sets that are compiled in and that this computer has, best first.
std::vector<std::int64_t> target_bits() {
  std::vector<std::int64_t> bits;
  for (std::int64_t all = hwy::SupportedTargets() & HWY_TARGETS; all != 0; all &= all - 1) bits.push_back(all & -all);
  return bits;
}

}  // namespace

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const std::int64_t bit : target_bits()) names.emplace_back(hwy::TargetName(bit));
  return names;
}

std::unique_ptr<Search> make_simd_search(const std::string& target, const Margins& margins) {
  static std::mutex choosing;
  const std::lock_guard<std::mutex> lock(choosing);
  for (const std::int64_t bit : target_bits()) {
    if (target != hwy::TargetName(bit)) continue;
    // The table of HWY_EXPORT is read at the chosen target; nothing else is chosen by it meanwhile.
    hwy::GetChosenTarget().Update(bit);
    std::unique_ptr<Search> search = HWY_DYNAMIC_DISPATCH(make)(margins);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return search;
  }
  throw std::invalid_argument("instruction set " + target + " is not one that this computer and this program have");
}

}  // namespace cchip
#endif  // HWY_ONCE
