// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact model of cchip_traversal. A Moore machine, like those in stream.hpp.
#ifndef CCHIP_BLOCKS_TRAVERSAL_HPP
#define CCHIP_BLOCKS_TRAVERSAL_HPP

#include <array>
#include <cchip/blocks/leaf_queue.hpp>
#include <cchip/blocks/traversal_events.hpp>
#include <cchip/internal/model/stream.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace cchip::model {

/// cchip_traversal: from queries and verdicts to node pairs, leaf pairs and answers.
class Traversal {
 public:
  struct Shape {
    std::size_t queries = 16;
    std::size_t pairs = 48;
    std::size_t leaves = 16;
    std::size_t stack = 64;
    std::size_t leaf_depth = 72;
    std::size_t credit = 32;
  };
  struct Inputs {
    TraversalLimits limits;  ///< of this clock; `stack` is that of the shape
    std::optional<TraversalEvents::QueryWords> query;
    bool start_ready = false;
    std::optional<std::size_t> leaf_left;  ///< place of a leaf pair that has left cchip_get_data
    std::optional<BoxVerdict> verdict;
    // what cchip_get_data knows of the place looked up last
    std::size_t lookup_context = 0;
    NodePair lookup_pair;
    NodeLines lookup_lines;
    std::optional<TraversalResult> result;
    bool credit = false;
    bool done_ready = false;
  };
  struct Start {
    std::size_t context = 0;
    unsigned epoch = 0;
  };
  /// Lines for a place of cchip_get_data.
  struct Fetch {
    std::size_t place = 0;
    std::size_t context = 0;
    std::optional<NodePair> pair;  ///< without: a leaf pair
    unsigned epoch = 0;            ///< of a leaf pair
    unsigned leaf_kind_a = 0, leaf_kind_b = 0;
    std::uint32_t line_a = 0, line_b = 0;  ///< from address 0
  };

  explicit Traversal(const Shape& shape);

  bool query_ready() const { return events_.query_ready(); }
  bool result_ready() const { return events_.result_ready(); }
  const std::optional<TraversalEvents::QueryWords>& query() const { return events_.query(); }
  std::optional<Start> start() const;
  const std::optional<Fetch>& fetch() const { return fetch_; }
  bool lookup() const { return events_.lookup(); }
  std::optional<std::size_t> lookup_place() const { return events_.lookup_place(); }
  /// Of a result: was its query still at work?
  struct Judgement {
    bool live = false;
    std::uint32_t tag = 0;
  };
  const std::optional<Judgement>& judged() const { return judged_; }
  bool done_valid() const { return done_.m_valid(); }
  const DoneRecord& done() const { return done_.m_data(); }
  std::optional<unsigned> step() const { return step_; }  ///< a node pair was expanded: child pairs compared
  bool leaf_pair() const { return fetch_ && !fetch_->pair; }

  void clock(const Inputs& in);
  /// One clock with rst = 1.
  void reset();

 private:
  /// An event in the pipeline, and what is known of its node pair.
  struct Inside {
    TraversalEvents::Event event;
    NodePair pair;
    NodeLines lines;
    bool over = false;        ///< steps were at their limit as it passed its third stage
    unsigned open_limit = 0;  ///< as it passed its sixth
  };
  static constexpr std::size_t stages = 7;
  static constexpr std::size_t leaving = 4;  ///< two clocks from the end

  TraversalEvents::Inputs events_inputs(const Inputs& in) const;
  void decide_next(const Inputs& in);

  Shape shape_;
  TraversalEvents events_;
  std::array<std::optional<Inside>, stages> inside_;
  /// Of the event that is at the end of the pipeline.
  std::optional<Decision> decision_;
  std::optional<Judgement> judged_;
  std::vector<QueryState> states_;
  std::vector<QueryConstants> constants_;
  std::vector<std::array<std::uint32_t, 4>> works_;
  std::vector<std::vector<StackEntry>> stacks_;
  NodePair looked_pair_;
  NodeLines looked_lines_;
  std::size_t cleared_ = 0;  ///< words after reset
  unsigned pairs_each_ = 0;  ///< node pairs of a query in flight, as few queries or many have them
  LeafQueue leaf_queue_;
  Pool leaf_places_;
  Fifo<DoneRecord> done_;
  std::optional<Fetch> fetch_;
  std::optional<unsigned> step_;
};

}  // namespace cchip::model

#endif
