// SPDX-License-Identifier: Apache-2.0
// The whole module on its ports, in nine configurations: clock by clock against the model, and the rules of
// DESIGN section 4 by counting, without the model.
#include <Vtt_w16_s10_rel___024root.h>
#include <Vtt_w16_s12_abs___024root.h>
#include <Vtt_w16_s8_abs___024root.h>

#include <cchip/model/primtest.hpp>
#include <cchip/sim/scoreboard.hpp>
#include <iostream>
#include <models/cchip_primtest_tri_tri.hpp>

#include "../campaign/pair_source.hpp"
#include "pair_tools.hpp"

using namespace cchip;
using namespace cchip::test;
using sim::PairRequest;
using sim::PairResultBeat;

namespace {

/// Stimulus: pairs of every class, reserved modes, any eta, tags unique among 2^16.
class RequestSource {
 public:
  RequestSource(int coord_w, std::uint64_t seed) : coord_w_(coord_w), pairs_(coord_w, seed), random_(seed) {}

  PairRequest draw() {
    PairRequest request;
    request.pair = pairs_.draw(campaign::pair_classes[pairs_.draw_class()].value);
    if (chance(random_, 10)) {
      request.pair.a = random_triangle(random_, coord_w_);
      request.pair.b = random_triangle(random_, coord_w_);
    }
    for (GridPrimitive* p : {&request.pair.a, &request.pair.b}) p->v[3] = random_point(random_, coord_w_);
    request.pair.eta = chance(random_, 60) ? 0 : static_cast<int>(random_() % 16);
    request.mode = static_cast<std::uint8_t>(chance(random_, 90) ? 0 : random_() % 4);
    request.tag = static_cast<std::uint16_t>(40503U * tag_++);  // odd factor: every tag once in 65536
    return request;
  }

 private:
  int coord_w_;
  campaign::PairSource pairs_;
  Random random_;
  unsigned tag_ = 0;
};

PairResultBeat illegal_answer(std::uint16_t tag) { return {tag, true, true, false, {AxisClass::illegal, 0, 0}, 0}; }

/// The answer by the functional model, without clocks.
PairResultBeat answer(const PairRequest& request, int coord_w) {
  if (request.mode != static_cast<std::uint8_t>(PairMode::exhaustive)) return illegal_answer(request.tag);
  const model::Outcome o = model::exhaustive(request.pair, coord_w);
  PairResultBeat r{request.tag, false, o.grid, false, o.witness, o.beats};
  r.definite = request.pair.eta == 0 && !(o.special && o.grid);
  r.hit = r.grid || !r.definite;
  return r;
}

/// Compares every output on every clock with the clock-exact model; reads all inputs from the pins.
template <class Config>
class ExactMonitor : public sim::Agent {
 public:
  using Model = typename Config::Model;
  explicit ExactMonitor(Model& top) : top_(top), model_({Config::COORD_W, Config::SUBSTAGES, Config::CONTEXTS}) {}

  std::uint64_t clocks_compared() const { return clocks_; }
  std::uint64_t results_compared() const { return results_; }

  void sample(const sim::ClockInfo& now) override {
    if (defined_) compare();
    if (now.in_reset) {
      model_.reset();
      defined_ = true;
      return;
    }
    std::optional<model::PrimtestTriTri::PairIn> pair;
    if (top_.s_pair_valid != 0) {
      pair = {{top_.s_pair_tag, top_.s_pair_mode, top_.s_pair_err}, triangle(top_.s_pair_a), triangle(top_.s_pair_b)};
    }
    model_.clock(pair, top_.m_result_ready != 0);
  }

