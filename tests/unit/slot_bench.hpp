// SPDX-License-Identifier: Apache-2.0
/// \file
/// A slot under its clock, with a hand-driven controller: every step of a swap is a function, so that a test can leave
/// one out.
#ifndef CCHIP_TESTS_UNIT_SLOT_BENCH_HPP
#define CCHIP_TESTS_UNIT_SLOT_BENCH_HPP

#include <cchip/exact/oracle.hpp>
#include <cchip/model/programme.hpp>
#include <cchip/sim/scoreboard.hpp>
#include <cchip/stimulus/pair_source.hpp>

#include "reconfig_tools.hpp"

namespace cchip::test {

/// Pairs for one of the modules, every class, both programmes, tags that do not repeat.
class SlotRequests {
 public:
  SlotRequests(int coord_w, std::uint64_t seed) : coord_w_(coord_w), random_(seed) {
    for (const ModuleId id : {ModuleId::tri_tri, ModuleId::tri_quad, ModuleId::quad_quad}) {
      sources_.emplace_back(coord_w, seed + static_cast<std::uint64_t>(id), kinds_of(id)[0], kinds_of(id)[1]);
    }
  }

  PairRequest draw(ModuleId id) {
    stimulus::PairSource& source = sources_.at(static_cast<std::size_t>(id) - 1);
    const auto classes = stimulus::classes_of(kinds_of(id)[0], kinds_of(id)[1]);
    PairRequest request;
    request.pair = source.draw(classes.at(source.draw_class()).value);
    request.mode = static_cast<PairMode>(random_() & 1);
    request.tag = tag_++;
    return request;
  }
  /// The answer of the functional model, which the exact oracle confirms.
  PairResult answer(const PairRequest& request) const {
    const auto vertices = [](Kind kind) { return static_cast<std::size_t>(kind); };
    const model::Options options{{vertices(request.pair.a.kind), vertices(request.pair.b.kind)}, true};
    const model::Outcome o = model::run_programme(options, request.pair, request.mode, coord_w_);
    sim::require(o.grid == exact_intersects(request.pair),
                 "the model contradicts the oracle, tag " + std::to_string(request.tag));
    return {request.tag, o.hit(), o.grid, o.definite, o.witness, o.beats};
  }

 private:
  int coord_w_;
  Random random_;
  std::vector<stimulus::PairSource> sources_;
  std::uint16_t tag_ = 1;
};

template <class Config>
class SlotBench : public sim::Agent {
 public:
  using Model = typename Config::Model;
  static constexpr int port_bytes = Config::CFG_W / 8;

  explicit SlotBench(const sim::SimulationOptions& options, sim::Pattern source = sim::Pattern::always(),
                     sim::Pattern back_pressure = sim::Pattern::always())
      : random(options.seed),
        simulation(options),
        top(simulation.top()),
        requests(Config::COORD_W, options.seed),
        port_(top, Config::COORD_W),
        driver(port_.driver(std::move(source))),
        sink(port_.sink(std::move(back_pressure))) {
    top.stop = top.decouple = top.hold_reset = top.roc_start = top.cfg_valid = 0;
    driver.when_idle([this] { port_.scramble(random); });
    driver.on_accept([this](const PairRequest& request, std::uint64_t clock) {
      scoreboard.expect(request.tag, requests.answer(request), clock);
      ++accepted;
    });
    sink.on_item([this](const PairResult& beat, std::uint64_t clock) {
      ++returned;
      if (on_result) return on_result(beat);
      scoreboard.got(beat.tag, beat, clock);
    });
    simulation.add(driver);
    simulation.add(sink);
    simulation.add(*this);
  }

  /// Rules for every clock, whatever the region does.
  void sample(const sim::ClockInfo& now) override {
    if (now.in_reset) return;
    if (top.decoupled != 0) {
      ++decoupled_clocks;
      expect("s_pair_ready while decoupled", int{top.s_pair_ready}, 0);
      expect("m_result_valid while decoupled", int{top.m_result_valid}, 0);
      expect("m_result while decoupled", port_.result(), PairResult{});
      expect("rm_id while decoupled", int{top.rm_id}, static_cast<int>(ModuleId::blank));
      expect("idle while decoupled", int{top.idle}, 1);
    }
    if (top.quiet != 0 && !on_result) expect("pairs inside a quiet slot", accepted - returned, std::uint64_t{0});
  }

  void power_up() {
    simulation.reset();
    wait_reset();
  }
  void wait_reset() {
    simulation.run_until([this] { return top.roc_busy == 0; }, 100, "the end of the module's reset");
  }
  void steps(int clocks) { simulation.steps(static_cast<std::uint64_t>(clocks)); }

  /// Sends pairs and waits for the answers.
  void work(ModuleId id, int pairs) {
    for (int i = 0; i < pairs; ++i) driver.push(requests.draw(id));
    simulation.run_until([this] { return driver.waiting() == 0 && scoreboard.open() == 0; },
                         static_cast<std::uint64_t>(pairs) * 20000, "answers");
    scoreboard.finish();
  }

  // ---- the steps of a swap
  void stop() {
    top.stop = 1;
    simulation.run_until([this] { return top.quiet != 0; }, 20000, "quiet");
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
    top.stop = 0;
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

 private:
  sim::PairPort<Model> port_;

 public:
  sim::StreamDriver<PairRequest> driver;
  sim::StreamSink<PairResult> sink;
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
