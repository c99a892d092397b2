// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set by Highway's foreach_target.h. Bounds: docs/cpp/exactness.md.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "search/simd_search.cpp"
#include "simd_targets.hpp"
// foreach_target.h must come before the others.
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <stdexcept>

#include "exact/ieee.hpp"
#include "far_test.hpp"
#include "frame_gap.hpp"
#include "relative_pose.hpp"
#include "search.hpp"
#include "simd_boxes-inl.hpp"
#include "simd_faces-inl.hpp"
#include "simd_task.hpp"

HWY_BEFORE_NAMESPACE();
namespace cchip {
namespace HWY_NAMESPACE {

/// Of simd_distance.cpp, for the same instruction set.
bool leaves(const DistanceFrame& frame, const float* vertices_a, NodeRef leaf_a, const float* vertices_b,
            NodeRef leaf_b, float limit, FaceGaps& gaps);

/// Reads what the next steps need into the cache.
HWY_INLINE void prefetch(const Task& task, Item item) {
  const auto read = [](const void* from, std::size_t lines) {
    for (std::size_t line = 0; line < lines; ++line) hwy::Prefetch(static_cast<const char*>(from) + 64 * line);
  };
  if (item.is_leaf_pair()) {  // a fan has 48 bytes
    read(task.moved->vertices(item.moved.first()), 2);
    read(task.fixed->vertices(item.fixed.first()), 2);
  } else {
    read(task.moved->lines() + item.moved.first(), 4);
    read(task.fixed->lines() + item.fixed.first(), 4);
  }
}

/// True only if the boxes of the objects, in their own frames, are farther apart than `within` along an edge of one. As
/// is_far(), it takes every map; edges are normals of faces only for rotations and scales.
HWY_INLINE bool boxes_apart(const CollisionQuery& query, const CentreLine& line, double within, double margin) {
  constexpr std::size_t axes = 6;
  using DD = hn::CappedTag<double, 8>;
  using VD = hn::Vec<DD>;
  const DD d;
  const double* const a = query.pose_a->data();  // columns of four
  const double* const b = query.pose_b->data();
  // Component i of each axis. Blends: what was stored number by number could not be loaded at once without a stall.
  const auto component = [&](std::size_t i, std::size_t at) {
    VD v = hn::Set(d, b[8 + i]);
    const auto put = [&](std::size_t n, double x) {
      if (n >= at) v = hn::IfThenElse(hn::FirstN(d, n - at + 1), hn::Set(d, x), v);
    };
    put(4, b[4 + i]);
    put(3, b[i]);
    put(2, a[8 + i]);
    put(1, a[4 + i]);
    put(0, a[i]);
    return v;
  };
  const VD limit = hn::Set(d, margin * far_limit * line.size);
  const VD least = hn::Set(d, far_axis_least);
  bool apart = false;
  for (std::size_t at = 0; at < axes; at += hn::MaxLanes(d)) {
    const VD x = component(0, at);
    const VD y = component(1, at);
    const VD z = component(2, at);
    VD reach = hn::Zero(d);
    const auto add_reach = [&](const SupportTree& tree, const double* linear) {
      for (std::size_t k = 0; k < 3; ++k) {
        const VD m =
            hn::MulAdd(x, hn::Set(d, linear[4 * k]),
                       hn::MulAdd(y, hn::Set(d, linear[4 * k + 1]), hn::Mul(z, hn::Set(d, linear[4 * k + 2]))));
        reach = hn::MulAdd(hn::Abs(m), hn::Set(d, tree.half(k)), reach);
      }
    };
    add_reach(query.a->tree(), a);
    add_reach(query.b->tree(), b);
    const VD along = hn::MulAdd(x, hn::Set(d, line.between[0]),
                                hn::MulAdd(y, hn::Set(d, line.between[1]), hn::Mul(z, hn::Set(d, line.between[2]))));
    const VD longest = hn::Max(hn::Abs(x), hn::Max(hn::Abs(y), hn::Abs(z)));
    VD gap = hn::Sub(hn::Abs(along), reach);
    if (within > 0) {
      const VD square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
      gap = hn::NegMulAdd(hn::Sqrt(square), hn::Set(d, within * (1 + 0x1p-48)), gap);
    }
    apart |= !hn::AllFalse(d, hn::And(hn::Gt(gap, hn::Mul(longest, limit)), hn::Gt(longest, least)));
  }
  return apart && line.moderate;
}

/// One thread's search.
class SimdSearch final : public Search {
 public:
  explicit SimdSearch(const Margins& margins) : margins_(margins), plain_(make_plain_search()) {}

