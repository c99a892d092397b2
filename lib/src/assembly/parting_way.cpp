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

namespace {

/// The normal of a face, by its number in the file, in doubles: of a triangle that was cut from it.
Vec3d rough_normal(const AssemblyPart& part, std::uint32_t face) {
  const Mesh& mesh = part.object.mesh();
  const auto& vertex = mesh.faces[part.object.parts(face).front()].vertex;
  const auto at = [&](std::size_t k) -> Vec3d { return part.pose * mesh.vertices[vertex[k]]; };
  return (at(1) - at(0)).cross(at(2) - at(0)).stableNormalized();
}

/// \param normal_of a part and the number of a face in its file
template <class NormalOf>
std::vector<Vec3d> normals_by(const AssemblyPart& a, const AssemblyPart& b, std::size_t most_contacts,
                              const NormalOf& normal_of) {
  CollisionRequest request;
  request.contacts = CollisionRequest::Contacts::all;
  request.max_contacts = most_contacts;
  const CollisionResult result = collide(a.object, a.pose, b.object, b.pose, request);
  struct Found {
    Vec3d normal;
    std::size_t count = 0;
  };
  std::map<Key, Found> found;
  const auto add = [&](const AssemblyPart& part, const std::map<std::uint32_t, std::size_t>& faces) {
    for (const auto& [face, count] : faces) {
      const Vec3d normal = normal_of(part, face);
      if (normal.isZero(0) || !normal.allFinite()) continue;
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

}  // namespace

std::vector<Vec3d> normals_of_contacts(const AssemblyPart& a, const AssemblyPart& b) {
  return normals_by(a, b, std::numeric_limits<std::size_t>::max(), [](const AssemblyPart& part, std::uint32_t face) {
    return face_normal(part.object, part.pose, face);
  });
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

/// The shortest of the ways that part B from A, of those that were looked at.
class BestWay {
 public:
  /// \param enough the first one that is not longer is taken
  BestWay(const AssemblyPart& a, const AssemblyPart& b, double enough) : a_(a), b_(b), enough_(enough) {}

  bool is_enough() const { return depth_ <= enough_ && std::isfinite(depth_); }
  std::optional<PartingWay> best() const {
    if (!std::isfinite(depth_)) return std::nullopt;
    return PartingWay{direction_, depth_};
  }
  void look(const Vec3d& direction) {
    const AlongResult result = clear_along(a_.object, a_.pose, b_.object, b_.pose, direction);
    // A little more than the exact way: the length of the direction, products and the sum below are rounded.
    const double rounding = 0x1p-50 * b_.pose.translation().cwiseAbs().maxCoeff();
    const double depth = result.upper * (1 + 0x1p-48) + rounding;
    if (!(depth < depth_)) return;
    // Surfaces that are clear of each other may be one inside the other.
    Pose moved = b_.pose;
    moved.translation() += depth * direction;
    if (are_parted(a_, b_, moved)) {
      direction_ = direction;
      depth_ = depth;
    }
  }

 private:
  const AssemblyPart& a_;
  const AssemblyPart& b_;
  double enough_;
  Vec3d direction_ = Vec3d::Zero();
  double depth_ = std::numeric_limits<double>::infinity();
};

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
  BestWay way(a, b, enough);
  std::vector<Vec3d> normals = normals_of_contacts(a, b);
  normals.resize(std::min(normals.size(), most_normals));
  const auto looks = [&way](const Vec3d& direction) {
    for (const double sign : {1.0, -1.0}) {
      way.look(sign * direction);
      if (way.is_enough()) return true;
    }
    return false;
  };
  for (const Vec3d& normal : normals) {
    if (looks(normal)) return way.best();
  }
  // A part in a corner slides along one face while it leaves the other: away from two or three at once it leaves all.
  constexpr std::size_t most_in_corner = 4;
  normals.resize(std::min(normals.size(), most_in_corner));
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t k = i + 1; k < normals.size(); ++k) {
      for (const double sign : {1.0, -1.0}) {
        const Vec3d two = normals[i] + sign * normals[k];
        std::vector<Vec3d> sums = {two};
        for (std::size_t m = k + 1; m < normals.size(); ++m) {
          sums.insert(sums.end(), {two + normals[m], two - normals[m]});
        }
        for (const Vec3d& sum : sums) {
          if (sum.norm() > 0x1p-10 && looks(sum.normalized())) return way.best();
        }
      }
    }
  }
  return way.best();
}

PartingWay rough_parting_way(const AssemblyPart& a, const AssemblyPart& b) {
  constexpr std::size_t most_contacts = 64;
  std::vector<Vec3d> directions = normals_by(a, b, most_contacts, rough_normal);
  for (int i = 0; i < 3; ++i) directions.emplace_back(Vec3d::Unit(i));
  const std::vector<PartingWay> ways = ways_past(a, b, directions);
  return *std::min_element(ways.begin(), ways.end(),
                           [](const PartingWay& x, const PartingWay& y) { return x.depth < y.depth; });
}

}  // namespace cchip::assembly
