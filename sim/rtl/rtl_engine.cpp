// SPDX-License-Identifier: Apache-2.0
#include <Vcchip_primtest_quad_quad.h>
#include <Vcchip_primtest_quad_quad___024root.h>
#include <Vcchip_primtest_tri_quad.h>
#include <Vcchip_primtest_tri_quad___024root.h>
#include <Vcchip_primtest_tri_tri.h>
#include <Vcchip_primtest_tri_tri___024root.h>

#include <cchip/device/primtest_engine.hpp>
#include <cchip/rtl/pair_port.hpp>
#include <cchip/rtl/rtl_engine.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace cchip {
namespace {

constexpr int width = defs::coord_w_default;
constexpr int contexts = defs::contexts_default(defs::substages_default);

// Nets of the controller that statistics are made of.
#define CCHIP_CONTROLLER_NETS(module)                                                       \
  bool beat_valid(const V##module& top) {                                                   \
    return top.rootp->module##__DOT__u_primtest__DOT__u_controller__DOT__beat_valid_q != 0; \
  }                                                                                         \
  bool pair_waits(const V##module& top) {                                                   \
    return top.rootp->module##__DOT__u_primtest__DOT__u_controller__DOT__pair_waits != 0;   \
  }
CCHIP_CONTROLLER_NETS(cchip_primtest_tri_tri)
CCHIP_CONTROLLER_NETS(cchip_primtest_tri_quad)
CCHIP_CONTROLLER_NETS(cchip_primtest_quad_quad)
#undef CCHIP_CONTROLLER_NETS

template <class Model>
class RtlMachine : public PrimtestMachine {
 public:
  RtlMachine(ModuleId id, const sim::SimulationOptions& options) try : simulation_(options) {
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
    if (request) port_.put({request->pair, request->tag, static_cast<std::uint8_t>(request->mode)});
  }

  Outputs outputs() override {
    simulation_.settle();
    const Model& top = simulation_.top();
    Outputs out{top.s_pair_ready != 0, std::nullopt, beat_valid(top), pair_waits(top)};
    if (top.m_result_valid != 0) {
      const PairResult beat = port_.result();
      out.result = beat;
    }
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
};

std::unique_ptr<PrimtestMachine> make_module(ModuleId id, const sim::SimulationOptions& options) {
  switch (id) {
    case ModuleId::tri_tri:
      return std::make_unique<RtlMachine<Vcchip_primtest_tri_tri>>(id, options);
    case ModuleId::tri_quad:
      return std::make_unique<RtlMachine<Vcchip_primtest_tri_quad>>(id, options);
    case ModuleId::quad_quad:
      return std::make_unique<RtlMachine<Vcchip_primtest_quad_quad>>(id, options);
    case ModuleId::blank:
      break;
  }
  throw std::invalid_argument("engine rtl: the blank module answers no pairs");
}

/// Makes the modules and gives each its waveform.
class RtlModules {
 public:
  explicit RtlModules(const RtlEngineOptions& options) : next_trace_(options.trace_path), trace_(options.trace_path) {
    simulation_.seed = options.seed;
    simulation_.trace_clocks = options.trace_clocks;
    simulation_.timeout_clocks = 0;
    if (trace_.empty()) return;
    std::error_code ignored;  // writing tells
    std::filesystem::create_directories(std::filesystem::path(trace_).parent_path(), ignored);
    if (!std::ofstream(trace_, std::ios::app)) {
      throw std::runtime_error(trace_ + ": the waveform cannot be written; check folder and permissions");
    }
  }

  std::unique_ptr<PrimtestMachine> make(ModuleId id) {
    sim::SimulationOptions options = simulation_;
    if (!trace_.empty()) {
      options.trace_path = trace_path(id);
      write_gtkw(options.trace_path, id);
    }
    return make_module(id, options);
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
  sim::SimulationOptions simulation_;
};

}  // namespace

std::unique_ptr<PairEngine> make_rtl_engine(const RtlEngineOptions& options) {
  PrimtestEngineOptions engine;
  engine.name = "rtl";
  engine.coord_w = width;
  engine.answer_bound = static_cast<std::uint64_t>(defs::drain_bound(defs::substages_default, contexts));
  engine.make_machine = [modules = RtlModules(options)](ModuleId id) mutable { return modules.make(id); };
  return make_primtest_engine(std::move(engine));
}

}  // namespace cchip
