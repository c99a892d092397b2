// SPDX-License-Identifier: Apache-2.0
// The checks of the whole modules on their ports: clock by clock against the model, and the rules of
// docs/modules/cchip_primtest.md by counting, without the model's clocks.
#include <cchip/internal/driver/primtest_engine.hpp>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/sim/scoreboard.hpp>
#include <cchip/stimulus/judge.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <cchip/stimulus/witness.hpp>
#include <iostream>

#include "primtest_bench.hpp"

namespace cchip::test {
namespace {

constexpr PairMode exhaustive = PairMode::exhaustive;
constexpr PairMode directed = PairMode::directed;

/// Stimulus: pairs of every class, every mode, any eta, tags unique among 2^16.
class RequestSource {
 public:
  RequestSource(const PrimtestConfig& config, std::uint64_t seed)
      : config_(config),
        classes_(stimulus::classes_of(config.kind_a, config.kind_b)),
        pairs_(config.coord_w, seed, config.kind_a, config.kind_b),
        random_(seed) {}

  PairRequest draw() {
    PairRequest request = draw_legal(chance(random_, 50) ? exhaustive : directed);
    if (chance(random_, 8)) request.mode = static_cast<PairMode>(random_() % 4);
    return request;
  }
  PairRequest draw_legal(PairMode mode) {
    PairRequest request;
    const auto choice = random_() % 100;
    request.pair = choice < 15   ? through_one_point()
                   : choice < 25 ? anywhere()
                                 : pairs_.draw(classes_[pairs_.draw_class()].value);
    for (GridPrimitive* p : {&request.pair.a, &request.pair.b}) {
      if (p->kind == Kind::tri) p->v[3] = random_point(random_, config_.coord_w);
    }
    request.pair.eta = chance(random_, 50) ? 0 : static_cast<int>(random_() % 16);
    request.mode = mode;
    request.tag = tag_of(tag_++);
    return request;
  }

 private:
  GridPair anywhere() {
    GridPair pair;
    pair.a.kind = config_.kind_a;
    pair.b.kind = config_.kind_b;
    for (GridPrimitive* p : {&pair.a, &pair.b}) {
      for (std::size_t i = 0; i < p->vertex_count(); ++i) p->v[i] = random_point(random_, config_.coord_w);
      *p = canonical_quad(*p);
    }
    return pair;
  }
  /// Parallelograms, a step off their plane or not, and triangles that all hold one point, more or less.
  GridPair through_one_point() {
    const int reach = (1 << (config_.coord_w - 1)) / 4 - 1;
    const Vec3i centre = inside(reach);
    GridPair pair;
    pair.a = around(config_.kind_a, centre, reach);
    pair.b = around(config_.kind_b, centre, reach);
    return pair;
  }
  Vec3i inside(int range) {
    return {pairs_.integer(-range, range), pairs_.integer(-range, range), pairs_.integer(-range, range)};
  }
  GridPrimitive around(Kind kind, const Vec3i& centre, int reach) {
    const Vec3i u = inside(reach);
    const Vec3i v = inside(reach);
    GridPrimitive p;
    p.kind = kind;
    if (kind == Kind::tri) {
      p.v = {Vec3i(centre + u), Vec3i(centre - u), Vec3i(centre + v), Vec3i::Zero()};
      return p;
    }
    const int jitter = pairs_.integer(0, 1);
    p.v = {Vec3i(centre - u - v), Vec3i(centre + u - v), Vec3i(centre + u + v), Vec3i(centre - u + v)};
    for (Vec3i& vertex : p.v) vertex += inside(jitter);
    return canonical_quad(p);
  }

