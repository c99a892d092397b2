// SPDX-License-Identifier: Apache-2.0
/// \file
/// On which clocks a stream agent is active: drivers offer an item, sinks are ready.
#ifndef CCHIP_SIM_PATTERN_HPP
#define CCHIP_SIM_PATTERN_HPP

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace cchip::sim {

/// A copy continues independently of the original.
class Pattern {
 public:
  /// Every clock.
  static Pattern always() { return {"always", Kind::bursts, 1, 0, 1.0, 0}; }
  /// Not on the first `clocks` clocks, then on every one.
  static Pattern never_for(std::uint64_t clocks) {
    return {"never for " + std::to_string(clocks), Kind::never_for, clocks, 0, 1.0, 0};
  }
  /// Each clock with this probability, 0..1.
  static Pattern random(double probability, std::uint64_t seed) {
    return {
        "random " + std::to_string(static_cast<int>(100 * probability)) + " %", Kind::random, 0, 0, probability, seed};
  }
  /// `active` clocks, then not for `idle` clocks, repeated.
  static Pattern bursts(std::uint64_t active, std::uint64_t idle) {
    return {"bursts " + std::to_string(active) + "/" + std::to_string(idle), Kind::bursts, active, idle, 1.0, 0};
  }
  /// Every second clock.
  static Pattern alternate() { return bursts(1, 1); }
  /// One clock in `period`.
  static Pattern single(std::uint64_t period) { return bursts(1, period - 1); }

  /// Active on the next clock?
  bool next() {
    const std::uint64_t clock = clock_++;
    if (kind_ == Kind::random) return std::bernoulli_distribution(probability_)(random_);
    if (kind_ == Kind::never_for) return clock >= first_;
    return clock % (first_ + second_) < first_;
  }
  const std::string& name() const { return name_; }

 private:
  enum class Kind { bursts, never_for, random };
  Pattern(std::string name, Kind kind, std::uint64_t first, std::uint64_t second, double probability,
          std::uint64_t seed)
      : name_(std::move(name)), kind_(kind), first_(first), second_(second), probability_(probability), random_(seed) {}

  std::string name_;
  Kind kind_;
  std::uint64_t first_;
  std::uint64_t second_;
  double probability_;
  std::mt19937_64 random_;
  std::uint64_t clock_ = 0;
};

/// One of each, for tests that sweep idle and back-pressure patterns.
inline std::vector<Pattern> standard_patterns(std::uint64_t seed) {
  return {Pattern::always(),     Pattern::never_for(40), Pattern::random(0.5, seed), Pattern::random(0.1, seed + 1),
          Pattern::bursts(5, 7), Pattern::alternate(),   Pattern::single(13)};
}

}  // namespace cchip::sim

#endif
