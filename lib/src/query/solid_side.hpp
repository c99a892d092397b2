// SPDX-License-Identifier: Apache-2.0
/// \file
/// A placed solid: its triangles in whole numbers, and what lines along the axes pass.
#ifndef CCHIP_QUERY_SOLID_SIDE_HPP
#define CCHIP_QUERY_SOLID_SIDE_HPP

#include <array>
#include <cchip/internal/geometry/box_tree.hpp>
#include <cchip/internal/judge/shells.hpp>
#include <cchip/object.hpp>
#include <cchip/pose.hpp>
#include <unordered_map>

#include "exact/scaled_points.hpp"
#include "search/frame_gap.hpp"

namespace cchip {

/// The point x / w in units of 2^exponent. \pre w > 0
struct SolidPoint {
  exact::Vec<exact::BigInt> x;
  exact::BigInt w;
};

/// A point on a face, moved by e along w and by e^2 along t, for an e above 0 that is as small as needed.
struct SolidSample {
  SolidPoint at;
  exact::Vec<exact::BigInt> w;
  exact::Vec<exact::BigInt> t;
  std::size_t axis;  ///< of the line through it
};

/// Triangles of a surface that a line passes before a point, at it and behind it: how many, and how many more with
/// their normals along the line than against it.
struct PassedTriangles {
  struct Count {
    unsigned all = 0;
    int net = 0;
  };
  Count below;
  Count here;
  Count above;
};

/// A quad is the two triangles of its corners 0, 1, 2 and 0, 2, 3.
class SolidSide {
 public:
  /// Number of a triangle: twice that of its face, and one more for the second one of a quad.
  using Triangle = std::uint32_t;
  using BigInt = exact::BigInt;
  using Vector = exact::Vec<BigInt>;

  SolidSide(const Object& object, const Pose& pose);

  const Object& object() const { return object_; }
  const Pose& pose() const { return pose_; }
  const Shells& shells() const { return shells_of(object_); }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(object_.mesh().faces.size()); }
  static std::uint32_t face(Triangle t) { return t / 2; }
  /// Of the triangle in object coordinates.
  std::array<std::uint32_t, 3> vertices(Triangle t) const;
  Primitive primitive(Triangle t) const;
  template <class Visit>
  void for_each_triangle(std::uint32_t face, const Visit& visit) const {
    visit(2 * face);
    if (object_.mesh().faces[face].kind == Kind::quad) visit(2 * face + 1);
  }

  /// Greatest exponent such that all coordinates in the world are certainly multiples of 2^exponent.
  int exponent() const;
  /// The unit of what follows, at most exponent().
  void set_exponent(int exponent) { exponent_ = exponent; }

  const std::array<Vector, 3>& corners(Triangle t) { return placed(t).corner; }
  /// Zero if the triangle is collapsed.
  const Vector& normal(Triangle t) { return placed(t).normal; }

  /// True only if a plane across an axis separates the two.
  bool is_clear_of(const SolidSide& other) const { return !whole_.overlaps(other.whole_); }
  /// Contains the point in the world, in spite of rounding.
  AxisBox<3> box_of(const SolidPoint& p) const;
  /// Does a line through the sample along its axis pass the triangle?
  bool is_passed(Triangle t, const SolidSample& sample);
  PassedTriangles passed(const SolidSample& sample);

 private:
  using Box = AxisBox<3>;
  struct Placed {
    std::array<Vector, 3> corner;
    Vector normal;
  };

  const Placed& placed(Triangle t);
  Box box_of(const bvh::SupportLine& line) const;
  void pass(bvh::NodeRef node, const Box& column, const SolidSample& sample, PassedTriangles& passed);

  const Object& object_;
  const Pose& pose_;
  std::array<LineReach, 3> reach_;  ///< along the axes of the world
  std::array<double, 3> centre_;
  std::array<double, 3> slack_;
  Box whole_;
  int exponent_ = 0;
  std::unordered_map<Triangle, Placed> placed_;
};

}  // namespace cchip

#endif