  const PrimtestConfig& config_;
  std::vector<stimulus::PairClassInfo> classes_;
  stimulus::PairSource pairs_;
  Random random_;
  unsigned tag_ = 0;
};

/// The answer of the functional model, without clocks, and the rules that every answer obeys, for any model.
PairResult answer(const PrimtestConfig& config, const PairRequest& request) {
  if (request.mode > directed) return {request.tag, true, true, false, {AxisClass::illegal, 0, 0}, 0};
  const PairResult r =
      model::run_programme(config.options(), request.pair, request.mode, config.coord_w).result(request.tag);
  const auto rule = [&](bool holds, const char* text) {
    sim::require(holds, std::string(text) + ": " + to_text(request.pair) + " mode " +
                            std::to_string(static_cast<int>(request.mode)) + ", model " + sim::to_text(r));
  };
  const bool exact = exact_intersects(request.pair);
  const bool exactly_decided = config.warped_exact || (request.pair.eta == 0 && r.definite);
  rule(!exactly_decided || r.grid == exact, "wrong answer");
  rule(r.hit || !exact, "false no");
  rule(r.hit == (r.grid || !r.definite), "hit is not grid or not definite");
  rule(r.grid || witness_separates(r.axis, request.pair), "the witness does not separate");
  if (request.pair.eta == 0) rule(r.definite || !config.warped_exact, "exact input left open");
  if (request.pair.eta == defs::err_unknown) rule(!r.definite, "definite with unknown error");
  if (is_general_position(request.pair)) {
    if (request.mode == directed) rule(r.beats <= most_general_position_beats(request.pair, r.grid), "too many beats");
    if (request.mode == exhaustive) rule(r.beats == config.exhaustive_beats(), "not the paper's schedule");
  }
  return r;
}

/// Compares every output on every clock with the clock-exact model; reads all inputs from the pins.
class ExactMonitor : public sim::Agent {
 public:
  ExactMonitor(const PrimtestConfig& config, PrimtestPins& pins)
      : id_(static_cast<int>(config.id)),
        pins_(pins),
        model_({config.coord_w, config.substages, config.contexts, config.options()}) {}

  std::uint64_t results_compared() const { return results_; }

  void sample(const sim::ClockInfo& now) override {
    if (defined_) compare();
    if (now.in_reset) {
      model_.reset();
      defined_ = true;
      return;
    }
    std::optional<PairRequest> request;
    if (pins_.s_pair_valid() != 0) request = pins_.request();
    model_.clock(request, pins_.m_result_ready() != 0);
  }

 private:
  void compare() {
    const PrimtestPins::Outputs out = pins_.outputs();
    expect("s_pair_ready", out.pair_ready, model_.s_pair_ready());
    expect("idle", out.idle, model_.idle());
    expect("rm_id", out.rm_id, id_);
    expect("m_result_valid", out.result_valid, model_.m_result_valid());
    if (!model_.m_result_valid()) return;
    expect("m_result", out.result, model_.m_result());
    ++results_;
  }

  int id_;
  PrimtestPins& pins_;
  model::Primtest model_;
  bool defined_ = false;
  std::uint64_t results_ = 0;
};

/// The rules that need no model: answers by value and once per tag, idle and ready from a count of handshakes.
class RuleMonitor : public sim::Agent {
 public:
  RuleMonitor(const PrimtestConfig& config, PrimtestPins& pins, sim::StreamDriver<PairRequest>& driver,
              sim::StreamSink<PairResult>& sink)
      : contexts_(static_cast<std::uint64_t>(config.contexts)), pins_(pins), scoreboard_("m_result") {
    driver.on_accept([this, &config](const PairRequest& request, std::uint64_t clock) {
      scoreboard_.expect(request.tag, answer(config, request), clock);
      ++accepted_;
    });
    sink.on_item([this](const PairResult& beat, std::uint64_t clock) {
      scoreboard_.got(beat.tag, beat, clock);
      if (on_result) on_result(beat);
      ++returned_;
    });
  }

  std::function<void(const PairResult&)> on_result;
  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t returned() const { return returned_; }
  std::uint64_t in_flight() const { return accepted_ - returned_; }
  void finish() const { scoreboard_.finish(); }

  /// Runs after driver and sink. idle and ready of this clock follow from the handshakes of the clocks before.
  void sample(const sim::ClockInfo& now) override {
    const PrimtestPins::Outputs out = pins_.outputs();
    if (now.in_reset) {
      if (after_reset_) {
        expect("idle in reset", out.idle, true);
        expect("s_pair_ready in reset", out.pair_ready, false);
        expect("m_result_valid in reset", out.result_valid, false);
      }
      scoreboard_.clear();
      accepted_ = returned_ = before_ = 0;
      after_reset_ = true;
      return;
    }
    expect("idle", out.idle, before_ == 0);
    if (now.clock > 1) expect("s_pair_ready", out.pair_ready, before_ < contexts_);
    before_ = in_flight();
    sim::require(before_ <= contexts_, "more than CONTEXTS pairs in flight");
    after_reset_ = false;
  }

