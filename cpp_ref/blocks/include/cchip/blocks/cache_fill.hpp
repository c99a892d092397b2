// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact model of cchip_cache_fill. A Moore machine, like those in stream.hpp.
#ifndef CCHIP_BLOCKS_CACHE_FILL_HPP
#define CCHIP_BLOCKS_CACHE_FILL_HPP

#include <cchip/blocks/line_data.hpp>
#include <cchip/internal/model/stream.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

namespace cchip::model {

/// cchip_cache_fill: the lines in flight of cchip_cache. A frame is 2 set + way.
class CacheFill {
 public:
  /// An answer of cchip_axi_read.
  struct Beat {
    std::size_t slot = 0;
    std::optional<std::size_t> beat;  ///< without: no data
    bool last = false;
    ReadCode code = ReadCode::ok;
    LineData data{};
  };
  /// A line that has come.
  struct Fill {
    std::size_t slot = 0;
    ReadCode code = ReadCode::ok;
    std::size_t frame = 0;
  };
  struct Allocation {
    std::size_t slot = 0;
    std::size_t frame = 0;
  };
  struct Inputs {
    bool free_take = false;              ///< free_slot() is taken
    std::optional<Allocation> allocate;  ///< this slot has this frame from the next clock on
    std::optional<Beat> beat;
    bool free = true;               ///< what fill() was asked with
    std::optional<Fill> filled;     ///< the line of a fill five clocks ago: its data, if it has any, go into the frame
    bool serving = false;           ///< a port has not served all who wait
    std::vector<bool> outstanding;  ///< of each slot, as cchip_axi_read says
  };

  /// \param beats of a line
  CacheFill(std::size_t slots, std::size_t beats);

  std::optional<std::size_t> free_slot() const {
    return free_.m_valid() ? std::optional(free_.m_number()) : std::nullopt;
  }
  bool exhausted() const { return exhausted_; }  ///< every slot is lost
  bool held(std::size_t slot) const { return lines_[slot].held; }
  bool holds(std::size_t slot, std::size_t frame) const { return lines_[slot].held && lines_[slot].frame == frame; }
  bool filled(std::size_t slot) const { return lines_[slot].filled; }
  const LineData& data(std::size_t slot) const { return lines_[slot].data; }
  /// A line goes into its frame, if port 0 is free.
  std::optional<Fill> fill(bool free) const;
  /// Who waits for the line of serves() is to be served.
  bool collect() const { return collect_; }
  const std::optional<Fill>& serves() const { return serves_; }

  void clock(const Inputs& in);
  void reset();

 private:
  struct Line {
    bool held = false, filled = false;
    std::size_t frame = 0;
    LineData data{};
  };

  std::optional<std::size_t> next_free(bool release, bool lost, const std::vector<bool>& outstanding);
  void clock_slots(const Inputs& in, bool release, bool lost);
  void clock_serves(const Inputs& in, bool release);

  std::size_t beats_;
  std::vector<Line> lines_;  // of each slot
  Pool free_;
  Fifo<Fill> arrived_;          // the frame is that of its slot
  Fifo<Fill> serve_queue_;      // lines whose waiters are to be served
  std::optional<Fill> filled_;  // on the last clock
  std::optional<Fill> serves_;
  bool collect_ = false, collected_ = false, serving_ = false;
  std::set<std::size_t> lost_;  // slots whose reads memory may still owe
  std::optional<std::size_t> back_;
  std::size_t scan_ = 0;
  bool exhausted_ = false;
};

}  // namespace cchip::model

#endif
