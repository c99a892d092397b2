// SPDX-License-Identifier: Apache-2.0
/// \file
/// Agents for valid/ready streams. T is the payload of one beat; it needs ==, and << for readable messages.
#ifndef CCHIP_SIM_STREAM_HPP
#define CCHIP_SIM_STREAM_HPP

#include <verilated.h>

#include <cchip/sim/agent.hpp>
#include <cchip/sim/errors.hpp>
#include <cchip/sim/pattern.hpp>
#include <cchip/sim/printing.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace cchip::sim {

/// Source of a stream: sends its queue in order. Valid rises on the clocks of the pattern and never waits for
/// ready; an item once offered stays until it is accepted. During reset valid is 0 and the queue is kept.
template <class T>
class StreamDriver : public Agent {
 public:
  /// \param valid,ready pins of the model
  /// \param set_payload writes an item to the payload pins
  StreamDriver(std::string name, CData& valid, const CData& ready, std::function<void(const T&)> set_payload,
               Pattern pattern = Pattern::always())
      : name_(std::move(name)),
        valid_(valid),
        ready_(ready),
        set_payload_(std::move(set_payload)),
        pattern_(std::move(pattern)) {
    valid_ = 0;
  }

  void push(T item) { queue_.push_back(std::move(item)); }
  /// Called on the clock on which an item is accepted.
  void on_accept(std::function<void(const T&, std::uint64_t clock)> action) { on_accept_ = std::move(action); }
  /// Called on clocks with valid = 0: may drive garbage on the payload pins.
  void when_idle(std::function<void()> action) { when_idle_ = std::move(action); }
  void set_pattern(Pattern pattern) { pattern_ = std::move(pattern); }
  /// Items not yet accepted.
  std::size_t waiting() const { return queue_.size(); }
  std::uint64_t accepted() const { return accepted_; }
  /// Drops all items not yet accepted. Only during reset: valid must not drop otherwise.
  void clear() { queue_.clear(); }

  void drive(const ClockInfo& now) override {
    if (now.in_reset) offering_ = false;
    if (!now.in_reset && !offering_ && !queue_.empty() && pattern_.next()) {
      offering_ = true;
      set_payload_(queue_.front());
    }
    valid_ = offering_ ? 1 : 0;
    if (!offering_ && when_idle_) when_idle_();
  }

  void sample(const ClockInfo& now) override {
    if (now.in_reset || !offering_ || ready_ == 0) return;
    offering_ = false;
    ++accepted_;
    const T item = std::move(queue_.front());
    queue_.pop_front();
    if (on_accept_) on_accept_(item, now.clock);
  }

  std::string waits_for() const override {
    if (queue_.empty()) return {};
    return name_ + " still has " + std::to_string(queue_.size()) + " items to send";
  }

 private:
  std::string name_;
  CData& valid_;
  const CData& ready_;
  std::function<void(const T&)> set_payload_;
  Pattern pattern_;
  std::deque<T> queue_;
  bool offering_ = false;
  std::uint64_t accepted_ = 0;
  std::function<void(const T&, std::uint64_t)> on_accept_;
  std::function<void()> when_idle_;
};

/// Watches a stream that others drive. Checks its rules on every clock: valid and payload of a beat that was offered
/// but not accepted must not change.
template <class T>
class StreamMonitor : public Agent {
 public:
  /// \param get_payload reads an item from the payload pins
  /// \param on_item called for every item handed over, with the number of its clock
  StreamMonitor(std::string name, const CData& valid, const CData& ready, std::function<T()> get_payload,
                std::function<void(const T&, std::uint64_t clock)> on_item = {})
      : name_(std::move(name)),
        valid_(valid),
        ready_(ready),
        get_payload_(std::move(get_payload)),
        on_item_(std::move(on_item)) {}

  void on_item(std::function<void(const T&, std::uint64_t clock)> action) { on_item_ = std::move(action); }
  /// Items handed over.
  std::uint64_t count() const { return count_; }
  /// Makes a timeout name this stream until `items` have been handed over in all.
  void expect_count(std::uint64_t items) { expected_ = items; }

  /// \throws StreamError
  void sample(const ClockInfo& now) override {
    if (now.in_reset) {
      stalled_.reset();
      return;
    }
    if (valid_ == 0) {
      if (stalled_)
        throw StreamError(name_ + ": valid dropped before the beat " + to_text(*stalled_) + " was accepted");
      return;
    }
    T item = get_payload_();
    if (stalled_ && !(*stalled_ == item)) {
      throw StreamError(name_ + ": payload changed while stalled, from " + to_text(*stalled_) + " to " + to_text(item));
    }
    if (ready_ == 0) {
      stalled_ = std::move(item);
      return;
    }
    stalled_.reset();
    ++count_;
    if (on_item_) on_item_(item, now.clock);
  }

  std::string waits_for() const override {
    if (count_ >= expected_) return {};
    return name_ + " delivered " + std::to_string(count_) + " of " + std::to_string(expected_) + " items";
  }

 private:
  std::string name_;
  const CData& valid_;
  const CData& ready_;
  std::function<T()> get_payload_;
  std::function<void(const T&, std::uint64_t)> on_item_;
  std::optional<T> stalled_;
  std::uint64_t count_ = 0;
  std::uint64_t expected_ = 0;
};

/// End of a stream: a monitor that also drives ready.
template <class T>
class StreamSink : public StreamMonitor<T> {
 public:
  StreamSink(std::string name, const CData& valid, CData& ready, std::function<T()> get_payload,
             Pattern pattern = Pattern::always(), std::function<void(const T&, std::uint64_t clock)> on_item = {})
      : StreamMonitor<T>(std::move(name), valid, ready, std::move(get_payload), std::move(on_item)),
        ready_(ready),
        pattern_(std::move(pattern)) {
    ready_ = 0;
  }

  void set_pattern(Pattern pattern) { pattern_ = std::move(pattern); }
  void drive(const ClockInfo&) override { ready_ = pattern_.next() ? 1 : 0; }

 private:
  CData& ready_;
  Pattern pattern_;
};

}  // namespace cchip::sim

#endif
