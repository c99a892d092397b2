// SPDX-License-Identifier: Apache-2.0
#include <cchip/model/box_test.hpp>
#include <cchip/model/broad_phase.hpp>
#include <cchip/model/leaf_pair.hpp>
#include <cchip/model/programme.hpp>

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

/// An expanded node pair with the child pairs that wait, as bits 4 i + j.
struct Entry {
  Half a;
  Half b;
  std::uint16_t waiting = 0;
  std::array<std::uint8_t, 16> key = {};
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
    expand(whole(a_, a_.header().root), whole(b_, b_.header().root));
    while (!stack_.empty() && !finished_) {
      Entry& top = stack_.back();
      const unsigned number = choose(top);
      top.waiting = static_cast<std::uint16_t>(top.waiting & ~(1U << number));
      const Half a = child(a_, top.a, number / 4);
      const Half b = child(b_, top.b, number % 4);
      if (top.waiting == 0) stack_.pop_back();
      expand(a, b);
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

  /// The child pair that comes next: the one that overlaps most, the first of equals.
  unsigned choose(const Entry& entry) {
    std::array<unsigned, 16> waiting;
    std::size_t count = 0;
    for (unsigned n = 0; n < 16; ++n) {
      if ((entry.waiting >> n & 1U) != 0) waiting[count++] = n;
    }
    if (options_.random_order != nullptr) return waiting[(*options_.random_order)() % count];
    unsigned best = waiting[0];
    for (std::size_t i = 1; i < count; ++i) {
      if (entry.key[waiting[i]] > entry.key[best]) best = waiting[i];
    }
    return best;
  }

  bvh::InnerLine node(const bvh::Image& image, std::uint32_t line) const {
    if (line >= image.lines.size()) throw Stop{QueryCode::outside};
    const bvh::InnerLine node = bvh::decode_inner(image.lines[line]);
    if (node.step > bvh::step_max) throw Stop{QueryCode::corrupt};
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

  void expand(const Half& half_a, const Half& half_b) {
    if (result_.counts.steps == options_.step_limit) throw Stop{QueryCode::steps};
    ++result_.counts.steps;
    const bvh::InnerLine a = node(a_, half_a.line);
    const bvh::InnerLine b = node(b_, half_b.line);
    const BoxVerdict verdict = test_boxes(a, b, pose_, grid_of(a, b, pose_));
    Entry entry{half_a, half_b, 0, verdict.key};
    for (unsigned number = 0; number < 16 && !finished_; ++number) {
      const unsigned i = number / 4;
      const unsigned j = number % 4;
      if ((half_a.children >> i & 1U) == 0 || (half_b.children >> j & 1U) == 0) continue;
      ++result_.counts.box_tests;
      if ((verdict.overlap >> number & 1U) == 0) continue;
      if (a.kind[i] == NodeKind::inner || b.kind[j] == NodeKind::inner) {
        entry.waiting = static_cast<std::uint16_t>(entry.waiting | 1U << number);
      } else {
        test_leaves(a.first + i, a.kind[i], b.first + j, b.kind[j]);
      }
    }
    if (entry.waiting == 0 || finished_) return;
    if (stack_.size() == options_.stack) throw Stop{QueryCode::stack};
    stack_.push_back(entry);
    result_.counts.stack_most = std::max(result_.counts.stack_most, stack_.size());
  }

  void test_leaves(std::uint32_t line_a, NodeKind kind_a, std::uint32_t line_b, NodeKind kind_b) {
    ++result_.counts.leaf_pairs;
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
    } else if (++result_.counts.open_pairs == options_.open_limit && query_.mode == QueryMode::first) {
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
