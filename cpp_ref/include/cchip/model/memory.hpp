// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact models of the blocks in rtl/memory. Moore machines, like those in stream.hpp.
#ifndef CCHIP_MODEL_MEMORY_HPP
#define CCHIP_MODEL_MEMORY_HPP

#include <algorithm>
#include <array>
#include <cchip/model/stream.hpp>
#include <cchip/wire/definitions.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace cchip::model {

/// 64 bytes, or the part of them that a beat carries; the lowest address first.
using LineData = std::array<std::uint32_t, 16>;

/// cchip_axi_read: lines for several clients from a memory that answers in any order.
class AxiRead {
 public:
  struct Request {
    std::size_t slot = 0;
    std::uint64_t line = 0;  ///< address / 64
  };
  struct Beat {
    std::size_t id = 0;
    LineData data{};
    bool okay = true;
    bool last = false;
  };
  struct Inputs {
    std::uint32_t limit = 0;
    std::vector<std::optional<Request>> requests;  ///< one for each client
    bool arready = false;
    std::optional<Beat> beat;  ///< rvalid = 1
  };
  struct Address {
    std::size_t id = 0;
    std::uint64_t line = 0;
  };
  struct Answer {
    std::size_t client = 0;
    std::size_t slot = 0;
    bool last = false;
    ReadCode code = ReadCode::ok;     ///< defined if last
    std::optional<std::size_t> beat;  ///< without: an answer without data
    LineData data{};
  };

  /// \param beats of a line
  AxiRead(std::size_t clients, std::size_t slots, std::size_t beats)
      : slots_(slots), beats_(beats), queues_(clients, Fifo<Request>(slots)), reads_(clients * slots) {}

  const std::optional<Answer>& answer() const { return answer_; }
  const std::optional<Address>& address() const { return address_; }
  bool rready() const { return rready_; }
  bool owes() const { return owes_; }

  void clock(const Inputs& in) {
    // decisions, from the present state
    const bool head_owed = head_ && reads_[head_->id].owed;
    const bool dead = address_ && !address_awaited_;
    const bool issue = head_ && !head_owed && (!address_ || (in.arready && address_awaited_));
    const bool refuse = head_ && (head_owed || dead) && !failing_ && !found_;
    const bool taken = address_ && in.arready;
    std::optional<Failure> fail;
    if (found_ && !failing_) {
      fail = Failure{*found_, ReadCode::timeout};
    } else if (refuse) {
      fail = Failure{head_->id, ReadCode::owed};
    }
    const auto found = found_ ? (failing_ ? found_ : std::nullopt) : late(scan_) ? std::optional(scan_) : std::nullopt;
    const std::size_t scan = found_ ? scan_ : (scan_ + 1) % reads_.size();
    const auto place_beat = rready_ && in.beat && in.beat->id < reads_.size() ? in.beat : std::nullopt;
    owes_ =
        address_.has_value() || std::any_of(reads_.begin(), reads_.end(), [](const Read& read) { return read.owed; });

    if (tick_) {
      for (Read& read : reads_) read.ticks = read.live ? std::min(read.ticks + 1, 2) : 0;
    }
    answer_.reset();
    if (failed_) answer_failure(*failed_);
    if (beat_) answer_beat(*beat_);

    // addresses
    if (taken) {
      Read& read = reads_[address_->id];
      read.owed = true;
      read.count = 0;
      read.bad = false;
      address_.reset();
    }
    if (issue) {
      address_ = Address{head_->id, head_->line};
      address_awaited_ = true;
      reads_[head_->id].live = true;
      reads_[head_->id].ticks = 0;
    }
    const bool load = !head_ || issue || refuse;
    const std::size_t clients = queues_.size();
    std::optional<std::size_t> granted;
    for (std::size_t i = 1; i <= clients && !granted; ++i) {
      if (queues_[(served_ + i) % clients].m_valid()) granted = (served_ + i) % clients;
    }
    if (load) {
      head_.reset();
      if (granted) {
        const Request& request = queues_[*granted].m_data();
        head_ = Address{*granted * slots_ + request.slot, request.line};
        served_ = *granted;
      }
    }
    for (std::size_t i = 0; i < clients; ++i) {
      const auto& request = in.requests[i];
      queues_[i].clock(request.has_value(), request.value_or(Request{}), load && granted == i);
    }

    // time
    tick_ = timer_ == 0;
    timer_ = timer_ == 0 ? in.limit : timer_ - 1;
    scan_ = scan;
    found_ = found;

    // the read channel
    failed_ = failing_;
    beat_ = place_beat;
    failing_ = fail;
    rready_ = !fail;
  }

  void reset(std::uint32_t limit) {
    for (auto& queue : queues_) queue.reset();
    for (auto& read : reads_) read = Read{};
    head_.reset();
    address_.reset();
    answer_.reset();
    found_.reset();
    failing_.reset();
    failed_.reset();
    beat_.reset();
    served_ = queues_.size() - 1;
    timer_ = limit;
    scan_ = 0;
    tick_ = rready_ = owes_ = address_awaited_ = false;
  }

 private:
  struct Read {
    bool live = false;  // the client waits
    bool owed = false;  // memory has beats to send
    int ticks = 0;      // seen while live, at most 2
    std::size_t count = 0;
    bool bad = false;
  };
  struct Failure {
    std::size_t id;
    ReadCode code;
  };

  bool late(std::size_t id) const { return reads_[id].live && reads_[id].ticks == 2; }

  void answer_failure(const Failure& failure) {
    Read& read = reads_[failure.id];
    if (failure.code == ReadCode::timeout) {
      if (!read.live) return;
      read.live = false;
      if (address_ && address_->id == failure.id) address_awaited_ = false;
    }
    answer_ = Answer{failure.id / slots_, failure.id % slots_, true, failure.code, std::nullopt, {}};
  }

  void answer_beat(const Beat& beat) {
    Read& read = reads_[beat.id];
    if (!read.owed) return;
    const bool last_one = read.count + 1 == beats_;
    read.bad = read.bad || !beat.okay;
    if (read.live) {
      const bool last = beat.last || last_one;
      const ReadCode code = read.bad || beat.last != last_one ? ReadCode::bus : ReadCode::ok;
      answer_ = Answer{beat.id / slots_, beat.id % slots_, last, code, read.count, beat.data};
      if (last) read.live = false;
    }
    ++read.count;
    if (beat.last) read.owed = false;
  }

  std::size_t slots_;
  std::size_t beats_;
  std::vector<Fifo<Request>> queues_;
  std::vector<Read> reads_;
  std::size_t served_ = 0;
  std::optional<Address> head_, address_;
  bool address_awaited_ = false;
  std::optional<Answer> answer_;
  std::uint32_t timer_ = 0;
  bool tick_ = false, rready_ = false, owes_ = false;
  std::size_t scan_ = 0;
  std::optional<std::size_t> found_;
  std::optional<Failure> failing_, failed_;
  std::optional<Beat> beat_;
};

}  // namespace cchip::model

#endif
