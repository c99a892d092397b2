// SPDX-License-Identifier: Apache-2.0
/// \file
/// Streams pairs through a Verilated primitive test; every pair with its own programme.
#ifndef CCHIP_CAMPAIGN_RTL_STREAM_HPP
#define CCHIP_CAMPAIGN_RTL_STREAM_HPP

#include <cchip/machines/rtl_engine.hpp>
#include <vector>

#include "commands.hpp"

namespace cchip::campaign {

/// What the machine did, from the first offered pair to the last result.
struct RtlCounts {
  std::uint64_t clocks = 0;
  std::uint64_t offered_clocks = 0;  ///< clocks on which a pair waits on s_pair
  std::uint64_t beats = 0;           ///< axes that the pipeline accepted on these clocks
  RtlCounts& operator+=(const RtlCounts& x) {
    clocks += x.clocks;
    offered_clocks += x.offered_clocks;
    beats += x.beats;
    return *this;
  }
};

struct RtlRun {
  std::vector<PairResult> results;  ///< in the order of the pairs
  RtlCounts counts;
};

/// Sends the requests back to back, a new one on every clock on which the module is ready; number n gets tag_of(n).
/// \throws PrimtestStreamError no answer, an unexpected answer
RtlRun run_rtl(PrimtestMachine& machine, const std::vector<PairRequest>& requests);

/// The result that the model predicts, with this tag.
PairResult predicted(const ShapeInfo& shape, const PairRequest& request, std::uint16_t tag);

/// Results that differ in any bit from the model's, or in the grid answer from the exact one (which is not checked in
/// reserved modes).
struct RtlJudgement {
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;
  std::uint64_t definite = 0;
  std::uint64_t not_as_model = 0;
  std::uint64_t wrong = 0;
  std::uint64_t too_many_beats = 0;
  Spread beats;
  RtlCounts counts;
  RtlJudgement& operator+=(const RtlJudgement& x) {
    pairs += x.pairs;
    hits += x.hits;
    definite += x.definite;
    not_as_model += x.not_as_model;
    wrong += x.wrong;
    too_many_beats += x.too_many_beats;
    beats += x.beats;
    counts += x.counts;
    return *this;
  }
  bool failed() const { return not_as_model + wrong + too_many_beats != 0; }
};

/// Runs the requests and judges them. `exact[i]` is the exact answer of request i.
RtlJudgement judge_rtl(const ShapeInfo& shape, const std::vector<PairRequest>& requests, const std::vector<bool>& exact,
                       std::uint64_t seed, std::uint64_t part, Examples& examples);

}  // namespace cchip::campaign

#endif
