// SPDX-License-Identifier: Apache-2.0
#include "rtl_stream.hpp"

#include <cchip/sim/errors.hpp>
#include <cchip/stimulus/judge.hpp>
#include <sstream>

namespace cchip::campaign {
namespace {

constexpr int width = defs::coord_w_default;
constexpr int contexts = defs::contexts_default(defs::substages_default);
constexpr std::uint64_t answer_bound = defs::drain_bound(defs::substages_default, contexts);
constexpr std::size_t tags = std::size_t{1} << defs::tag_w;
constexpr std::size_t nobody = ~std::size_t{0};

}  // namespace

RtlRun run_rtl(PrimtestMachine& machine, const std::vector<PairRequest>& requests) {
  RtlRun run;
  run.results.resize(requests.size());
  std::vector<std::size_t> in_flight(tags, nobody);
  std::size_t accepted = 0;
  std::size_t answered = 0;
  std::uint64_t progress = 0;
  const auto offer = [&] {
    std::optional<PairRequest> request;
    if (accepted < requests.size()) request = requests[accepted];
    if (request) request->tag = tag_of(accepted);
    machine.offer(request);
  };
  offer();
  for (std::uint64_t& clock = run.counts.clocks; answered < requests.size(); ++clock) {
    const PrimtestMachine::Outputs out = machine.outputs();
    const bool offers = accepted < requests.size();
    if (offers) {
      ++run.counts.offered_clocks;
      run.counts.beats += out.beat_valid ? 1 : 0;
    }
    if (out.result) {
      std::size_t& index = in_flight[out.result->tag];
      if (index == nobody) {
        throw sim::ScoreboardError(fmt::format("a result with tag {} that no pair has", out.result->tag));
      }
      run.results[index] = *out.result;
      index = nobody;
      ++answered;
      progress = clock;
    }
    const bool accept = offers && out.pair_ready;
    if (accept) {
      in_flight[tag_of(accepted)] = accepted;
      ++accepted;
      progress = clock;
    }
    machine.clock();
    if (accept) offer();
    if (clock - progress > answer_bound) {
      throw sim::SimulationTimeout(fmt::format("no pair accepted and no result for {} clocks", answer_bound));
    }
  }
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
  const RtlRun run = run_rtl(*make_rtl_machine(module_of(shape.a, shape.b), machine), requests);
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
    one.too_many_beats = directed && got.beats > general_position_beats && is_general_position(request.pair) ? 1 : 0;
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
