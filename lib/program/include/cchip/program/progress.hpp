// SPDX-License-Identifier: Apache-2.0
/// \file
/// Progress on a terminal.
#ifndef CCHIP_PROGRAM_PROGRESS_HPP
#define CCHIP_PROGRAM_PROGRESS_HPP

#include <chrono>
#include <cstdint>
#include <ostream>
#include <string>

namespace cchip {

/// One line with a bar, a count and, after a second, an estimate of the time left. It is redrawn at most ten times a
/// second and removed at the end. Not thread-safe.
class Progress {
 public:
  /// \param unit what is counted, in the plural, for example "pairs"
  Progress(std::ostream& out, bool enabled, std::string unit = "pairs")
      : out_(out), enabled_(enabled), unit_(std::move(unit)) {}
  /// On standard error; silent unless that is a terminal.
  explicit Progress(std::string unit = "pairs");
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  bool enabled() const { return enabled_; }
  /// \param fraction of the work in 0..1; negative if not known, then there is no bar and no estimate
  void update(std::uint64_t count, double fraction);
  /// The same for a count with a known total.
  void update_of(std::uint64_t count, std::uint64_t total);
  /// Removes the line, so that something else can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::ostream& out_;
  bool enabled_;
  std::string unit_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

}  // namespace cchip

#endif
