// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact models of the blocks in rtl/common. Every model is a Moore machine: its accessors show
/// the outputs during the present clock, clock() is the rising edge that ends it.
#ifndef CCHIP_INTERNAL_MODEL_STREAM_HPP
#define CCHIP_INTERNAL_MODEL_STREAM_HPP

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace cchip::model {

/// cchip_delay: output is the input `depth` clocks ago. For depth 0 use the input itself.
template <class T>
class Delay {
 public:
  /// \param depth clocks, >= 1
  /// \param reset value of every stage after construction and reset()
  explicit Delay(std::size_t depth, T reset = T{}) : stages_(depth, reset), reset_(std::move(reset)) {
    if (depth == 0) throw std::invalid_argument("model::Delay: depth must be at least 1; use the input itself for 0");
  }
  const T& q() const { return stages_[next_]; }
  void clock(T d) {
    stages_[next_] = std::move(d);
    next_ = (next_ + 1) % stages_.size();
  }
  /// One clock with rst = 1 (RESET = 1).
  void reset() { stages_.assign(stages_.size(), reset_); }

 private:
  std::vector<T> stages_;
  T reset_;
  std::size_t next_ = 0;
};

/// cchip_fifo: capacity `depth`, visible two clocks after the push; every output registered.
template <class T>
class Fifo {
 public:
  explicit Fifo(std::size_t depth) : depth_(depth) {}
  bool s_ready() const { return ready_; }
  bool m_valid() const { return out_.has_value(); }
  /// Defined while m_valid().
  const T& m_data() const { return *out_; }
  std::size_t size() const { return items_.size() + (out_ ? 1 : 0); }

  void clock(bool s_valid, const T& s_data, bool m_ready) {
    const bool push = s_valid && ready_;
    if (m_ready) out_.reset();
    if (!out_ && !items_.empty()) {
      out_ = std::move(items_.front());
      items_.pop_front();
    }
    if (push) items_.push_back(s_data);
    ready_ = size() != depth_;
  }
  void reset() {
    items_.clear();
    out_.reset();
    ready_ = false;
  }

 private:
  std::size_t depth_;
  std::deque<T> items_;
  std::optional<T> out_;
  bool ready_ = false;
};

/// cchip_skid_buffer: two beats, every output registered.
template <class T>
class SkidBuffer {
 public:
  bool s_ready() const { return ready_; }
  bool m_valid() const { return out_.has_value(); }
  /// Defined while m_valid().
  const T& m_data() const { return *out_; }

  void clock(bool s_valid, const T& s_data, bool m_ready) {
    std::optional<T> in;
    if (s_valid && ready_) in = s_data;
    if (m_ready || !out_) {
      out_ = skid_ ? std::exchange(skid_, std::nullopt) : std::move(in);
    } else if (in) {
      skid_ = std::move(in);
    }
    ready_ = !skid_;
  }
  void reset() {
    out_.reset();
    skid_.reset();
    ready_ = false;
  }

 private:
  bool ready_ = false;
  std::optional<T> out_;
  std::optional<T> skid_;
};

/// cchip_pool: numbers first to first + count - 1, lent one at a time; the one that came back first goes first.
class Pool {
 public:
  explicit Pool(std::size_t count, std::size_t first = 0) : first_(first), end_(first + count), free_(count) {}
  bool m_valid() const { return free_.m_valid(); }
  std::size_t m_number() const { return free_.m_data(); }

  void clock(bool m_ready, std::optional<std::size_t> back) {
    const bool fill = next_ != end_ && free_.s_ready() && !back;
    free_.clock(fill || back, back.value_or(next_), m_ready);
    next_ += fill ? 1 : 0;
  }
  void reset() {
    free_.reset();
    next_ = first_;
  }

 private:
  std::size_t first_;
  std::size_t end_;
  std::size_t next_ = first_;
  Fifo<std::size_t> free_;
};

/// cchip_arbiter: of the requests the first behind the one served last. At most 32 sources.
class Arbiter {
 public:
  explicit Arbiter(std::size_t sources) : sources_(sources) {}
  std::optional<std::size_t> grant(std::uint32_t requests) const {
    for (std::size_t i = 0; i < sources_; ++i) {
      const std::size_t source = (next_ + i) % sources_;
      if ((requests >> source & 1) != 0) return source;
    }
    return std::nullopt;
  }
  /// The source of grant(requests), if any, is served if take = 1.
  void clock(std::uint32_t requests, bool take) {
    if (const auto served = grant(requests); served && take) next_ = (*served + 1) % sources_;
  }
  void reset() { next_ = 0; }

 private:
  std::size_t sources_;
  std::size_t next_ = 0;
};

/// cchip_timeout: clocks since restart; a limit of 0 is the default. A limit is seen a clock after it was given.
class Timeout {
 public:
  explicit Timeout(std::uint32_t limit_of_0) : default_(limit_of_0) {}
  /// 1 on the first clock after restart.
  std::uint32_t elapsed() const { return elapsed_; }
  bool expired() const { return expired_; }

  void clock(bool restart, std::uint32_t limit) {
    expired_ = !restart && elapsed_ >= bound_;
    elapsed_ = restart ? 1 : elapsed_ + 1;
    bound_ = limit == 0 ? default_ : limit;
  }

 private:
  std::uint32_t default_;
  std::uint32_t bound_ = default_;
  std::uint32_t elapsed_ = 1;
  bool expired_ = false;
};

/// cchip_ram: registered read of the old word; words are undefined (nullopt) until written.
template <class T>
class Ram {
 public:
  explicit Ram(std::size_t depth) : words_(depth) {}
  const std::optional<T>& read_data() const { return read_; }
  void clock(bool write, std::size_t write_addr, const T& write_data, std::size_t read_addr) {
    read_ = read_addr < words_.size() ? words_[read_addr] : std::nullopt;
    if (write) words_.at(write_addr) = write_data;
  }

 private:
  std::vector<std::optional<T>> words_;
  std::optional<T> read_;
};

}  // namespace cchip::model

#endif
