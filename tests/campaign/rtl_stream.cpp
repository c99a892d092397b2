// SPDX-License-Identifier: Apache-2.0
#include "rtl_stream.hpp"

#include <Vcchip_primtest_quad_quad.h>
#include <Vcchip_primtest_quad_quad___024root.h>
#include <Vcchip_primtest_tri_quad.h>
#include <Vcchip_primtest_tri_quad___024root.h>
#include <Vcchip_primtest_tri_tri.h>
#include <Vcchip_primtest_tri_tri___024root.h>

#include <cchip/sim/simulation.hpp>
#include <cchip/stimulus/judge.hpp>
#include <sstream>

namespace cchip::campaign {
namespace {

constexpr int width = defs::coord_w_default;
constexpr int contexts = defs::contexts_default(defs::substages_default);
constexpr std::uint64_t answer_bound = defs::drain_bound(defs::substages_default, contexts);

/// The controller hands an axis to the pipeline.
bool axis_leaves(const Vcchip_primtest_tri_tri& top) {
  return top.rootp->cchip_primtest_tri_tri__DOT__u_primtest__DOT__u_controller__DOT__beat_valid_q != 0;
}
bool axis_leaves(const Vcchip_primtest_tri_quad& top) {
  return top.rootp->cchip_primtest_tri_quad__DOT__u_primtest__DOT__u_controller__DOT__beat_valid_q != 0;
}
bool axis_leaves(const Vcchip_primtest_quad_quad& top) {
  return top.rootp->cchip_primtest_quad_quad__DOT__u_primtest__DOT__u_controller__DOT__beat_valid_q != 0;
}

sim::SimulationOptions simulation_options(std::uint64_t seed) {
  sim::SimulationOptions options;
  options.seed = seed;
  options.timeout_clocks = 0;
  return options;
}

template <class Model>
class Stream : public RtlStream {
 public:
  explicit Stream(std::uint64_t seed)
      : random_(seed), simulation_(simulation_options(seed)), port_(simulation_.top(), width) {
    simulation_->s_pair_valid = 0;
    simulation_->m_result_ready = 1;
    port_.put({});
    simulation_.reset();
  }

  Run run(const std::vector<PairRequest>& requests) override {
    constexpr std::size_t tags = std::size_t{1} << defs::tag_w;
    Run run;
    run.results.resize(requests.size());
    std::vector<std::size_t> in_flight(tags, nobody);
    std::size_t accepted = 0;
    std::size_t answered = 0;
    const std::uint64_t start = simulation_.clock();
    std::uint64_t progress = start;
    offer(requests, accepted);
    while (answered < requests.size()) {
      simulation_.settle();
      if (simulation_->s_pair_valid != 0) {
        ++run.counts.offered_clocks;
        run.counts.beats += axis_leaves(simulation_.top()) ? 1 : 0;
      }
      if (simulation_->m_result_valid != 0) {
        const PairResult beat = port_.result();
        std::size_t& index = in_flight[beat.tag];
        if (index == nobody) throw sim::ScoreboardError(fmt::format("a result with tag {} that no pair has", beat.tag));
        run.results[index] = beat;
        index = nobody;
        ++answered;
        progress = simulation_.clock();
      }
      const bool accept = simulation_->s_pair_valid != 0 && simulation_->s_pair_ready != 0;
      if (accept) {
        in_flight[tag(accepted)] = accepted;
        ++accepted;
        progress = simulation_.clock();
      }
      simulation_.rise();
      if (accept) offer(requests, accepted);
      if (simulation_.clock() - progress > answer_bound) {
        throw sim::SimulationTimeout(fmt::format("no pair accepted and no result for {} clocks", answer_bound));
      }
    }
    run.counts.clocks = simulation_.clock() - start;
    return run;
  }

 private:
  static constexpr std::size_t nobody = ~std::size_t{0};

  void offer(const std::vector<PairRequest>& requests, std::size_t index) {
    simulation_->s_pair_valid = index < requests.size() ? 1 : 0;
    if (index >= requests.size()) {
      port_.scramble(random_);
      return;
    }
    PairRequest sent{requests[index].pair, tag(index), static_cast<std::uint8_t>(requests[index].mode)};
    for (GridPrimitive* p : {&sent.pair.a, &sent.pair.b}) {
      if (p->kind == Kind::tri) p->v[3].setConstant(static_cast<std::int16_t>(random_()));
    }
    port_.put(sent);
  }

  std::mt19937_64 random_;
  sim::Simulation<Model> simulation_;
  sim::PairPort<Model> port_;
};

}  // namespace

std::unique_ptr<RtlStream> make_rtl_stream(const ShapeInfo& shape, std::uint64_t seed) {
  if (shape.a == Kind::quad) return std::make_unique<Stream<Vcchip_primtest_quad_quad>>(seed);
  if (shape.b == Kind::quad) return std::make_unique<Stream<Vcchip_primtest_tri_quad>>(seed);
  return std::make_unique<Stream<Vcchip_primtest_tri_tri>>(seed);
}

PairResult predicted(const ShapeInfo& shape, const PairRequest& request, std::uint16_t tag) {
  const model::Outcome o = model::run_programme(shape.options(), request.pair, request.mode, width);
  return {tag, o.hit(), o.grid, o.definite, o.witness, o.beats};
}

RtlJudgement judge_rtl(const ShapeInfo& shape, const std::vector<PairRequest>& requests, const std::vector<bool>& exact,
                       std::uint64_t seed, std::uint64_t part, Examples& examples) {
  const auto run = make_rtl_stream(shape, seed)->run(requests);
  RtlJudgement sum;
  sum.counts = run.counts;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const PairRequest& request = requests[i];
    const PairResult& got = run.results[i];
    const PairResult expected = predicted(shape, request, RtlStream::tag(i));
    const bool legal = request.mode <= static_cast<int>(PairMode::directed);
    RtlJudgement one;
    one.pairs = 1;
    one.hits = exact[i] ? 1 : 0;
    one.definite = got.definite ? 1 : 0;
    one.not_as_model = got == expected ? 0 : 1;
    one.wrong = legal && (got.grid != exact[i] || (exact[i] && !got.hit)) ? 1 : 0;
    const bool directed = request.mode == static_cast<int>(PairMode::directed);
    one.too_many_beats = directed && got.beats > general_position_beats && is_general_position(request.pair) ? 1 : 0;
    if (legal) one.beats.add(got.beats);
    if (one.failed()) {
      std::ostringstream text;
      text << to_text(request.pair) << ", mode " << request.mode << ": RTL " << got << ", model " << expected
           << ", exact " << exact[i];
      examples.add(part, text.str());
    }
    sum += one;
  }
  return sum;
}

}  // namespace cchip::campaign