 private:
  std::uint64_t contexts_;
  PrimtestPins& pins_;
  sim::TagScoreboard<PairResult> scoreboard_;
  std::uint64_t accepted_ = 0;
  std::uint64_t returned_ = 0;
  std::uint64_t before_ = 0;
  bool after_reset_ = false;
};

/// Everything together: driver, sink, both monitors, garbage on idle inputs.
class ModuleBench {
 public:
  ModuleBench(const PrimtestConfig& config, const sim::SimulationOptions& options,
              sim::Pattern source = sim::Pattern::always(), sim::Pattern back_pressure = sim::Pattern::always())
      : pins_owner_(config.simulate(options)),
        pins(*pins_owner_),
        driver(
            "s_pair", pins.s_pair_valid(), pins.s_pair_ready(), [this](const PairRequest& r) { pins.put(r); },
            std::move(source)),
        sink(
            "m_result", pins.m_result_valid(), pins.m_result_ready(), [this] { return pins.outputs().result; },
            std::move(back_pressure)),
        rules(config, pins, driver, sink),
        exact(config, pins),
        bound_(static_cast<std::uint64_t>(defs::drain_bound(config.substages, config.contexts))),
        garbage_(options.seed) {
    driver.when_idle([this] { pins.scramble(garbage_); });
    pins.add(driver);
    pins.add(sink);
    pins.add(rules);
    pins.add(exact);
  }

  void steps(std::uint64_t clocks) {
    for (std::uint64_t i = 0; i < clocks; ++i) pins.step();
  }
  /// Steps until everything that was pushed is accepted.
  void run_accepted() {
    const std::uint64_t most = driver.waiting() * 5000 + bound_;
    for (std::uint64_t i = 0; driver.waiting() != 0; ++i) {
      if (i == most) throw sim::SimulationTimeout("pairs are not accepted");
      pins.step();
    }
  }
  /// Steps until everything is answered.
  void run() {
    const std::uint64_t most = (driver.waiting() + rules.in_flight()) * 5000 + bound_;
    for (std::uint64_t i = 0; driver.waiting() != 0 || rules.in_flight() != 0; ++i) {
      if (i == most) throw sim::SimulationTimeout("answers are missing");
      pins.step();
    }
    rules.finish();
  }

 private:
  std::unique_ptr<PrimtestPins> pins_owner_;

 public:
  PrimtestPins& pins;
  sim::StreamDriver<PairRequest> driver;
  sim::StreamSink<PairResult> sink;
  RuleMonitor rules;
  ExactMonitor exact;

 private:
  std::uint64_t bound_;
  Random garbage_;
};

/// Clocks from the handshake of s_pair to that of m_result, alone in the module.
int lone_latency(ModuleBench& bench, const PairRequest& request) {
  bench.driver.push(request);
  for (int clock = 0; bench.rules.in_flight() == 0 && clock < 3; ++clock) bench.pins.step();  // ready soon after reset
  REQUIRE(bench.rules.in_flight() == 1);
  int clocks = 0;
  while (bench.rules.in_flight() == 1 && clocks < 5000) {
    bench.pins.step();
    ++clocks;
  }
  return clocks;
}

}  // namespace

std::vector<PairResult> exact_answers(const PrimtestConfig& config, const std::vector<GridPair>& pairs, PairMode mode) {
  std::vector<PairResult> result(pairs.size());
  sim::with_wave_on_failure(test_name(), [&](const sim::SimulationOptions& options) {
    ModuleBench bench(config, options);
    bench.rules.on_result = [&](const PairResult& r) { result.at(r.tag) = r; };
    bench.pins.reset(2);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      bench.driver.push({pairs[i], static_cast<std::uint16_t>(i), mode});
    }
    bench.run();  // answer() asks the oracle
    REQUIRE(bench.rules.returned() == pairs.size());
  });
  return result;
}

