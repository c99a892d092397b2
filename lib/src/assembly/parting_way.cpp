// SPDX-License-Identifier: Apache-2.0
#include "parting_way.hpp"

#include <algorithm>
#include <array>
#include <cchip/along.hpp>
#include <cchip/intersection.hpp>
#include <cchip/solids.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace cchip::assembly {
namespace {

/// A direction, the same for normals that differ by less than their rounding and for both signs.
using Key = std::array<std::int64_t, 3>;

Key key_of(const Vec3d& normal) {
  constexpr double steps = 0x1p36;  // of 1: normals of coordinates in single precision differ by more
  Key key = {};
  for (std::size_t i = 0; i < 3; ++i) key[i] = std::llround(normal[static_cast<Eigen::Index>(i)] * steps);
  if (key < Key{}) {
    for (std::int64_t& x : key) x = -x;
  }
  return key;
}

}  // namespace

std::vector<Vec3d> normals_of_contacts(const AssemblyPart& a, const AssemblyPart& b) {
  CollisionRequest request;
  request.contacts = CollisionRequest::Contacts::all;
  const CollisionResult result = collide(a.object, a.pose, b.object, b.pose, request);
  struct Found {
    Vec3d normal;
    std::size_t count = 0;
  };
  std::map<Key, Found> found;
  const auto add = [&found](const AssemblyPart& part, const std::map<std::uint32_t, std::size_t>& faces) {
    for (const auto& [face, count] : faces) {
      const Vec3d normal = face_normal(part.object, part.pose, face);
      if (normal.isZero(0)) continue;
      const auto place = found.emplace(key_of(normal), Found{normal, 0}).first;
      place->second.count += count;
    }
  };
  std::map<std::uint32_t, std::size_t> faces_a;
  std::map<std::uint32_t, std::size_t> faces_b;
  for (const Contact& contact : result.contacts) {
    ++faces_a[contact.face_a];
    ++faces_b[contact.face_b];
  }
  add(a, faces_a);
  add(b, faces_b);
  std::vector<Found> sorted;
  for (const auto& entry : found) sorted.push_back(entry.second);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Found& x, const Found& y) { return x.count > y.count; });
  std::vector<Vec3d> normals;
  for (const Found& one : sorted) normals.push_back(one.normal);
  return normals;
}

namespace {

/// Do the parts share no volume, or, if one is open, do their surfaces not cross?
bool are_parted(const AssemblyPart& a, const AssemblyPart& b, const Pose& pose_b) {
  if (a.object.is_closed() && b.object.is_closed()) {
    const SolidResult result = solids(a.object, a.pose, b.object, pose_b);
    return result.relation == SolidRelation::disjoint || result.relation == SolidRelation::touching;
  }
  CollisionRequest request;
  request.relation = true;
  const CollisionResult result = collide(a.object, a.pose, b.object, pose_b, request);
  return result.relation != Relation::crossing;
}

}  // namespace

std::optional<PartingWay> parting_way(const AssemblyPart& a, const AssemblyPart& b, double enough,
                                      std::size_t most_normals) {
  std::optional<PartingWay> best;
  std::vector<Vec3d> normals = normals_of_contacts(a, b);
  normals.resize(std::min(normals.size(), most_normals));
  for (const Vec3d& normal : normals) {
    for (const double sign : {1.0, -1.0}) {
      const Vec3d direction = sign * normal;
      const AlongResult result = clear_along(a.object, a.pose, b.object, b.pose, direction);
      // A little more than the exact way: the length of the direction, products and the sum below are rounded.
      const double rounding = 0x1p-50 * b.pose.translation().cwiseAbs().maxCoeff();
      const double depth = result.upper * (1 + 0x1p-48) + rounding;
      if (!std::isfinite(depth) || (best && depth >= best->depth)) continue;
      // Surfaces that are clear of each other may be one inside the other.
      Pose moved = b.pose;
      moved.translation() += depth * direction;
      if (!are_parted(a, b, moved)) continue;
      best = PartingWay{direction, depth};
      if (depth <= enough) return best;
    }
  }
  return best;
}

}  // namespace cchip::assembly