 private:
  template <class Port>
  GridPrimitive triangle(const Port& port) const {
    GridPrimitive p;
    for (int i = 0; i < 3; ++i) {
      const model::Word3 v = get_word3(port, Config::COORD_W, i);
      p.v[static_cast<std::size_t>(i)] = {static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2])};
    }
    return p;
  }

  void compare() {
    expect("s_pair_ready", top_.s_pair_ready != 0, model_.s_pair_ready());
    expect("idle", top_.idle != 0, model_.idle());
    expect("rm_id", int{top_.rm_id}, static_cast<int>(ModuleId::tri_tri));
    expect("m_result_valid", top_.m_result_valid != 0, model_.m_result_valid());
    ++clocks_;
    if (!model_.m_result_valid()) return;
    const model::Result& r = model_.m_result();
    expect("m_result", sim::PairPort<Model>(top_, Config::COORD_W).result(),
           PairResultBeat{r.tag, r.hit, r.grid, r.definite, r.axis, r.beats});
    ++results_;
  }

  Model& top_;
  model::PrimtestTriTri model_;
  bool defined_ = false;
  std::uint64_t clocks_ = 0;
  std::uint64_t results_ = 0;
};

/// The rules that need no model: answers by value and once per tag, idle and ready from a count of handshakes.
template <class Config>
class RuleMonitor : public sim::Agent {
 public:
  using Model = typename Config::Model;
  RuleMonitor(Model& top, sim::StreamDriver<PairRequest>& driver, sim::StreamSink<PairResultBeat>& sink)
      : top_(top), scoreboard_("m_result") {
    driver.on_accept([this](const PairRequest& request, std::uint64_t clock) {
      scoreboard_.expect(request.tag, answer(request, Config::COORD_W), clock);
      ++accepted_;
    });
    sink.on_item([this](const PairResultBeat& beat, std::uint64_t clock) {
      scoreboard_.got(beat.tag, beat, clock);
      ++returned_;
    });
  }

  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t returned() const { return returned_; }
  std::uint64_t in_flight() const { return accepted_ - returned_; }
  void finish() const { scoreboard_.finish(); }

  /// Runs after driver and sink. idle and ready of this clock follow from the handshakes of the clocks before.
  void sample(const sim::ClockInfo& now) override {
    if (now.in_reset) {
      if (after_reset_) {
        expect("idle in reset", top_.idle != 0, true);
        expect("s_pair_ready in reset", top_.s_pair_ready != 0, false);
        expect("m_result_valid in reset", top_.m_result_valid != 0, false);
      }
      scoreboard_.clear();
      accepted_ = returned_ = before_ = 0;
      after_reset_ = true;
      return;
    }
    expect("idle", top_.idle != 0, before_ == 0);
    if (now.clock > 0)
      expect("s_pair_ready", top_.s_pair_ready != 0, before_ < static_cast<std::uint64_t>(Config::CONTEXTS));
    before_ = in_flight();
    sim::require(before_ <= static_cast<std::uint64_t>(Config::CONTEXTS), "more than CONTEXTS pairs in flight");
    after_reset_ = false;
  }

 private:
  Model& top_;
  sim::TagScoreboard<PairResultBeat> scoreboard_;
  std::uint64_t accepted_ = 0;
  std::uint64_t returned_ = 0;
  std::uint64_t before_ = 0;
  bool after_reset_ = false;
};

/// Everything together: driver, sink, both monitors, garbage on idle inputs.
template <class Config>
class ModuleBench {
 public:
  using Model = typename Config::Model;
  explicit ModuleBench(const sim::SimulationOptions& options, sim::Pattern source = sim::Pattern::always(),
                       sim::Pattern back_pressure = sim::Pattern::always())
      : simulation(options),
        port(simulation.top(), Config::COORD_W),
        driver(port.driver(std::move(source))),
        sink(port.sink(std::move(back_pressure))),
        rules(simulation.top(), driver, sink),
        exact(simulation.top()),
        garbage_(options.seed) {
    driver.when_idle([this] { port.scramble(garbage_); });
    simulation.add(driver);
    simulation.add(sink);
    simulation.add(rules);
    simulation.add(exact);
  }

  /// Sends what is pushed until everything is answered.
  void run() {
    const auto bound = static_cast<std::uint64_t>(defs::drain_bound(Config::SUBSTAGES, Config::CONTEXTS));
    simulation.run_until([this] { return driver.waiting() == 0 && rules.in_flight() == 0; },
                         driver.waiting() * 200 + bound, "all answers");
    rules.finish();
  }

