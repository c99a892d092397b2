// SPDX-License-Identifier: Apache-2.0
/// \file
/// The primitive tests on their ports, for any shape and parameters: what the tests of the three modules
/// share. The checks are in test_cchip_primtest.cpp.
#ifndef CCHIP_TESTS_UNIT_PRIMTEST_BENCH_HPP
#define CCHIP_TESTS_UNIT_PRIMTEST_BENCH_HPP

#include <cchip/internal/model/primtest.hpp>
#include <cchip/machines/probes.hpp>
#include <functional>
#include <memory>

#include "bench.hpp"

namespace cchip::test {

/// A Verilated primitive test under its clock, hidden behind one interface: the checks are compiled once.
class PrimtestPins {
 public:
  struct Outputs {
    bool pair_ready = false;
    bool result_valid = false;
    bool idle = false;
    int rm_id = 0;
    PairResult result;
    friend bool operator==(const Outputs& x, const Outputs& y) {
      return x.pair_ready == y.pair_ready && x.result_valid == y.result_valid && x.idle == y.idle &&
             x.rm_id == y.rm_id && x.result == y.result;
    }
  };
  virtual ~PrimtestPins() = default;
  virtual void add(sim::Agent& agent) = 0;
  virtual void step() = 0;
  virtual void reset(int clocks) = 0;
  /// Evaluates the model, so that outputs follow changed inputs if they do.
  virtual void eval() = 0;
  virtual Outputs outputs() const = 0;
  virtual CData& rst() = 0;
  virtual CData& s_pair_valid() = 0;
  virtual const CData& s_pair_ready() const = 0;
  virtual const CData& m_result_valid() const = 0;
  virtual CData& m_result_ready() = 0;
  /// Payload of s_pair.
  virtual void put(const PairRequest& request) = 0;
  virtual void scramble(Random& random) = 0;
  virtual PairRequest request() const = 0;
  /// Signals of the controller: an axis leaves / a pair waits for a slot.
  virtual bool beat_leaves() const = 0;
  virtual bool pair_waits() const = 0;
};

struct PrimtestConfig {
  int coord_w;
  int substages;
  int contexts;
  Kind kind_a;
  Kind kind_b;
  bool warped_exact;
  ModuleId id;
  std::function<std::unique_ptr<PrimtestPins>(const sim::SimulationOptions&)> simulate;

