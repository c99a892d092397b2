// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lines of a chip's memory, given out in ranges.
#ifndef CCHIP_DRIVER_LINE_ALLOCATOR_HPP
#define CCHIP_DRIVER_LINE_ALLOCATOR_HPP

#include <cstdint>
#include <map>
#include <optional>

namespace cchip {

/// First fit.
class LineAllocator {
 public:
  LineAllocator(std::uint32_t first, std::uint32_t lines) : first_(first), end_(std::uint64_t{first} + lines) {}

  /// \param lines > 0
  /// \returns the first line of a free range, none if no free range is as long
  std::optional<std::uint32_t> allocate(std::uint32_t lines) {
    std::uint64_t at = first_;
    for (const auto& [first, end] : used_) {
      if (first - at >= lines) break;
      at = end;
    }
    if (end_ - at < lines) return std::nullopt;
    used_.emplace(at, at + lines);
    return static_cast<std::uint32_t>(at);
  }
  /// \param first of a range that allocate() returned
  void release(std::uint32_t first) { used_.erase(first); }
  void release_all() { used_.clear(); }

 private:
  std::uint64_t first_;
  std::uint64_t end_;
  std::map<std::uint64_t, std::uint64_t> used_;  // first line, end
};

}  // namespace cchip

#endif
