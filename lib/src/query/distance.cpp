// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/distance.hpp>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/internal/judge/near_parts.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "exact/nearest_planes.hpp"
#include "search/behind_plane.hpp"
#include "search/frame_gap.hpp"
#include "search/query_scale.hpp"
#include "search/tree_side.hpp"

namespace cchip {
namespace {

using bvh::NodeRef;

constexpr double infinity = std::numeric_limits<double>::infinity();

void check(const DistanceRequest& request) {
  if (!(request.rel_error >= 0 && request.rel_error < 1)) {
    throw std::invalid_argument("rel_error is " + decimal_text(request.rel_error) +
                                ": ask for one that is at least 0 and less than 1");
  }
  if (!(request.stop_above >= 0)) {
    throw std::invalid_argument("stop_above is " + decimal_text(request.stop_above) + ": it must be at least 0");
  }
}

/// Branch and bound over pairs of nodes, the one with the least gap first. Faces that may be the nearest ones are kept
/// with their bounds in doubles; integers decide between them at the end. All in the unit that QueryScale has chosen.
class DistanceSearch {
 public:
  DistanceSearch(const CollisionQuery& query, const QueryScale& scale, const DistanceRequest& request)
      : scale_(scale),
        request_(request),
        stop_above_(scale.rounded_up(request.stop_above)),
        a_{query.a->mesh(), query.a->tree()},
        b_{query.b->mesh(), query.b->tree()},
        frame_(*query.a, *query.pose_a, *query.b, *query.pose_b),
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
    double gap;
    NodeRef a;
    NodeRef b;
    bool is_leaf_pair() const { return a.is_leaf() && b.is_leaf(); }
    friend bool operator<(const Item& x, const Item& y) { return x.gap > y.gap; }  // the least on top
  };
  struct Faces {
    DistanceBounds bounds;
    std::uint32_t a;
    std::uint32_t b;
  };

  /// Nothing this far apart matters any more.
  bool is_pruned(double gap) {
    if (gap > stop_above_) return true;
    // A little less than what is allowed, for the rounding of this line.
    if (gap < upper_ * (1 - (1 - 0x1p-20) * request_.rel_error)) return false;
    pruned_ = std::min(pruned_, gap);
    return true;
  }

  void search() {
    std::vector<Item> queue = {{0, a_.tree.root(), b_.tree.root()}};
    queue.reserve(256);
    frame_.set_axis(frame_.middle_b(b_.tree.lines() + b_.tree.root().first(), b_.tree.root().count()) -
                    frame_.middle_a(a_.tree.lines() + a_.tree.root().first(), a_.tree.root().count()));
    while (!queue.empty()) {
      std::pop_heap(queue.begin(), queue.end());
      Item item = queue.back();
      queue.pop_back();
      if (is_pruned(item.gap)) break;  // and so are all the others
      const bool is_behind = is_behind_planes(item);
      if (all_behind_) break;
      if (is_behind) continue;
      // Down to a pair of leaves if none has bounded the distance yet, or while the gap hardly grows: between parallel
      // faces all nodes are about as near, and the least gap alone would open them level by level.
      while (!item.is_leaf_pair()) {
        const std::size_t before = queue.size();
        const double most = upper_ < infinity ? 1.25 * item.gap : infinity;
        open(item, queue);
        const auto first = queue.begin() + static_cast<std::ptrdiff_t>(before);
        if (first != queue.end()) std::iter_swap(std::max_element(first, queue.end()), queue.end() - 1);
        const bool deeper = first != queue.end() && queue.back().gap <= most;
        if (deeper) {
          item = queue.back();
          queue.pop_back();
        }
        for (std::size_t end = before + 1; end <= queue.size(); ++end) push(queue, end);
        if (!deeper) break;
      }
      if (item.is_leaf_pair()) test_leaves(item.a, item.b);
    }
  }

  /// True only if nothing below the item is nearer than the nearest faces so far. Of many pairs at the same distance,
  /// as between parallel faces, the bounds in doubles leave each open; the planes through the nearest points do not.
  bool is_behind_planes(const Item& item) {
    if (upper_ == infinity) return false;
    if (!(item.gap >= (1 - 0x1p-7) * upper_)) {
      if (stats_.steps < next_look_) return false;
      next_look_ = stats_.steps + 64;
      if (!frame_.is_gap_nearly(upper_, a_, b_)) return false;
    }
    make_planes(found_[nearest_]);
    return behind_a_->contains(item.a) && behind_b_->contains(item.b);
  }

