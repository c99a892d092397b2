// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cchip/program/progress.hpp>
#include <iostream>
#include <utility>

namespace cchip {
namespace {

/// "3 s", "12 min", "2.5 h".
std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

constexpr double first_estimate = 1;  // seconds; before, the start of the work distorts it

/// "1 pair", "2 pairs", of a unit in the plural.
std::string counted(std::uint64_t count, const std::string& unit) {
  return fmt::format("{} {}", count, count == 1 && unit.back() == 's' ? unit.substr(0, unit.size() - 1) : unit);
}

}  // namespace

Progress::Progress(std::string unit) : Progress(std::cerr, isatty(STDERR_FILENO) == 1, std::move(unit)) {}

void Progress::update(std::uint64_t count, double fraction) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  if (fraction < 0) {
    out_ << "\r\x1b[K" << counted(count, unit_) << std::flush;
    return;
  }
  const double done = std::min(fraction, 1.0);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const std::string left =
      done > 0 && elapsed > first_estimate ? fmt::format(", {} left", duration(elapsed * (1 - done) / done)) : "";
  out_ << fmt::format("\r\x1b[K[{:<40}] {:3.0f} %  {}{}", std::string(static_cast<std::size_t>(40 * done), '#'),
                      100 * done, counted(count, unit_), left)
       << std::flush;
}

void Progress::update_of(std::uint64_t count, std::uint64_t total) {
  update(count, total == 0 ? -1 : static_cast<double>(count) / static_cast<double>(total));
}

void Progress::clear() {
  if (drawn_) out_ << "\r\x1b[K" << std::flush;
  drawn_ = false;
}

}  // namespace cchip
