// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/internal/judge/face_pairs.hpp>

#include "dop_pairs.hpp"
#include "search.hpp"
#include "tree_side.hpp"

namespace cchip {
namespace {

using bvh::Dop26;
using bvh::NodeRef;
using bvh::SupportLine;
using bvh::SupportTree;

/// A node of A and one of B whose volumes overlap.
struct NodePair {
  NodeRef a;
  NodeRef b;
};

/// Descends in both trees at once, where the volumes overlap most first.
class PlainSearch final : public Search {
 public:
  void run(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) override {
    faces_.start(query, request, result);
    faces_.visit_hint([this](std::uint32_t face_a, std::uint32_t face_b) { faces_.test(face_a, face_b); });
    const DopPairs volumes(*query.a, *query.pose_a, *query.b, *query.pose_b, request.within);
    const TreeSide a = {query.a->mesh(), query.a->tree()};
    const TreeSide b = {query.b->mesh(), query.b->tree()};
    stack_.clear();
    stack_.push_back({a.tree.root(), b.tree.root()});
    while (!stack_.empty() && !faces_.done()) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
      if (pair.a.is_leaf() && pair.b.is_leaf()) {
        test_leaves(a.tree, pair.a, b.tree, pair.b);
      } else {
        expand(a, pair.a, b, pair.b, volumes);
      }
    }
    faces_.finish();
  }

  void run(QueryFeed& feed, const CollisionRequest& request) override {
    for (std::size_t number = 0; feed.next(number);) {
      run(feed.query(number), request, result_);
      feed.done(number, result_);
    }
  }

 private:
  static constexpr std::size_t width = 4;  // children of a node

  void expand(const TreeSide& a, NodeRef node_a, const TreeSide& b, NodeRef node_b, const DopPairs& volumes) {
    std::array<Dop26, width> volumes_b;
    for (std::uint32_t k = 0; k < node_b.count(); ++k) {
      volumes_b[k] = volumes.volume_b(b.volume(b.tree.lines()[node_b.first() + k]));
    }
    struct Candidate {
      double depth;
      std::uint32_t a;
      std::uint32_t b;
    };
    std::array<Candidate, width * width> found;
    std::size_t count = 0;
    for (std::uint32_t i = node_a.first(); i < node_a.first() + node_a.count(); ++i) {
      const Dop26 volume_a = volumes.volume_a(a.volume(a.tree.lines()[i]));
      for (std::uint32_t k = 0; k < node_b.count(); ++k) {
        const double depth = DopPairs::overlap(volume_a, volumes_b[k]);
        if (depth >= 0) found[count++] = {depth, i, node_b.first() + k};
      }
    }
    ++faces_.stats().steps;
    faces_.stats().box_tests += std::uint64_t{node_a.count()} * node_b.count();
    // The deepest comes last, on top of the stack; among equals the first.
    std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Candidate& p, const Candidate& q) {
                if (p.depth != q.depth) return p.depth < q.depth;
                return p.a != q.a ? p.a > q.a : p.b > q.b;
              });
    for (std::size_t i = 0; i < count; ++i) {
      const bool leaf_a = a.tree.lines()[found[i].a].ref().is_leaf();
      const bool leaf_b = b.tree.lines()[found[i].b].ref().is_leaf();
      stack_.push_back({a.below(found[i].a, leaf_b), b.below(found[i].b, leaf_a)});
    }
  }

  void test_leaves(const SupportTree& a, NodeRef leaf_a, const SupportTree& b, NodeRef leaf_b) {
    for (std::uint32_t i = leaf_a.first(); i < leaf_a.first() + leaf_a.count(); ++i) {
      for (std::uint32_t k = leaf_b.first(); k < leaf_b.first() + leaf_b.count(); ++k) {
        faces_.test(a.faces()[i], b.faces()[k]);
        if (faces_.done()) return;
      }
    }
  }

  FacePairs faces_;
  CollisionResult result_;  // of batches
  std::vector<NodePair> stack_;
};

}  // namespace

std::unique_ptr<Search> make_plain_search() { return std::make_unique<PlainSearch>(); }

}  // namespace cchip
