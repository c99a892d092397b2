// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "filter.hpp"
#include "hulls.hpp"
#include "posed_filter.hpp"
#include "posed_ints.hpp"

namespace cchip {
namespace {

using exact::Filter;
using exact::filter_offset;
using exact::filter_points;
using exact::fits;
using exact::greatest_component;
using exact::Hull;
using exact::Offset;
using exact::PosedInts;
using exact::Vec;

constexpr double unit = std::numeric_limits<double>::epsilon() / 2;  // greatest relative error of one operation
constexpr double lost = 0x1p-1070;                                   // more than what underflows of some operations

/// Vertices of both primitives with B's translation taken off, rounded.
struct Rounded {
  std::array<Vec3d, 4> a;
  std::array<Vec3d, 4> b;
  std::size_t count_a = 0;
  std::size_t count_b = 0;
  double error = 0;     ///< bound on the error of each coordinate
  double greatest = 0;  ///< magnitude of a coordinate relative to the base
};

/// True only if the intervals on the axis are disjoint, by more than rounding can explain. The axis itself needs no
/// error bound: any axis is valid.
bool separates(const Vec3d& axis, const Rounded& r) {
  const double size = axis.cwiseAbs().sum();
  if (!(size * r.greatest < 0x1p1000)) return false;  // a projection might overflow
  const auto interval = [&axis](const std::array<Vec3d, 4>& v, std::size_t count) {
    const double first = axis.dot(v[0]);
    std::pair<double, double> range = {first, first};
    for (std::size_t i = 1; i < count; ++i) {
      const double at = axis.dot(v[i]);
      range.first = std::min(range.first, at);
      range.second = std::max(range.second, at);
    }
    return range;
  };
  const auto a = interval(r.a, r.count_a);
  const auto b = interval(r.b, r.count_b);
  const double gap = std::max(b.first - a.second, a.first - b.second);
  return gap > size * (2.5 * r.error + 16 * unit * r.greatest) + lost;
}

/// Normal of a triangle, or of the plane along both diagonals of a quad.
Vec3d normal(const std::array<Vec3d, 4>& v, std::size_t count) { return (v[2] - v[0]).cross(v[count - 1] - v[1]); }

/// Directions of the separating axis test for planar primitives: both normals, then the cross products of their edges
/// or, if the planes are nearly parallel, the normals of the edges within the plane.
bool separated(const Rounded& r) {
  const Vec3d normal_a = normal(r.a, r.count_a);
  const Vec3d normal_b = normal(r.b, r.count_b);
  if (separates(normal_a, r) || separates(normal_b, r)) return true;
  const auto size = [](const Vec3d& v) { return v.cwiseAbs().sum(); };
  if (size(normal_a.cross(normal_b)) < 0x1p-20 * size(normal_a) * size(normal_b)) {
    for (std::size_t i = 0; i < r.count_a; ++i) {
      if (separates(normal_a.cross(r.a[(i + 1) % r.count_a] - r.a[i]), r)) return true;
    }
    for (std::size_t k = 0; k < r.count_b; ++k) {
      if (separates(normal_a.cross(r.b[(k + 1) % r.count_b] - r.b[k]), r)) return true;
    }
    return false;
  }
  for (std::size_t i = 0; i < r.count_a; ++i) {
    const Vec3d edge = r.a[(i + 1) % r.count_a] - r.a[i];
    for (std::size_t k = 0; k < r.count_b; ++k) {
      if (separates(edge.cross(r.b[(k + 1) % r.count_b] - r.b[k]), r)) return true;
    }
  }
  return false;
}

/// True if rounding hides on which side of A's plane each vertex of B lies.
bool is_flush_but_for_rounding(const Rounded& r) {
  const Vec3d axis = normal(r.a, r.count_a);
  const double bound = axis.cwiseAbs().sum() * (2.5 * r.error + 16 * unit * r.greatest);
  return std::all_of(r.b.begin(), r.b.begin() + static_cast<std::ptrdiff_t>(r.count_b),
                     [&](const Vec3d& v) { return std::abs(axis.dot(v - r.a[0])) <= bound; });
}

/// True if coordinates under the pose are sums of products that no double holds, as a rule.
bool rounds(const Pose& pose) {
  for (Eigen::Index row = 0; row < 3; ++row) {
    int terms = 0;
    bool is_long = false;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double entry = pose(row, c);
      if (entry == 0) continue;
      ++terms;
      is_long = is_long || std::abs(std::remainder(entry, 0x1p-20)) > 0;
    }
    if (terms > 1 && is_long) return true;
  }
  return false;
}

Hull<Filter> filter_hull(const Primitive& p, const Eigen::Matrix3d& linear, const Vec<Filter>& offset) {
  return {filter_points(p, linear, offset), p.vertex_count()};
}

/// True only if the map has an inverse. The product of the columns' sums of magnitudes bounds all that is added up for
/// the determinant; its rounding errors are below 2^-49 of it.
bool is_regular(const Pose& pose) {
  const Vec3d columns = pose.linear().cwiseAbs().colwise().sum();
  if (!(columns.minCoeff() > 0x1p-200 && columns.maxCoeff() < 0x1p200)) return false;
  return std::abs(pose.linear().determinant()) > 0x1p-40 * columns.prod();
}

}  // namespace

