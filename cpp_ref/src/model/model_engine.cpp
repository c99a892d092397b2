// SPDX-License-Identifier: Apache-2.0
#include <cchip/model/primtest.hpp>
#include <cchip/primtest_engine.hpp>

namespace cchip {
namespace {

model::Primtest::Parameters parameters(ModuleId id, int coord_w) {
  model::Primtest::Parameters p;
  p.coord_w = coord_w;
  p.options.shape = {id == ModuleId::quad_quad ? 4U : 3U, id == ModuleId::tri_tri ? 3U : 4U};
  return p;
}

class ModelMachine : public PrimtestMachine {
 public:
  ModelMachine(ModuleId id, int coord_w) : machine_(parameters(id, coord_w)) { machine_.reset(); }

  void offer(const std::optional<PrimtestRequest>& request) override {
    pair_.reset();
    if (!request) return;
    const GridPair& pair = request->pair;
    pair_ = {{request->tag, static_cast<int>(request->mode), pair.eta}, pair.a, pair.b};
  }

  Outputs outputs() override {
    Outputs out{machine_.s_pair_ready(), std::nullopt, machine_.beat_valid(), machine_.pair_waits()};
    if (machine_.m_result_valid()) {
      const model::Result& r = machine_.m_result();
      out.result = PrimtestResult{r.tag, r.hit, r.grid, r.definite, r.axis, r.beats};
    }
    return out;
  }

  void clock() override { machine_.clock(pair_, true); }

 private:
  model::Primtest machine_;
  std::optional<model::Primtest::PairIn> pair_;
};

}  // namespace

std::unique_ptr<PairEngine> make_model_engine(int coord_w) {
  const model::Primtest::Parameters p = parameters(ModuleId::tri_tri, coord_w);
  PrimtestEngineOptions options;
  options.name = "model";
  options.coord_w = coord_w;
  options.answer_bound = static_cast<std::uint64_t>(defs::drain_bound(p.substages, p.contexts));
  options.make_machine = [coord_w](ModuleId id) { return std::make_unique<ModelMachine>(id, coord_w); };
  return make_primtest_engine(std::move(options));
}

}  // namespace cchip