  sim::Simulation<Model> simulation;
  sim::PairPort<Model> port;
  sim::StreamDriver<PairRequest> driver;
  sim::StreamSink<PairResultBeat> sink;
  RuleMonitor<Config> rules;
  ExactMonitor<Config> exact;

 private:
  Random garbage_;
};

/// Answers in the order of the requests, whose tags are overwritten by their index.
template <class Config>
std::vector<PairResultBeat> answers(std::vector<PairRequest> requests, const sim::SimulationOptions& options) {
  ModuleBench<Config> bench(options);
  std::vector<PairResultBeat> result(requests.size());
  sim::StreamMonitor<PairResultBeat> collector(
      "m_result", bench.simulation->m_result_valid, bench.simulation->m_result_ready,
      [&] { return bench.port.result(); }, [&](const PairResultBeat& r, std::uint64_t) { result.at(r.tag) = r; });
  bench.simulation.add(collector);
  bench.simulation.reset();
  for (std::size_t i = 0; i < requests.size(); ++i) {
    requests[i].tag = static_cast<std::uint16_t>(i);
    bench.driver.push(requests[i]);
  }
  bench.run();
  return result;
}

/// Sends pairs with eta = 0 and compares the answers with the exact oracle (special pairs: a no must be right)
/// and the witness of a no with the projections of all vertices. Returns the answers.
template <class Config>
std::vector<PairResultBeat> require_exact(const std::vector<GridPair>& pairs, const sim::SimulationOptions& options) {
  std::vector<PairRequest> requests(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) requests[i].pair = pairs[i];
  const auto result = answers<Config>(requests, options);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const bool hit = exact_intersects(pairs[i]);
    INFO(describe(pairs[i]));
    if (!result[i].grid || !is_special(pairs[i])) REQUIRE(result[i].grid == hit);
    REQUIRE(result[i].definite == (!result[i].grid || !is_special(pairs[i])));
    if (!result[i].grid) REQUIRE(axis_separates(result[i].axis, pairs[i]));
  }
  return result;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_tri: every output on every clock is the model's",
                        "[unit][cchip_primtest_tri_tri]", cchip_primtest_tri_tri_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource requests(TestType::COORD_W, options.seed);
    for (const sim::Pattern& source : sim::standard_patterns(options.seed)) {
      for (const sim::Pattern& back_pressure : sim::standard_patterns(options.seed + 100)) {
        INFO("s_pair " << source.name() << ", m_result " << back_pressure.name());
        ModuleBench<TestType> bench(options, source, back_pressure);
        bench.simulation.reset(1);
        for (int part = 0; part < 2; ++part) {  // ended by a reset in mid traffic
          while (bench.driver.waiting() < 40) bench.driver.push(requests.draw());
          bench.simulation.steps(120);
          bench.simulation.reset(part + 1);
        }
        while (bench.driver.waiting() < 20) bench.driver.push(requests.draw());
        bench.run();
        REQUIRE(bench.rules.returned() >= 20);
        bench.simulation.steps(100);  // nothing comes after the last answer
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_tri: long traffic", "[unit][cchip_primtest_tri_tri]",
                        cchip_primtest_tri_tri_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource requests(TestType::COORD_W, options.seed);
    ModuleBench<TestType> bench(options, sim::Pattern::random(0.2, options.seed),
                                sim::Pattern::random(0.5, options.seed + 1));
    bench.simulation.reset();
    for (int i = 0; i < 1500; ++i) bench.driver.push(requests.draw());
    bench.run();
    REQUIRE(bench.rules.returned() == 1500);
    REQUIRE(bench.exact.results_compared() >= 1500);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_tri: extreme coordinates", "[unit][cchip_primtest_tri_tri]",
                        cchip_primtest_tri_tri_configs) {
  const sim::SimulationOptions options;
  Random random(options.seed);
  std::vector<GridPair> pairs;
  const int most = (1 << (TestType::COORD_W - 1)) - 1;
  for (const auto& values :
       {std::vector<int>{-most - 1, most}, std::vector<int>{-most - 1, -most, 0, most - 1, most}}) {
    for (int i = 0; i < 1000; ++i) {
      GridPair pair;
      for (GridPrimitive* p : {&pair.a, &pair.b}) {
        for (std::size_t v = 0; v < 3; ++v) {
          for (int d = 0; d < 3; ++d) p->v[v][d] = values[random() % values.size()];
        }
      }
      pairs.push_back(pair);
    }
  }
  const auto result = require_exact<TestType>(pairs, options);
  const auto hits = std::count_if(result.begin(), result.end(), [](const PairResultBeat& r) { return r.grid; });
  REQUIRE(hits > 200);
  REQUIRE(hits < 1800);
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_tri: each axis is the witness of the pair that it alone separates",
                        "[unit][cchip_primtest_tri_tri]", cchip_primtest_tri_tri_configs) {
  const sim::SimulationOptions options;
  std::vector<GridPair> pairs;
  for (int beat = 0; beat < defs::exhaustive_beats_tri_tri; ++beat) {
    for (const std::uint64_t n : {0U, 1U, 2U}) {
      pairs.push_back(pair_separated_only_by(model::exhaustive_axis(beat), TestType::COORD_W, options.seed + n));
    }
  }
  const auto result = require_exact<TestType>(pairs, options);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    INFO(describe(pairs[i]));
    REQUIRE_FALSE(result[i].grid);
    REQUIRE(result[i].axis == model::exhaustive_axis(static_cast<int>(i / 3)));
  }
}

