// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/driver/chip_driver.hpp>
#include <deque>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace cchip {
namespace {

/// One of several chips on the same memory.
struct Member {
  std::unique_ptr<QueryPort> port;
  std::size_t room = 0;             ///< queries in flight, at most
  std::set<std::uint32_t> flights;  ///< tags
  SwapCounts swaps;                 ///< when it was asked last
  bool dead = false;
};

/// Their ports as one. All read the images at the same lines. A chip that stops or dies ends its own queries with an
/// error code, which the host answers by itself; those of the others are not disturbed.
class ChipGroup final : public QueryPort {
 public:
  explicit ChipGroup(std::vector<std::unique_ptr<QueryPort>> ports) {
    bool is_first = true;
    for (std::unique_ptr<QueryPort>& port : ports) {
      const ChipCapabilities one = port->capabilities();
      Member member;
      member.room = std::max<std::size_t>(1, one.queries_in_flight);
      member.port = std::move(port);
      members_.push_back(std::move(member));
      if (std::exchange(is_first, false)) {
        all_ = one;
        all_.queries_in_flight = members_.back().room;
        all_.refits = false;  // the engine would be that of one of them
        continue;
      }
      if (one.swap_slots != all_.swap_slots)
        throw std::invalid_argument("open_chips: chip " + std::to_string(members_.size() - 1) + " has " +
                                    std::to_string(one.swap_slots) + " slots with swaps, chip 0 has " +
                                    std::to_string(all_.swap_slots) + "; give chips with the same number");
      const std::uint64_t end = std::min(end_of(all_), end_of(one));
      all_.image_first = std::max(all_.image_first, one.image_first);
      all_.image_lines = static_cast<std::uint32_t>(end - std::min<std::uint64_t>(end, all_.image_first));
      all_.queries_in_flight += members_.back().room;
      all_.quads = all_.quads && one.quads;
      all_.lock_ranges = std::min(all_.lock_ranges, one.lock_ranges);
    }
  }

  const char* name() const override { return members_.front().port->name(); }
  ChipCapabilities capabilities() const override { return all_; }

  /// Each chip's port writes the same bytes to the same lines, so memory holds one copy, and then invalidates them in
  /// its own chip's cache.
  void store(std::uint32_t first_line, const std::vector<Line>& lines) override {
    each([&](QueryPort& port) { port.store(first_line, lines); });
  }

  void lock(unsigned range, std::uint32_t first, std::uint32_t last) override {
    locks_[range] = {first, last};
    each([&](QueryPort& port) { port.lock(range, first, last); });
  }

  /// To the chip with the fewest queries in flight: as those that have room differ in their queries, not in themselves,
  /// that one is idle first. Of equal ones, to the one after that which got the last.
  bool submit(const Query& query) override {
    std::vector<std::size_t> order;
    for (std::size_t i = 1; i <= members_.size(); ++i) {
      const std::size_t member = (last_ + i) % members_.size();
      if (!members_[member].dead && members_[member].flights.size() < members_[member].room) order.push_back(member);
    }
    std::stable_sort(order.begin(), order.end(), [this](std::size_t x, std::size_t y) {
      return members_[x].flights.size() < members_[y].flights.size();
    });
    for (const std::size_t i : order) {
      Member& member = members_[i];
      bool taken = false;
      call(member, [&](QueryPort& port) { taken = port.submit(query); });
      if (!taken || member.dead) continue;
      member.flights.insert(query.tag);
      last_ = i;
      return true;
    }
    require_alive();
    return false;
  }

  /// Takes what all chips have before it hands over the first: so their doorbells and the clock cost the host one
  /// access for several short queries, not for each.
  std::optional<QueryOutcome> collect() override {
    if (ended_.empty()) collect_all();
    if (ended_.empty()) return std::nullopt;
    QueryOutcome outcome = std::move(ended_.front());
    ended_.pop_front();
    return outcome;
  }

  bool proceed() override {
    clocks_known_ = false;
    bool goes_on = false;
    for (Member& member : members_) {
      bool good = false;
      call(member, [&](QueryPort& port) { good = port.proceed(); });
      goes_on = goes_on || good;
      if (!good && !member.dead && !member.flights.empty()) restart(member);
    }
    require_alive();
    return goes_on || !ended_.empty();
  }

