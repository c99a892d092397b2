// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where do two objects touch or cross? docs/cpp/intersections.md
///
/// The points, segments and polygons that faces in contact share, and the curves that these form. Exact as collide():
/// each coordinate is the double nearest to that of the exact point.
#ifndef CCHIP_INTERSECTION_HPP
#define CCHIP_INTERSECTION_HPP

#include <cchip/collide.hpp>
#include <cchip/internal/exact/intersection.hpp>
#include <cstdint>
#include <vector>

namespace cchip {

/// What the two faces of a contact share: one Intersection. Of faces that were cut into triangles, one for each pair of
/// their triangles that share a point, by their numbers in the meshes. None if the faces are apart, as those of a query
/// with CollisionRequest::within may be.
/// \param contact of collide() for this query
/// \throws std::invalid_argument as Device::collide(); an object has no such face
/// \throws std::runtime_error the calling thread flushes small numbers to zero
std::vector<Intersection> intersections(const CollisionQuery& query, const Contact& contact);
/// The same for many contacts, in their order.
std::vector<std::vector<Intersection>> intersections(const CollisionQuery& query, const std::vector<Contact>& contacts);

/// Segments that follow each other.
struct IntersectionCurve {
  std::vector<Vec3d> points;  ///< at least two; of a closed curve the first is not repeated
  bool closed = false;        ///< the last point is joined to the first
};

/// The segments that the faces of the contacts share, chained where their ends are the same exact point. A segment that
/// several pairs of faces share, such as those beside an edge, counts once. Curves end where one segment ends alone,
/// and where more than two meet. Points and polygons that faces share are left out; a polygon is commonly framed by
/// segments of the faces around it. Does not depend on the order of the contacts.
/// \param contacts of collide() with Contacts::all
/// \throws as intersections()
std::vector<IntersectionCurve> intersection_curves(const CollisionQuery& query, const std::vector<Contact>& contacts);

/// Unit normal of a face under a pose, by the order of its vertices: counter-clockwise as seen from where it points to.
/// A pose that mirrors turns it about. Of a quad that is not flat, and of a face that was cut, that of its vector area;
/// zero if that is zero. Each component is off by at most 2^-50.
/// \param face number in the file, as in Contact
/// \throws as intersections()
Vec3d face_normal(const Object& object, const Pose& pose, std::uint32_t face);

}  // namespace cchip

#endif
