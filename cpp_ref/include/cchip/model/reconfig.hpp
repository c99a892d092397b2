// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact models of the blocks in rtl/reconfig between a region and the rest. Moore machines, like those in
/// stream.hpp.
#ifndef CCHIP_MODEL_RECONFIG_HPP
#define CCHIP_MODEL_RECONFIG_HPP

#include <cstdint>
#include <deque>

namespace cchip::model {

/// cchip_roc_generator, modelled from power-up on: counts the clocks since the last configuration, power-up or reset.
class RocGenerator {
 public:
  /// \param cycles length of the reset, clocks
  explicit RocGenerator(std::uint64_t cycles) : cycles_(cycles) {}
  bool roc() const { return since_ < cycles_; }
  /// Rising edge.
  void clock(bool rst, bool configured) { since_ = rst || configured ? 0 : since_ + 1; }

 private:
  std::uint64_t cycles_;
  std::uint64_t since_ = 0;
};

/// cchip_pr_gate: a queue of two beats that takes nothing while stopped and is empty while closed.
template <class T>
class Gate {
 public:
  bool s_ready() const { return ready_; }
  bool m_valid() const { return !beats_.empty(); }
  /// Defined while m_valid().
  const T& m_data() const { return beats_.front(); }
  /// All outputs are 0, data too.
  bool closed() const { return closed_; }

  void clock(bool close, bool stop, bool s_valid, const T& s_data, bool m_ready) {
    const bool push = s_valid && ready_;
    if (m_ready && !beats_.empty()) beats_.pop_front();
    if (push) beats_.push_back(s_data);
    if (close) beats_.clear();
    ready_ = !close && !stop && beats_.size() < 2;
    closed_ = close;
  }

 private:
  std::deque<T> beats_;
  bool ready_ = false;
  bool closed_ = true;
};

}  // namespace cchip::model

#endif