  bool recover() override {
    for (Member& member : members_) {
      restart(member);
    }
    ended_.clear();
    clocks_known_ = false;
    return std::any_of(members_.begin(), members_.end(), [](const Member& x) { return !x.dead; });
  }

  void load(ModuleId module_id) override {
    each([&](QueryPort& port) { port.load(module_id); });
  }

  SwapCounts swaps() override {
    SwapCounts sum;
    for (Member& member : members_) {
      call(member, [&](QueryPort& port) { member.swaps = port.swaps(); });
      sum.swaps += member.swaps.swaps;
      sum.clocks += member.swaps.clocks;
    }
    return sum;
  }

  /// All chips have one clock. It is read once for the outcomes that came together.
  std::uint64_t clocks() const override {
    for (const Member& member : members_) {
      if (clocks_known_) break;
      if (member.dead) continue;
      try {
        clocks_ = member.port->clocks();
        clocks_known_ = true;
      } catch (const std::runtime_error&) {  // another call finds it dead
      }
    }
    return clocks_;
  }

 private:
  static std::uint64_t end_of(const ChipCapabilities& chip) {
    return std::uint64_t{chip.image_first} + chip.image_lines;
  }

  /// Does nothing for a dead chip; an exception makes it one.
  template <class Action>
  void call(Member& member, const Action& action) {
    if (member.dead) return;
    try {
      action(*member.port);
    } catch (const std::runtime_error&) {
      bury(member);
    }
  }
  template <class Action>
  void each(const Action& action) {
    for (Member& member : members_) call(member, action);
  }

  void bury(Member& member) {
    member.dead = true;
    lose(member);
  }
  void lose(Member& member) {
    for (const std::uint32_t tag : member.flights) {
      QueryOutcome outcome;
      outcome.done.tag = tag;
      outcome.done.code = QueryCode::memory;
      ended_.push_back(std::move(outcome));
    }
    member.flights.clear();
  }

  void collect_all() {
    clocks_known_ = false;
    for (Member& member : members_) {
      for (bool more = true; more && !member.dead;) {
        std::optional<QueryOutcome> outcome;
        call(member, [&](QueryPort& port) { outcome = port.collect(); });
        more = outcome.has_value();
        // a tag that this chip was not given belongs to another one's query, or to none
        if (more && member.flights.erase(outcome->done.tag) != 0) ended_.push_back(std::move(*outcome));
      }
    }
  }

  /// Its queries are lost; memory, and with it the images, stays as it is.
  void restart(Member& member) {
    lose(member);
    bool good = false;
    call(member, [&](QueryPort& port) {
      good = port.recover();
      if (!good) return;
      for (const auto& [range, lines] : locks_) port.lock(range, lines.first, lines.second);
    });
    if (!good && !member.dead) bury(member);
  }

  void require_alive() const {
    const bool alive = std::any_of(members_.begin(), members_.end(), [](const Member& x) { return !x.dead; });
    if (!alive && ended_.empty()) throw std::runtime_error("chips: none of them works; reset chips and bus");
  }

  std::vector<Member> members_;
  ChipCapabilities all_;
  std::map<unsigned, std::pair<std::uint32_t, std::uint32_t>> locks_;  // by range: lines
  std::deque<QueryOutcome> ended_;                                     // not handed over yet
  std::size_t last_ = 0;                                               // member that got the last query
  mutable std::uint64_t clocks_ = 0;
  mutable bool clocks_known_ = false;
};

}  // namespace

std::unique_ptr<QueryPort> open_chips(std::vector<std::unique_ptr<Machine>> machines,
                                      const ChipDriverOptions& options) {
  if (machines.empty()) throw std::invalid_argument("open_chips: no machines; give one for each chip");
  std::vector<std::unique_ptr<QueryPort>> ports;
  ChipDriverOptions one = options;
  for (std::unique_ptr<Machine>& machine : machines) {
    ports.push_back(open_chip(std::move(machine), one));
    // The next chip's rings are where this one would put images, and the images behind those of the last chip.
    const std::uint64_t used = ports.back()->capabilities().image_first * std::uint64_t{line_bytes} - one.memory_base;
    one.memory_base += used;
    one.memory_bytes -= used;
  }
  return std::make_unique<ChipGroup>(std::move(ports));
}

}  // namespace cchip
