// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/internal/judge/near_parts.hpp>
#include <cchip/intersection.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "exact/common_part.hpp"
#include "exact/float_mode.hpp"

namespace cchip {
namespace {

using exact::BigInt;
using exact::CommonPart;
using exact::cross;
using exact::FractionPoint;
using exact::operator-;
using exact::Vec;

void check_face(const Object& object, std::uint32_t face, const char* name) {
  if (!object.parts(face).empty()) return;
  throw std::invalid_argument(std::string("contact: ") + name + " has no face " + std::to_string(face) +
                              "; take contacts of a query of the same objects");
}

/// Calls take(CommonPart) for each pair of parts of the faces that share a point.
template <class Take>
void for_each_part(const CollisionQuery& query, const Contact& contact, const Take& take) {
  check_face(*query.a, contact.face_a, "A");
  check_face(*query.b, contact.face_b, "B");
  const PosedPairs pairs(*query.pose_a, *query.pose_b);
  any_near_parts(query, contact, [&](std::uint32_t face_a, std::uint32_t face_b) {
    const Primitive a = query.a->mesh().primitive(face_a);
    const Primitive b = query.b->mesh().primitive(face_b);
    if (!pairs.decide(a, b).hit) return false;
    std::optional<CommonPart> part = exact::common_part(a, *query.pose_a, b, *query.pose_b);
    if (part) take(std::move(*part));
    return false;
  });
}

void check(const CollisionQuery& query) {
  check_float_mode();
  check_query(query, {});
}

std::vector<Intersection> checked_intersections(const CollisionQuery& query, const Contact& contact) {
  std::vector<Intersection> result;
  for_each_part(query, contact, [&](const CommonPart& part) {
    Intersection& one = result.emplace_back();
    one.kind = part.kind;
    for (const FractionPoint& p : part.points) one.points.push_back(p.rounded);
  });
  return result;
}

/// Segments between points that are known by their numbers, which ascend as the points do.
class Graph {
 public:
  void add(const FractionPoint& p, const FractionPoint& q) { segments_.emplace_back(place(p), place(q)); }

  std::vector<IntersectionCurve> curves() {
    number_points();
    std::vector<IntersectionCurve> result;
    // Curves with ends first; what is left then are rings.
    for (const bool rings : {false, true}) {
      for (std::size_t p = 0; p < at_.size(); ++p) {
        if (!rings && at_[p].size() == 2) continue;
        for (const std::size_t s : at_[p]) {
          if (!used_[s]) result.push_back(follow(p, s));
        }
      }
    }
    return result;
  }

 private:
  struct Before {
    bool operator()(const FractionPoint& p, const FractionPoint& q) const { return exact::compare(p, q) < 0; }
  };
  using Places = std::map<FractionPoint, std::size_t, Before>;

  Places::iterator place(const FractionPoint& p) { return places_.emplace(p, 0).first; }

  void number_points() {
    std::size_t number = 0;
    for (auto& [point, n] : places_) {
      n = number++;
      point_.push_back(point.rounded);
    }
    for (const auto& [p, q] : segments_) ends_.emplace_back(std::minmax(p->second, q->second));
    std::sort(ends_.begin(), ends_.end());
    ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
    at_.resize(point_.size());
    for (std::size_t s = 0; s < ends_.size(); ++s) {
      at_[ends_[s].first].push_back(s);
      at_[ends_[s].second].push_back(s);
    }
    used_.resize(ends_.size());
  }

  /// From a point along a segment to where the curve ends.
  IntersectionCurve follow(std::size_t from, std::size_t segment) {
    IntersectionCurve curve;
    curve.points.push_back(point_[from]);
    std::size_t p = from;
    for (;;) {
      used_[segment] = true;
      p = ends_[segment].first == p ? ends_[segment].second : ends_[segment].first;
      if (p == from) {
        curve.closed = true;
        return curve;
      }
      curve.points.push_back(point_[p]);
      if (at_[p].size() != 2) return curve;
      segment = at_[p][at_[p][0] == segment ? 1 : 0];
    }
  }

  Places places_;
  std::vector<std::pair<Places::iterator, Places::iterator>> segments_;
  std::vector<Vec3d> point_;
  std::vector<std::pair<std::size_t, std::size_t>> ends_;  ///< of each segment, the lesser first
  std::vector<std::vector<std::size_t>> at_;               ///< segments that end at a point
  std::vector<bool> used_;
};

/// Twice the vector area of a primitive, from the cross product of its diagonals, or of two edges of a triangle.
Vec<BigInt> vector_area(const Primitive& p, const Pose& pose, int exponent) {
  const std::array<Vec<BigInt>, 4> v = exact::scaled_points(p, pose, exponent);
  return p.kind == Kind::quad ? cross(v[2] - v[0], v[3] - v[1]) : cross(v[1] - v[0], v[2] - v[0]);
}

}  // namespace

std::vector<Intersection> intersections(const CollisionQuery& query, const Contact& contact) {
  check(query);
  return checked_intersections(query, contact);
}

std::vector<std::vector<Intersection>> intersections(const CollisionQuery& query,
                                                     const std::vector<Contact>& contacts) {
  check(query);
  std::vector<std::vector<Intersection>> result;
  result.reserve(contacts.size());
  for (const Contact& contact : contacts) result.push_back(checked_intersections(query, contact));
  return result;
}

std::vector<IntersectionCurve> intersection_curves(const CollisionQuery& query, const std::vector<Contact>& contacts) {
  check(query);
  Graph graph;
  for (const Contact& contact : contacts) {
    for_each_part(query, contact, [&](const CommonPart& part) {
      if (part.kind == Intersection::Kind::segment) graph.add(part.points[0], part.points[1]);
    });
  }
  return graph.curves();
}

Vec3d face_normal(const Object& object, const Pose& pose, std::uint32_t face) {
  check({&object, &pose, &object, &pose});
  check_face(object, face, "the object");
  const std::vector<std::uint32_t> parts = object.parts(face);
  int exponent = std::numeric_limits<int>::max();
  for (const std::uint32_t part : parts) {
    exponent = exact::common_exponent(object.mesh().primitive(part), pose, exponent);
  }
  Vec<BigInt> area;
  for (const std::uint32_t part : parts) {
    const Vec<BigInt> here = vector_area(object.mesh().primitive(part), pose, exponent);
    for (std::size_t k = 0; k < 3; ++k) area[k] += here[k];
  }
  const BigInt greatest = std::max({BigInt(abs(area[0])), BigInt(abs(area[1])), BigInt(abs(area[2]))});
  if (greatest == 0) return Vec3d::Zero();
  Vec3d normal;
  for (std::size_t k = 0; k < 3; ++k) {
    normal[static_cast<Eigen::Index>(k)] = exact::nearest_double(area[k], greatest, 0);
  }
  return normal / std::sqrt(normal.squaredNorm());
}

}  // namespace cchip
