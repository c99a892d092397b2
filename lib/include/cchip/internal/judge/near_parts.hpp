// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pairs of parts of two polygons that may meet.
#ifndef CCHIP_INTERNAL_JUDGE_NEAR_PARTS_HPP
#define CCHIP_INTERNAL_JUDGE_NEAR_PARTS_HPP

#include <cchip/collide.hpp>
#include <cchip/internal/geometry/box_tree.hpp>
#include <cstdint>
#include <vector>

namespace cchip {

/// Contains the point in the world, in spite of rounding; infinite where a coordinate may be beyond the doubles.
AxisBox<3> world_box(const Pose& pose, const Vec3d& p);
/// The same of a face of a mesh.
AxisBox<3> world_box(const Pose& pose, const Mesh& mesh, std::uint32_t face);

/// Calls visit(face of A, face of B), numbers in the meshes, for parts of the faces of a contact whose boxes in the
/// world overlap, until it returns true: in the order of B's parts for each of A's if there are few. \returns whether
/// it has
template <class Visit>
bool any_near_parts(const CollisionQuery& query, const Contact& contact, const Visit& visit) {
  const std::vector<std::uint32_t> parts_a = query.a->parts(contact.face_a);
  const std::vector<std::uint32_t> parts_b = query.b->parts(contact.face_b);
  const auto boxes = [](const Object& object, const Pose& pose, const std::vector<std::uint32_t>& parts) {
    std::vector<AxisBox<3>> result;
    result.reserve(parts.size());
    for (const std::uint32_t face : parts) result.push_back(world_box(pose, object.mesh(), face));
    return result;
  };
  constexpr std::size_t few = 64;
  if (parts_a.size() * parts_b.size() <= few) {
    for (const std::uint32_t a : parts_a) {
      for (const std::uint32_t b : parts_b) {
        if (visit(a, b)) return true;
      }
    }
    return false;
  }
  const BoxTree<3> a(boxes(*query.a, *query.pose_a, parts_a));
  const BoxTree<3> b(boxes(*query.b, *query.pose_b, parts_b));
  bool done = false;
  a.for_each_overlap(b, [&](std::uint32_t i, std::uint32_t k) { done = done || visit(parts_a[i], parts_b[k]); });
  return done;
}

}  // namespace cchip

#endif
