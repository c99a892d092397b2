// SPDX-License-Identifier: Apache-2.0
/// \file
/// Comparison of all levels with the Eigen reference and with each other.
#ifndef CCHIP_LEVELS_SUMMARY_HPP
#define CCHIP_LEVELS_SUMMARY_HPP

#include <cchip/levels/level.hpp>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace cchip::levels {

/// A level and its answers.
struct LevelRun {
  std::string name;         ///< L0 to L4
  std::string description;  ///< a few words
  bool reconfigures = false;
  LevelResult result;
  std::string error;  ///< why it ended before all was answered; then its answers do not count
};

/// Answers of the Eigen reference for the pairs on the grid; of points those of the nearest point of the triangle.
std::vector<std::uint8_t> reference_answers(const Stimulus& stimulus);

/// Indices of answers that differ from the expected ones, missing answers included.
std::vector<std::size_t> differences(const std::vector<std::uint8_t>& expected,
                                     const std::vector<std::uint8_t>& answers);

/// All findings.
class Summary {
 public:
  explicit Summary(const Stimulus& stimulus) : stimulus_(stimulus), expected_(reference_answers(stimulus)) {}

  void add(LevelRun run) { runs_.push_back(std::move(run)); }
  void set_added_deltas(std::int64_t deltas) { added_deltas_ = deltas; }

  /// Answers of all levels that differ from the reference.
  std::size_t mismatches() const;
  /// True if all levels that reconfigure did so equally often.
  bool swaps_agree() const;
  bool good() const { return mismatches() == 0 && swaps_agree() && added_deltas_ == 0; }

  /// Table, errors and the first differences of each level, and a last line
  /// levels=5 pairs=N swaps=S mismatches=M added_deltas=D
  void print(std::ostream& out) const;

 private:
  void print_run(std::ostream& out, const LevelRun& run) const;
  void print_differences(std::ostream& out, const LevelRun& run) const;
  std::uint64_t swaps() const;

  const Stimulus& stimulus_;
  std::vector<std::uint8_t> expected_;
  std::vector<LevelRun> runs_;
  std::int64_t added_deltas_ = 0;
};

}  // namespace cchip::levels

#endif
