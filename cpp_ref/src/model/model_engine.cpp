// SPDX-License-Identifier: Apache-2.0
#include <cchip/model/primtest.hpp>
#include <stdexcept>

namespace cchip {
namespace {

/// The clock-exact model behind the engine interface: a pair offered on every clock, results always
/// accepted, as the RTL engine does.
class ModelEngine : public PairEngine {
 public:
  explicit ModelEngine(int coord_w) : machine_(parameters(coord_w)) { machine_.reset(); }
  const char* name() const override { return "model"; }
  int coord_w() const override { return machine_.parameters().coord_w; }
  EngineStatistics statistics() const override { return statistics_; }

  std::vector<EngineAnswer> run(const std::vector<GridPair>& pairs, PairMode mode) override {
    std::vector<EngineAnswer> answers(pairs.size());
    std::vector<std::uint64_t> clock_in(pairs.size());
    std::vector<std::size_t> index_of_tag(std::size_t{1} << defs::tag_w);
    const auto& p = machine_.parameters();
    std::uint64_t limit = statistics_.clocks + static_cast<std::uint64_t>(defs::drain_bound(p.substages, p.contexts));
    for (std::size_t sent = 0, received = 0; received < pairs.size();) {
      if (statistics_.clocks > limit) throw std::runtime_error("model engine: no answer within the drain bound");
      std::optional<model::Primtest::PairIn> in;
      if (sent < pairs.size()) {
        const GridPair& pair = pairs[sent];
        if (pair.a.kind != Kind::tri || pair.b.kind != Kind::tri) {
          throw std::invalid_argument("model engine: quads are not answered by the triangle-triangle module; triangulate them");
        }
        in = {{static_cast<std::uint16_t>(sent & 0xffff), static_cast<int>(mode), pair.eta}, pair.a, pair.b};
      }
      if (in && machine_.s_pair_ready()) {
        index_of_tag[in->header.tag] = sent;
        clock_in[sent++] = statistics_.clocks;
      }
      if (machine_.m_result_valid()) {
        const model::Result& r = machine_.m_result();
        const std::size_t index = index_of_tag[r.tag];  // unique: at most CONTEXTS pairs are in flight
        EngineAnswer& answer = answers.at(index);
        answer.grid = r.grid;
        answer.definite = r.definite;
        answer.hardware = HardwareAnswer{r.hit, r.grid, r.definite, r.axis, r.beats, clock_in[index], statistics_.clocks};
        ++received;
        limit = statistics_.clocks + static_cast<std::uint64_t>(defs::drain_bound(p.substages, p.contexts));
      }
      statistics_.beats += machine_.beat_valid();
      statistics_.waiting_clocks += machine_.pair_waits();
      machine_.clock(in, true);
      ++statistics_.clocks;
    }
    return answers;
  }

 private:
  static model::Primtest::Parameters parameters(int coord_w) {
    model::Primtest::Parameters p;
    p.coord_w = coord_w;
    return p;
  }
  model::Primtest machine_;
  EngineStatistics statistics_;
};

}  // namespace

std::unique_ptr<PairEngine> make_model_engine(int coord_w) { return std::make_unique<ModelEngine>(coord_w); }

}  // namespace cchip
