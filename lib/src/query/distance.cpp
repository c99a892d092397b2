// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/distance.hpp>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/internal/judge/near_parts.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "exact/nearest_planes.hpp"
#include "search/behind_plane.hpp"
#include "search/frame_gap.hpp"
#include "search/query_scale.hpp"
#include "search/simd_distance.hpp"
#include "search/tree_side.hpp"

namespace cchip {
namespace {

using bvh::NodeRef;

using FacePair = std::array<std::uint32_t, 2>;  ///< of A and of B, numbers in the meshes

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A search that takes more steps asks slabs, too: a short one is over before they pay.
constexpr std::uint64_t slab_steps = 256;
constexpr double nearly = 1 - 0x1p-7;

void check(const DistanceRequest& request) {
  if (!(request.rel_error >= 0 && request.rel_error < 1)) {
    throw std::invalid_argument("rel_error is " + decimal_text(request.rel_error) +
                                ": ask for one that is at least 0 and less than 1");
  }
  if (!(request.stop_above >= 0)) {
    throw std::invalid_argument("stop_above is " + decimal_text(request.stop_above) + ": it must be at least 0");
  }
}

/// Branch and bound over pairs of nodes, depth first, of those below a pair the nearest one first. Bounds of nodes and
/// of faces are in single precision; faces that may be the nearest ones are kept, doubles and then integers decide
/// between them at the end. All in the unit that QueryScale has chosen.
class DistanceSearch {
 public:
  DistanceSearch(const CollisionQuery& query, const QueryScale& scale, const DistanceRequest& request)
      : scale_(scale),
        request_(request),
        stop_above_(scale.rounded_up(request.stop_above)),
        kernels_(simd::distance_kernels()),
        a_{query.a->mesh(), query.a->tree()},
        b_{query.b->mesh(), query.b->tree()},
        gap_(*query.a, *query.pose_a, *query.b, *query.pose_b),
        distances_(*query.pose_a, *query.pose_b) {}

  /// \pre the objects share no point
  void run(DistanceResult& result) {
    stats_ = result.stats;
    search();
    answer(result);
    result.stats = stats_;
  }

 private:
  struct Item {
    double gap;    ///< at most the distance
    double order;  ///< the gap, or, below 0, how far the nodes overlap
    NodeRef a;
    NodeRef b;
    friend bool operator<(const Item& x, const Item& y) { return x.order > y.order; }
  };
  struct Faces {
    double lower;  ///< at most the distance
    std::uint32_t a;
    std::uint32_t b;
    std::uint64_t group;  ///< 0 until there are many
  };

  /// The same for parallel faces, mostly.
  static std::uint64_t group_of(const Primitive& p) {
    const Vec3d normal = (p.v[1] - p.v[0]).cross(p.v[2] - p.v[0]);
    const double size = normal.cwiseAbs().maxCoeff();
    if (!(size > 0 && size < infinity)) return 0;
    std::uint64_t group = 0;
    for (const double x : normal) group = group << 16U | static_cast<std::uint16_t>(std::lround(x / size * 0x1p14));
    return group;
  }

  /// Nothing this far apart matters any more.
  bool is_pruned(double gap) {
    if (gap > stop_above_) return true;
    // A little less than what is allowed, for the rounding of this line.
    if (gap < upper_ * (1 - (1 - 0x1p-20) * request_.rel_error)) return false;
    pruned_ = std::min(pruned_, gap);
    return true;
  }

  void set_axis(const Vec3d& axis) {
    gap_.set_axis(axis);
    unit_ = gap_.in_single(frame_);
  }

  void search() {
    set_axis(gap_.middle_b(b_.tree.lines() + b_.tree.root().first(), b_.tree.root().count()) -
             gap_.middle_a(a_.tree.lines() + a_.tree.root().first(), a_.tree.root().count()));
    stack_.reserve(256);
    stack_.push_back({0, 0, a_.tree.root(), b_.tree.root()});
    while (!stack_.empty()) {
      std::pop_heap(stack_.begin(), stack_.end());
      Item item = stack_.back();
      stack_.pop_back();
      if (is_pruned(item.gap)) break;
      const bool is_behind = is_behind_planes(item);
      if (all_behind_) {
        found_.clear();
        break;
      }
      if (is_behind) continue;
      for (;;) {
        if (item.a.is_leaf() && item.b.is_leaf()) {
          test_leaves(item.a, item.b);
          break;
        }
        const std::size_t before = stack_.size();
        const double most = nearest_ ? 1.25 * item.gap : infinity;
        open(item);
        const bool deeper = stack_.size() > before && stack_.back().gap <= most;
        if (deeper) {
          item = stack_.back();
          stack_.pop_back();
        }
        for (std::size_t end = before + 1; end <= stack_.size(); ++end) {
          std::push_heap(stack_.begin(), stack_.begin() + static_cast<std::ptrdiff_t>(end));
        }
        if (!deeper) break;
      }
    }
  }