  /// Those through the nearest points of these faces, which share no point.
  void make_planes(const Faces& faces) {
    if (planes_ && planes_of_ == std::array<std::uint32_t, 2>{faces.a, faces.b}) return;
    ++stats_.open;
    planes_of_ = {faces.a, faces.b};
    planes_.emplace(distances_, a_.mesh.primitive(faces.a), b_.mesh.primitive(faces.b));
    behind_a_.emplace(a_, planes_->a());
    behind_b_.emplace(b_, planes_->b());
    all_behind_ = behind_a_->contains(a_.tree.root()) && behind_b_->contains(b_.tree.root());
  }

  static void push(std::vector<Item>& queue, std::size_t end) {
    std::push_heap(queue.begin(), queue.begin() + static_cast<std::ptrdiff_t>(end));
  }

  /// Appends the pairs of the nodes below that may be nearer than what is known.
  void open(const Item& item, std::vector<Item>& queue) {
    ++stats_.steps;
    stats_.box_tests += std::uint64_t{item.a.count()} * item.b.count();
    const bvh::SupportLine* const lines_a = a_.tree.lines() + item.a.first();
    const bvh::SupportLine* const lines_b = b_.tree.lines() + item.b.first();
    const FrameGap::Line line =
        frame_.line(frame_.middle_b(lines_b, item.b.count()) - frame_.middle_a(lines_a, item.a.count()));
    std::array<FrameGap::Reach, 4> reach_b;
    std::array<double, 4> on_line_b;
    for (std::uint32_t k = 0; k < item.b.count(); ++k) {
      reach_b[k] = frame_.reach_b(lines_b[k]);
      on_line_b[k] = FrameGap::reach_b(line, lines_b[k]);
    }
    // Lines are too coarse for an object that is much larger than its partner; leaves wait for the partner's.
    if (item.b.count() == 1 && lines_b[0].ref().is_leaf()) reach_b[0] = reach_of_b(lines_b[0].ref());
    for (std::uint32_t i = 0; i < item.a.count(); ++i) {
      const bool leaf_a = lines_a[i].ref().is_leaf();
      const FrameGap::Reach reach_a =
          item.a.count() == 1 && leaf_a ? reach_of_a(lines_a[i].ref()) : frame_.reach_a(lines_a[i]);
      const double on_line_a = FrameGap::reach_a(line, lines_a[i]);
      for (std::uint32_t k = 0; k < item.b.count(); ++k) {
        double gap = std::max(item.gap, frame_(reach_a, reach_b[k]));
        gap = std::max(gap, FrameGap::gap(line, on_line_a, on_line_b[k]));
        if (is_pruned(gap)) continue;
        const bool leaf_b = lines_b[k].ref().is_leaf();
        queue.push_back({gap, a_.below(item.a.first() + i, leaf_b), b_.below(item.b.first() + k, leaf_a)});
      }
    }
  }

  FrameGap::Reach reach_of_a(NodeRef leaf) const {
    FrameGap::Reach reach = frame_.reach_a(a_.mesh.primitive(a_.tree.faces()[leaf.first()]));
    for (std::uint32_t i = 1; i < leaf.count(); ++i) {
      reach = FrameGap::enclose(reach, frame_.reach_a(a_.mesh.primitive(a_.tree.faces()[leaf.first() + i])));
    }
    return reach;
  }
  FrameGap::Reach reach_of_b(NodeRef leaf) const {
    FrameGap::Reach reach = frame_.reach_b(b_.mesh.primitive(b_.tree.faces()[leaf.first()]));
    for (std::uint32_t i = 1; i < leaf.count(); ++i) {
      reach = FrameGap::enclose(reach, frame_.reach_b(b_.mesh.primitive(b_.tree.faces()[leaf.first() + i])));
    }
    return reach;
  }

