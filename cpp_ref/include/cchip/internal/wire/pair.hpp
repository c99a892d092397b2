// SPDX-License-Identifier: Apache-2.0
/// \file
/// A pair of primitives on its way into a primitive test, and the result on its way out.
#ifndef CCHIP_INTERNAL_WIRE_PAIR_HPP
#define CCHIP_INTERNAL_WIRE_PAIR_HPP

#include <Eigen/Core>
#include <array>
#include <cchip/internal/wire/axis.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/primitive.hpp>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>

namespace cchip {

/// Point or direction in grid steps.
using Vec3i = Eigen::Matrix<std::int32_t, 3, 1>;

/// A primitive on the local grid of its pair, in grid steps. `v[3]` of a triangle is unused.
struct GridPrimitive {
  Kind kind = Kind::tri;
  std::array<Vec3i, 4> v = {Vec3i::Zero(), Vec3i::Zero(), Vec3i::Zero(), Vec3i::Zero()};
  std::size_t vertex_count() const { return static_cast<std::size_t>(kind); }
};

/// Two primitives on one local grid.
struct GridPair {
  GridPrimitive a;
  GridPrimitive b;
  /// eta, `s_pair_err`: upper bound, in whole grid steps and infinity norm, on the error of the
  /// difference of any two vertices. 0 = exact input, 15 = unknown.
  int eta = 0;
};

/// "A (x, y, z) ...  B (x, y, z) ...  eta n", for messages.
std::string to_text(const GridPair& pair);

/// The module that answers a pair of these kinds; a quad and a triangle are answered with A and B exchanged.
ModuleId module_of(Kind a, Kind b);
inline ModuleId module_of(const GridPair& pair) { return module_of(pair.a.kind, pair.b.kind); }
/// Kinds of A and of B that the module takes: a triangle and a quad for tri_quad. Not for blank and point_tri.
constexpr std::array<Kind, 2> kinds_of(ModuleId id) {
  const int m = static_cast<int>(id);
  return {static_cast<Kind>(defs::rm_verts_a(m)), static_cast<Kind>(defs::rm_verts_b(m))};
}
/// Vertices of A and of B that the module takes: {3, 4} for tri_quad. {0, 0} for blank, {1, 3} for point_tri.
constexpr std::array<std::size_t, 2> vertices_of(ModuleId id) {
  if (id == ModuleId::blank) return {0, 0};
  if (id == ModuleId::point_tri) return {1, 3};
  return {static_cast<std::size_t>(kinds_of(id)[0]), static_cast<std::size_t>(kinds_of(id)[1])};
}
/// "tri_tri", "tri_quad", "quad_quad", "point_tri" or "blank".
const char* to_name(ModuleId id);

/// One beat of the stream s_pair.
struct PairRequest {
  GridPair pair;
  std::uint16_t tag = 0;
  /// Any value of two bits may be sent, reserved ones included.
  PairMode mode = PairMode::exhaustive;
};

/// One beat of the stream m_result.
struct PairResult {
  std::uint16_t tag = 0;
  bool hit = false;       ///< grid | !definite
  bool grid = false;      ///< the answer for the grid coordinates: the closed primitives share a point
  bool definite = false;  ///< grid also is the proven answer for the unrounded primitives
  AxisCode axis;
  int beats = 0;  ///< axes issued for this pair, saturating at 63
  friend bool operator==(const PairResult& x, const PairResult& y) {
    return x.tag == y.tag && x.hit == y.hit && x.grid == y.grid && x.definite == y.definite && x.axis == y.axis &&
           x.beats == y.beats;
  }
  friend std::ostream& operator<<(std::ostream& out, const PairResult& x) {
    return out << "{tag " << x.tag << " hit " << x.hit << " grid " << x.grid << " definite " << x.definite << " axis "
               << to_words(x.axis) << " beats " << x.beats << '}';
  }
};

/// One beat of the stream s_pair of cchip_primtest_subsystem: kind is the ModuleId of the test, 0 is illegal.
struct KindRequest {
  PairRequest request;
  int kind = 0;
};

/// One beat of its stream m_result. A pair that no module tested has axis class illegal.
struct KindResult {
  PairResult beat;
  int kind = 0;
  friend bool operator==(const KindResult& x, const KindResult& y) { return x.kind == y.kind && x.beat == y.beat; }
  friend std::ostream& operator<<(std::ostream& out, const KindResult& x) {
    return out << "kind " << x.kind << ' ' << x.beat;
  }
};

/// Tag for the pair with this number: consecutive tags differ in many bits, and every tag occurs once in 2^16 pairs,
/// because the factor is odd.
constexpr std::uint16_t tag_of(std::size_t number) { return static_cast<std::uint16_t>(40503U * number); }

}  // namespace cchip

#endif