  /// True only if nothing below the item is nearer than the nearest faces so far. Of many pairs at the same distance,
  /// as between parallel faces, bounds in single precision leave each open; the planes through the nearest points do
  /// not. They cost as much as some steps: they wait for as many, but not if the whole objects seem to lie behind them.
  bool is_behind_planes(const Item& item) {
    if (!nearest_ || !(is_between_planes_ || item.gap >= nearly * upper_)) return false;
    ++as_near_;
    // Those of earlier faces, which were not nearer, still prune.
    const auto is_behind = [&] { return behind_a_ && behind_a_->contains(item.a) && behind_b_->contains(item.b); };
    if (is_behind()) return true;
    const std::uint64_t wait = !is_between_planes_ ? 128 : behind_a_ ? 4 : 1;
    if (planes_of_ == nearest_ || as_near_ < wait) return false;
    make_planes();
    behind_a_.emplace(a_, planes_->a());
    behind_b_.emplace(b_, planes_->b());
    all_behind_ = is_between_planes_ && behind_a_->contains_all() && behind_b_->contains_all();
    return is_behind();
  }

  /// At most the distance of the objects, by the frame.
  double whole_gap() {
    kernels_.nodes(frame_, a_.tree.lines() + a_.tree.whole().first(), 1, b_.tree.lines() + b_.tree.whole().first(), 1,
                   0, gaps_);
    return std::sqrt(gaps_.square[0]) * unit_;
  }

  /// Those through the nearest points of the nearest faces, which share no point.
  void make_planes() {
    if (planes_of_ == nearest_) return;
    ++stats_.open;
    planes_of_ = nearest_;
    behind_a_.reset();
    behind_b_.reset();
    planes_.emplace(distances_, a_.mesh.primitive((*nearest_)[0]), b_.mesh.primitive((*nearest_)[1]));
  }

  /// Puts the pairs of the nodes below that may be nearer than what is known onto the stack, the nearest one on top.
  void open(const Item& item) {
    ++stats_.steps;
    stats_.box_tests += std::uint64_t{item.a.count()} * item.b.count();
    const bvh::SupportLine* const lines_a = a_.tree.lines() + item.a.first();
    const bvh::SupportLine* const lines_b = b_.tree.lines() + item.b.first();
    unsigned left = kernels_.nodes(frame_, lines_a, item.a.count(), lines_b, item.b.count(),
                                   single(std::min(upper_, stop_above_)), gaps_);
    if (left == 0) return;
    // Along the line between the middles of both, besides.
    const FrameGap::Line line =
        gap_.line(gap_.in_world(middle(gaps_.b, item.b.count(), -1) - middle(gaps_.a, item.a.count(), 1)));
    std::array<double, 4> on_line_b;
    for (std::uint32_t k = 0; k < item.b.count(); ++k) on_line_b[k] = FrameGap::reach_b(line, lines_b[k]);
    // In a long search, by the slabs of both.
    const bool with_slabs = stats_.steps > slab_steps;
    std::array<FrameGap::FrameSlab, 4> slabs_b;
    for (std::uint32_t k = 0; with_slabs && k < item.b.count(); ++k) slabs_b[k] = gap_.slab_b(lines_b[k], gaps_.b[k]);
    const std::size_t before = stack_.size();
    for (std::uint32_t i = 0; i < item.a.count(); ++i, left >>= 4U) {
      if ((left & 15U) == 0) continue;
      const FrameGap::FrameSlab slab_a = with_slabs ? gap_.slab_a(lines_a[i], gaps_.a[i]) : FrameGap::FrameSlab();
      const bool leaf_a = lines_a[i].ref().is_leaf();
      const double on_line_a = FrameGap::reach_a(line, lines_a[i]);
      for (std::uint32_t k = 0; k < item.b.count(); ++k) {
        if ((left >> k & 1U) == 0) continue;
        const double in_frame = std::sqrt(gaps_.square[4 * i + k]) * unit_;
        const double on_line = FrameGap::gap(line, on_line_a, on_line_b[k]);
        double gap = std::max(item.gap, std::max(in_frame, on_line));
        if (is_pruned(gap)) continue;
        if (with_slabs) {
          gap = std::max(gap, gap_.slab_gap(slab_a, slabs_b[k]) * unit_);
          if (is_pruned(gap)) continue;
        }
        const bool leaf_b = lines_b[k].ref().is_leaf();
        stack_.push_back(
            {gap, gap > 0 ? gap : on_line, a_.below(item.a.first() + i, leaf_b), b_.below(item.b.first() + k, leaf_a)});
      }
    }
    if (stack_.size() > before + 1) {
      std::iter_swap(std::max_element(stack_.begin() + static_cast<std::ptrdiff_t>(before), stack_.end()),
                     stack_.end() - 1);
    }
  }