namespace {

/// Directed pairs whose answer is known by construction: `gap` < 0 deep, 0 touching, > 0 missed by so many steps.
struct KnownPair {
  GridPair pair;
  int gap;
};

GridPair with_axes(const GridPair& pair, int first, int sign) {
  GridPair result = pair;
  for (auto [from, to] : {std::pair(&pair.a, &result.a), std::pair(&pair.b, &result.b)}) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (int d = 0; d < 3; ++d) to->v[i][(d + first) % 3] = d == 2 ? sign * from->v[i][d] : from->v[i][d];
    }
  }
  return result;
}

/// A in the plane z = 0; B above it, its lowest point at height `gap` over the inside, a side or a corner of A.
std::vector<KnownPair> touching_pairs(int coord_w) {
  const int r = (1 << (coord_w - 1)) - 4;  // nearly the whole grid
  const auto tri = [](const Vec3i& p, const Vec3i& q, const Vec3i& s) {
    GridPrimitive t;
    t.v = {p, q, s, Vec3i::Zero()};
    return t;
  };
  std::vector<KnownPair> list;
  for (const int gap : {-2, -1, 0, 1, 2}) {
    const GridPrimitive floor = tri({-r, -r, 0}, {r, -r, 0}, {0, r, 0});
    const int top = r / 2 + gap;
    const std::vector<GridPair> shapes = {
        {floor, tri({0, 0, gap}, {r, r / 3, top}, {-r / 2, r, top}), 0},  // vertex over the face
        {floor, tri({0, -r, gap}, {1, -r, top}, {r, -r + 2, top}), 0},    // vertex over a side
        {floor, tri({0, r, gap}, {2, r - 1, top}, {-3, r, top}), 0},      // vertex over a corner
        {floor, tri({-r, 0, gap}, {r, 0, gap}, {0, 1, top}), 0},          // edge across the face
        {tri({-r, 0, 0}, {r, 0, 0}, {0, 1, -r}), tri({0, -r, gap}, {0, r, gap}, {1, 0, top}), 0},       // edge on edge
        {tri({-r, -1, 0}, {r, 1, 0}, {0, 0, -r}), tri({-1, -r, gap}, {1, r, gap}, {0, 0, top}), 0},     // oblique edges
        {tri({0, 0, 0}, {r, 1, -r}, {-r, 2, -r + 1}), tri({0, 0, gap}, {r, 1, top}, {-1, r, top}), 0},  // tip on tip
        {tri({0, 0, 0}, {0, 0, -r}, {r, 0, -r}), tri({0, -r, gap}, {0, r, gap}, {0, 0, top}), 0},  // corner under edge
    };
    for (const GridPair& shape : shapes) {
      for (int first = 0; first < 3; ++first) {
        for (const int sign : {1, -1}) {
          const GridPair pair = with_axes(shape, first, sign);
          list.push_back({pair, gap});
          list.push_back({{pair.b, pair.a, 0}, gap});
        }
      }
    }
  }
  return list;
}