  model::Options options() const {
    return {{static_cast<std::size_t>(kind_a), static_cast<std::size_t>(kind_b)}, warped_exact};
  }
  int exhaustive_beats() const { return defs::exhaustive_beats(static_cast<int>(kind_a), static_cast<int>(kind_b)); }
};

/// Signals of the controller in a configuration: specialise with CCHIP_WATCH to make them visible.
template <class Config>
struct Watch {
  static bool beat(const typename Config::Model&) { throw std::logic_error("Watch: use CCHIP_WATCH"); }
  static bool waits(const typename Config::Model&) { throw std::logic_error("Watch: use CCHIP_WATCH"); }
};
#define CCHIP_WATCH(name)                                                          \
  template <>                                                                      \
  struct cchip::test::Watch<cchip::test::name> {                                   \
    static bool beat(const V##name& top) { return probes::beat_valid(top) != 0; }  \
    static bool waits(const V##name& top) { return probes::pair_waits(top) != 0; } \
  }

template <class Config>
class PrimtestPinsOf : public PrimtestPins {
 public:
  PrimtestPinsOf(const sim::SimulationOptions& options, Kind kind_a, Kind kind_b)
      : simulation_(options), port_(simulation_.top(), Config::COORD_W), kind_a_(kind_a), kind_b_(kind_b) {}

  void add(sim::Agent& agent) override { simulation_.add(agent); }
  void step() override { simulation_.step(); }
  void reset(int clocks) override { simulation_.reset(clocks); }
  void eval() override { top().eval(); }
  Outputs outputs() const override {
    return {top().s_pair_ready != 0, top().m_result_valid != 0, top().idle != 0, top().rm_id, port_.result()};
  }
  CData& rst() override { return top().rst; }
  CData& s_pair_valid() override { return top().s_pair_valid; }
  const CData& s_pair_ready() const override { return top().s_pair_ready; }
  const CData& m_result_valid() const override { return top().m_result_valid; }
  CData& m_result_ready() override { return top().m_result_ready; }
  void put(const PairRequest& request) override { port_.put(request); }
  void scramble(Random& random) override { port_.scramble(random); }
  PairRequest request() const override { return port_.request(kind_a_, kind_b_); }
  bool beat_leaves() const override { return Watch<Config>::beat(top()); }
  bool pair_waits() const override { return Watch<Config>::waits(top()); }

 private:
  using Model = typename Config::Model;
  Model& top() const { return simulation_.top(); }

  mutable sim::Simulation<Model> simulation_;
  sim::PairPort<Model> port_;
  Kind kind_a_;
  Kind kind_b_;
};

template <class Config>
PrimtestConfig primtest_config(ModuleId id) {
  const Kind a = kinds_of(id)[0];
  const Kind b = kinds_of(id)[1];
  return {Config::COORD_W,
          Config::SUBSTAGES,
          Config::CONTEXTS,
          a,
          b,
          Config::WARPED_EXACT != 0,
          id,
          [a, b](const sim::SimulationOptions& options) {
            return std::make_unique<PrimtestPinsOf<Config>>(options, a, b);
          }};
}

/// Outputs of an empty module, for any inputs, before and after a rising edge.
template <class Config>
void require_never_answers() {
  for_two_power_ups<typename Config::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    sim::PairPort<typename Config::Model> port(top, Config::COORD_W);
    for (int clock = 0; clock < 500; ++clock) {
      port.scramble(random);
      top.rst = random() & 1;
      top.s_pair_valid = random() & 1;
      top.m_result_ready = random() & 1;
      simulation.settle();
      for (int phase = 0; phase < 2; ++phase) {
        REQUIRE(top.s_pair_ready == 0);
        REQUIRE(top.m_result_valid == 0);
        REQUIRE(top.idle == 1);
        REQUIRE(int{top.rm_id} == static_cast<int>(ModuleId::blank));
        REQUIRE(port.result() == PairResult{});
        if (phase == 0) simulation.rise();
      }
    }
  });
}

/// Answers to these pairs in their order, on a module that is kept full. Every answer is compared with the exact
/// oracle, every "no" with the intervals on its witness.
std::vector<PairResult> exact_answers(const PrimtestConfig& config, const std::vector<GridPair>& pairs, PairMode mode);

/// Every output on every clock against the model, for all pairs of idle and back-pressure patterns, with resets.
void check_every_clock(const PrimtestConfig& config);
void check_long_traffic(const PrimtestConfig& config);
/// Coordinates at the ends of the grid: answers are exact, witnesses separate.
void check_extreme_coordinates(const PrimtestConfig& config);
/// For each axis of the EXHAUSTIVE programme pairs that it alone separates.
void check_only_witness(const PrimtestConfig& config);
void check_lone_pair_latency(const PrimtestConfig& config);
void check_drain(const PrimtestConfig& config);
void check_registered_outputs(const PrimtestConfig& config);
void check_no_old_tags(const PrimtestConfig& config);
/// Axes must be accepted on at least 99 % of the clocks on which a pair waits, at the port or inside.
void check_throughput(const PrimtestConfig& config);

}  // namespace cchip::test

/// A test case for each of these checks, for every configuration of cchip_primtest_<kind>.
#define CCHIP_PRIMTEST_CASE(kind, name, check)                                                   \
  TEMPLATE_LIST_TEST_CASE("cchip_primtest_" #kind ": " name, "[unit][cchip_primtest_" #kind "]", \
                          cchip_primtest_##kind##_configs) {                                     \
    check(primtest_config<TestType>(ModuleId::kind));                                            \
  }
#define CCHIP_PRIMTEST_CASES(kind)                                                                              \
  CCHIP_PRIMTEST_CASE(kind, "every output on every clock is the model's", check_every_clock)                    \
  CCHIP_PRIMTEST_CASE(kind, "long traffic", check_long_traffic)                                                 \
  CCHIP_PRIMTEST_CASE(kind, "extreme coordinates", check_extreme_coordinates)                                   \
  CCHIP_PRIMTEST_CASE(kind, "each axis is the witness of the pair that it alone separates", check_only_witness) \
  CCHIP_PRIMTEST_CASE(kind, "latency of a lone pair", check_lone_pair_latency)                                  \
  CCHIP_PRIMTEST_CASE(kind, "drains within its bound, keeps all results without ready", check_drain)            \
  CCHIP_PRIMTEST_CASE(kind, "no output follows an input before the rising edge", check_registered_outputs)      \
  CCHIP_PRIMTEST_CASE(kind, "no old tag after reset, whenever it comes", check_no_old_tags)

#endif