  /// A length in units of the frame, rounded up.
  float single(double length) const { return static_cast<float>(std::min(length / unit_ * (1 + 0x1p-20), 1e15)); }

  /// Of nodes whose reaches these are, along the axes, from the centre of A.
  Vec3d middle(const std::array<std::array<float, simd::reach_lanes>, 4>& reach, std::uint32_t count, int sign) const {
    Vec3d sum = Vec3d::Zero();
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) sum[static_cast<Eigen::Index>(k)] += reach[i][2 * k] - reach[i][2 * k + 1];
    }
    sum *= sign * 0.5 / count;
    if (sign < 0) sum += Vec3d(frame_.centre_b[0], frame_.centre_b[1], frame_.centre_b[2]);
    return sum;
  }

  void test_leaves(NodeRef leaf_a, NodeRef leaf_b) {
    const std::uint32_t pairs = leaf_a.count() * leaf_b.count();
    stats_.pairs += pairs;
    if (!kernels_.leaves(frame_, a_.tree.vertices(leaf_a.first()), leaf_a, b_.tree.vertices(leaf_b.first()), leaf_b,
                         single(std::min(upper_, stop_above_)), faces_)) {
      // All are beyond what is known; a bound for an answer that need not be exact.
      for (std::uint32_t i = 0; i < pairs; ++i) is_pruned(faces_.lower[number(i, leaf_b)] * unit_);
      return;
    }
    for (std::uint32_t i = 0; i < pairs; ++i) {
      const double lower = faces_.lower[number(i, leaf_b)] * unit_;
      if (is_pruned(lower)) continue;
      const std::uint32_t face_a = a_.tree.faces()[leaf_a.first() + i / leaf_b.count()];
      const std::uint32_t face_b = b_.tree.faces()[leaf_b.first() + i % leaf_b.count()];
      const bool is_nearer = faces_.upper[number(i, leaf_b)] * unit_ < upper_ || !nearest_;
      // Between parallel faces only the planes see which are nearer.
      const bool sticks_out = !is_nearer && behind_a_ && !is_behind(face_a, face_b);
      if (!is_nearer && behind_a_ && !sticks_out) continue;
      found_.push_back({lower, face_a, face_b, 0});
      if (is_nearer || sticks_out) refine(found_.back());
    }
  }
  /// No nearer than the faces of the planes.
  bool is_behind(std::uint32_t face_a, std::uint32_t face_b) const {
    return planes_->a().contains(a_.mesh.primitive(face_a)) && planes_->b().contains(b_.mesh.primitive(face_b));
  }
  static std::size_t number(std::uint32_t pair, NodeRef leaf_b) {
    return 2 * std::size_t{pair / leaf_b.count()} + pair % leaf_b.count();
  }

  /// Bounds in doubles of faces that may be the nearest ones.
  void refine(Faces& faces) {
    const DistanceBounds bounds = distances_.bounds(a_.mesh.primitive(faces.a), b_.mesh.primitive(faces.b));
    faces.lower = std::max(faces.lower, bounds.lower);
    if (nearest_ && !(bounds.upper < upper_)) return;
    upper_ = bounds.upper;
    best_ = bounds;
    nearest_ = {faces.a, faces.b};
    as_near_ = 0;
    set_axis(bounds.point_b - bounds.point_a);
    is_between_planes_ = whole_gap() >= nearly * upper_;
  }

  void answer(DistanceResult& result) {
    if (!nearest_) return answer_above(result);
    double lower = std::min(pruned_, best_.lower);
    settle(lower);
    result.lower = scale_.lower(lower);
    if (result.lower > request_.stop_above) return answer_above(result);
    result.upper = scale_.upper(best_.upper);
    result.point_a = scale_.point(best_.point_a);
    result.point_b = scale_.point(best_.point_b);
    result.face_a = a_.mesh.number_in_file((*nearest_)[0]);
    result.face_b = b_.mesh.number_in_file((*nearest_)[1]);
  }

