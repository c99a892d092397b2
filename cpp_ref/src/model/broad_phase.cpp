// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/model/box_test.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/internal/model/leaf_pair.hpp>
#include <cchip/internal/model/programme.hpp>
#include <optional>

namespace cchip::model {
namespace {

using bvh::NodeKind;

/// Ends a query.
struct Stop {
  QueryCode code;
};

/// A line in the role of a node, of which some children count: all of an inner node, or one that is a leaf.
struct Half {
  std::uint32_t line;
  unsigned children;
};

struct NodePair {
  Half a;
  Half b;
};

/// An expanded node pair with the child pairs that wait, as bits 4 i + j.
struct Entry {
  NodePair pair;
  std::uint16_t waiting = 0;
  std::uint16_t strong = 0;  ///< those of them with at least strong_key: they go first
};

class Run {
 public:
  Run(const Query& query, const bvh::Image& a, const bvh::Image& b, const BroadPhaseOptions& options)
      : query_(query), a_(a), b_(b), options_(options), pose_(set_up(query)) {}

  BroadPhaseResult run() {
    result_.done.tag = query_.tag;
    try {
      traverse();
    } catch (const Stop& stop) {
      result_.done.code = stop.code;
    }
    result_.done.steps = static_cast<std::uint32_t>(result_.counts.steps);
    result_.done.pairs = static_cast<std::uint32_t>(result_.pairs.size());
    if (result_.done.answer == QueryAnswer::no && result_.counts.open_pairs > 0) {
      result_.done.answer = QueryAnswer::open;
    }
    return std::move(result_);
  }

 private:
  void traverse() {
    check_descriptor();
    std::optional<NodePair> next = NodePair{whole(a_, a_.header().root), whole(b_, b_.header().root)};
    while (next && !finished_) {
      next = expand(*next);
      if (!next) next = pop();
    }
  }

  void check_descriptor() const {
    for (const auto& row : query_.m) {
      for (const std::int32_t x : row) {
        if (x > 1 << query_m_fraction || x < -(1 << query_m_fraction)) throw Stop{QueryCode::bad_descriptor};
      }
    }
    for (const bvh::Image* image : {&a_, &b_}) {
      const bvh::HeaderLine header = image->header();
      if (header.magic != bvh::image_magic || header.version != bvh::image_version) {
        throw Stop{QueryCode::bad_descriptor};
      }
    }
  }

  std::optional<NodePair> pop() {
    if (stack_.empty()) return std::nullopt;
    const auto at = stack_.end() - 1 - static_cast<std::ptrdiff_t>(any_of(stack_.size()));
    const unsigned from = at->strong != 0 ? at->strong : at->waiting;
    unsigned number = 0;
    while ((from >> number & 1U) == 0) ++number;
    at->strong = static_cast<std::uint16_t>(at->strong & ~(1U << number));
    at->waiting = static_cast<std::uint16_t>(at->waiting & ~(1U << number));
    const NodePair next = children(at->pair, number);
    if (at->waiting == 0) stack_.erase(at);
    return next;
  }

  /// 0, or any number below `count` if the order is to be random.
  std::size_t any_of(std::size_t count) const {
    return options_.random_order != nullptr ? (*options_.random_order)() % count : 0;
  }

  /// The child pair that overlaps most, the first of equals.
  unsigned best_of(const ChildPairs& pairs) const {
    if (options_.random_order == nullptr) return pairs.best;
    std::array<unsigned, 16> numbers = {};
    std::size_t count = 0;
    for (unsigned n = 0; n < 16; ++n) {
      if ((pairs.waiting >> n & 1U) != 0) numbers[count++] = n;
    }
    return numbers[any_of(count)];
  }

  bvh::InnerLine node(const bvh::Image& image, std::uint32_t line) const {
    if (line >= image.lines.size()) throw Stop{QueryCode::outside};
    const bvh::InnerLine node = bvh::decode_inner(image.lines[line]);
    if (node.step > bvh::step_max || has_inverted_box(node)) throw Stop{QueryCode::corrupt};
    if (node.first <= line || node.first + static_cast<std::uint32_t>(node.children) > image.lines.size()) {
      throw Stop{QueryCode::outside};
    }
    return node;
  }

  Half whole(const bvh::Image& image, std::uint32_t line) const {
    return {line, (1U << node(image, line).children) - 1};
  }

  /// Child `i` of a node as the next half: its own children, or itself alone if it is a leaf.
  Half child(const bvh::Image& image, const Half& half, unsigned i) const {
    const bvh::InnerLine parent = node(image, half.line);
    return parent.kind[i] == NodeKind::inner ? whole(image, parent.first + i) : Half{half.line, 1U << i};
  }

