// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact models of cchip_traversal_events and cchip_traversal_decision. Moore machines, like those in stream.hpp.
#ifndef CCHIP_MODELS_TRAVERSAL_PIPELINE_HPP
#define CCHIP_MODELS_TRAVERSAL_PIPELINE_HPP

#include <array>
#include <cchip/model/stream.hpp>
#include <cchip/wire/query.hpp>
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
  friend bool operator==(const NodePair& x, const NodePair& y) {
    return x.header == y.header && x.epoch == y.epoch && x.children_a == y.children_a && x.children_b == y.children_b &&
           x.line_a == y.line_a && x.line_b == y.line_b;
  }
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
    friend bool operator==(const Side& x, const Side& y) {
      return x.inner == y.inner && x.first == y.first && x.line == y.line;
    }
  };
  Side a, b;
  std::uint16_t waiting = 0, strong = 0;
  friend bool operator==(const StackEntry& x, const StackEntry& y) {
    return x.a == y.a && x.b == y.b && x.waiting == y.waiting && x.strong == y.strong;
  }
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
  friend bool operator==(const QueryState& x, const QueryState& y) {
    return x.epoch == y.epoch && x.active == y.active && x.mode == y.mode && x.entries == y.entries &&
           x.under_way == y.under_way && x.steps == y.steps && x.pairs == y.pairs && x.open == y.open && x.hit == y.hit;
  }
};

/// What stays the same while a query runs.
struct QueryConstants {
  std::uint32_t base_a = 0, base_b = 0, tag = 0;
  friend bool operator==(const QueryConstants& x, const QueryConstants& y) {
    return x.base_a == y.base_a && x.base_b == y.base_b && x.tag == y.tag;
  }
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
  friend bool operator==(const LeafEntry& x, const LeafEntry& y) {
    return x.first_a == y.first_a && x.first_b == y.first_b && x.kinds_a == y.kinds_a && x.kinds_b == y.kinds_b &&
           x.leaves == y.leaves;
  }
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

/// Last line at which an image may begin: its lines, at most 2^24 - 1, have numbers of 32 bits.
inline constexpr std::uint32_t last_base = 0xfeffffff;

/// True if bits are set that must be 0, an entry of M is beyond 1, or a base is beyond the last one.
bool bad_descriptor(const std::array<std::uint32_t, 16>& query);

/// cchip_traversal_events: which event enters.
class TraversalEvents {
 public:
  struct Shape {
    std::size_t queries = 16;
    std::size_t pairs = 48;
    std::size_t leaf_depth = 72;
    std::size_t answers = 32;
  };
  using QueryWords = std::array<std::uint32_t, 16>;
  struct Of {
    std::size_t context = 0;
    unsigned epoch = 0;
  };
  /// An event leaves the pipeline.
  struct Left {
    std::size_t context = 0;
    bool active = false;  ///< the context has a query,
    bool wants = false;   ///< of whose stack a node pair may go
    bool start = false;
    bool cancel = false;
    std::optional<std::size_t> place;  ///< that is free
    unsigned room = 0;
  };
  struct Inputs {
    bool running = false;
    std::optional<QueryWords> query;
    bool start_ready = false;
    std::optional<BoxVerdict> verdict;
    Of lookup;  ///< of the verdict that waits
    std::optional<TraversalResult> result;
    std::optional<Of> drop;
    std::optional<std::size_t> leaving;  ///< context of the event that leaves in two clocks
    std::optional<Left> left;
    bool leaf_room = false;
    bool answer_room = false;
  };
  struct Event {
    TraversalEvent event = TraversalEvent::verdict;
    std::size_t context = 0;
    unsigned epoch = 0;  ///< defined for verdicts and results
    bool extra = false;
    bool judge = false;      ///< a result that came from outside
    std::size_t place = 0;   ///< defined for all but results
    BoxVerdict verdict;      ///< of verdicts
    TraversalResult result;  ///< of results; of a dropped pair all 0
  };

  explicit TraversalEvents(const Shape& shape)
      : shape_(shape), idle_(shape.queries), want_(shape.queries), verdicts_(shape.pairs), places_(shape.pairs) {
    reset();
  }

  bool query_ready() const { return query_ready_; }
  const std::optional<QueryWords>& query() const { return query_; }  ///< the last one taken
  bool query_bad() const { return query_bad_; }
  bool result_ready() const { return results_.s_ready(); }
  const std::optional<Event>& event() const { return event_; }
  /// The verdict that waits is at its place; defined while it has one.
  std::optional<std::size_t> lookup_place() const {
    return verdicts_.m_valid() ? std::optional(verdicts_.m_data().place) : std::nullopt;
  }
  bool lookup() const { return !verdict_ || choose() == Source::verdict; }
  bool drop_ready() const { return choose() == Source::drop; }

  void clock(const Inputs& in);
  void reset();

 private:
  enum class Source { nobody, verdict, result, drop, start, pop };
  struct May {
    bool verdict = false, result = false, drop = false, start = false, pop = false;
  };
  May ask(const Inputs& in) const;
  Source choose() const;
  static bool has(std::uint32_t set, std::size_t bit) { return (set >> bit & 1) != 0; }

  Shape shape_;
  Arbiter idle_;
  Arbiter want_;
  Fifo<BoxVerdict> verdicts_;
  std::optional<BoxVerdict> verdict_;
  SkidBuffer<TraversalResult> results_;
  Pool places_;
  bool choose_ = false;  ///< on every second clock an event may enter; on the others sources ask
  May may_;
  std::size_t room_ = 0, room_back_ = 0;
  bool some_room_ = true;
  std::size_t answers_ = 0;
  std::uint32_t locked_ = 0, inside_ = 0, without_query_ = 0, wanting_ = 0;  ///< contexts
  std::uint32_t free_idle_ = 0, free_want_ = 0;                              ///< a clock ago
  std::optional<QueryWords> query_;
  bool query_ready_ = false, query_valid_ = false, query_bad_ = false, bad_next_ = false, judging_ = false,
       judged_ = false, starting_ = false;
  bool result_first_ = false;  ///< a verdict has entered while a result could have: the result is next
  std::optional<std::size_t> idle_context_, want_context_, pop_context_;
  std::optional<Event> event_;
};

}  // namespace cchip::model

#endif
