// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact model of cchip_traversal_events. A Moore machine, like those in stream.hpp.
#ifndef CCHIP_BLOCKS_TRAVERSAL_EVENTS_HPP
#define CCHIP_BLOCKS_TRAVERSAL_EVENTS_HPP

#include <array>
#include <cchip/blocks/traversal_decision.hpp>
#include <cchip/internal/model/stream.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace cchip::model {

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
    bool active = false;  ///< the context has a query
    bool wants = false;   ///< a node pair of that query's stack may go
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
  bool few() const { return few_; }  ///< 3 queries or fewer had started whose answers were not taken
  /// The verdict that waits is at its place; defined while it has one.
  std::optional<std::size_t> lookup_place() const {
    return verdicts_.m_valid() ? std::optional(verdicts_.m_data().place) : std::nullopt;
  }
  bool lookup() const { return !verdict_ || choose() == Source::verdict; }
  bool drop_ready() const { return choose() == Source::drop; }

  void clock(const Inputs& in);
  void reset();

 private:
  enum class Source { none, verdict, result, drop, start, pop };
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
  bool few_ = true;
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
