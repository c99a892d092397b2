// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/driver/model_engine.hpp>
#include <cchip/internal/driver/primtest_engine.hpp>
#include <cchip/internal/model/primtest.hpp>

namespace cchip {
namespace {

model::Primtest::Parameters parameters(ModuleId id, int coord_w) {
  model::Primtest::Parameters p;
  p.coord_w = coord_w;
  const auto [a, b] = vertices_of(id);
  p.options.shape = {a, b};
  return p;
}

class ModelMachine : public PrimtestMachine {
 public:
  ModelMachine(ModuleId id, int coord_w) : machine_(parameters(id, coord_w)) { machine_.reset(); }

  void offer(const std::optional<PairRequest>& request) override { request_ = request; }

  Outputs outputs() override {
    Outputs out{machine_.s_pair_ready(), std::nullopt, machine_.beat_valid(), machine_.pair_waits()};
    if (machine_.m_result_valid()) out.result = machine_.m_result();
    return out;
  }

  void clock() override { machine_.clock(request_, true); }

 private:
  model::Primtest machine_;
  std::optional<PairRequest> request_;
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
