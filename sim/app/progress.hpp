// SPDX-License-Identifier: Apache-2.0
/// \file
/// Progress on a terminal.
#ifndef CCHIP_APP_PROGRESS_HPP
#define CCHIP_APP_PROGRESS_HPP

#include <chrono>
#include <cstdint>
#include <ostream>

namespace cchip::app {

/// One line that is redrawn at most ten times a second; silent unless `enabled`.
class Progress {
 public:
  Progress(std::ostream& out, bool enabled) : out_(out), enabled_(enabled) {}
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` of the input in 0..1, negative if not known.
  void update(std::uint64_t pairs, double fraction);
  /// Takes the line away.
  void clear();

 private:
  std::ostream& out_;
  bool enabled_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace cchip::app

#endif
