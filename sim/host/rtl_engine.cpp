// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_primtest_tri_tri.h>
#include <Vcchip_primtest_tri_tri___024root.h>

#include <cchip/rtl_engine.hpp>
#include <cchip/sim/pair_port.hpp>
#include <cchip/sim/simulation.hpp>
#include <stdexcept>

namespace cchip {
namespace {

using Model = Vcchip_primtest_tri_tri;
constexpr int width = defs::coord_w_default;
constexpr int contexts = defs::contexts_default(defs::substages_default);
constexpr std::uint64_t answer_bound = defs::drain_bound(defs::substages_default, contexts);
constexpr std::size_t tags = std::size_t{1} << defs::tag_w;

sim::SimulationOptions simulation_options(const RtlEngineOptions& options) {
  sim::SimulationOptions result;
  result.seed = options.seed;
  result.trace_path = options.trace_path;
  result.trace_clocks = options.trace_clocks;
  result.timeout_clocks = 0;
  return result;
}

void check(const GridPrimitive& primitive, std::size_t index) {
  const std::string pair = "pair " + std::to_string(index);
  if (primitive.kind != Kind::tri)
    throw std::invalid_argument(pair + ": engine rtl takes triangles only; use eigen or exact");
  for (std::size_t i = 0; i < 3; ++i) {
    if (primitive.v[i].minCoeff() < -(1 << (width - 1)) || primitive.v[i].maxCoeff() >= 1 << (width - 1)) {
      throw std::invalid_argument(pair + ": coordinate beyond " + std::to_string(width) +
                                  " signed bits; quantise it first");
    }
  }
}

/// The triangles with nothing in the unused vertex slot.
GridPair sent(const GridPair& pair) {
  GridPair result = pair;
  result.a.v[3].setZero();
  result.b.v[3].setZero();
  return result;
}

class RtlEngine : public PairEngine {
 public:
  explicit RtlEngine(const RtlEngineOptions& options) try
      : simulation_(simulation_options(options)), port_(simulation_.top(), width) {
    simulation_->s_pair_valid = 0;
    simulation_->m_result_ready = 1;
    port_.put({});
    simulation_.reset();
  } catch (const sim::SimulationError& error) {
    throw std::runtime_error(error.what());
  }

  const char* name() const override { return "rtl"; }
  int coord_w() const override { return width; }
  EngineStatistics statistics() const override { return statistics_; }

  std::vector<EngineAnswer> run(const std::vector<GridPair>& pairs, PairMode mode) override {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      check(pairs[i].a, i);
      check(pairs[i].b, i);
    }
    try {
      return stream(pairs, mode);
    } catch (const sim::SimulationError& error) {
      throw std::runtime_error("engine rtl: " + std::string(error.what()) + "; this is a defect, please report it");
    }
  }

 private:
  std::vector<EngineAnswer> stream(const std::vector<GridPair>& pairs, PairMode mode) {
    std::vector<EngineAnswer> answers(pairs.size());
    std::size_t accepted = 0;
    std::size_t answered = 0;
    std::uint64_t progress = simulation_.clock();
    offer(pairs, accepted, mode);
    while (answered < pairs.size()) {
      simulation_.settle();
      count_clock();
      const std::uint64_t clock = simulation_.clock();
      if (simulation_->m_result_valid != 0) {
        take(answers, accepted, clock);
        ++answered;
        progress = clock;
      }
      const bool accept = simulation_->s_pair_valid != 0 && simulation_->s_pair_ready != 0;
      if (accept) {
        answers[accepted].hardware = HardwareAnswer{};
        answers[accepted].hardware->clock_in = clock;
        ++accepted;
        progress = clock;
      }
      simulation_.rise();
      if (accept) offer(pairs, accepted, mode);
      if (clock - progress > answer_bound) {
        throw sim::SimulationTimeout("no pair accepted and no result for " + std::to_string(answer_bound) +
                                     " clocks, clock " + std::to_string(clock) + ", " + std::to_string(accepted) +
                                     " of " + std::to_string(pairs.size()) + " pairs accepted, " +
                                     std::to_string(answered) + " answered");
      }
    }
    return answers;
  }

  /// The tag is the index modulo 2^16; at most `contexts` pairs are inside, so it is unique there.
  void offer(const std::vector<GridPair>& pairs, std::size_t index, PairMode mode) {
    simulation_->s_pair_valid = index < pairs.size() ? 1 : 0;
    if (index < pairs.size()) {
      port_.put({sent(pairs[index]), static_cast<std::uint16_t>(index % tags), static_cast<std::uint8_t>(mode)});
    }
  }

  void take(std::vector<EngineAnswer>& answers, std::size_t accepted, std::uint64_t clock) {
    const sim::PairResultBeat beat = port_.result();
    const std::size_t age = (accepted + tags - 1 - beat.tag) % tags;  // 0: the pair accepted last
    if (age >= accepted || answers[accepted - 1 - age].hardware->clock_out != 0) {
      throw sim::ScoreboardError("clock " + std::to_string(clock) + ": result with tag " + std::to_string(beat.tag) +
                                 " that no pair in flight has");
    }
    EngineAnswer& answer = answers[accepted - 1 - age];
    answer.grid = beat.grid;
    answer.definite = beat.definite;
    answer.hardware =
        HardwareAnswer{beat.hit, beat.grid, beat.definite, beat.axis, beat.beats, answer.hardware->clock_in, clock};
  }

  void count_clock() {
    const auto* signals = simulation_->rootp;
    ++statistics_.clocks;
    statistics_.beats += signals->cchip_primtest_tri_tri__DOT__u_primtest__DOT__u_controller__DOT__beat_valid_q;
    statistics_.waiting_clocks += signals->cchip_primtest_tri_tri__DOT__u_primtest__DOT__u_controller__DOT__pair_waits;
  }

  sim::Simulation<Model> simulation_;
  sim::PairPort<Model> port_;
  EngineStatistics statistics_;
};

}  // namespace

std::unique_ptr<PairEngine> make_rtl_engine(const RtlEngineOptions& options) {
  return std::make_unique<RtlEngine>(options);
}

}  // namespace cchip
