// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numbers for tests: any number of a range, or, for a known share of the draws, one at which arithmetic errs more
/// often than chance would draw it; and bins that say which ends of which ranges a test has met.
#ifndef CCHIP_STIMULUS_BOUNDARY_HPP
#define CCHIP_STIMULUS_BOUNDARY_HPP

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace cchip::stimulus {

/// Percentage of draws that are boundary values, in every test that does not say otherwise. Half of these are the two
/// ends of the range.
inline constexpr int boundary_percent = 40;

/// A number of least..most: uniform, or a boundary value: an end of the range or its neighbour, 0, 1, -1, a power of
/// two of either sign or its neighbour.
template <class Engine>
std::int64_t draw(Engine& random, std::int64_t least, std::int64_t most, int percent = boundary_percent) {
  const std::uint64_t span = static_cast<std::uint64_t>(most) - static_cast<std::uint64_t>(least);
  if (static_cast<int>(random() % 100) >= percent) {
    const std::uint64_t offset = span == UINT64_MAX ? random() : random() % (span + 1);
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(least) + offset);
  }
  const std::uint64_t kind = random() % 8;
  if (kind < 4 || span < 2) return kind % 2 == 0 ? least : most;
  if (kind == 4) return random() % 2 == 0 ? least + 1 : most - 1;
  const std::uint64_t bit = random() % 64;
  const std::int64_t power = bit > 62 ? 0 : std::int64_t{1} << bit;
  const std::int64_t value = (random() % 2 == 0 ? power : -power) + static_cast<std::int64_t>(random() % 3) - 1;
  if (value >= least && value <= most) return value;
  return least <= 0 && most >= 0 ? 0 : least;  // of small ranges, which 0 fits best
}

/// Counts how often each field of a test's inputs was at each end of its range, and how often two fields were at each
/// pair of ends in the same input.
class Bins {
 public:
  /// One input: see() each of its fields once, then end().
  void see(const std::string& field, std::int64_t value, std::int64_t least, std::int64_t most) {
    const auto number = numbers_.emplace(field, numbers_.size()).first->second;
    if (number >= ends_.size()) {
      ends_.resize(number + 1);
      names_.push_back(field);
    }
    if (value == least) met(number, 0);
    if (value == most) met(number, 1);
  }
  /// \param pairs count the pairs of ends, too
  void end(bool pairs = true) {
    for (std::size_t i = 0; pairs && i < now_.size(); ++i) {
      for (std::size_t j = i + 1; j < now_.size(); ++j) ++pairs_[std::minmax(now_[i], now_[j])];
    }
    now_.clear();
  }

  /// The ends that no input has met, as "field=least, field=most"; empty if all were.
  std::string missing_ends() const {
    std::string text;
    for (std::size_t i = 0; i < 2 * ends_.size(); ++i) {
      if (ends_[i / 2][i % 2] == 0) add(text, name(i));
    }
    return text;
  }
  /// The same with the pairs of ends, as "field=least with other=most".
  /// \param impossible regular expression of the pairs that no legal input has
  std::string missing(const std::string& impossible = "(?!)") const {
    std::string text = missing_ends();
    const std::regex skip(impossible);
    for (std::size_t i = 0; i < 2 * ends_.size(); ++i) {
      for (std::size_t j = (i | 1U) + 1; j < 2 * ends_.size(); ++j) {
        const std::string pair = name(i) + " with " + name(j);
        if (pairs_.count({i, j}) == 0 && !std::regex_match(pair, skip)) add(text, pair);
      }
    }
    return text;
  }
  /// Adds the bins of the same fields, seen in the same order.
  Bins& operator+=(const Bins& other) {
    if (numbers_.empty()) return *this = other;
    for (std::size_t i = 0; i < other.ends_.size(); ++i) {
      for (std::size_t side = 0; side < 2; ++side) ends_.at(i)[side] += other.ends_[i][side];
    }
    for (const auto& [pair, count] : other.pairs_) pairs_[pair] += count;
    return *this;
  }
  /// As "fields=9 bins=18 pairs=144".
  std::string summary() const {
    std::size_t bins = 0;
    for (const auto& ends : ends_) bins += (ends[0] > 0 ? 1 : 0) + (ends[1] > 0 ? 1 : 0);
    return "fields=" + std::to_string(ends_.size()) + " bins=" + std::to_string(bins) +
           " pairs=" + std::to_string(pairs_.size());
  }

 private:
  void met(std::size_t number, std::size_t side) {
    ++ends_[number][side];
    now_.push_back(2 * number + side);
  }
  static void add(std::string& text, const std::string& bin) { text += (text.empty() ? "" : ", ") + bin; }
  std::string name(std::size_t bin) const { return names_[bin / 2] + (bin % 2 == 0 ? "=least" : "=most"); }

  std::map<std::string, std::size_t> numbers_;
  std::vector<std::string> names_;
  std::vector<std::array<std::uint64_t, 2>> ends_;
  std::map<std::pair<std::size_t, std::size_t>, std::uint64_t> pairs_;
  std::vector<std::size_t> now_;  // ends met by the present input: 2 field + side
};

}  // namespace cchip::stimulus

#endif
