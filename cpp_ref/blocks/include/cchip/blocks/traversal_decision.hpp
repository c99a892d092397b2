// SPDX-License-Identifier: Apache-2.0
/// \file
/// Model of cchip_traversal_decision, and the records of the traversal's pipeline.
#ifndef CCHIP_BLOCKS_TRAVERSAL_DECISION_HPP
#define CCHIP_BLOCKS_TRAVERSAL_DECISION_HPP

#include <cchip/blocks/tie.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace cchip::model {

/// Of the child pairs of a node pair, child i of A and j of B is bit 4 i + j.
struct BoxVerdict {
  std::size_t place = 0;
  std::uint16_t waiting = 0;  ///< overlap, not both leaves
  std::uint16_t leaves = 0;   ///< overlap, both leaves
  std::uint16_t strong = 0;   ///< of the waiting ones those that overlap much
  unsigned best = 0;          ///< of the waiting ones that which overlaps most
  unsigned tests = 0;
};

struct TraversalResult {
  std::size_t context = 0;
  unsigned epoch = 0;
  unsigned hits = 0;  ///< definite
  unsigned open = 0;
  QueryCode code = QueryCode::ok;
};

/// A node pair: lines from the bases of the images, and which of their children are of interest.
struct NodePair {
  bool header = false;  ///< the roots are to be found
  unsigned epoch = 0;
  unsigned children_a = 0, children_b = 0;
  std::uint32_t line_a = 0, line_b = 0;
  auto tie() const { return std::tie(header, epoch, children_a, children_b, line_a, line_b); }
};

/// What its two lines say: kinds of the children, 2 bits each, and the line of the first.
struct NodeLines {
  QueryCode code = QueryCode::ok;
  std::uint8_t kinds_a = 0, kinds_b = 0;
  std::uint32_t first_a = 0, first_b = 0;
};

/// Child pairs that wait: of either node which children are nodes, the first child's line and its own.
struct StackEntry {
  struct Side {
    unsigned inner = 0;
    std::uint32_t first = 0;
    std::uint32_t line = 0;
    auto tie() const { return std::tie(inner, first, line); }
  };
  Side a, b;
  std::uint16_t waiting = 0, strong = 0;
  auto tie() const { return std::tie(a, b, waiting, strong); }
};

/// A context.
struct QueryState {
  unsigned epoch = 0;
  bool active = false;
  QueryMode mode = QueryMode::first;
  std::size_t entries = 0;  ///< of its stack
  unsigned under_way = 0;   ///< node pairs
  std::uint32_t steps = 0;
  std::uint32_t pairs = 0;  ///< hits and open pairs
  unsigned open = 0;        ///< open pairs, at most 255
  bool hit = false;
  auto tie() const { return std::tie(epoch, active, mode, entries, under_way, steps, pairs, open, hit); }
};

/// What stays the same while a query runs.
struct QueryConstants {
  std::uint32_t base_a = 0, base_b = 0, tag = 0;
  auto tie() const { return std::tie(base_a, base_b, tag); }
};

enum class TraversalEvent { verdict, result, start, pop };

struct TraversalLimits {
  unsigned pairs_each = 3;  ///< node pairs of a query in flight, 0..7; 0 counts as 1
  std::uint32_t steps = 0xffffffff;
  unsigned open = 16;  ///< 0..255; 0 counts as 1
  std::size_t stack = 64;
};

/// An event and all that is known when it is decided upon.
struct Occurrence {
  TraversalEvent event = TraversalEvent::verdict;
  unsigned epoch = 0;  ///< of the event
  bool live = false;   ///< its query is still at work
  bool extra = false;  ///< a verdict that has further room in the leaf queue
  bool over = false;   ///< the steps of its query have reached their limit
  QueryState state;
  QueryConstants constants;
  std::uint32_t work = 0;  ///< node pairs and leaf pairs of the epoch
  BoxVerdict verdict;
  NodePair pair;
  NodeLines lines;
  TraversalResult result;
  StackEntry top;
  // the query that starts
  bool bad = false;
  QueryMode mode = QueryMode::first;
  QueryConstants query;
};

/// Leaves of a node pair: lines from address 0.
struct LeafEntry {
  std::uint32_t first_a = 0, first_b = 0;
  std::uint8_t kinds_a = 0, kinds_b = 0;
  std::uint16_t leaves = 0;
  auto tie() const { return std::tie(first_a, first_b, kinds_a, kinds_b, leaves); }
};

struct Decision {
  QueryState state;
  QueryConstants constants;
  std::uint32_t work = 0;
  bool wants = false;            ///< the query may have another node pair of its stack in flight
  bool cancelled = false;        ///< a start: the epoch has something in flight
  std::optional<NodePair> goes;  ///< to the box test
  bool place_free = false;
  unsigned room = 0;   ///< entries of the leaf queue that are free again
  std::size_t at = 0;  ///< of `push`
  std::optional<StackEntry> push;
  std::optional<LeafEntry> leaf;
  std::optional<DoneRecord> done;
  std::optional<unsigned> step;  ///< child pairs that were compared
};

Decision decide(const TraversalLimits& limits, const Occurrence& o);

}  // namespace cchip::model

#endif
