// SPDX-License-Identifier: Apache-2.0
/// \file
/// How do two solids lie to each other: apart, touching, overlapping, one inside the other? docs/cpp/solids.md
///
/// A closed surface bounds a solid. InsideRule says which points are inside; surfaces whose shells neither overlap nor
/// are there twice have the same inside by both rules if their cavities are turned inside out. Pieces of a surface with
/// the same side on both sides, such as two faces that coincide, bound nothing.
#ifndef CCHIP_SOLIDS_HPP
#define CCHIP_SOLIDS_HPP

#include <cchip/collide.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/scene.hpp>
#include <optional>
#include <vector>

namespace cchip {

enum class InsideRule {
  /// Where a ray crosses the surface an odd number of times, as in STL slicers' "even-odd". A shell inside another is a
  /// cavity, whichever way round its faces are, and space that two shells of one mesh share is outside.
  odd,
  /// Where the surface winds around a point: rays leave it more often than they enter it, or the other way round. Space
  /// that two shells share is inside, a shell inside another is a cavity if its faces are the other way round. Faces
  /// must be the same way round as their neighbours.
  nonzero
};

struct SolidRequest {
  InsideRule inside = InsideRule::odd;
};

enum class SolidRelation {
  disjoint,     ///< they share no volume, and their surfaces share no point
  touching,     ///< they share no volume, but their surfaces share a point
  overlapping,  ///< they share volume, and each has volume outside the other
  a_in_b,       ///< all of A's volume is in B, which has more; their surfaces may touch
  b_in_a,       ///< the same the other way round
  equal         ///< the same volume
};

/// The name of the enumerator, such as "a_in_b".
const char* name_of(SolidRelation relation);

struct SolidResult {
  SolidRelation relation = SolidRelation::disjoint;
  /// shell_overlap() of A and of B: faces of one object that cross or share an area. Where shells overlap or were
  /// written twice, the relation depends on the rule for the inside, so look at the mesh, or ask with the rule that is
  /// meant. Not looked for, and empty, if the boxes of the objects are apart.
  std::optional<Contact> overlap_a = std::nullopt;
  std::optional<Contact> overlap_b = std::nullopt;
  operator SolidRelation() const { return relation; }  // NOLINT: it is one
};

/// How two placed solids lie to each other; exactly, in real arithmetic. A quad that is not flat is the two triangles
/// of its corners 0, 1, 2 and 0, 2, 3.
/// \param device finds the faces in contact; the rest is done by the calling thread
/// \throws as Device::collide(); std::invalid_argument a surface is open (the message names the object and
///         Object::open_edge()), or, with InsideRule::nonzero, its faces are not all the same way round
///         (Object::twisted_edge()), or a pose flattens space, so that nothing is a solid any more
SolidResult solids(Device& device, const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                   const SolidRequest& request = {});
/// The same without a device of one's own. Any number of threads may call it at a time.
SolidResult solids(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                   const SolidRequest& request = {});

enum class PointPlace { outside, on_surface, inside };
/// The name of the enumerator, such as "on_surface".
const char* name_of(PointPlace place);

/// Where points are to a placed solid; exactly, in real arithmetic.
/// \param points in the world
/// \param threads 0: as many as there are cores
/// \throws as solids(); std::invalid_argument as PointCloud
std::vector<PointPlace> inside(const Object& object, const Pose& pose, const std::vector<Vec3d>& points,
                               const SolidRequest& request = {}, unsigned threads = 1);

/// Two objects of a scene, a < b. In the relation `a` is object A.
struct SolidPair : SolidResult {
  Scene::Id a = 0;
  Scene::Id b = 0;
};
/// The pairs of Scene::candidates() that are not disjoint, or of which an object's shells overlap, ascending.
/// \throws as above; each object of a pair must be closed
std::vector<SolidPair> solids(Device& device, const Scene& scene, const SolidRequest& request = {});

}  // namespace cchip

#endif
