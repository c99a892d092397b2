// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact model of cchip_cache. A Moore machine, like those in stream.hpp.
#ifndef CCHIP_BLOCKS_CACHE_HPP
#define CCHIP_BLOCKS_CACHE_HPP

#include <array>
#include <cchip/blocks/cache_fill.hpp>
#include <cchip/blocks/line_data.hpp>
#include <cchip/internal/model/stream.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace cchip::model {

/// cchip_cache: lines of 64 bytes, two ways, two ports. Counts what its ports do on each clock.
class Cache {
 public:
  struct Shape {
    std::size_t sets = 1024;
    std::size_t places = 32;
    std::size_t misses = 32;
    std::size_t beats = 4;  ///< of a line
  };
  struct Range {  ///< of lines; empty if first > last
    std::uint64_t first = 1;
    std::uint64_t last = 0;
    bool has(std::uint64_t line) const { return first <= line && line <= last; }
  };
  struct Request {
    std::size_t place = 0;
    std::uint64_t line = 0;
  };
  struct Answer {
    std::size_t place = 0;
    ReadCode code = ReadCode::ok;
    LineData data{};  ///< if the code is ok
  };
  using Beat = CacheFill::Beat;
  struct Inputs {
    std::array<std::optional<Request>, 2> requests;
    std::vector<Range> locks;
    std::optional<Range> invalidate;  ///< taken if invalidate_ready()
    std::optional<Beat> beat;
    std::vector<bool> outstanding;  ///< of each slot, as cchip_axi_read says
  };
  struct Counts {
    bool hit = false, miss = false, wait = false, again = false;
  };

  explicit Cache(const Shape& shape);

  const std::array<std::optional<Answer>, 2>& answers() const { return answers_; }
  const std::array<Counts, 2>& counts() const { return counts_; }
  bool invalidate_ready() const { return ready_; }
  /// Request to memory: the slot is its place.
  const std::optional<Request>& read() const { return read_; }

  void clock(const Inputs& in);
  void reset();

 private:
  enum class Kind { none, look, serve, own };
  enum class State { clear, idle, ask, see, reads, answers };
  struct Entry {
    bool valid = false;
    bool locked = false;
    bool turn = false;
    std::size_t slot = 0;
    std::uint64_t line = 0;
  };
  struct Step {
    Kind kind = Kind::none;
    std::size_t place = 0;
    std::uint64_t line = 0;  // the set alone if kind is serve or own
    std::size_t way = 0;
    std::size_t slot = 0;
    ReadCode code = ReadCode::ok;
    bool stale = false;
    std::array<Entry, 2> entries{};
    std::array<bool, 2> holds{}, filled{};  // of the lines in flight that the entries name
    bool match = false, wait = false;
    std::size_t wait_slot = 0;
    std::optional<std::size_t> victim;
    bool locks = false, turn = false;
    std::array<bool, 2> forget{};
    LineData data{};
  };
  struct Port {
    explicit Port(std::size_t places) : late(places), again(places) {}
    Fifo<Request> late, again;  // found the port taken; to be looked up again
    bool again_first = false;
    std::set<std::size_t> wake;
    std::optional<Step> serve;
    std::map<std::size_t, std::size_t> asleep;  // place, slot of the line it waits for
    std::array<Step, 6> steps;                  // stages 1 to 6
    // what stage 6 decided on the last clock: of which lookup, whether it is made again, which place falls asleep on
    // which slot
    std::optional<Request> decided;
    bool looks_again = false;
    std::optional<std::pair<std::size_t, std::size_t>> sleeps;
  };
  struct Change {
    std::size_t set = 0;
    std::array<bool, 2> ways{};
    std::array<Entry, 2> entries{};
  };

  /// What stage 6 decides.
  struct Decisions {
    std::array<bool, 2> fresh{};  // a lookup, and its set has not changed since
    std::array<bool, 2> hit{}, wait{};
    bool kill = false;                   // a fill without data: its line is forgotten
    bool walk_seen = false;              // a set of the walk
    bool walk_next = false;              // that need not be looked at again
    bool walk_write = false;             // and has lines to invalidate
    std::optional<std::size_t> granted;  // port that gets a frame
  };

  std::size_t set_of(const Step& step) const { return step.line % shape_.sets; }
  bool changes(const Step& step) const { return change_ && change_->set == set_of(step); }

  /// A port took nothing on the clock before: what is in it has two clocks of the memory of lines.
  bool rests(std::size_t p) const { return ports_[p].steps[0].kind == Kind::none; }
  /// It takes a request. Port 1 rests before a set to invalidate, too.
  bool takes(std::size_t p) const { return rests(p) && !(p == 1 && walk_valid_); }
  bool serving() const;
  Decisions decide();
  void clock_turn();
  bool answer(std::size_t p, const Decisions& now);
  Step enter(std::size_t p, const std::optional<Request>& ask, bool again, const Request& again7);
  void clock_waiters(std::size_t p, const Decisions& now, bool served);
  void clock_steps(std::size_t p, const std::vector<Range>& locks);
  void look_up(Step& step) const;
  void judge(Step& step) const;
  void clock_entries(const Decisions& now);
  void clock_walk(const std::optional<Range>& invalidate, const Decisions& now);
  void next_set();

  Shape shape_;
  CacheFill fill_;
  std::array<Port, 2> ports_{Port(2), Port(2)};
  std::vector<std::array<Entry, 2>> entries_;
  std::vector<LineData> data_;
  std::optional<Change> change_;
  std::size_t allocate_frame_ = 0;
  std::optional<Request> read_;
  std::optional<Beat> beat_;  // that came on the last clock
  std::array<std::optional<Answer>, 2> answers_;
  std::array<Counts, 2> counts_{};
  bool favour_ = false, running_ = false, ready_ = false, walk_valid_ = false;
  State state_ = State::clear;
  std::size_t walk_set_ = 0;
  std::uint64_t left_ = 0;
  Range walk_range_;
  std::set<std::size_t> old_;
  int clocks_ = 0;
  std::vector<bool> retried_;  // of each place, of port 0 first
  std::size_t oldest_ = 0;
  int age_ = 0;
  std::size_t was_oldest_ = 0;
  bool was_alone_ = false;
  bool alone_ = false;
  bool look_ = false, seen_retried_ = false;
  bool was_running_ = false, walk_enters_ = false, served_ = false;  // a clock later than what they follow
  std::size_t entering_set_ = 0;
};

}  // namespace cchip::model

#endif
