// SPDX-License-Identifier: Apache-2.0
/// \file
/// How do two solids lie to each other: apart, touching, overlapping, one inside the other? docs/cpp/solids.md
///
/// A closed surface bounds a solid: the points from which a ray crosses it an odd number of times. So a shell inside
/// another is a cavity, whichever way round its faces are, and space that two parts of one mesh share is outside.
/// Pieces of a surface with the same side on both sides, such as two faces that coincide, bound nothing.
#ifndef CCHIP_CPU_SOLIDS_HPP
#define CCHIP_CPU_SOLIDS_HPP

#include <cchip/collide/collide.hpp>
#include <cchip/collide/scene.hpp>
#include <cchip/cpu/cpu_device.hpp>
#include <vector>

namespace cchip {

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

/// How two placed solids lie to each other; exactly, in real arithmetic. A quad that is not flat is the two triangles
/// of its corners 0, 1, 2 and 0, 2, 3.
/// \param device finds the faces in contact; the rest is done by the calling thread
/// \throws as Device::collide(); std::invalid_argument a surface is open (the message names the object and
///         Object::open_edge()), or a pose flattens space, so that nothing is a solid any more
SolidRelation solids(Device& device, const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b);
/// The same without a device of one's own. Any number of threads may call it at a time.
SolidRelation solids(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b);

/// Two objects of a scene that are not disjoint, a < b. In the relation `a` is object A.
struct SolidPair {
  Scene::Id a = 0;
  Scene::Id b = 0;
  SolidRelation relation = SolidRelation::disjoint;
};
/// All pairs of Scene::candidates() that are not disjoint, ascending.
/// \throws as above; each object of a pair must be closed
std::vector<SolidPair> solids(Device& device, const Scene& scene);

}  // namespace cchip

#endif