/// A tilted: B's vertex on a grid point of A's plane, and one step to every side.
std::vector<GridPair> tilted_touching_pairs(int coord_w, Random& random) {
  const int r = (1 << (coord_w - 1)) / 8;
  std::uniform_int_distribution<int> c(-r, r);
  const auto point = [&] { return Vec3i(c(random), c(random), c(random)); };
  std::vector<GridPair> list;
  for (int i = 0; i < 40; ++i) {
    const Vec3i u = point();
    const Vec3i v = point();
    GridPair pair;
    pair.a.v = {Vec3i(-u - v), Vec3i(2 * u - v), Vec3i(2 * v - u), Vec3i::Zero()};  // the origin is inside
    const std::array<Vec3i, 4> targets = {Vec3i(0, 0, 0), u, Vec3i(-v), Vec3i(-u - v)};
    for (const Vec3i& target : targets) {
      const Vec3i second = point();
      const Vec3i third = point();
      for (int step = 0; step < 7; ++step) {
        Vec3i move = Vec3i::Zero();
        if (step > 0) move[(step - 1) / 2] = step % 2 == 0 ? 1 : -1;
        pair.b.v = {Vec3i(target + move), Vec3i(target + move + second), Vec3i(target + move + third), Vec3i::Zero()};
        list.push_back(pair);
      }
    }
  }
  return list;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_tri: touching and just missing by one step",
                        "[unit][cchip_primtest_tri_tri]", cchip_primtest_tri_tri_configs) {
  const sim::SimulationOptions options;
  std::vector<GridPair> pairs;
  const auto known = touching_pairs(TestType::COORD_W);
  for (const KnownPair& k : known) pairs.push_back(k.pair);
  const auto result = require_exact<TestType>(pairs, options);
  for (std::size_t i = 0; i < known.size(); ++i) {
    INFO(describe(known[i].pair) << ", gap " << known[i].gap);
    REQUIRE_FALSE(is_special(known[i].pair));
    REQUIRE((result[i].grid || known[i].gap > 0));
    REQUIRE((!result[i].grid || known[i].gap <= 0));
  }
  Random random(options.seed);
  require_exact<TestType>(tilted_touching_pairs(TestType::COORD_W, random), options);
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_tri: latency of a lone pair does not depend on its data",
                        "[unit][cchip_primtest_tri_tri]", cchip_primtest_tri_tri_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource requests(TestType::COORD_W, options.seed);
    ModuleBench<TestType> bench(options);
    bench.simulation.reset();
    bench.simulation.step();
    for (int i = 0; i < 100; ++i) {
      const PairRequest request = requests.draw();
      const int beats = request.mode == 0 ? defs::exhaustive_beats_tri_tri : 1;
      bench.driver.push(request);
      bench.simulation.step();  // accepted on this clock
      REQUIRE(bench.rules.in_flight() == 1);
      int clocks = 0;
      while (bench.rules.in_flight() == 1 && clocks < 1000) {
        bench.simulation.step();
        ++clocks;
      }
      REQUIRE(clocks == defs::pair_latency(TestType::SUBSTAGES, beats));
      bench.simulation.steps(static_cast<std::uint64_t>(i) % 3);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_tri: drains within its bound, keeps all results without ready",
                        "[unit][cchip_primtest_tri_tri]", cchip_primtest_tri_tri_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    constexpr std::uint64_t contexts = TestType::CONTEXTS;
    constexpr auto bound = static_cast<std::uint64_t>(defs::drain_bound(TestType::SUBSTAGES, TestType::CONTEXTS));
    RequestSource requests(TestType::COORD_W, options.seed);
    ModuleBench<TestType> bench(options, sim::Pattern::always(), sim::Pattern::never_for(3000));
    bench.simulation.reset();
    for (std::uint64_t i = 0; i < contexts + 10; ++i) bench.driver.push(requests.draw());
    bench.simulation.steps(2900);  // far more than all of them need
    REQUIRE(bench.rules.accepted() == contexts);
    REQUIRE(bench.rules.returned() == 0);
    REQUIRE(bench.simulation->idle == 0);
    // every verdict is there: one result per clock
    bench.sink.set_pattern(sim::Pattern::always());
    bench.simulation.steps(contexts);
    REQUIRE(bench.rules.returned() >= contexts);
    bench.run();
    // full module, ready = 1: from the last handshake of s_pair to idle
    for (std::uint64_t i = 0; i < 3 * contexts; ++i) bench.driver.push(requests.draw());
    bench.simulation.run_until([&] { return bench.driver.waiting() == 0; }, 100000, "all pairs accepted");
    std::uint64_t clocks = 0;
    while (bench.simulation->idle == 0 && clocks <= bound) {
      bench.simulation.step();
      ++clocks;
    }
    REQUIRE(clocks > 11);
    REQUIRE(clocks <= bound);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_tri: no output follows an input before the rising edge",
                        "[unit][cchip_primtest_tri_tri]", cchip_primtest_tri_tri_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource requests(TestType::COORD_W, options.seed);
    Random random(options.seed);
    ModuleBench<TestType> bench(options, sim::Pattern::random(0.3, options.seed),
                                sim::Pattern::random(0.3, options.seed));
    Model& top = bench.simulation.top();
    struct Outputs {
      bool ready, valid, idle;
      int id;
      PairResultBeat result;
      bool operator==(const Outputs& x) const {
        return ready == x.ready && valid == x.valid && idle == x.idle && id == x.id && result == x.result;
      }
    };
    const auto outputs = [&] {
      return Outputs{top.s_pair_ready != 0, top.m_result_valid != 0, top.idle != 0, top.rm_id, bench.port.result()};
    };
    int seen_valid = 0;
    // after driver and sink have set the inputs of a clock: other inputs, then theirs again
    Bench toggler([](const sim::ClockInfo&) {},
                  [&](const sim::ClockInfo& now) {
                    if (now.in_reset) return;
                    const Outputs before = outputs();
                    const CData valid = top.s_pair_valid;
                    const CData ready = top.m_result_ready;
                    const auto a = top.s_pair_a;
                    const auto b = top.s_pair_b;
                    const SData tag = top.s_pair_tag;
                    const CData mode = top.s_pair_mode;
                    const CData err = top.s_pair_err;
                    for (int i = 0; i < 4; ++i) {
                      top.s_pair_valid = i & 1;
                      top.m_result_ready = i >> 1 & 1;
                      top.rst = random() & 1;
                      bench.port.scramble(random);
                      top.eval();
                      sim::require(outputs() == before, "an output follows an input without a clock edge");
                    }
                    top.s_pair_valid = valid;
                    top.m_result_ready = ready;
                    top.rst = 0;
                    top.s_pair_a = a;
                    top.s_pair_b = b;
                    top.s_pair_tag = tag;
                    top.s_pair_mode = mode;
                    top.s_pair_err = err;
                    top.eval();
                    seen_valid += before.valid ? 1 : 0;
                  });
    bench.simulation.add(toggler);
    bench.simulation.reset();
    for (int i = 0; i < 60; ++i) bench.driver.push(requests.draw());
    bench.run();
    REQUIRE(seen_valid >= 60);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_tri_tri: no old tag after reset, whenever it comes",
                        "[unit][cchip_primtest_tri_tri]", cchip_primtest_tri_tri_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource requests(TestType::COORD_W, options.seed);
    ModuleBench<TestType> bench(options);
    // a sender that is not in reset itself: what it offers on these clocks is not accepted
    Bench careless(
        [&](const sim::ClockInfo& now) {
          if (now.in_reset) bench.simulation->s_pair_valid = 1;
        },
        [](const sim::ClockInfo&) {});
    bench.simulation.add(careless);
    bench.simulation.reset();
    for (std::uint64_t moment = 1; moment < 90; ++moment) {  // a pair or several at every place of the machine
      for (int i = 0; i < 8; ++i) bench.driver.push(requests.draw());
      bench.simulation.steps(moment);
      bench.driver.clear();
      bench.simulation.reset(1);  // the scoreboard forgets: any result from before is an error
      bench.simulation.steps(moment % 2 == 0 ? 120 : 0);
      bench.driver.push(requests.draw());
      bench.run();
      REQUIRE(bench.rules.returned() == 1);
    }
  });
}