  NodePair children(const NodePair& pair, unsigned number) const {
    return {child(a_, pair.a, number / 4), child(b_, pair.b, number % 4)};
  }

  /// Tests the children of a node pair, sends leaf pairs on, and returns the child pair to go on with; the others
  /// wait on the stack.
  std::optional<NodePair> expand(const NodePair& pair) {
    if (result_.counts.steps >= options_.step_limit) throw Stop{QueryCode::steps};
    ++result_.counts.steps;
    const bvh::InnerLine a = node(a_, pair.a.line);
    const bvh::InnerLine b = node(b_, pair.b.line);
    const ChildPairs pairs =
        sort_children(a, pair.a.children, b, pair.b.children, test_boxes(a, b, pose_, grid_of(a, b, pose_)));
    for (unsigned number = 0; number < 16 && !finished_; ++number) {
      const unsigned i = number / 4;
      const unsigned j = number % 4;
      if ((pairs.counted >> number & 1U) != 0) ++result_.counts.box_tests;
      if ((pairs.leaves >> number & 1U) != 0) test_leaves(a.first + i, a.kind[i], b.first + j, b.kind[j]);
    }
    Entry entry{pair, pairs.waiting, pairs.strong};
    if (entry.waiting == 0 || finished_) return std::nullopt;
    const unsigned best = best_of(pairs);
    entry.waiting = static_cast<std::uint16_t>(entry.waiting & ~(1U << best));
    entry.strong = static_cast<std::uint16_t>(entry.strong & ~(1U << best));
    if (entry.waiting != 0) push(entry);
    return children(pair, best);
  }

  void push(const Entry& entry) {
    if (stack_.size() == options_.stack) throw Stop{QueryCode::stack};
    stack_.push_back(entry);
    result_.counts.stack_most = std::max(result_.counts.stack_most, stack_.size());
  }

  void test_leaves(std::uint32_t line_a, NodeKind kind_a, std::uint32_t line_b, NodeKind kind_b) {
    ++result_.counts.leaf_pairs;
    if (options_.leaf_pairs != nullptr) options_.leaf_pairs->emplace_back(line_a, line_b);
    const bvh::LeafLine a = bvh::decode_leaf(a_.lines[line_a], kind_a);
    const bvh::LeafLine b = bvh::decode_leaf(b_.lines[line_b], kind_b);
    if (a.extent > bvh::extent_max || b.extent > bvh::extent_max) throw Stop{QueryCode::corrupt};
    const MovedLeaves moved = move_leaves(a, kind_a, b, kind_b, query_);
    for (std::size_t i = 0; i < bvh::primitives_in(kind_a) && !finished_; ++i) {
      for (std::size_t j = 0; j < bvh::primitives_in(kind_b) && !finished_; ++j) {
        test_pair(normalise(moved, kind_a, i, kind_b, j, options_.coord_w), a.id[i], b.id[j]);
      }
    }
  }

  void test_pair(GridPair pair, std::uint32_t id_a, std::uint32_t id_b) {
    ++result_.counts.primitive_pairs;
    if (pair.a.kind > pair.b.kind) std::swap(pair.a, pair.b);  // tri_quad takes the triangle as A
    Options options;
    options.shape = {pair.a.vertex_count(), pair.b.vertex_count()};
    const Outcome outcome = run_programme(options, pair, options_.mode, options_.coord_w);
    result_.counts.beats += static_cast<std::uint64_t>(outcome.beats);
    if (!outcome.hit()) return;
    if (query_.swapped) std::swap(id_a, id_b);
    result_.pairs.push_back({query_.tag, id_a, id_b, outcome.definite});
    if (outcome.definite) {
      result_.done.answer = QueryAnswer::yes;
      finished_ = query_.mode == QueryMode::first;
    } else if (++result_.counts.open_pairs >= options_.open_limit && query_.mode == QueryMode::first) {
      throw Stop{QueryCode::host};
    }
  }

  const Query& query_;
  const bvh::Image& a_;
  const bvh::Image& b_;
  const BroadPhaseOptions& options_;
  const PoseSetup pose_;
  std::vector<Entry> stack_;
  BroadPhaseResult result_;
  bool finished_ = false;
};

}  // namespace

BroadPhaseResult run_query(const Query& query, const bvh::Image& a, const bvh::Image& b,
                           const BroadPhaseOptions& options) {
  return Run(query, a, b, options).run();
}

}  // namespace cchip::model
