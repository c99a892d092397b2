// SPDX-License-Identifier: Apache-2.0
/// \file
/// What two primitives have in common, exactly.
#ifndef CCHIP_INTERNAL_EXACT_INTERSECTION_HPP
#define CCHIP_INTERNAL_EXACT_INTERSECTION_HPP

#include <cchip/pose.hpp>
#include <cchip/primitive.hpp>
#include <optional>
#include <vector>

namespace cchip {

/// The set of all points that two closed primitives share: the hull of `points`, none of which is superfluous. Kind,
/// number and order of the points are those of the exact set. Each coordinate is the double nearest to the exact one,
/// of two that are equally near the even one; infinite where that is beyond the doubles. So points that differ may have
/// the same coordinates.
struct Intersection {
  enum class Kind {
    point,       ///< one point
    segment,     ///< two points, the lesser first: the one with the lesser x, of equal x the lesser y, then z
    polygon,     ///< the corners once around, from the least one to the lesser one of its neighbours
    polyhedron,  ///< of two quads that are not flat, which are tetrahedra: the corners, ascending
  };
  Kind kind = Kind::point;
  std::vector<Vec3d> points;
};

/// The points shared by two primitives under poses; none if they are apart, as exact_intersects() tells. In real
/// arithmetic without rounding: a vertex v lies at linear() v + translation(). A quad is the hull of its four vertices.
/// \throws std::invalid_argument a coordinate or an entry of a pose is not finite
std::optional<Intersection> exact_intersection(const Primitive& a, const Pose& pose_a, const Primitive& b,
                                               const Pose& pose_b);

}  // namespace cchip

#endif
