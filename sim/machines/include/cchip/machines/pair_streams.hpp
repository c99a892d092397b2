// SPDX-License-Identifier: Apache-2.0
/// \file
/// Both streams of pairs of a Verilated cchip_primtest_subsystem: one request at a time, results as they come.
#ifndef CCHIP_MACHINES_PAIR_STREAMS_HPP
#define CCHIP_MACHINES_PAIR_STREAMS_HPP

#include <cchip/internal/wire/pair.hpp>
#include <cchip/machines/pair_port.hpp>
#include <cchip/sim/agent.hpp>
#include <deque>

namespace cchip::sim {

template <class Model>
class PairStreams : public Agent {
 public:
  PairStreams(Model& model, int coord_w) : model_(model), port_(model, coord_w) {
    model_.s_pair_valid = 0;
    model_.s_pair_kind = 0;
    port_.put({});
  }

  /// \returns false, and drops this request, while offers()
  bool send(const KindRequest& request) {
    if (offers_) return false;
    port_.put(request.request);
    model_.s_pair_kind = static_cast<CData>(request.kind);
    offers_ = true;
    return true;
  }
  /// The request sent last is not accepted yet.
  bool offers() const { return offers_; }

  bool ready = true;               ///< m_result_ready of the next clocks
  std::deque<KindResult> results;  ///< handed over, oldest first; the user removes them

  void drive(const ClockInfo& now) override {
    model_.m_result_ready = ready ? 1 : 0;
    model_.s_pair_valid = offers_ && !now.in_reset ? 1 : 0;
  }
  void sample(const ClockInfo& now) override {
    if (now.in_reset) return;
    if (model_.s_pair_ready != 0) offers_ = false;
    if (model_.m_result_valid != 0 && model_.m_result_ready != 0)
      results.push_back({port_.result(), static_cast<int>(model_.m_result_kind)});
  }

 private:
  Model& model_;
  PairPort<Model> port_;
  bool offers_ = false;
};

}  // namespace cchip::sim

#endif
