// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace cchip::app {

void Progress::update(std::uint64_t pairs, double fraction) {
  if (!enabled_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  if (fraction < 0) {
    out_ << fmt::format("\r\x1b[K{} pairs", pairs) << std::flush;
    return;
  }
  const auto filled = static_cast<std::size_t>(40 * std::min(fraction, 1.0));
  out_ << fmt::format("\r\x1b[K[{:<40}] {:3.0f} %  {} pairs", std::string(filled, '#'), 100 * fraction, pairs)
       << std::flush;
}

void Progress::clear() {
  if (drawn_) out_ << "\r\x1b[K" << std::flush;
  drawn_ = false;
}

}  // namespace cchip::app
