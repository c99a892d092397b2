// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where each field of an image lies in its line of 64 bytes; docs/hardware/image.md shows the same as a table.
#ifndef CCHIP_INTERNAL_IMAGE_IMAGE_FIELDS_HPP
#define CCHIP_INTERNAL_IMAGE_IMAGE_FIELDS_HPP

#include <array>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/internal/wire/line.hpp>

namespace cchip::bvh {

/// Line 0 of an image.
namespace header_field {
inline constexpr Field magic = {"magic", 0, 32};
inline constexpr Field crc = {"crc", 32, 32};  ///< CRC-32 of all bytes from byte 8 to the end of the image
inline constexpr Field version = {"version", 64, 16};
inline constexpr Field exponent = {"exponent", 80, 16, 1, true};
inline constexpr Field lines = {"lines", 96, 32};
inline constexpr Field root = {"root", 128, 24};
inline constexpr Field depth = {"depth", 152, 6};
inline constexpr Field kinds = {"kinds", 158, 2};  ///< bit 0: triangles, bit 1: quads
inline constexpr Field triangles = {"triangles", 160, 32};
inline constexpr Field quads = {"quads", 192, 32};
inline constexpr Field inner = {"inner", 224, 32};
inline constexpr Field leaves = {"leaves", 256, 32};
inline constexpr Field centre = {"centre", 320, 64, 3};  ///< IEEE 754 doubles
inline constexpr std::array<Field, 13> all = {magic, crc,       version, exponent, lines,  root,  depth,
                                              kinds, triangles, quads,   inner,    leaves, centre};
}  // namespace header_field

/// An inner node and the volumes of its children.
namespace inner_field {
inline constexpr Field origin = {"origin", 0, 18, 3, true};     ///< 2^-18
inline constexpr Field step = {"step", 54, 5};                  ///< s: a step is 2^(s - 24)
inline constexpr Field first = {"first", 59, 24};               ///< line of the first child
inline constexpr Field kind = {"kind", 83, 2, 4};               ///< NodeKind of each child
inline constexpr Field children = {"children", 91, 2};          ///< their number - 1
inline constexpr Field cut_exponent = {"cut_exponent", 93, 1};  ///< k - 2
inline constexpr Field child = {"child", 96, 102, 4};
inline constexpr std::array<Field, 7> all = {origin, step, first, kind, children, cut_exponent, child};
}  // namespace inner_field

/// Within the bits of one child.
namespace child_field {
inline constexpr Field box = {"box", 0, 7, 6, true};  ///< least x, greatest x, least y, ...; steps from the origin
inline constexpr Field face_cut = {"face_cut", 42, 3, 12};     ///< two a face diagonal: upper, lower; 2^k half steps
inline constexpr Field corner_cut = {"corner_cut", 78, 3, 8};  ///< two a cube diagonal; 2^(k+1) half steps
inline constexpr std::array<Field, 3> all = {box, face_cut, corner_cut};
}  // namespace child_field

/// A leaf: one or two triangles, or a quad; the parent's `kind` says which.
namespace leaf_field {
inline constexpr Field origin = {"origin", 0, 24, 3, true};  ///< 2^-24
inline constexpr Field extent = {"extent", 72, 5};    ///< q: a step is 2^(q - 43) for triangles, 2^(q - 47) for a quad
inline constexpr Field rounded = {"rounded", 77, 1};  ///< 0: every vertex is the mesh's exactly
inline constexpr Field open = {"open", 78, 1};        ///< no answer for this quad is definite
inline constexpr Field id = {"id", 80, 32, 2};        ///< numbers of the faces
inline constexpr Field triangle = {"triangle", 144, 20, 18, true};  ///< vertices 0, 1, 2 of both, x first; steps
inline constexpr Field quad = {"quad", 144, 24, 12, true};          ///< or four vertices
inline constexpr std::array<Field, 7> all = {origin, extent, rounded, open, id, triangle, quad};
}  // namespace leaf_field

static_assert(inner_field::child.end() == 504 && child_field::corner_cut.end() == inner_field::child.width);
static_assert(leaf_field::triangle.end() == 504 && header_field::centre.end() == 512);

/// The RTL reads a field where it is written: its names are made from scripts/definitions.json.
constexpr bool is_where(const Field& field, const defs::Field& rtl) {
  return field.lsb == static_cast<std::size_t>(rtl.lsb) && field.end() <= static_cast<std::size_t>(rtl.lsb + rtl.width);
}
static_assert(is_where(header_field::magic, defs::header_line_magic) &&
              is_where(header_field::version, defs::header_line_version) &&
              is_where(header_field::lines, defs::header_line_lines) &&
              is_where(header_field::root, defs::header_line_root) &&
              is_where(header_field::centre, defs::header_line_centre));
static_assert(is_where(inner_field::origin, defs::node_line_origin) &&
              is_where(inner_field::step, defs::node_line_step) &&
              is_where(inner_field::first, defs::node_line_first) &&
              is_where(inner_field::kind, defs::node_line_kinds) &&
              is_where(inner_field::children, defs::node_line_children) &&
              is_where(inner_field::cut_exponent, defs::node_line_cut_exponent) &&
              is_where(inner_field::child, defs::node_line_child));
static_assert(is_where(leaf_field::origin, defs::leaf_line_origin) &&
              is_where(leaf_field::extent, defs::leaf_line_extent) &&
              is_where(leaf_field::rounded, defs::leaf_line_rounded) &&
              is_where(leaf_field::open, defs::leaf_line_open) && leaf_field::id.lsb == defs::leaf_line_id0.lsb &&
              is_where(leaf_field::triangle, defs::leaf_line_points) &&
              is_where(leaf_field::quad, defs::leaf_line_points));

inline constexpr unsigned image_magic = 0x4D494343;  // "CCIM"
inline constexpr unsigned image_version = 1;
inline constexpr int step_max = 18;        ///< of inner_field::step
inline constexpr int extent_max = 24;      ///< of leaf_field::extent
inline constexpr int exponent_max = 1002;  ///< of header_field::exponent, in magnitude

}  // namespace cchip::bvh

#endif