  /// Decides between the faces that were found.
  void settle(double& lower) {
    double least = infinity;  // of those that may be nearer
    const auto is_left = [&](const Faces& faces) {
      if (!(faces.lower < upper_) || nearest_ == FacePair{faces.a, faces.b}) return false;
      least = std::min(least, faces.lower);
      return true;
    };
    found_.erase(std::remove_if(found_.begin(), found_.end(), [&](const Faces& x) { return !is_left(x); }),
                 found_.end());
    lower = std::min({pruned_, best_.lower, least});
    if (best_.upper < infinity && best_.upper - lower <= request_.rel_error * best_.upper) return;
    // Few may end early. Many are at the same distance: those whose faces of A are parallel are behind the same planes.
    constexpr std::size_t few = 64;
    if (found_.size() > few) {
      for (Faces& faces : found_) faces.group = group_of(a_.mesh.primitive(faces.a));
    }
    std::sort(found_.begin(), found_.end(), [](const Faces& x, const Faces& y) {
      return std::tie(x.group, x.lower, x.a, x.b) < std::tie(y.group, y.lower, y.a, y.b);
    });
    make_planes();
    best_ = planes_->bounds();
    std::vector<exact::NearestPlanes> known = {*planes_};
    for (const Faces& faces : found_) {
      if (!(faces.lower < best_.lower)) continue;
      const Primitive a = a_.mesh.primitive(faces.a);
      const Primitive b = b_.mesh.primitive(faces.b);
      const bool is_behind = std::any_of(known.begin(), known.end(), [&](const exact::NearestPlanes& planes) {
        return planes.a().contains(a) && planes.b().contains(b);
      });
      if (is_behind) continue;
      if (distances_.bounds(a, b).lower >= best_.lower) continue;
      constexpr std::size_t most_known = 4;
      if (known.size() == most_known) known.pop_back();
      known.insert(known.begin(), exact::NearestPlanes(distances_, a, b));
      ++stats_.open;
      const DistanceBounds& bounds = known.front().bounds();
      if (!(bounds.lower < best_.lower || (bounds.lower == best_.lower && bounds.upper < best_.upper))) continue;
      nearest_ = {faces.a, faces.b};
      best_ = bounds;
    }
    lower = std::min(pruned_, best_.lower);
  }

  void answer_above(DistanceResult& result) const {
    result.lower = std::min(request_.stop_above, std::numeric_limits<double>::max());
    result.upper = infinity;
  }

  const QueryScale& scale_;
  const DistanceRequest& request_;
  const double stop_above_;  ///< DistanceRequest::stop_above in the unit of the search, at least
  const simd::DistanceKernels& kernels_;
  const TreeSide a_;
  const TreeSide b_;
  FrameGap gap_;
  simd::DistanceFrame frame_;
  double unit_ = 1;  ///< of the frame
  simd::NodeGaps gaps_;
  simd::FaceGaps faces_;
  const PosedDistances distances_;
  CollisionStats stats_;
  std::vector<Item> stack_;
  std::vector<Faces> found_;
  double upper_ = infinity;   ///< the least of a pair of faces so far
  double pruned_ = infinity;  ///< the least gap of what was left out since a pair of faces is as near
  std::optional<FacePair> nearest_;
  DistanceBounds best_;             ///< of these
  std::uint64_t as_near_ = 0;       ///< items since then that are about as near
  bool is_between_planes_ = false;  ///< by the frame the whole objects are nearly as far apart
  std::optional<exact::NearestPlanes> planes_;
  bool all_behind_ = false;  ///< nothing is nearer than the faces that planes_ is of
  std::optional<FacePair> planes_of_;
  std::optional<BehindPlane> behind_a_;
  std::optional<BehindPlane> behind_b_;
};

/// Of objects that share a point: 0, and such a point.
void answer_contact(const CollisionQuery& query, const QueryScale& scale, const Contact& contact,
                    DistanceResult& result) {
  const PosedDistances distances(*query.pose_a, *query.pose_b);
  result.face_a = contact.face_a;
  result.face_b = contact.face_b;
  const PosedPairs pairs(*query.pose_a, *query.pose_b);
  any_near_parts(query, contact, [&](std::uint32_t part_a, std::uint32_t part_b) {
    const Primitive a = query.a->mesh().primitive(part_a);
    const Primitive b = query.b->mesh().primitive(part_b);
    if (!pairs.decide(a, b).hit) return false;
    const DistanceBounds bounds = distances.tight_bounds(a, b);
    result.point_a = scale.point(bounds.point_a);
    result.point_b = scale.point(bounds.point_b);
    return true;
  });
}

}  // namespace

DistanceResult distance(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                        const DistanceRequest& request) {
  check(request);
  DistanceResult result;
  const CollisionResult touching = collide(a, pose_a, b, pose_b);
  result.stats = touching.stats;
  const QueryScale scale({&a, &pose_a, &b, &pose_b});
  const Pose scaled_a = scale(pose_a);
  const Pose scaled_b = scale(pose_b);
  const CollisionQuery query = {&a, &scaled_a, &b, &scaled_b};
  if (touching.hit) {
    answer_contact(query, scale, touching.contacts.front(), result);
  } else {
    DistanceSearch(query, scale, request).run(result);
  }
  return result;
}

}  // namespace cchip
