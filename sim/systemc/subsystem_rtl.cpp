// SPDX-License-Identifier: Apache-2.0
#include "subsystem_rtl.hpp"

#include <Vlevel4_subsystem.h>

#include <cchip/levels/stimulus.hpp>
#include <cchip/machines/pair_streams.hpp>
#include <cchip/sim/axi_lite.hpp>
#include <cchip/sim/axi_memory.hpp>
#include <cchip/sim/simulation.hpp>
#include <deque>
#include <utility>

namespace cchip::levels {

using Model = Vlevel4_subsystem;

struct SubsystemRtl::Parts {
  explicit Parts(std::uint64_t seed) : simulation(sim::without_timeout(seed)) {
    simulation->cfg_error = 0;
    pairs.ready = false;
    memory.elsewhere = [this](std::uint32_t address, std::uint32_t beats) { bursts.push_back({address, beats}); };
    for (sim::Agent* agent : std::initializer_list<sim::Agent*>{&memory, &registers, &pairs}) simulation.add(*agent);
    simulation.reset();
  }

  sim::Simulation<Model> simulation;
  sim::PairStreams<Model> pairs{simulation.top(), coord_w};
  sim::AxiMemory<Model> memory{simulation.top()};
  std::deque<AxiBurst> bursts;  // the memory itself is behind SystemC
  sim::AxiLiteMaster<Model> registers{simulation.top()};
  enum class Access { none, write, read } access = Access::none;
};

SubsystemRtl::SubsystemRtl(std::uint64_t seed) : parts_(std::make_unique<Parts>(seed)) {}
SubsystemRtl::~SubsystemRtl() = default;

void SubsystemRtl::clock() { parts_->simulation.step(); }

bool SubsystemRtl::wants_pair() const { return !parts_->pairs.offers(); }
void SubsystemRtl::offer(const PairRequest& request, ModuleId test) {
  parts_->pairs.send({request, static_cast<int>(test)});
}
void SubsystemRtl::set_result_ready(bool ready) { parts_->pairs.ready = ready; }
std::optional<PairResult> SubsystemRtl::result() {
  std::deque<KindResult>& results = parts_->pairs.results;
  if (results.empty()) return std::nullopt;
  const PairResult result = results.front().beat;
  results.pop_front();
  return result;
}

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
  if (parts_->bursts.empty()) return std::nullopt;
  const AxiBurst burst = parts_->bursts.front();
  parts_->bursts.pop_front();
  return burst;
}

void SubsystemRtl::give_beat(std::uint32_t data, bool ok, bool last) {
  parts_->memory.answer({0, data, ok ? sim::AxiResponse::okay : sim::AxiResponse::slave_error, last});
}

bool SubsystemRtl::irq() const { return parts_->simulation.top().irq != 0; }

}  // namespace cchip::levels