void check_every_clock(const PrimtestConfig& config) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    RequestSource requests(config, options.seed);
    for (const sim::Pattern& source : sim::standard_patterns(options.seed)) {
      for (const sim::Pattern& back_pressure : sim::standard_patterns(options.seed + 100)) {
        INFO("s_pair " << source.name() << ", m_result " << back_pressure.name());
        ModuleBench bench(config, options, source, back_pressure);
        bench.pins.reset(1);
        for (int part = 0; part < 2; ++part) {  // ended by a reset in mid traffic
          while (bench.driver.waiting() < 40) bench.driver.push(requests.draw());
          bench.steps(120);
          bench.pins.reset(part + 1);
        }
        bench.steps(1);
        while (bench.driver.waiting() < 12) bench.driver.push(requests.draw());
        bench.run();
        REQUIRE(bench.rules.returned() >= 12);
        bench.steps(50);  // nothing may come after the last answer
      }
    }
  });
}

void check_long_traffic(const PrimtestConfig& config) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    RequestSource requests(config, options.seed);
    ModuleBench bench(config, options, sim::Pattern::random(0.2, options.seed),
                      sim::Pattern::random(0.5, options.seed + 1));
    int certain_warped_hits = 0;
    int open = 0;
    bench.rules.on_result = [&](const PairResult& r) {
      certain_warped_hits += r.grid && r.definite && r.beats == general_position_beats ? 1 : 0;
      open += r.definite || r.axis.cls == AxisClass::illegal ? 0 : 1;
    };
    bench.pins.reset(2);
    for (int i = 0; i < 1000; ++i) bench.driver.push(requests.draw());
    bench.run();
    REQUIRE(bench.rules.returned() == 1000);
    REQUIRE(bench.exact.results_compared() >= 1000);
    REQUIRE(certain_warped_hits > 10);
    REQUIRE(open > 50);
  });
}

void check_extreme_coordinates(const PrimtestConfig& config) {
  Random random(sim::seed_from_environment());
  std::vector<GridPair> pairs;
  const int most = (1 << (config.coord_w - 1)) - 1;
  for (const auto& values :
       {std::vector<int>{-most - 1, most}, std::vector<int>{-most - 1, -most, 0, most - 1, most}}) {
    for (int i = 0; i < 400; ++i) {
      GridPair pair;
      pair.a.kind = config.kind_a;
      pair.b.kind = config.kind_b;
      for (GridPrimitive* p : {&pair.a, &pair.b}) {
        for (std::size_t v = 0; v < p->vertex_count(); ++v) {
          for (int d = 0; d < 3; ++d) p->v[v][d] = values[random() % values.size()];
        }
        *p = canonical_quad(*p);
      }
      pairs.push_back(pair);
    }
  }
  for (const PairMode mode : {PairMode::exhaustive, PairMode::directed}) {
    const auto result = exact_answers(config, pairs, mode);
    const auto hits = std::count_if(result.begin(), result.end(), [](const PairResult& r) { return r.grid; });
    REQUIRE(hits > 80);
    REQUIRE(hits < 800);
  }
}

void check_only_witness(const PrimtestConfig& config) {
  std::vector<AxisCode> codes = {{AxisClass::normal_a, 0, 0}, {AxisClass::normal_b, 0, 0}};
  for (std::uint8_t k = 0; k < static_cast<std::uint8_t>(config.kind_a); ++k) {
    for (std::uint8_t l = 0; l < static_cast<std::uint8_t>(config.kind_b); ++l)
      codes.push_back({AxisClass::cross, k, l});
  }
  REQUIRE(static_cast<int>(codes.size()) == config.exhaustive_beats());
  std::vector<GridPair> pairs;
  stimulus::PairSource source(config.coord_w, sim::seed_from_environment(), config.kind_a, config.kind_b);
  for (const AxisCode& code : codes) {
    for (int n = 0; n < 2;) {
      const GridPair pair = source.draw(stimulus::PairClass::general_full);
      if (!witness_separates(code, pair) || !is_general_position(pair)) continue;
      const auto separating =
          std::count_if(codes.begin(), codes.end(), [&](const AxisCode& c) { return witness_separates(c, pair); });
      if (separating != 1) continue;
      pairs.push_back(pair);
      ++n;
    }
  }
  for (const PairMode mode : {PairMode::exhaustive, PairMode::directed}) {
    const auto result = exact_answers(config, pairs, mode);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      INFO(to_text(pairs[i]));
      REQUIRE_FALSE(result[i].grid);
      REQUIRE(result[i].axis == codes[i / 2]);
    }
  }
}