PosedPairs::PosedPairs(const Pose& pose_a, const Pose& pose_b) : pose_a_(pose_a), pose_b_(pose_b) {
  if (!pose_a.affine().allFinite() || !pose_b.affine().allFinite()) {
    throw std::invalid_argument("pose: an entry is not finite: replace NaN and infinities by numbers");
  }
  if (pose_a.affine() == pose_b.affine() && is_regular(pose_a)) {
    // A map that has an inverse keeps common points and inner points, so the primitives meet and cross as they lie.
    pose_a_ = Pose::Identity();
    pose_b_ = Pose::Identity();
  }
  rounds_ = rounds(pose_a_) || rounds(pose_b_);
  row_sum_a_ = pose_a_.linear().cwiseAbs().rowwise().sum().maxCoeff();
  row_sum_b_ = pose_b_.linear().cwiseAbs().rowwise().sum().maxCoeff();
  const Offset offset(pose_a_, pose_b_);
  offset_ = offset.value;
  offset_error_ = offset.error;
}

PosedPairs::Answer PosedPairs::decide(const Primitive& a, const Primitive& b, bool tell_crossing) const {
  Rounded r;
  r.count_a = a.vertex_count();
  r.count_b = b.vertex_count();
  // Both frames lose B's translation; then b's first vertex, rounded, is the origin: a fixed point like any other.
  const Vec3d base = pose_b_.linear() * b.v[0];
  for (std::size_t i = 0; i < r.count_a; ++i) {
    r.a[i] = (pose_a_.linear() * a.v[i] + offset_) - base;
    r.greatest = std::max(r.greatest, r.a[i].cwiseAbs().maxCoeff());
  }
  for (std::size_t i = 0; i < r.count_b; ++i) {
    r.b[i] = pose_b_.linear() * b.v[i] - base;
    r.greatest = std::max(r.greatest, r.b[i].cwiseAbs().maxCoeff());
  }
  const double magnitude =
      row_sum_a_ * greatest_component(a) + row_sum_b_ * greatest_component(b) + offset_.cwiseAbs().maxCoeff();
  r.error = 8 * unit * magnitude + lost;
  if (magnitude < 0x1p1000 && separated(r)) return {};
  // Doubles with an error bound would know no side either, so that stage is left out.
  if (rounds_ && is_flush_but_for_rounding(r)) return decide_in_integers(a, b, tell_crossing);

  const Hull<Filter> hull_a = filter_hull(a, pose_a_.linear(), filter_offset(offset_, offset_error_));
  const Hull<Filter> hull_b = filter_hull(b, pose_b_.linear(), Vec<Filter>{});
  Filter::reset();
  Answer answer;
  answer.hit = hulls_meet(hull_a, hull_b);
  bool known = !Filter::gave_up();
  if (known && (!answer.hit || !tell_crossing)) return answer;
  if (known) {
    answer.crosses = hulls_cross(hull_a, hull_b);
    known = !Filter::gave_up();
    if (known) return answer;
  }
  return decide_in_integers(a, b, tell_crossing);
}

bool PosedPairs::cross(const Primitive& a, const Primitive& b) const {
  Filter::reset();
  const bool crosses = hulls_cross(filter_hull(a, pose_a_.linear(), filter_offset(offset_, offset_error_)),
                                   filter_hull(b, pose_b_.linear(), Vec<Filter>{}));
  if (!Filter::gave_up()) return crosses;
  return decide_in_integers(a, b, true).crosses;
}

PosedPairs::Answer PosedPairs::decide_in_integers(const Primitive& a, const Primitive& b, bool tell_crossing) const {
  Pose pose_a = pose_a_;
  Pose pose_b = pose_b_;
  if (offset_error_.isZero(0)) {  // what is left of the translations has fewer bits
    pose_a.translation() = offset_;
    pose_b.translation().setZero();
  }
  const PosedInts ints_a(a, pose_a);
  const PosedInts ints_b(b, pose_b);
  const auto answer = [&](const auto& hull_a, const auto& hull_b) -> Answer {
    const bool hit = hulls_meet(hull_a, hull_b);
    return {hit, true, hit && tell_crossing && hulls_cross(hull_a, hull_b)};
  };
  const int exponent = std::min(ints_a.exponent(), ints_b.exponent());
  const int bits = std::max(ints_a.top(), ints_b.top()) - exponent;
  const auto wide = [&](auto width) {
    constexpr std::size_t words = decltype(width)::value;
    return answer(ints_a.hull<words>(exponent), ints_b.hull<words>(exponent));
  };
  if (fits<4>(bits)) return wide(std::integral_constant<std::size_t, 4>());
  if (fits<6>(bits)) return wide(std::integral_constant<std::size_t, 6>());
  if (fits<8>(bits)) return wide(std::integral_constant<std::size_t, 8>());
  if (!tell_crossing) return {exact_intersects(a, pose_a, b, pose_b), true, false};
  const Relation relation = exact_relation(a, pose_a, b, pose_b);
  return {relation != Relation::apart, true, relation == Relation::crossing};
}

}  // namespace cchip