// ---- throughput

namespace {

template <class Config>
struct Signals;
#define CCHIP_SIGNALS(name)                                                                \
  template <>                                                                              \
  struct Signals<name> {                                                                   \
    static bool beat(const V##name& top) {                                                 \
      return top.rootp->cchip_primtest_tri_tri__DOT__u_controller__DOT__beat_valid_q != 0; \
    }                                                                                      \
    static bool waits(const V##name& top) {                                                \
      return top.rootp->cchip_primtest_tri_tri__DOT__u_controller__DOT__pair_waits != 0;   \
    }                                                                                      \
  }
CCHIP_SIGNALS(tt_w16_s8_abs);
CCHIP_SIGNALS(tt_w16_s10_rel);
CCHIP_SIGNALS(tt_w16_s12_abs);
#undef CCHIP_SIGNALS

}  // namespace

TEMPLATE_TEST_CASE("cchip_primtest_tri_tri: an axis on 99 % of the clocks while pairs wait",
                   "[unit][cchip_primtest_tri_tri]", tt_w16_s8_abs, tt_w16_s10_rel, tt_w16_s12_abs) {
  static_assert(TestType::CONTEXTS == defs::contexts_default(TestType::SUBSTAGES), "default CONTEXTS");
  const sim::SimulationOptions options;
  sim::with_wave_on_failure(
      test_name(),
      [](const sim::SimulationOptions& o) {
        RequestSource requests(TestType::COORD_W, o.seed);
        ModuleBench<TestType> bench(o);
        constexpr std::uint64_t pairs = 3000;
        std::uint64_t beats = 0;
        std::uint64_t waiting = 0;
        std::uint64_t first_accept = 0;
        std::uint64_t last_result = 0;
        Bench counter([](const sim::ClockInfo&) {},
                      [&](const sim::ClockInfo& now) {
                        if (now.in_reset) return;
                        beats += Signals<TestType>::beat(bench.simulation.top()) ? 1 : 0;
                        waiting += Signals<TestType>::waits(bench.simulation.top()) ? 1 : 0;
                        if (bench.rules.accepted() == 0) first_accept = now.clock + 1;
                        if (bench.rules.returned() < pairs) last_result = now.clock + 1;
                      });
        bench.simulation.add(counter);
        bench.simulation.reset();
        for (std::uint64_t i = 0; i < pairs; ++i) {
          PairRequest request = requests.draw();
          request.mode = static_cast<std::uint8_t>(PairMode::exhaustive);
          bench.driver.push(request);
        }
        bench.run();
        REQUIRE(beats == 11 * pairs);
        REQUIRE(static_cast<double>(beats) >= 0.99 * static_cast<double>(waiting));
        // from the ports alone, filling and draining of the pipeline included
        REQUIRE(static_cast<double>(11 * pairs) >= 0.99 * static_cast<double>(last_result - first_accept));
      },
      options);
}