  void run(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) override {
    Task& task = tasks_[0];
    if (!start(task, query, request, result)) return;
    if (request.contacts == CollisionRequest::Contacts::all) {
      search_all(task);
    } else {
      search_alone(task);
    }
    task.finish();
  }

  void run(QueryFeed& feed, const CollisionRequest& request) override {
    if (request.contacts == CollisionRequest::Contacts::all) {
      Task& task = tasks_[0];
      while (feed.next(task.number)) {
        run(feed.query(task.number), request, task.own_result);
        feed.done(task.number, task.own_result);
      }
    } else {
      search_in_step(feed, request);
    }
  }

 private:
  // Queries of a batch: more of them do not fit into the first level of the cache together.
  static constexpr std::size_t together = 8;
  // Items of a search for all contacts.
  static constexpr std::size_t items_together = 16;

  /// Prepares a query.
  /// \returns false if the result is complete
  bool start(Task& task, const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) {
    const CentreLine line = centre_line(query);
    if (is_far(query, line, request.within, margins_.far) || boxes_apart(query, line, request.within, margins_.far)) {
      FacePairs::answer_apart(request, result);
      result.stats.box_tests = 1;
      return false;
    }
    RelativePose relation;
    if (!relate(query, line, request.within, relation)) {
      plain_->run(query, request, result);
      return false;
    }
    task.query = query;
    task.within = request.within;
    task.world.is_made = false;
    task.faces.start(query, request, result);
    task.stats = {};
    task.stats.box_tests = 1;  // of the whole objects, above
    task.open_count = 0;
    task.swapped = relation.swapped;
    task.moved = &(relation.swapped ? query.b : query.a)->tree();
    task.fixed = &(relation.swapped ? query.a : query.b)->tree();
    for (std::size_t i = 0; i < 9; ++i) task.place.m[i] = static_cast<float>(relation.m[i]);
    for (std::size_t i = 0; i < 3; ++i) task.place.t[i] = static_cast<float>(relation.t[i]);
    // A coordinate of a moved vertex: 1 rounding each of vertex, matrix and three products, three sums; of the offset.
    const double own = 1.01 * margins_.vertex * ulp;
    const double of_relation = 1.01 * margins_.relation * relation.vertex_error;
    task.place.moved_error =
        static_cast<float>(own * (6 * radius * relation.row + 4 * relation.distance) + of_relation);
    task.place.fixed_error = static_cast<float>(own * radius);
    task.place.growth = static_cast<float>(1.01 * relation.growth);
    task.faces.visit_hint([&](std::uint32_t face_a, std::uint32_t face_b) { test_hint(task, query, face_a, face_b); });
    if (task.faces.done()) {
      task.finish();
      return false;
    }
    make_planes(relation, margins_, task.planes);
    const double of_plane = margins_.wide * ulp * (radius * (3 + 12 * relation.norm) + 5 * relation.distance);
    task.planes.side_error =
        static_cast<float>(1.01 * of_plane + of_relation) + task.place.fixed_error + task.place.growth;
    task.stack[0] = {task.planes.tiny ? task.moved->whole() : task.moved->root(), task.fixed->root()};
    task.size = 1;
    return true;
  }

  /// Tests two faces, by their numbers in the meshes: as test_leaves(), but that nothing is known of their leaves.
  static void test_hint(Task& task, const CollisionQuery& query, std::uint32_t face_a, std::uint32_t face_b) {
    ++task.stats.pairs;
    const Primitive a = query.a->mesh().primitive(face_a);
    const Primitive b = query.b->mesh().primitive(face_b);
    if (a.kind == Kind::tri && b.kind == Kind::tri) {
      const NodeRef alone = NodeRef::leaf(0, 1, false);
      alignas(64) LeafSide p;
      alignas(64) LeafSide q;
      load_moved(task.moved->vertices_of(task.swapped ? b : a).data(), alone, task.place, p);
      load_fixed(task.fixed->vertices_of(task.swapped ? a : b).data(), alone, task.place, q);
      Verdict verdict = Verdict::apart;
      visit_triangles(p, 1, q, 1, task.place, [&verdict](std::size_t, std::size_t, Verdict x) {
        verdict = x;
        return true;
      });
      if (verdict == Verdict::apart) return;
      if (verdict == Verdict::cross) return task.faces.add(face_a, face_b);
    }
    task.faces.test(face_a, face_b);
  }

