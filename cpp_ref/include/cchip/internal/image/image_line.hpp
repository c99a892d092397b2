// SPDX-License-Identifier: Apache-2.0
/// \file
/// The lines of an image, packed and unpacked.
#ifndef CCHIP_INTERNAL_IMAGE_IMAGE_LINE_HPP
#define CCHIP_INTERNAL_IMAGE_IMAGE_LINE_HPP

#include <array>
#include <cchip/internal/image/image_fields.hpp>
#include <cchip/internal/tree/dop26.hpp>
#include <cchip/internal/tree/tree.hpp>
#include <cstdint>

namespace cchip::bvh {

/// Integers of an object's frame: (x - centre) 2^-exponent lies in [-1/2, 1/2 - 2^-24]^3.
struct HeaderLine {
  std::uint32_t magic = image_magic;
  std::uint32_t crc = 0;
  std::uint16_t version = image_version;
  int exponent = 0;
  std::uint32_t lines = 0;
  std::uint32_t root = 1;
  int depth = 0;
  bool has_triangles = false;
  bool has_quads = false;
  std::uint32_t triangles = 0;
  std::uint32_t quads = 0;
  std::uint32_t inner = 0;
  std::uint32_t leaves = 0;
  Vec3d centre = Vec3d::Zero();
};

/// Ends of a box, in steps from the node's origin.
inline constexpr int box_least = -64;
inline constexpr int box_most = 63;

/// Box minus cuts: the plane of direction d on the upper side lies at (sum of the box corner that is furthest along d)
/// - cut, on the lower side likewise.
struct ChildVolume {
  std::array<int, 3> least = {};     ///< steps from the node's origin, box_least..box_most
  std::array<int, 3> greatest = {};  ///< the same
  /// As stored, 0..7, of directions 3..12: {upper, lower}. Half steps: shift left by k for face diagonals, by k + 1 for
  /// cube diagonals.
  std::array<std::array<int, 2>, directions.size() - first_face> cut = {};
};

struct InnerLine {
  std::array<std::int32_t, 3> origin = {};  ///< 2^-18
  int step = 0;                             ///< s
  std::uint32_t first = 0;
  int children = 1;      ///< 1..4
  int cut_exponent = 2;  ///< k, 2 or 3
  std::array<NodeKind, 4> kind = {};
  std::array<ChildVolume, 4> child = {};
};

struct LeafLine {
  std::array<std::int32_t, 3> origin = {};  ///< 2^-24
  int extent = 0;                           ///< q
  bool rounded = false;
  bool open = false;
  std::array<std::uint32_t, 2> id = {};
  /// Triangles: 0..2 and 3..5; a quad: 0..3. Steps from the origin.
  std::array<std::array<std::int32_t, 3>, 6> vertex = {};
};

/// Primitives in a leaf.
constexpr std::size_t primitives_in(NodeKind kind) { return kind == NodeKind::two_triangles ? 2 : 1; }
/// Vertices that a leaf line uses: 3, 6 or 4.
constexpr std::size_t vertices_in(NodeKind kind) {
  return kind == NodeKind::quad ? 4 : kind == NodeKind::two_triangles ? 6 : 3;
}
/// log2 of a leaf's step in the unit of the object.
constexpr int leaf_step(NodeKind kind, int extent) { return extent - (kind == NodeKind::quad ? 47 : 43); }

Line encode(const HeaderLine& header);
Line encode(const InnerLine& node);
/// \param kind not inner
Line encode(const LeafLine& leaf, NodeKind kind);
/// Any line can be decoded; check_image() says whether it makes sense.
HeaderLine decode_header(const Line& line);
InnerLine decode_inner(const Line& line);

/// A child has a box with greatest < least on an axis. Absent children, whose bits are 0, have none.
bool has_inverted_box(const InnerLine& node);
LeafLine decode_leaf(const Line& line, NodeKind kind);

}  // namespace cchip::bvh

#endif
