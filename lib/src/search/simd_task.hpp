// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the SIMD search has in memory, the same for all instruction sets: a query on its way, planes, leaves.
#ifndef CCHIP_SEARCH_SIMD_TASK_HPP
#define CCHIP_SEARCH_SIMD_TASK_HPP

#include <algorithm>
#include <array>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cmath>
#include <cstdint>

#include "line_reach.hpp"
#include "simd_distance.hpp"

namespace cchip::simd {

using bvh::NodeRef;
using bvh::SupportLine;
using bvh::SupportTree;

inline constexpr std::size_t words = bvh::support_words;
inline constexpr float radius = bvh::support_most;
inline constexpr float ulp = 0x1p-24F;            // greatest relative error of one operation
inline constexpr float shortest_axis = 0x1p-60F;  // |x| + |y| + |z|: with a shorter one products might underflow

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
inline constexpr Directions normalised;

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
  float growth;  ///< how far the moved object as a whole may be from there, for a query within a distance

  /// Bound on the error of the difference of a vertex of each.
  float both_errors() const { return moved_error + fixed_error + growth; }
};

/// Two primitives of a leaf, in units of the fixed object; lane 4 i + v is vertex v of primitive i.
struct LeafSide {
  alignas(32) std::array<float, 8> x, y, z;     ///< vertices
  alignas(32) std::array<float, 8> nx, ny, nz;  ///< normal, in lane 4 i
  alignas(32) std::array<float, 8> size;        ///< what its error grows with, in lane 4 i
};

/// Vertices of the two triangles 0 1 2 and 0 2 3 of a quad or a fan, each with its first one again.
alignas(32) inline constexpr std::array<std::int32_t, 8> fan_corners = {0, 1, 2, 0, 0, 2, 3, 0};

/// Bounds on rounding are strict, so that two primitives in certain contact cross.
enum class Verdict { apart, cross, open };

/// The two edges of a triangle that decide, by the mask of its vertices on the negative side: from the positive to the
/// negative side and back, in the order of the vertices. Lanes 0 and 1 of where they begin and of where they end.
struct CrossingEdges {
  alignas(16) std::array<std::int32_t, 4> from;
  alignas(16) std::array<std::int32_t, 4> to;
};
inline constexpr std::array<CrossingEdges, 8> crossing_edges = {{{{0, 0, 0, 0}, {0, 0, 0, 0}},    // none: not asked for
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
inline constexpr std::size_t stack_most = 15 * 2 * bvh::tree_depth_max + 16;

/// Pairs that single precision leaves open wait until this many have come, or until the search ends without another
/// hit.
inline constexpr std::size_t open_most = 16;

/// Faces in the world, for a query within a distance; made for its first pair of leaves.
struct WithinFrame {
  bool is_made;
  DistanceFrame frame;
  float near;  ///< a distance certainly within, in units of the frame
  float far;   ///< one that certainly is not
};

/// One query on its way.
struct Task {
  CollisionQuery query;
  double within;  ///< the distance that is asked for
  WithinFrame world;
  Planes planes;
  Placement place;
  const SupportTree* moved;
  const SupportTree* fixed;
  bool swapped;
  std::size_t number;
  FacePairs faces;
  CollisionResult own_result;  ///< of batches
  CollisionStats stats;
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
    stats.open = faces.stats().open;
    faces.stats() = stats;
    faces.finish();
  }
};

/// True only if the node of the moved object lies beside the plane of each face of the fixed object's leaf: planes of
/// volumes leave much room around a face that is askew, in which all of a small object may lie.
inline bool beside_faces(const Task& task, const SupportLine& node, NodeRef leaf) {
  const float* const v = task.fixed->vertices(leaf.first());
  const std::size_t stride = 4 * leaf.vertex_sets();
  const Placement& place = task.place;
  for (std::size_t k = 0; k < leaf.count(); ++k) {
    Corners face;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto at = static_cast<std::size_t>(leaf.is_fan() ? fan_corners[4 * k + i] : 4 * k + i);
      face.v[i] = {v[at], v[stride + at], v[2 * stride + at]};
    }
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
    for (std::size_t k = 0; k < 3; ++k) {
      m[k] = place.m[k] * axis[0] + place.m[3 + k] * axis[1] + place.m[6 + k] * axis[2];
    }
    const BasicLineReach<float> reach(m, 1);
    const float centre = along(place.t);
    const float size = std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2]);
    const float gap = std::max(low - (centre + reach.along(node)), centre - reach.against(node) - high);
    if (!(gap > 1.02F * size * task.planes.side_error && size > shortest_axis)) return false;
  }
  return true;
}

}  // namespace cchip::simd

#endif
