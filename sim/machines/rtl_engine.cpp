// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_primtest_quad_quad.h>
#include <Vcchip_primtest_quad_quad___024root.h>
#include <Vcchip_primtest_tri_quad.h>
#include <Vcchip_primtest_tri_quad___024root.h>
#include <Vcchip_primtest_tri_tri.h>
#include <Vcchip_primtest_tri_tri___024root.h>

#include <cchip/machines/pair_port.hpp>
#include <cchip/machines/probes.hpp>
#include <cchip/machines/rtl_engine.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <filesystem>
#include <stdexcept>

namespace cchip {
namespace {

constexpr int width = defs::coord_w_default;
constexpr int contexts = defs::contexts_default(defs::substages_default);

template <class Model>
class RtlMachine : public PrimtestMachine {
 public:
  RtlMachine(ModuleId id, const RtlMachineOptions& options) try
      : simulation_(sim::without_timeout(options.seed, options.trace_path, options.trace_clocks)),
        scramble_(options.scramble),
        random_(options.seed) {
    simulation_->s_pair_valid = 0;
    simulation_->m_result_ready = 1;
    port_.put({});
    simulation_.reset();
    if (simulation_->rm_id != static_cast<unsigned>(id)) {
      throw std::runtime_error("engine rtl: module " + std::string(to_name(id)) + " has rm_id " +
                               std::to_string(simulation_->rm_id) + "; this is a defect, please report it");
    }
  } catch (const sim::SimulationError& error) {
    throw std::runtime_error(error.what());
  }

  void offer(const std::optional<PairRequest>& request) override {
    simulation_->s_pair_valid = request ? 1 : 0;
    if (scramble_) port_.scramble(random_);
    if (!request) return;
    PairRequest sent = *request;
    for (GridPrimitive* p : {&sent.pair.a, &sent.pair.b}) {
      if (scramble_ && p->kind == Kind::tri) p->v[3].setConstant(static_cast<std::int16_t>(random_()));
    }
    port_.put(sent);
  }

  Outputs outputs() override {
    simulation_.settle();
    const Model& top = simulation_.top();
    Outputs out{top.s_pair_ready != 0, std::nullopt, probes::beat_valid(top) != 0, probes::pair_waits(top) != 0};
    if (top.m_result_valid != 0) out.result = port_.result();
    return out;
  }

  void clock() override {
    try {
      simulation_.rise();
    } catch (const sim::SimulationError& error) {
      throw std::runtime_error("engine rtl: clock " + std::to_string(simulation_.clock()) + ": " + error.what() +
                               "; this is a defect, please report it");
    }
  }

 private:
  sim::Simulation<Model> simulation_;
  sim::PairPort<Model> port_{simulation_.top(), width};
  bool scramble_;
  std::mt19937_64 random_;
};

/// Makes the modules and gives each its waveform.
class RtlModules {
 public:
  explicit RtlModules(const RtlEngineOptions& options)
      : next_trace_(options.trace_path), trace_(options.trace_path), machine_{options} {
    machine_.trace_path.clear();
    if (trace_.empty()) return;
    std::error_code ignored;  // writing tells
    std::filesystem::create_directories(std::filesystem::path(trace_).parent_path(), ignored);
    sim::check_writable(trace_);
  }

  std::unique_ptr<PrimtestMachine> make(ModuleId id) {
    RtlMachineOptions options = machine_;
    if (!trace_.empty()) {
      options.trace_path = trace_path(id);
      write_gtkw(options.trace_path, id);
    }
    return make_rtl_machine(id, options);
  }

 private:
  std::string trace_path(ModuleId id) {
    if (!next_trace_.empty()) return std::exchange(next_trace_, {});
    std::filesystem::path path(trace_);
    const std::string extension = path.extension().string();
    path.replace_filename(path.stem().string() + "_" + to_name(id) + extension);
    return path.string();
  }

  std::string next_trace_;
  std::string trace_;
  RtlMachineOptions machine_;
};

}  // namespace

std::unique_ptr<PrimtestMachine> make_rtl_machine(ModuleId id, const RtlMachineOptions& options) {
  switch (id) {
    case ModuleId::tri_tri:
      return std::make_unique<RtlMachine<Vcchip_primtest_tri_tri>>(id, options);
    case ModuleId::tri_quad:
      return std::make_unique<RtlMachine<Vcchip_primtest_tri_quad>>(id, options);
    case ModuleId::quad_quad:
      return std::make_unique<RtlMachine<Vcchip_primtest_quad_quad>>(id, options);
    case ModuleId::blank:
    case ModuleId::point_tri:
      break;
  }
  throw std::invalid_argument(
      "engine rtl: only tri_tri, tri_quad and quad_quad answer pairs of faces; choose one of these");
}

std::unique_ptr<PairEngine> make_rtl_engine(const RtlEngineOptions& options) {
  PrimtestEngineOptions engine;
  engine.name = "rtl";
  engine.coord_w = width;
  engine.answer_bound = static_cast<std::uint64_t>(defs::drain_bound(defs::substages_default, contexts));
  engine.make_machine = [modules = RtlModules(options)](ModuleId id) mutable { return modules.make(id); };
  return make_primtest_engine(std::move(engine));
}

}  // namespace cchip