  /// Tests the nodes below an item.
  unsigned test(const Task& task, Item item, std::int16_t* keys) {
    const SupportLine* const moved = task.moved->lines() + item.moved.first();
    const SupportLine* const fixed = task.fixed->lines() + item.fixed.first();
    if (HWY_LIKELY(!task.planes.wide)) {
      return item.moved.count() == 1 ? narrow_test<1>(moved, fixed, task.planes, keys)
                                     : narrow_test<4>(moved, fixed, task.planes, keys);
    }
    const NodeRef first = fixed->ref();
    const bool leaf = item.fixed.count() == 1 && first.is_leaf();
    if (leaf) {
      planes_of_leaf(*task.fixed, first, margins_, wide_);
    } else {
      planes_of_lines(fixed, wide_);
    }
    unsigned hits = item.moved.count() == 1 ? wide_test<1>(moved, wide_, task.planes, keys)
                                            : wide_test<4>(moved, wide_, task.planes, keys);
    if (leaf) {  // of the hits only those of the one fixed node count
      for (std::uint32_t i = 0; i < item.moved.count(); ++i) {
        if ((hits >> 4 * i & 1U) != 0 && beside_faces(task, moved[i], first)) hits ^= 1U << 4 * i;
      }
    }
    return hits;
  }

  /// Puts the pairs that may meet onto a stack, the one that overlaps most on top.
  /// \returns how many
  template <bool best_first>
  static HWY_INLINE std::size_t push(Task& task, Item item, unsigned hits, const std::int16_t* keys, Item* stack) {
    const std::uint32_t moved_count = item.moved.count();
    const std::uint32_t fixed_count = item.fixed.count();
    ++task.stats.steps;
    task.stats.box_tests += moved_count * fixed_count;
    hits &= (0x1111U * ((1U << fixed_count) - 1)) & ((1U << 4 * moved_count) - 1);
    if (hits == 0) return 0;
    const SupportLine* const moved = task.moved->lines() + item.moved.first();
    const SupportLine* const fixed = task.fixed->lines() + item.fixed.first();
    std::size_t count = 0;
    std::size_t best = 0;
    int best_key = -1;
    do {
      const std::size_t bit = hwy::Num0BitsBelowLS1Bit_Nonzero32(hits);
      hits &= hits - 1;
      const auto i = static_cast<std::uint32_t>(bit / 4);
      const auto j = static_cast<std::uint32_t>(bit % 4);
      NodeRef a = moved[i].ref();
      NodeRef b = fixed[j].ref();
      // A leaf waits for the other one to come down: its own line is the only child.
      const bool leaf_a = a.is_leaf();
      const bool leaf_b = b.is_leaf();
      if (!leaf_b && (leaf_a || task.planes.tiny)) a = NodeRef::inner(item.moved.first() + i, 1);
      if (leaf_b && !leaf_a) b = NodeRef::inner(item.fixed.first() + j, 1);
      stack[count] = {a, b};
      if (best_first) {
        const bool better = keys[bit] > best_key;
        best_key = better ? keys[bit] : best_key;
        best = better ? count : best;
      }
      ++count;
    } while (hits != 0);
    if (best_first) std::swap(stack[best], stack[count - 1]);
    return count;
  }