void check_lone_pair_latency(const PrimtestConfig& config) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    RequestSource requests(config, options.seed);
    ModuleBench bench(config, options);
    bench.pins.reset(2);
    bench.pins.step();
    const int s = config.substages;
    for (int i = 0; i < 120; ++i) {
      PairRequest request = requests.draw();
      const int beats = answer(config, request).beats;
      // EXHAUSTIVE axes leave back to back; every other beat waits for the verdict before it
      const int together = request.mode == exhaustive ? config.exhaustive_beats() : 1;
      const int waited = request.mode > directed ? 0 : beats - together;
      REQUIRE(waited >= 0);
      const bool special = !is_general_position(request.pair);
      if (request.mode == exhaustive && !special) REQUIRE(waited == 0);  // for any data
      const int clocks = lone_latency(bench, request);
      INFO(to_text(request.pair) << " mode " << static_cast<int>(request.mode) << " beats " << beats);
      REQUIRE(clocks == defs::pair_latency(s, together) + waited * defs::beat_latency(s));
      bench.steps(static_cast<std::uint64_t>(i) % 3);
    }
  });
}

void check_drain(const PrimtestConfig& config) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    const auto contexts = static_cast<std::uint64_t>(config.contexts);
    const auto bound = static_cast<std::uint64_t>(defs::drain_bound(config.substages, config.contexts));
    RequestSource requests(config, options.seed);
    {
      ModuleBench bench(config, options, sim::Pattern::always(), sim::Pattern::never_for(3000));
      bench.pins.reset(2);
      for (std::uint64_t i = 0; i < contexts + 10; ++i) bench.driver.push(requests.draw());
      bench.steps(2950);  // more than all of them need
      REQUIRE(bench.rules.accepted() == contexts);
      REQUIRE(bench.rules.returned() == 0);
      REQUIRE_FALSE(bench.pins.outputs().idle);
      // every verdict has arrived: one result per clock
      bench.sink.set_pattern(sim::Pattern::always());
      bench.steps(contexts);
      REQUIRE(bench.rules.returned() >= contexts);
      bench.run();
    }
    // the pair with the most beats, as many times as the module has places
    PairRequest worst = requests.draw_legal(exhaustive);
    int most = answer(config, worst).beats;
    for (int i = 0; i < 1000; ++i) {
      const PairRequest request = requests.draw_legal(exhaustive);
      const int beats = answer(config, request).beats;
      if (beats > most) {
        worst = request;
        most = beats;
      }
    }
    REQUIRE(most >= config.exhaustive_beats() + 20);
    for (const std::uint64_t pairs : {contexts, 2 * contexts + 1}) {
      ModuleBench bench(config, options);
      bench.pins.reset(2);
      for (std::uint64_t i = 0; i < pairs; ++i) {
        worst.tag = static_cast<std::uint16_t>(i);
        bench.driver.push(worst);
      }
      bench.run_accepted();
      std::uint64_t clocks = 0;
      while (!bench.pins.outputs().idle && clocks <= 4 * bound) {
        bench.pins.step();
        ++clocks;
      }
      INFO("drained in " << clocks << " of at most " << bound << " clocks, " << most << " beats a pair");
      REQUIRE(clocks > static_cast<std::uint64_t>(most));
      REQUIRE(clocks <= bound);
    }
  });
}

void check_registered_outputs(const PrimtestConfig& config) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    RequestSource requests(config, options.seed);
    Random random(options.seed);
    ModuleBench bench(config, options, sim::Pattern::random(0.3, options.seed),
                      sim::Pattern::random(0.3, options.seed));
    PrimtestPins& pins = bench.pins;
    int seen_valid = 0;
    // after driver and sink have set the inputs of a clock: sets other inputs, then the original ones again
    Bench toggler([](const sim::ClockInfo&) {},
                  [&](const sim::ClockInfo& now) {
                    if (now.in_reset) return;
                    const PrimtestPins::Outputs before = pins.outputs();
                    const CData valid = pins.s_pair_valid();
                    const CData ready = pins.m_result_ready();
                    const PairRequest request = pins.request();
                    for (int i = 0; i < 4; ++i) {
                      pins.s_pair_valid() = i & 1;
                      pins.m_result_ready() = i >> 1 & 1;
                      pins.rst() = random() & 1;
                      pins.scramble(random);
                      pins.eval();
                      sim::require(pins.outputs() == before, "an output follows an input without a clock edge");
                    }
                    pins.s_pair_valid() = valid;
                    pins.m_result_ready() = ready;
                    pins.rst() = 0;
                    pins.put(request);
                    pins.eval();
                    seen_valid += before.result_valid ? 1 : 0;
                  });
    pins.add(toggler);
    pins.reset(2);
    for (int i = 0; i < 60; ++i) bench.driver.push(requests.draw());
    bench.run();
    REQUIRE(seen_valid >= 60);
  });
}

