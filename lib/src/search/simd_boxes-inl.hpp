// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bounding volumes of up to four by four nodes against each other, in 16 bits or in single precision.
/// Included by simd_search.cpp once for each instruction set.
#if defined(CCHIP_CPU_SIMD_BOXES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef CCHIP_CPU_SIMD_BOXES_INL_HPP
#undef CCHIP_CPU_SIMD_BOXES_INL_HPP
#else
#define CCHIP_CPU_SIMD_BOXES_INL_HPP
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
HWY_INLINE void planes_of_lines(const SupportLine* lines, WideNode& node) {
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t w = 0; w < words; ++w) node.plane[j][w] = lines[j].word[w];
  }
}

/// Planes of a leaf from its vertices: finer than its line, which matters if the moved object is much smaller.
HWY_INLINE void planes_of_leaf(const SupportTree& tree, NodeRef leaf, const Margins& margins, WideNode& node) {
  const float* const v = tree.vertices(leaf.first());
  const std::size_t stride = 4 * leaf.vertex_sets();
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
  const auto plane_error = static_cast<float>(margins.relation * r.plane_error + r.growth) * 1.01F;
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

}  // namespace HWY_NAMESPACE
}  // namespace cchip
HWY_AFTER_NAMESPACE();
#endif  // CCHIP_CPU_SIMD_BOXES_INL_HPP
