// SPDX-License-Identifier: Apache-2.0
/// \file
/// The distance of two placed meshes by brute force over all pairs of faces, in integers. It shares no search, no tree
/// and no arithmetic with the library.
#ifndef CCHIP_BENCH_EXACT_DISTANCE_HPP
#define CCHIP_BENCH_EXACT_DISTANCE_HPP

#include <algorithm>
#include <cchip/mesh.hpp>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "distance_oracle.hpp"  // of tests/lib

namespace cchip::testing {

/// The faces of a mesh under a rigid pose: bounds of each in doubles, and its points in integers.
class PlacedFaces {
 public:
  PlacedFaces(const Mesh& mesh, const Pose& pose) : mesh_(mesh), pose_(pose) {
    for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
      const Primitive face = mesh.primitive(i);
      Bounds box = {i, pose * face.v[0], pose * face.v[0]};
      for (std::size_t k = 1; k < face.vertex_count(); ++k) {
        box.low = box.low.cwiseMin(pose * face.v[k]);
        box.high = box.high.cwiseMax(pose * face.v[k]);
      }
      boxes_.push_back(box);
    }
    for (const Vec3d& v : mesh.vertices) {
      note_exponent(least_vertex_, v);
      reach_ = std::max(reach_, v.cwiseAbs().sum() + pose.translation().cwiseAbs().sum());
    }
    for (Eigen::Index column = 0; column < 4; ++column) note_exponent(least_pose_, pose.affine().col(column));
  }

  struct Bounds {
    std::uint32_t face;
    Vec3d low, high;
    /// Of the boxes, in doubles.
    double distance(const Bounds& b) const {
      return (low - b.high).cwiseMax(b.low - high).cwiseMax(Vec3d::Zero()).norm();
    }
  };
  const std::vector<Bounds>& boxes() const { return boxes_; }
  Bounds whole() const {
    Bounds all = boxes_.front();
    for (const Bounds& box : boxes_) {
      all.low = all.low.cwiseMin(box.low);
      all.high = all.high.cwiseMax(box.high);
    }
    return all;
  }
  /// Above every error of a box and of a projection: roundings are some 2^-50 of the greatest sum of coordinates.
  double margin() const { return 0x1p-40 * reach_; }
  /// The places after the point that every coordinate in the world needs.
  int unit_bits() const { return std::max(0, -least_vertex_ - least_pose_); }
  std::vector<cchip_test::IntPoint<cchip_test::BigInt>> points(std::uint32_t face, int unit_bits) const {
    return cchip_test::posed_points(mesh_.primitive(face), pose_, unit_bits);
  }
  /// Least and greatest coordinate along a direction of each face, as those of boxes().
  std::vector<std::pair<double, double>> along(const Vec3d& direction) const {
    std::vector<std::pair<double, double>> result;
    for (std::uint32_t i = 0; i < mesh_.faces.size(); ++i) {
      const Primitive face = mesh_.primitive(i);
      std::pair<double, double> range = {std::numeric_limits<double>::infinity(),
                                         -std::numeric_limits<double>::infinity()};
      for (std::size_t k = 0; k < face.vertex_count(); ++k) {
        const double x = direction.dot(pose_ * face.v[k]);
        range = {std::min(range.first, x), std::max(range.second, x)};
      }
      result.push_back(range);
    }
    return result;
  }

 private:
  template <class Vector>
  static void note_exponent(int& least, const Vector& values) {
    for (Eigen::Index i = 0; i < 3; ++i) least = std::min(least, cchip_test::Parts(values[i]).exponent);
  }

  const Mesh& mesh_;
  const Pose& pose_;
  std::vector<Bounds> boxes_;
  double reach_ = 0;
  int least_vertex_ = 0;
  int least_pose_ = -53;  // a pose has a 1 as its last row
};

/// The least square of a distance of two faces, where it is at most that of `limit`.
struct ExactDistance {
  cchip_test::IntSquare<cchip_test::BigInt> square;  ///< under 0: every pair is farther apart than the limit
  int unit_bits = 0;
  std::size_t asked = 0;  ///< pairs that took integers
  /// -1, 0, 1: the distance is below, at or above d; above, if none is within the limit.
  int compare(double d) const { return square.under == 0 ? 1 : cchip_test::compare(square, d, unit_bits); }
};

/// \param direction any direction; pairs of faces that it parts by more than the limit need no integers
inline ExactDistance exact_distance(const PlacedFaces& a, const PlacedFaces& b, double limit, const Vec3d& direction) {
  ExactDistance result;
  result.unit_bits = std::max(a.unit_bits(), b.unit_bits());
  const double far = limit + a.margin() + b.margin();
  const Vec3d unit = direction.norm() > 0 ? Vec3d(direction.normalized()) : Vec3d(Vec3d::UnitX());
  const auto along_a = a.along(unit);
  const auto along_b = b.along(unit);
  const PlacedFaces::Bounds whole_b = b.whole();
  for (const PlacedFaces::Bounds& box_a : a.boxes()) {
    if (box_a.distance(whole_b) > far) continue;
    const auto [least_a, greatest_a] = along_a[box_a.face];
    std::vector<cchip_test::IntPoint<cchip_test::BigInt>> points_a;
    for (const PlacedFaces::Bounds& box_b : b.boxes()) {
      if (along_b[box_b.face].first - greatest_a > far || least_a - along_b[box_b.face].second > far) continue;
      if (box_a.distance(box_b) > far) continue;
      ++result.asked;
      if (points_a.empty()) points_a = a.points(box_a.face, result.unit_bits);
      const auto square = cchip_test::square_of_distance(points_a, b.points(box_b.face, result.unit_bits));
      if (result.square.under == 0 ||
          square.over * result.square.under < cchip_test::BigInt(result.square.over * square.under)) {
        result.square = square;
      }
      if (result.square.over == 0) return result;
    }
  }
  return result;
}

/// Is a point within d of the faces? d is small: integers are asked about the faces near it only.
inline bool is_near(const Vec3d& point, const PlacedFaces& faces, double d) {
  if (!point.allFinite()) return false;
  Mesh alone;
  alone.vertices = {point};
  alone.faces = {{Kind::tri, {0, 0, 0, 0}}};
  const Pose here = Pose::Identity();
  return exact_distance(PlacedFaces(alone, here), faces, d, Vec3d::UnitX()).compare(d) <= 0;
}

}  // namespace cchip::testing

#endif
