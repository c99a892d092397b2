// SPDX-License-Identifier: Apache-2.0
/// \file
/// What an outline means: docs/cpp/mesh_files.md has the rule. Every decision is exact.
#ifndef CCHIP_MESH_CUT_POLYGON_HPP
#define CCHIP_MESH_CUT_POLYGON_HPP

#include <array>
#include <cchip/primitive.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cchip::outline {

/// Most corners that cut_polygon() takes, and most points at which sides may touch: its memory is proportional to
/// both, its time to the pairs of sides whose extents overlap along one axis.
constexpr std::size_t most_corners = 16384;
constexpr std::size_t most_touches = std::size_t{1} << 20;

/// The order in which the corners of a face of four follow each other around the hull that it is; nothing if the
/// outline has a dent or a spike, so that it must be cut.
/// \param quad finite coordinates
std::optional<std::array<std::size_t, 4>> hull_order(const std::array<Vec3d, 4>& quad);

struct Cut {
  std::vector<std::array<std::size_t, 3>> triangles;  ///< numbers of corners
  std::string error;                                  ///< empty, or why there are no triangles: what follows "face 3"
};

/// Cuts an outline of 4 or more corners into triangles of its corners. Together they cover what lies inside by the
/// even-odd rule, and the outline itself: corners on a side, spikes and sides that are passed twice included. An
/// outline with n corners that does not touch itself makes n - 2 triangles. They turn as the outline does.
/// \param polygon finite coordinates
// Method: sides are split where corners touch them; then a sweep keeps, between neighbouring sides, a chain of corners
// that bulges towards what is not yet covered, and cuts off what a new corner sees of it (S. Hertel, K. Mehlhorn, "Fast
// triangulation of the plane with respect to simple polygons", Information and Control 64, 1985). The orientation of
// three corners is the only predicate.
Cut cut_polygon(const std::vector<Vec3d>& polygon);

struct Faces {
  struct Face {
    Kind kind;
    std::array<std::size_t, 4> corner;  ///< numbers of the outline's corners; the last one of a triangle is 0
  };
  std::vector<Face> faces;
  bool cut = false;   ///< the outline is not one of the faces
  std::string error;  ///< as in Cut
};

/// The faces that stand for an outline of 3 or more corners: itself, if it is a triangle or a quad to be kept, or
/// triangles.
Faces faces_of(const std::vector<Vec3d>& polygon, bool keep_quads);

}  // namespace cchip::outline

#endif