void check_no_old_tags(const PrimtestConfig& config) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    RequestSource requests(config, options.seed);
    ModuleBench bench(config, options);
    // a sender that is not itself in reset: what it offers on these clocks must not be accepted
    Bench careless(
        [&](const sim::ClockInfo& now) {
          if (now.in_reset) bench.pins.s_pair_valid() = 1;
        },
        [](const sim::ClockInfo&) {});
    bench.pins.add(careless);
    bench.pins.reset(2);
    for (std::uint64_t moment = 1; moment < 90; ++moment) {  // a pair or several at every place of the machine
      for (int i = 0; i < 8; ++i) bench.driver.push(requests.draw());
      bench.steps(moment);
      bench.driver.clear();
      bench.pins.reset(1);  // the scoreboard is empty: any earlier result is an error
      bench.steps(moment % 2 == 0 ? 120 : 0);
      bench.driver.push(requests.draw());
      bench.run();
      REQUIRE(bench.rules.returned() == 1);
    }
  });
}

void check_throughput(const PrimtestConfig& config) {
  REQUIRE(config.contexts == defs::contexts_default(config.substages));
  struct Stream {
    const char* name;
    std::function<PairRequest(RequestSource&, int i)> draw;
  };
  const auto one_beat = [&](RequestSource& source, int) {
    while (true) {
      const PairRequest request = source.draw_legal(directed);
      const auto o = model::run_programme(config.options(), request.pair, directed, config.coord_w);
      if (o.beats == 1) return request;
    }
  };
  const std::vector<Stream> streams = {
      {"EXHAUSTIVE", [](RequestSource& source, int) { return source.draw_legal(exhaustive); }},
      {"DIRECTED, one beat", one_beat},
      {"DIRECTED", [](RequestSource& source, int) { return source.draw_legal(directed); }},
      {"mixed", [](RequestSource& source, int) { return source.draw(); }},
      {"one beat and EXHAUSTIVE in turn",
       [&](RequestSource& source, int i) { return i % 2 == 0 ? one_beat(source, i) : source.draw_legal(exhaustive); }},
  };
  for (const Stream& stream : streams) {
    sim::with_wave_on_failure(test_name(), [&](const sim::SimulationOptions& options) {
      RequestSource requests(config, options.seed);
      ModuleBench bench(config, options);
      // long enough that the end of the stream, where few pairs are left to fill the pipeline, does not count
      constexpr std::uint64_t pairs = 12000;
      std::uint64_t beats = 0;
      std::uint64_t waiting = 0;
      std::uint64_t clocks = 0;
      std::uint64_t answered_beats = 0;
      bench.rules.on_result = [&](const PairResult& r) {
        answered_beats += r.axis.cls == AxisClass::illegal ? 1U : static_cast<unsigned>(r.beats);
      };
      Bench counter([](const sim::ClockInfo&) {},
                    [&](const sim::ClockInfo& now) {
                      if (now.in_reset) return;
                      ++clocks;
                      beats += bench.pins.beat_leaves() ? 1 : 0;
                      waiting += bench.pins.pair_waits() || bench.pins.s_pair_valid() != 0 ? 1 : 0;
                    });
      bench.pins.add(counter);
      bench.pins.reset(2);
      for (std::uint64_t i = 0; i < pairs; ++i) bench.driver.push(stream.draw(requests, static_cast<int>(i)));
      bench.run();
      const double share = static_cast<double>(beats) / static_cast<double>(waiting);
      std::cout << to_name(config.id) << " W=" << config.coord_w << " S=" << config.substages
                << " CONTEXTS=" << config.contexts << ' ' << stream.name << ": axes per waiting clock " << share
                << ", beats per pair " << static_cast<double>(beats) / pairs << ", clocks per pair "
                << static_cast<double>(clocks) / pairs << '\n';
      INFO(stream.name);
      CHECK(beats == answered_beats);
      CHECK(share >= 0.99);
    });
  }
}

}  // namespace cchip::test