  /// Tests the primitives of two leaves.
  /// \returns true if the request is fulfilled
  static HWY_INLINE bool test_leaves(Task& task, Item item) {
    if (HWY_UNLIKELY(task.within > 0) && !item.moved.is_quad() && !item.fixed.is_quad()) {
      return test_leaves_within(task, item);
    }
    const Placement& place = task.place;
    alignas(64) LeafSide p;
    alignas(64) LeafSide q;
    load_moved(task.moved->vertices(item.moved.first()), item.moved, place, p);
    load_fixed(task.fixed->vertices(item.fixed.first()), item.fixed, place, q);
    const std::size_t count_p = item.moved.count();
    const std::size_t count_q = item.fixed.count();
    task.stats.pairs += count_p * count_q;
    const std::uint32_t* const faces_p = task.moved->faces().data() + item.moved.first();
    const std::uint32_t* const faces_q = task.fixed->faces().data() + item.fixed.first();
    if (HWY_UNLIKELY(item.moved.is_quad() || item.fixed.is_quad())) {
      for (std::size_t i = 0; i < count_p; ++i) {
        for (std::size_t k = 0; k < count_q; ++k) {
          const AxisTest test(p, 4 * i, q, 4 * k, place.both_errors());
          if (test.normals_separate(p, 4 * i, q, 4 * k)) continue;
          if (quads_cross(p, 4 * i, item.moved.is_quad(), q, 4 * k, item.fixed.is_quad(), place)) {
            task.add(faces_p[i], faces_q[k]);
          } else if (!test.sides_separate()) {
            task.keep_open(faces_p[i], faces_q[k]);
          }
          if (task.faces.done()) return true;
        }
      }
      return false;
    }
    return visit_triangles(p, count_p, q, count_q, place, [&](std::size_t i, std::size_t k, Verdict verdict) {
      if (verdict == Verdict::cross) {
        task.add(faces_p[i], faces_q[k]);
      } else {
        task.keep_open(faces_p[i], faces_q[k]);
      }
      return task.faces.done();
    });
  }

  /// The same for triangles in a query within a distance.
  static bool test_leaves_within(Task& task, Item item) {
    if (!task.world.is_made) make_world(task);
    const SupportTree& a = task.query.a->tree();
    const SupportTree& b = task.query.b->tree();
    const NodeRef leaf_a = task.swapped ? item.fixed : item.moved;
    const NodeRef leaf_b = task.swapped ? item.moved : item.fixed;
    task.stats.pairs += leaf_a.count() * leaf_b.count();
    FaceGaps gaps;
    if (!leaves(task.world.frame, a.vertices(leaf_a.first()), leaf_a, b.vertices(leaf_b.first()), leaf_b,
                task.world.far, gaps)) {
      return false;
    }
    for (std::uint32_t i = 0; i < leaf_a.count(); ++i) {
      for (std::uint32_t k = 0; k < leaf_b.count(); ++k) {
        const std::uint32_t face_a = a.faces()[leaf_a.first() + i];
        const std::uint32_t face_b = b.faces()[leaf_b.first() + k];
        if (gaps.lower[2 * i + k] > task.world.far) continue;
        if (gaps.upper[2 * i + k] < task.world.near) {
          task.faces.add(face_a, face_b);
        } else {
          task.swapped ? task.keep_open(face_b, face_a) : task.keep_open(face_a, face_b);
        }
        if (task.faces.done()) return true;
      }
    }
    return false;
  }

  static void make_world(Task& task) {
    const CollisionQuery& query = task.query;
    FrameGap gap(*query.a, *query.pose_a, *query.b, *query.pose_b);
    const double within = task.within / gap.in_single(task.world.frame);
    task.world.near = static_cast<float>(std::min(within * (1 - 0x1p-20), 1e15));
    task.world.far = static_cast<float>(std::min(within * (1 + 0x1p-20), 1e15));
    task.world.is_made = true;
  }

