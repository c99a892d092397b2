// SPDX-License-Identifier: Apache-2.0
/// \file
/// A slot under its clock, with a hand-driven controller: every step of a swap is a function, so that a test can leave
/// one out.
#ifndef CCHIP_TESTS_UNIT_SLOT_BENCH_HPP
#define CCHIP_TESTS_UNIT_SLOT_BENCH_HPP

#include "reconfig_tools.hpp"
#include "vertex_port.hpp"

namespace cchip::test {

template <class Config>
class SlotBench : public sim::Agent {
 public:
  using Model = typename Config::Model;
  static constexpr int port_bytes = Config::CFG_W / 8;

  explicit SlotBench(const sim::SimulationOptions& options, sim::Pattern source = sim::Pattern::always())
      : random(options.seed),
        simulation(options),
        top(simulation.top()),
        requests(Config::COORD_W, options.seed),
        port(top, Config::COORD_W, Config::CONTEXTS, options.seed, std::move(source)) {
    top.decouple = top.hold_reset = top.roc_start = top.cfg_valid = 0;
    port.on_sent = [this](const PairRequest& request) {
      scoreboard.expect(request.tag, requests.answer(request, module_id), simulation.clock());
      ++accepted;
    };
    port.on_result = [this](const PairResult& result, bool known) {
      ++returned;
      if (on_result) return on_result(result);
      sim::require(known, "a result without a request");
      scoreboard.got(result.tag, result, simulation.clock());
    };
    simulation.add(port);
    simulation.add(*this);
  }

  /// Rules for every clock, regardless of the region.
  void sample(const sim::ClockInfo& now) override {
    if (now.in_reset) return;
    if (top.decoupled != 0) {
      ++decoupled_clocks;
      expect("m_result_valid while decoupled", int{top.m_result_valid}, 0);
      expect("m_result while decoupled", sim::get_bits(top.m_result_data, 0, defs::slot_result_w), std::uint64_t{0});
      expect("rm_id while decoupled", int{top.rm_id}, static_cast<int>(ModuleId::blank));
      expect("idle while decoupled", int{top.idle}, 1);
    }
  }

  void power_up() {
    simulation.reset();
    wait_reset();
  }
  void wait_reset() {
    simulation.run_until([this] { return top.roc_busy == 0; }, 100, "the end of the module's reset");
  }
  void steps(int clocks) { simulation.steps(static_cast<std::uint64_t>(clocks)); }

  /// Sends pairs of this kind and waits for the answers.
  void work(ModuleId kind, int pairs) {
    for (int i = 0; i < pairs; ++i) port.push(requests.draw(kind));
    simulation.run_until([this] { return port.waiting() == 0 && scoreboard.open() == 0; },
                         static_cast<std::uint64_t>(pairs) * 20000, "answers");
    scoreboard.finish();
  }

  // ---- the steps of a swap
  void stop() {
    port.stop(true);
    simulation.run_until([this] { return port.inside() == 0; }, 20000, "the results of the pairs inside");
    steps(8);  // one that is being sent
    simulation.run_until([this] { return port.inside() == 0; }, 20000, "the last result");
  }
  void decouple() {
    top.decouple = 1;
    simulation.run_until([this] { return top.decoupled != 0; }, 4, "decoupled");
  }
  void hold_reset() { top.hold_reset = 1; }
  void transfer(const Bytes& bytes) {
    for (std::size_t i = 0; i + port_bytes <= bytes.size(); i += port_bytes) {
      top.cfg_valid = 1;
      sim::set_bits(top.cfg_data, 0, Config::CFG_W, port_bytes == 1 ? bytes[i] : word_at(bytes, i));
      simulation.step();
      top.cfg_valid = 0;
      sim::set_random(top.cfg_data, Config::CFG_W, random);
      if (port_bytes == 1) simulation.step();  // the port's clock is half the system's
      if (during) during();
    }
    simulation.step();
  }
  void reset_on_configuration() {
    top.hold_reset = 0;  // so that the reset on configuration is one of its own
    top.roc_start = 1;
    simulation.step();
    top.roc_start = 0;
    wait_reset();
  }
  void recouple() {
    top.decouple = 0;
    simulation.run_until([this] { return top.decoupled == 0; }, 4, "coupled");
    port.stop(false);
  }

  Bytes payload(ModuleId id) {
    return make_payload(Config::SLOT_ID, static_cast<int>(id), 64 + 4 * (random() % 64), random);
  }
  /// A whole swap, in order.
  void swap(ModuleId id) {
    stop();
    decouple();
    hold_reset();
    transfer(payload(id));
    reset_on_configuration();
    expect("region_rm_id", int{top.region_rm_id}, static_cast<int>(id));
    module_id = id;
    recouple();
  }
  /// Number of different values of the region's number within this many clocks: 1 if something works in the slot.
  std::size_t numbers(int clocks) {
    std::vector<int> seen;
    for (int i = 0; i < clocks; ++i) {
      simulation.step();
      if (std::find(seen.begin(), seen.end(), int{top.region_rm_id}) == seen.end()) seen.push_back(top.region_rm_id);
    }
    return seen.size();
  }

  Random random;
  sim::Simulation<Model> simulation;
  Model& top;
  SlotRequests requests;
  VertexPort<Model> port;
  ModuleId module_id = static_cast<ModuleId>(Config::RM_ID);  ///< that answers
  sim::TagScoreboard<PairResult> scoreboard{"slot"};
  /// Takes the results instead of the scoreboard.
  std::function<void(const PairResult&)> on_result;
  /// Called after every word of a transfer.
  std::function<void()> during;
  std::uint64_t accepted = 0;
  std::uint64_t returned = 0;
  std::uint64_t decoupled_clocks = 0;
};

}  // namespace cchip::test

#endif
