// SPDX-License-Identifier: Apache-2.0
#include "rtl_stream.hpp"

#include <cchip/stimulus/judge.hpp>
#include <sstream>

namespace cchip::campaign {
namespace {

constexpr int width = defs::coord_w_default;
constexpr int contexts = defs::contexts_default(defs::substages_default);
constexpr std::uint64_t answer_bound = defs::drain_bound(defs::substages_default, contexts);

}  // namespace

RtlRun run_rtl(PrimtestMachine& machine, const std::vector<PairRequest>& requests) {
  RtlRun run;
  run.results.resize(requests.size());
  PrimtestTraffic traffic;
  traffic.pairs = requests.size();
  traffic.answer_bound = answer_bound;
  traffic.request = [&](std::size_t n) {
    PairRequest request = requests[n];
    request.tag = tag_of(n);
    return request;
  };
  traffic.accepted = [](std::size_t) {};
  traffic.answered = [&](std::size_t n, const PairResult& result) { run.results[n] = result; };
  traffic.clock = [&](const PrimtestMachine::Outputs& out, bool offers) {
    ++run.counts.clocks;
    run.counts.offered_clocks += offers ? 1 : 0;
    run.counts.beats += offers && out.beat_valid ? 1 : 0;
  };
  stream_pairs(machine, traffic);
  return run;
}

PairResult predicted(const ShapeInfo& shape, const PairRequest& request, std::uint16_t tag) {
  return model::run_programme(shape.options(), request.pair, request.mode, width).result(tag);
}

RtlJudgement judge_rtl(const ShapeInfo& shape, const std::vector<PairRequest>& requests, const std::vector<bool>& exact,
                       std::uint64_t seed, std::uint64_t part, Examples& examples) {
  RtlMachineOptions machine;
  machine.seed = seed;
  machine.scramble = true;
  const RtlRun run = run_rtl(*make_rtl_machine(shape.id, machine), requests);
  RtlJudgement sum;
  sum.counts = run.counts;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const PairRequest& request = requests[i];
    const PairResult& got = run.results[i];
    const PairResult expected = predicted(shape, request, tag_of(i));
    const bool legal = request.mode <= PairMode::directed;
    RtlJudgement one;
    one.pairs = 1;
    one.hits = exact[i] ? 1 : 0;
    one.definite = got.definite ? 1 : 0;
    one.not_as_model = got == expected ? 0 : 1;
    one.wrong = legal && (got.grid != exact[i] || (exact[i] && !got.hit)) ? 1 : 0;
    const bool directed = request.mode == PairMode::directed;
    const bool bounded = directed && is_general_position(request.pair);
    one.too_many_beats = bounded && got.beats > most_general_position_beats(request.pair, got.grid) ? 1 : 0;
    if (legal) one.beats.add(got.beats);
    if (one.failed()) {
      std::ostringstream text;
      text << to_text(request.pair) << ", mode " << static_cast<int>(request.mode) << ": RTL " << got << ", model "
           << expected << ", exact " << exact[i];
      examples.add(part, text.str());
    }
    sum += one;
  }
  return sum;
}

}  // namespace cchip::campaign
