// SPDX-License-Identifier: Apache-2.0
/// \file
/// Results that come back in any order, matched by tag.
#ifndef CCHIP_SIM_SCOREBOARD_HPP
#define CCHIP_SIM_SCOREBOARD_HPP

#include <cchip/sim/errors.hpp>
#include <cchip/sim/printing.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace cchip::sim {

/// Every expected tag must come back once, with the value expected. A tag may be used again after that.
template <class Expected, class Got = Expected>
class TagScoreboard {
 public:
  using Matches = std::function<bool(const Expected&, const Got&)>;
  explicit TagScoreboard(std::string name, Matches matches = default_match())
      : name_(std::move(name)), matches_(std::move(matches)) {}

  /// \throws ScoreboardError the tag is still waiting for its result
  void expect(std::uint64_t tag, Expected value, std::uint64_t clock) {
    if (!open_.emplace(tag, Entry{std::move(value), clock}).second) {
      fail(tag, clock, "is sent again before its result came");
    }
  }

  /// \throws ScoreboardError the result is unexpected, repeated or wrong
  void got(std::uint64_t tag, const Got& value, std::uint64_t clock) {
    const auto entry = open_.find(tag);
    if (entry == open_.end()) {
      const auto before = answered_.find(tag);
      fail(tag, clock,
           before == answered_.end()
               ? "was never sent: " + to_text(value)
               : "came twice, before on clock " + std::to_string(before->second) + ": " + to_text(value));
    }
    if (!matches_(entry->second.value, value)) {
      fail(tag, clock,
           "sent on clock " + std::to_string(entry->second.clock) + ": expected " + to_text(entry->second.value) +
               ", got " + to_text(value));
    }
    open_.erase(entry);
    answered_[tag] = clock;
    ++matched_;
  }

  /// \throws ScoreboardError results are missing
  void finish() const {
    if (open_.empty()) return;
    const auto& [tag, entry] = *open_.begin();
    throw ScoreboardError(name_ + ": " + std::to_string(open_.size()) + " results are missing, first tag " +
                          std::to_string(tag) + " sent on clock " + std::to_string(entry.clock) + ": expected " +
                          to_text(entry.value));
  }

  /// Drops everything, for a reset in mid traffic: results requested before count as never requested.
  void clear() {
    open_.clear();
    answered_.clear();
  }

  std::size_t open() const { return open_.size(); }
  std::uint64_t matched() const { return matched_; }

 private:
  struct Entry {
    Expected value;
    std::uint64_t clock;
  };
  static Matches default_match() {
    return [](const Expected& expected, const Got& got) { return expected == got; };
  }
  [[noreturn]] void fail(std::uint64_t tag, std::uint64_t clock, const std::string& problem) const {
    throw ScoreboardError(name_ + ": clock " + std::to_string(clock) + ": tag " + std::to_string(tag) + " " + problem);
  }

  std::string name_;
  Matches matches_;
  std::map<std::uint64_t, Entry> open_;
  std::map<std::uint64_t, std::uint64_t> answered_;
  std::uint64_t matched_ = 0;
};

}  // namespace cchip::sim

#endif
