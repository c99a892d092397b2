// SPDX-License-Identifier: Apache-2.0
#include "subsystem_rtl.hpp"

#include <Vlevel4_subsystem.h>

#include <cchip/levels/stimulus.hpp>
#include <cchip/machines/pair_port.hpp>
#include <cchip/sim/axi_lite.hpp>
#include <cchip/sim/axi_memory.hpp>
#include <cchip/sim/simulation.hpp>
#include <deque>
#include <utility>

namespace cchip::levels {
namespace {

using Model = Vlevel4_subsystem;

/// s_pair and m_result.
class Pairs : public sim::Agent {
 public:
  explicit Pairs(Model& model) : model_(model), port_(model, coord_w) {
    model_.s_pair_valid = 0;
    model_.s_pair_kind = 0;
    model_.m_result_ready = 0;
    port_.put({});
  }

  void offer(const PairRequest& request) {
    port_.put(request);
    model_.s_pair_kind = static_cast<CData>(module_of(request.pair));
    offers_ = true;
  }

  void drive(const sim::ClockInfo& now) override { model_.s_pair_valid = offers_ && !now.in_reset ? 1 : 0; }
  void sample(const sim::ClockInfo& now) override {
    result.reset();
    if (now.in_reset) return;
    if (model_.s_pair_ready != 0) offers_ = false;
    if (model_.m_result_valid == 0 || model_.m_result_ready == 0) return;
    result = port_.result();
  }

  bool offers() const { return offers_; }

  std::optional<PairResult> result;

 private:
  Model& model_;
  sim::PairPort<Model> port_;
  bool offers_ = false;
};

/// m_axi_*: collects the bursts, sends the beats that it is given.
class Memory : public sim::Agent {
 public:
  explicit Memory(Model& model) : model_(model) {}

  void drive(const sim::ClockInfo& now) override {
    model_.m_axi_arready = now.in_reset ? 0 : 1;
    model_.m_axi_rvalid = !now.in_reset && !beats.empty() ? 1 : 0;
    if (model_.m_axi_rvalid == 0) return;
    model_.m_axi_rdata = beats.front().data;
    model_.m_axi_rresp = static_cast<CData>(beats.front().response);
    model_.m_axi_rlast = beats.front().last ? 1 : 0;
  }
  void sample(const sim::ClockInfo& now) override {
    if (now.in_reset) return;
    if (model_.m_axi_rvalid != 0 && model_.m_axi_rready != 0) beats.pop_front();
    if (model_.m_axi_arvalid != 0) bursts.push_back({model_.m_axi_araddr, std::uint32_t{model_.m_axi_arlen} + 1});
  }

  std::deque<AxiBurst> bursts;
  std::deque<sim::AxiBeat> beats;

 private:
  Model& model_;
};

}  // namespace

struct SubsystemRtl::Parts {
  explicit Parts(std::uint64_t seed) : simulation(sim::without_timeout(seed)) {
    simulation->cfg_error = 0;
    for (sim::Agent* agent : std::initializer_list<sim::Agent*>{&memory, &registers, &pairs}) simulation.add(*agent);
    simulation.reset();
  }

  sim::Simulation<Model> simulation;
  Pairs pairs{simulation.top()};
  Memory memory{simulation.top()};
  sim::AxiLiteMaster<Model> registers{simulation.top()};
  enum class Access { none, write, read } access = Access::none;
};

SubsystemRtl::SubsystemRtl(std::uint64_t seed) : parts_(std::make_unique<Parts>(seed)) {}
SubsystemRtl::~SubsystemRtl() = default;

void SubsystemRtl::clock() { parts_->simulation.step(); }

bool SubsystemRtl::wants_pair() const { return !parts_->pairs.offers(); }
void SubsystemRtl::offer(const PairRequest& request) { parts_->pairs.offer(request); }
void SubsystemRtl::set_result_ready(bool ready) { parts_->simulation->m_result_ready = ready ? 1 : 0; }
std::optional<PairResult> SubsystemRtl::result() const { return parts_->pairs.result; }

void SubsystemRtl::write_register(std::uint32_t address, std::uint32_t data) {
  parts_->registers.push_write(address, data);
  parts_->access = Parts::Access::write;
}

void SubsystemRtl::read_register(std::uint32_t address) {
  parts_->registers.push_read(address);
  parts_->access = Parts::Access::read;
}

std::optional<RegisterAnswer> SubsystemRtl::register_answer() {
  if (parts_->access == Parts::Access::none || !parts_->registers.done()) return std::nullopt;
  if (std::exchange(parts_->access, Parts::Access::none) == Parts::Access::write) {
    return RegisterAnswer{0, parts_->registers.next_write()};
  }
  const sim::AxiLiteWord word = parts_->registers.next_read();
  return RegisterAnswer{word.data, word.ok};
}

std::optional<AxiBurst> SubsystemRtl::burst() {
  if (parts_->memory.bursts.empty()) return std::nullopt;
  const AxiBurst burst = parts_->memory.bursts.front();
  parts_->memory.bursts.pop_front();
  return burst;
}

void SubsystemRtl::give_beat(std::uint32_t data, bool ok, bool last) {
  parts_->memory.beats.push_back({0, data, ok ? sim::AxiResponse::okay : sim::AxiResponse::slave_error, last});
}

bool SubsystemRtl::irq() const { return parts_->simulation.top().irq != 0; }

}  // namespace cchip::levels