  /// Calls `visit` for the pairs of up to two by two triangles that are not apart, until it returns true.
  /// \returns whether it did
  template <class Visit>
  static HWY_INLINE bool visit_triangles(const LeafSide& p, std::size_t count_p, const LeafSide& q, std::size_t count_q,
                                         const Placement& place, const Visit& visit) {
    // Bit 8 i + 4 k: triangles i and k may touch; all their vertices lie on certain sides.
    unsigned left = 0;
    unsigned certain = 0;
    std::array<Sides, 2> of_p;
    std::array<Sides, 2> of_q;
    const auto all_three = [](unsigned bits) { return bits & bits >> 1U & bits >> 2U; };
    for (std::size_t i = 0; i < count_p; ++i) {
      compare(p, i, q, place, of_q[i], of_p[i]);
      const unsigned apart = all_three(of_p[i].positive) | all_three(of_p[i].negative) | all_three(of_q[i].positive) |
                             all_three(of_q[i].negative);
      const unsigned known =
          all_three(of_p[i].positive | of_p[i].negative) & all_three(of_q[i].positive | of_q[i].negative);
      left |= (~apart & (count_q == 2 ? 0x11U : 0x01U)) << 8 * i;
      certain |= known << 8 * i;
    }
    for (; left != 0; left &= left - 1) {
      const std::size_t bit = hwy::Num0BitsBelowLS1Bit_Nonzero32(left);
      const std::size_t i = bit / 8;
      const std::size_t k = bit / 4 % 2;
      const Verdict verdict = (certain >> bit & 1U) != 0 ? cross_test(p, 4 * i, of_p[i].negative >> 4 * k & 7U, q,
                                                                      4 * k, of_q[i].negative >> 4 * k & 7U, place)
                                                         : Verdict::open;
      if (verdict != Verdict::apart && visit(i, k, verdict)) return true;
    }
    return false;
  }

  /// True only if a triangle of one crosses a triangle of the other.
  static bool quads_cross(const LeafSide& p, std::size_t at_p, bool quad_p, const LeafSide& q, std::size_t at_q,
                          bool quad_q, const Placement& place) {
    alignas(64) LeafSide halves_p;
    alignas(64) LeafSide halves_q;
    halve(p, at_p, place.moved_error, halves_p);
    halve(q, at_q, place.fixed_error, halves_q);
    return visit_triangles(halves_p, quad_p ? 2 : 1, halves_q, quad_q ? 2 : 1, place,
                           [](std::size_t, std::size_t, Verdict verdict) { return verdict == Verdict::cross; });
  }

  /// One query for its first contact, one item at a time.
  void search_alone(Task& task) {
    std::int16_t keys[16];
    while (task.size > 0) {
      const Item item = task.stack[--task.size];
      if (item.is_leaf_pair()) {
        if (test_leaves(task, item)) return;
        continue;
      }
      if (task.size > 0) prefetch(task, task.stack[task.size - 1]);
      const unsigned hits = test(task, item, keys);
      task.size += push<true>(task, item, hits, keys, task.stack.data() + task.size);
    }
  }

  /// One query for all contacts: several items at a time, in any order.
  void search_all(Task& task) {
    Item items[items_together];
    std::int16_t keys[items_together][16];
    std::array<unsigned, items_together> hits;
    if (deep_.size() < 1024) deep_.resize(1024);
    deep_[0] = task.stack[0];
    std::size_t size = 1;
    while (size > 0) {
      std::size_t count = 0;
      while (size > 0 && count < items_together) {
        const Item item = deep_[--size];
        if (item.is_leaf_pair()) {
          if (test_leaves(task, item)) return;
        } else {
          items[count++] = item;
        }
      }
      if (deep_.size() < size + 16 * items_together) deep_.resize(2 * deep_.size());
      for (std::size_t i = 0; i < count; ++i) hits[i] = test(task, items[i], keys[i]);
      for (std::size_t i = 0; i < count; ++i)
        size += push<false>(task, items[i], hits[i], keys[i], deep_.data() + size);
      for (std::size_t i = 1; i <= std::min(size, items_together); ++i) prefetch(task, deep_[size - i]);
    }
  }

