// SPDX-License-Identifier: Apache-2.0
#include "parting_way.hpp"

#include <algorithm>
#include <array>
#include <cchip/along.hpp>
#include <cchip/intersection.hpp>
#include <cchip/solids.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
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

std::vector<Vec3d> normals_of_contacts(const AssemblyPart& a, const AssemblyPart& b, std::size_t most_contacts) {
  CollisionRequest request;
  request.contacts = CollisionRequest::Contacts::all;
  request.max_contacts = most_contacts;
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

/// The shortest of the ways along some directions that part B from A; the first that is short enough.
std::optional<PartingWay> best_way(const AssemblyPart& a, const AssemblyPart& b, double enough,
                                   const std::vector<Vec3d>& directions) {
  std::optional<PartingWay> best;
  for (const Vec3d& direction : directions) {
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
  return best;
}

/// For each direction and its opposite the way along it until all of B is past all of A.
std::vector<PartingWay> ways_past(const AssemblyPart& a, const AssemblyPart& b, const std::vector<Vec3d>& directions) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<std::array<double, 4>> ends(directions.size(), {infinity, -infinity, infinity, -infinity});
  double greatest = 0;
  for (const std::size_t side : {0U, 1U}) {
    const AssemblyPart& part = side == 0 ? a : b;
    for (const Vec3d& vertex : part.object.mesh().vertices) {
      const Vec3d at = part.pose * vertex;
      greatest = std::max(greatest, at.cwiseAbs().maxCoeff());
      for (std::size_t i = 0; i < directions.size(); ++i) {
        const double value = directions[i].dot(at);
        ends[i][2 * side] = std::min(ends[i][2 * side], value);
        ends[i][2 * side + 1] = std::max(ends[i][2 * side + 1], value);
      }
    }
  }
  const double rounding = 0x1p-44 * std::max(greatest, b.pose.translation().cwiseAbs().maxCoeff());
  std::vector<PartingWay> ways;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    ways.push_back({directions[i], std::max(0.0, ends[i][1] - ends[i][2]) + rounding});
    ways.push_back({-directions[i], std::max(0.0, ends[i][3] - ends[i][0]) + rounding});
  }
  return ways;
}

}  // namespace

std::optional<PartingWay> parting_way(const AssemblyPart& a, const AssemblyPart& b, double enough,
                                      std::size_t most_normals) {
  std::vector<Vec3d> directions;
  for (const Vec3d& normal : normals_of_contacts(a, b)) {
    if (directions.size() / 2 == most_normals) break;
    directions.insert(directions.end(), {normal, -normal});
  }
  return best_way(a, b, enough, directions);
}

PartingWay rough_parting_way(const AssemblyPart& a, const AssemblyPart& b) {
  constexpr std::size_t most_contacts = 64;
  std::vector<Vec3d> directions = normals_of_contacts(a, b, most_contacts);
  for (int i = 0; i < 3; ++i) directions.emplace_back(Vec3d::Unit(i));
  const std::vector<PartingWay> ways = ways_past(a, b, directions);
  return *std::min_element(ways.begin(), ways.end(),
                           [](const PartingWay& x, const PartingWay& y) { return x.depth < y.depth; });
}

}  // namespace cchip::assembly