  void test_leaves(NodeRef leaf_a, NodeRef leaf_b) {
    for (std::uint32_t k = leaf_b.first(); k < leaf_b.first() + leaf_b.count(); ++k) {
      const std::uint32_t face_b = b_.tree.faces()[k];
      const Primitive b = b_.mesh.primitive(face_b);
      FrameGap::Reach reach_b = frame_.reach_b(b);
      for (std::uint32_t i = leaf_a.first(); i < leaf_a.first() + leaf_a.count(); ++i) {
        const std::uint32_t face_a = a_.tree.faces()[i];
        const Primitive a = a_.mesh.primitive(face_a);
        if (is_pruned(frame_(frame_.reach_a(a), reach_b))) continue;
        ++stats_.pairs;
        const DistanceBounds bounds = distances_.bounds(a, b);
        if (is_pruned(bounds.lower)) continue;
        found_.push_back({bounds, face_a, face_b});
        if (!(bounds.upper < upper_)) continue;
        upper_ = bounds.upper;
        nearest_ = found_.size() - 1;
        next_look_ = stats_.steps + 4;
        frame_.set_axis(bounds.point_b - bounds.point_a, &a);
        reach_b = frame_.reach_b(b);
      }
    }
  }

  void answer(DistanceResult& result) {
    if (found_.empty()) return answer_above(result);
    Faces best = found_[nearest_];
    double lower = pruned_;
    for (const Faces& faces : found_) lower = std::min(lower, faces.bounds.lower);
    const bool is_near_enough =
        best.bounds.upper < infinity && best.bounds.upper - lower <= request_.rel_error * best.bounds.upper;
    if (!is_near_enough) {
      std::sort(found_.begin(), found_.end(), [](const Faces& x, const Faces& y) {
        if (x.bounds.lower != y.bounds.lower) return x.bounds.lower < y.bounds.lower;
        return x.a != y.a ? x.a < y.a : x.b < y.b;
      });
      make_planes(best);
      best.bounds = planes_->bounds();
      for (const Faces& faces : found_) {
        if (faces.bounds.lower >= best.bounds.lower) break;
        const Primitive a = a_.mesh.primitive(faces.a);
        const Primitive b = b_.mesh.primitive(faces.b);
        if (planes_->a().contains(a) && planes_->b().contains(b)) continue;
        // Those between the same two doubles change nothing.
        const bool exact = best.bounds.lower == best.bounds.upper;
        const PosedDistances::Answer nearer =
            exact ? distances_.nearer(a, b, best.bounds.lower) : distances_.within(a, b, best.bounds.lower);
        stats_.open += nearer.open;
        if (!nearer.hit) continue;
        make_planes(faces);
        best = {planes_->bounds(), faces.a, faces.b};
      }
      lower = std::min(pruned_, best.bounds.lower);
    }
    result.lower = scale_.lower(lower);
    if (result.lower > request_.stop_above) return answer_above(result);
    result.upper = scale_.upper(best.bounds.upper);
    result.point_a = scale_.point(best.bounds.point_a);
    result.point_b = scale_.point(best.bounds.point_b);
    result.face_a = a_.mesh.number_in_file(best.a);
    result.face_b = b_.mesh.number_in_file(best.b);
  }

  void answer_above(DistanceResult& result) const {
    result.lower = std::min(request_.stop_above, std::numeric_limits<double>::max());
    result.upper = infinity;
  }

  const QueryScale& scale_;
  const DistanceRequest& request_;
  const double stop_above_;  ///< DistanceRequest::stop_above in the unit of the search, at least
  const TreeSide a_;
  const TreeSide b_;
  FrameGap frame_;
  const PosedDistances distances_;
  CollisionStats stats_;
  double upper_ = infinity;   ///< the least of a pair of faces so far
  double pruned_ = infinity;  ///< the least gap of what was left out since a pair of faces is as near
  std::vector<Faces> found_;
  std::size_t nearest_ = 0;      ///< of these the one with the least upper bound
  std::uint64_t next_look_ = 0;  ///< step at which the planes of the nearest faces so far may be tried
  std::optional<exact::NearestPlanes> planes_;
  bool all_behind_ = false;                      ///< nothing is nearer than the faces that planes_ is of
  std::array<std::uint32_t, 2> planes_of_ = {};  ///< faces
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