  /// Many queries for their first contacts: one item of each in a round. All tests come first, which do not branch,
  /// then all that depends on them.
  void search_in_step(QueryFeed& feed, const CollisionRequest& request) {
    Item current[together];
    std::int16_t keys[together][16];
    std::array<unsigned, together> hits;
    std::array<std::array<std::uint8_t, together>, 2> inner;  // tasks whose item is a pair to be expanded
    std::array<std::array<std::uint8_t, together>, 2> leaves;
    std::array<std::size_t, 2> inner_count = {0, 0};
    std::array<std::size_t, 2> leaf_count = {0, 0};
    const auto pop = [&](std::size_t i, std::size_t round) {
      Task& task = tasks_[i];
      const Item item = task.stack[--task.size];
      current[i] = item;
      if (item.is_leaf_pair()) {
        leaves[round][leaf_count[round]++] = static_cast<std::uint8_t>(i);
      } else {
        inner[round][inner_count[round]++] = static_cast<std::uint8_t>(i);
      }
      prefetch(task, item);
    };
    bool more = true;
    const auto begin = [&](std::size_t i, std::size_t round) {
      Task& task = tasks_[i];
      while (more) {
        more = feed.next(task.number);
        if (!more) return;
        if (start(task, feed.query(task.number), request, task.own_result)) return pop(i, round);
        feed.done(task.number, task.own_result);
      }
    };
    const auto end = [&](std::size_t i, std::size_t round) {
      tasks_[i].finish();
      feed.done(tasks_[i].number, tasks_[i].own_result);
      begin(i, round);
    };
    for (std::size_t i = 0; i < std::min(together, feed.at_once()); ++i) begin(i, 0);
    for (std::size_t round = 0; inner_count[round] + leaf_count[round] > 0; round ^= 1U) {
      const std::size_t next = round ^ 1U;
      inner_count[next] = leaf_count[next] = 0;
      const std::size_t count = inner_count[round];
      for (std::size_t n = 0; n < count; ++n) {
        const std::size_t i = inner[round][n];
        hits[n] = test(tasks_[i], current[i], keys[n]);
      }
      for (std::size_t n = 0; n < count; ++n) {
        const std::size_t i = inner[round][n];
        Task& task = tasks_[i];
        task.size += push<true>(task, current[i], hits[n], keys[n], task.stack.data() + task.size);
        task.size > 0 ? pop(i, next) : end(i, next);
      }
      for (std::size_t n = 0; n < leaf_count[round]; ++n) {
        const std::size_t i = leaves[round][n];
        const bool fulfilled = test_leaves(tasks_[i], current[i]);
        tasks_[i].size > 0 && !fulfilled ? pop(i, next) : end(i, next);
      }
    }
  }

  Margins margins_;
  std::unique_ptr<Search> plain_;
  WideNode wide_;
  std::vector<Item> deep_;
  std::array<Task, together> tasks_;
};

std::unique_ptr<Search> make(const Margins& margins) { return std::make_unique<SimdSearch>(margins); }

}  // namespace HWY_NAMESPACE
}  // namespace cchip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cchip {
namespace {

HWY_EXPORT(make);

/// Instruction sets that this computer has. To find them Highway replaces the choice of the process by all of them, so
/// it is asked once, and the choice of another user of Highway is put back.
std::int64_t supported_targets() {
  static const std::int64_t targets = [] {
    hwy::ChosenTarget& chosen = hwy::GetChosenTarget();
    const bool initialised = chosen.IsInitialized();
    const std::size_t index = chosen.GetIndex();
    const std::int64_t all = hwy::SupportedTargets();
    if (!initialised) {
      chosen.DeInit();
    } else {
      std::int64_t left = all;  // without the best ones, until the choice is the same; better sets have lower bits
      for (; chosen.GetIndex() != index && left != 0; chosen.Update(left)) left &= left - 1;
      if (left == 0) chosen.Update(all);  // none of those that are compiled in here
    }
    return all;
  }();
  return targets;
}

/// Bits of the instruction sets that are compiled in and that this computer has, best first.
std::vector<std::int64_t> target_bits() {
  std::vector<std::int64_t> bits;
  for (std::int64_t all = supported_targets() & HWY_TARGETS; all != 0; all &= all - 1) bits.push_back(all & -all);
  return bits;
}

}  // namespace

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const std::int64_t bit : target_bits()) names.emplace_back(hwy::TargetName(bit));
  return names;
}

std::size_t target_index(const std::string& target, std::size_t entries) {
  for (const std::int64_t bit : target_bits()) {
    if (target != hwy::TargetName(bit)) continue;
    hwy::ChosenTarget chosen;
    chosen.Update(bit);
    return entries > 1 ? chosen.GetIndex() : 0;
  }
  throw std::invalid_argument("instruction set " + target + " is not one that this computer and this program have");
}

std::unique_ptr<Search> make_simd_search(const std::string& target, const Margins& margins) {
  return HWY_DISPATCH_TABLE(make)[target_index(target, std::size(HWY_DISPATCH_TABLE(make)))](margins);
}

}  // namespace cchip
#endif  // HWY_ONCE
