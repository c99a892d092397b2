// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact model of cchip_leaf_queue. A Moore machine, like those in stream.hpp.
#ifndef CCHIP_BLOCKS_LEAF_QUEUE_HPP
#define CCHIP_BLOCKS_LEAF_QUEUE_HPP

#include <array>
#include <cchip/internal/model/stream.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace cchip::model {

/// cchip_leaf_queue: leaf pairs that wait for a primitive test, an entry for all of a node pair.
class LeafQueue {
 public:
  /// The children of a node.
  struct Children {
    std::array<unsigned, 4> kinds{};  ///< 2 bits each
    std::uint32_t first = 0;          ///< line of the first; the others follow it
  };
  struct Entry {
    std::size_t context = 0;
    unsigned epoch = 0;
    Children a, b;
    std::uint16_t leaves = 1;  ///< bit 4 i + j: child i of A and j of B are a pair; not 0
  };
  struct Epoch {
    std::size_t context = 0;
    unsigned epoch = 0;
  };
  struct Inputs {
    std::optional<Entry> entry;  ///< only while there is room for it, see capacity()
    std::optional<Epoch> epoch;
    bool credit = false;
    bool ready = false;
    bool drop_ready = false;
  };
  struct Pair {
    std::size_t context = 0;
    unsigned epoch = 0;
    unsigned kind_a = 0, kind_b = 0;
    std::uint32_t line_a = 0, line_b = 0;
  };

  /// \param contexts queries at once
  /// \param depth entries, besides the one at work
  /// \param credit pairs that the receiver has room for
  LeafQueue(std::size_t contexts, std::size_t depth, std::size_t credit)
      : queue_(depth), epochs_(contexts), all_credit_(credit), credit_(credit) {}

  /// Whether an entry may come: the queue has room, and this is not the first clock after reset.
  bool capacity() const { return queue_.s_ready(); }
  bool room() const { return room_; }
  bool valid() const { return state_ == State::fetch; }
  bool drop_valid() const { return state_ == State::drop; }
  /// Defined while valid() or drop_valid().
  const Pair& pair() const { return pairs_.front(); }

  void clock(const Inputs& in) {
    const bool taken = (valid() && in.ready) || (drop_valid() && in.drop_ready);
    const bool next = state_ == State::none;
    bool spent = false;
    switch (state_) {
      case State::none:
      case State::choose:
        if (state_ == State::choose) state_ = State::judge;
        break;
      case State::judge:
        if (epochs_[pair().context] != pair().epoch) {
          state_ = State::drop;
        } else if (credit_ != 0) {
          state_ = State::fetch;
          spent = true;
        }
        break;
      default:
        if (!taken) break;
        pairs_.pop_front();
        state_ = pairs_.empty() ? State::none : State::choose;
    }
    room_ = next && queue_.m_valid();
    if (room_) begin(queue_.m_data());
    queue_.clock(in.entry.has_value(), in.entry.value_or(Entry{}), next);
    credit_ = credit_ + (in.credit ? 1 : 0) - (spent ? 1 : 0);
    write(in.epoch);
  }

  /// One clock with rst = 1. The epochs stay, and may be written.
  void reset(const std::optional<Epoch>& epoch = std::nullopt) {
    queue_.reset();
    pairs_.clear();
    state_ = State::none;
    room_ = false;
    credit_ = all_credit_;
    write(epoch);
  }

 private:
  enum class State { none, choose, judge, fetch, drop };

  void write(const std::optional<Epoch>& epoch) {
    if (epoch) epochs_[epoch->context] = epoch->epoch;
  }
  void begin(const Entry& entry) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      for (std::uint32_t j = 0; j < 4; ++j) {
        if ((entry.leaves >> (4 * i + j) & 1) == 0) continue;
        pairs_.push_back(
            Pair{entry.context, entry.epoch, entry.a.kinds[i], entry.b.kinds[j], entry.a.first + i, entry.b.first + j});
      }
    }
    state_ = State::choose;
  }

  Fifo<Entry> queue_;
  std::vector<std::optional<unsigned>> epochs_;
  std::size_t all_credit_;
  std::size_t credit_;
  State state_ = State::none;
  std::deque<Pair> pairs_;  // of the entry at work that are left
  bool room_ = false;
};

}  // namespace cchip::model

#endif
