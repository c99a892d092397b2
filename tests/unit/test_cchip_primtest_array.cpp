// SPDX-License-Identifier: Apache-2.0
// Lanes behind one pair of streams. Answers come from the functional model of one lane; ready, idle, latency and
// rates are known by counting.
#include <Vpa_l1___024root.h>
#include <Vpa_l2_quad___024root.h>
#include <Vpa_l3___024root.h>

#include <algorithm>
#include <cchip/internal/driver/primtest_engine.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/model/primtest.hpp>
#include <cchip/machines/probes.hpp>
#include <cchip/sim/scoreboard.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <cchip/stimulus/witness.hpp>
#include <deque>
#include <map>
#include <models/cchip_primtest_array.hpp>
#include <numeric>

#include "bench.hpp"

namespace cchip::test {
namespace {

constexpr PairMode exhaustive = PairMode::exhaustive;
constexpr PairMode directed = PairMode::directed;
constexpr auto reserved = static_cast<PairMode>(3);

template <class Config>
constexpr Kind kind_a = static_cast<Kind>(Config::VERTS_A);
template <class Config>
constexpr Kind kind_b = static_cast<Kind>(Config::VERTS_B);

template <class Config>
PairResult answer(const PairRequest& request) {
  if (request.mode > directed) return {request.tag, true, true, false, {AxisClass::illegal, 0, 0}, 0};
  const model::Options options{{Config::VERTS_A, Config::VERTS_B}, Config::WARPED_EXACT != 0};
  const PairResult r = model::run_programme(options, request.pair, request.mode, Config::COORD_W).result(request.tag);
  sim::require(r.grid == exact_intersects(request.pair), "the model is wrong: " + to_text(request.pair));
  return r;
}

/// Pairs of every class, every mode, any eta, tags unique among 2^16.
template <class Config>
class RequestSource {
 public:
  explicit RequestSource(std::uint64_t seed)
      : pairs_(Config::COORD_W, seed, kind_a<Config>, kind_b<Config>), random_(seed) {}

  PairRequest draw() {
    return draw(chance(random_, 8)    ? static_cast<PairMode>(random_() % 4)
                : chance(random_, 30) ? exhaustive
                                      : directed);
  }
  PairRequest draw(PairMode mode) {
    PairRequest request;
    const auto classes = stimulus::classes_of(kind_a<Config>, kind_b<Config>);
    request.pair = pairs_.draw(classes[pairs_.draw_class()].value);
    for (GridPrimitive* p : {&request.pair.a, &request.pair.b}) {
      if (p->kind == Kind::tri) p->v[3] = random_point(random_, Config::COORD_W);
    }
    request.pair.eta = static_cast<int>(random_() % 16);
    request.mode = mode;
    request.tag = tag_of(tag_++);
    return request;
  }
  /// EXHAUSTIVE pairs that need no more than the schedule.
  PairRequest draw_plain() {
    while (true) {
      const PairRequest request = draw(exhaustive);
      if (answer<Config>(request).beats == defs::exhaustive_beats(Config::VERTS_A, Config::VERTS_B)) return request;
    }
  }

 private:
  stimulus::PairSource pairs_;
  Random random_;
  unsigned tag_ = 0;
};

/// A result and its history. Clocks of handshakes.
struct Returned {
  std::uint16_t tag;
  std::size_t lane;
  std::uint64_t accepted;  ///< at s_pair
  std::uint64_t returned;  ///< at m_result
};

/// Driver, sink and the rules that always hold.
template <class Config>
class ArrayBench {
 public:
  static constexpr std::size_t lanes = Config::LANES;
  static constexpr std::uint64_t capacity = std::uint64_t{lanes} * Config::CONTEXTS;

  explicit ArrayBench(const sim::SimulationOptions& options, sim::Pattern source = sim::Pattern::always(),
                      sim::Pattern back_pressure = sim::Pattern::always())
      : simulation(options),
        port_(simulation.top(), Config::COORD_W),
        driver(port_.driver(std::move(source))),
        sink(port_.sink(std::move(back_pressure))),
        scoreboard_("m_result"),
        garbage_(options.seed),
        rules_([](const sim::ClockInfo&) {}, [this](const sim::ClockInfo& now) { check(now); }) {
    driver.when_idle([this] { port_.scramble(garbage_); });
    driver.on_accept([this](const PairRequest& r, std::uint64_t clock) { accept(r, clock); });
    sink.on_item([this](const PairResult& r, std::uint64_t clock) { take(r, clock); });
    simulation.add(driver);
    simulation.add(sink);
    simulation.add(rules_);
  }

  void push(const PairRequest& request) { driver.push(request); }
  void steps(std::uint64_t clocks) { simulation.steps(clocks); }
  std::uint64_t in_flight() const { return accepted_ - results.size(); }
  /// Steps until everything is answered.
  void run() {
    const std::uint64_t most = (driver.waiting() + in_flight()) * 6000 + 10000;
    simulation.run_until([this] { return driver.waiting() == 0 && in_flight() == 0; }, most, "all answers");
    scoreboard_.finish();
  }
  /// rst = 1; afterwards the next pair goes to lane 0 again.
  void reset(int clocks) {
    driver.clear();
    simulation.reset(clocks);
  }
  std::size_t count_of(std::size_t lane) const {
    return static_cast<std::size_t>(
        std::count_if(results.begin(), results.end(), [&](const Returned& r) { return r.lane == lane; }));
  }

  std::vector<Returned> results;  ///< since the last reset, in their order
  sim::Simulation<typename Config::Model> simulation;

 private:
  using Model = typename Config::Model;
  sim::PairPort<Model> port_;

 public:
  sim::StreamDriver<PairRequest> driver;
  sim::StreamSink<PairResult> sink;

 private:
  struct Lane {
    std::uint64_t accepted = 0;
    std::uint64_t returned = 0;
    std::uint64_t passed_over = 0;  ///< pairs that other lanes got while it had a place
  };
  struct Pair {
    std::size_t lane;
    std::uint64_t accepted;
  };

  Model& top() { return simulation.top(); }

  void accept(const PairRequest& request, std::uint64_t clock) {
    scoreboard_.expect(request.tag, answer<Config>(request), clock);
    std::size_t lane = 0;
    while (lane < lanes && static_cast<unsigned>(probes::array_choice(top())) != 1U << lane) ++lane;
    sim::require(lane < lanes, "not one lane is chosen");
    for (std::size_t other = 0; other < lanes; ++other) {
      Lane& l = state_[other];
      const bool room = l.accepted - old_returns_.front()[other] < Config::CONTEXTS;
      l.passed_over = other != lane && room ? l.passed_over + 1 : 0;
      sim::require(l.passed_over < lanes, "lane " + std::to_string(other) + " has a place, but other lanes get pairs");
    }
    Lane& l = state_[lane];
    sim::require(l.accepted - l.returned < Config::CONTEXTS,
                 "a pair for lane " + std::to_string(lane) + ", which is full");
    ++l.accepted;
    ++accepted_;
    pairs_[request.tag] = {lane, clock};
  }

  void take(const PairResult& beat, std::uint64_t clock) {
    scoreboard_.got(beat.tag, beat, clock);
    const Pair pair = pairs_.at(beat.tag);
    Lane& l = state_[pair.lane];
    results.push_back({beat.tag, pair.lane, pair.accepted, clock});
    ++l.returned;
  }

  /// Runs after driver and sink. Ready and idle of a clock follow from the handshakes of the clocks before.
  void check(const sim::ClockInfo& now) {
    expect("rm_id", int{top().rm_id}, Config::VERTS_A + Config::VERTS_B - 5);
    if (now.in_reset) {
      if (was_reset_) {
        expect("idle in reset", top().idle != 0, true);
        expect("s_pair_ready in reset", top().s_pair_ready != 0, false);
        expect("m_result_valid in reset", top().m_result_valid != 0, false);
      }
      was_reset_ = true;
      scoreboard_.clear();
      results.clear();
      pairs_.clear();
      state_.fill({});
      accepted_ = before_ = accepted_before_ = 0;
      old_returns_.assign(defs::array_place_latency(), {});
      return;
    }
    was_reset_ = false;
    const auto& old = old_returns_.front();
    const std::uint64_t returned = std::accumulate(old.begin(), old.end(), std::uint64_t{0});
    expect("idle", top().idle != 0, before_ == 0);
    expect("s_pair_ready", top().s_pair_ready != 0,
           now.clock > defs::array_latency(Config::LANES) && accepted_before_ - returned < capacity);
    before_ = in_flight();
    accepted_before_ = accepted_;
    sim::require(before_ <= capacity, "more pairs in flight than places");
    old_returns_.pop_front();
    old_returns_.emplace_back();
    for (std::size_t lane = 0; lane < lanes; ++lane) old_returns_.back()[lane] = state_[lane].returned;
  }

  sim::TagScoreboard<PairResult> scoreboard_;
  Random garbage_;
  Bench rules_;
  std::array<Lane, lanes> state_;
  std::map<std::uint16_t, Pair> pairs_;
  /// Results returned by each lane, a place's latency ago first.
  std::deque<std::array<std::uint64_t, lanes>> old_returns_;
  std::uint64_t accepted_ = 0;
  std::uint64_t before_ = 0;
  std::uint64_t accepted_before_ = 0;
  bool was_reset_ = false;
};

/// Clocks from handshake to handshake of a pair of one axis.
template <class Config>
constexpr std::uint64_t short_latency = defs::pair_latency(Config::SUBSTAGES, 1) + defs::array_latency(Config::LANES);

#define CCHIP_CASE(name) \
  TEMPLATE_LIST_TEST_CASE("cchip_primtest_array: " name, "[unit][cchip_primtest_array]", cchip_primtest_array_configs)

CCHIP_CASE("every tag once with the answer of the model, ready and idle on every clock") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource<TestType> requests(options.seed);
    for (const sim::Pattern& source : sim::standard_patterns(options.seed)) {
      for (const sim::Pattern& back_pressure : sim::standard_patterns(options.seed + 100)) {
        INFO("s_pair " << source.name() << ", m_result " << back_pressure.name());
        ArrayBench<TestType> bench(options, source, back_pressure);
        bench.reset(1);
        for (int part = 0; part < 2; ++part) {  // ended by a reset in mid traffic
          for (int i = 0; i < 80; ++i) bench.push(requests.draw());
          bench.steps(110);
          bench.reset(part + 1);
        }
        for (int i = 0; i < 12; ++i) bench.push(requests.draw());
        bench.run();
        REQUIRE(bench.results.size() == 12);
        bench.steps(50);  // nothing may come after the last answer
      }
    }
  });
}

CCHIP_CASE("long traffic, every lane has its share") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource<TestType> requests(options.seed);
    ArrayBench<TestType> bench(options, sim::Pattern::random(0.5, options.seed),
                               sim::Pattern::random(0.5, options.seed + 1));
    bench.reset(2);
    constexpr std::size_t pairs = 300 * TestType::LANES;
    for (std::size_t i = 0; i < pairs; ++i) bench.push(requests.draw());
    bench.run();
    REQUIRE(bench.results.size() == pairs);
    for (std::size_t lane = 0; lane < TestType::LANES; ++lane) {
      CAPTURE(lane, bench.count_of(lane));
      REQUIRE(bench.count_of(lane) > 300 / 2);
    }
  });
}

CCHIP_CASE("latency of a lone pair is the same in every lane, lanes are served in turn") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource<TestType> requests(options.seed);
    ArrayBench<TestType> bench(options);
    bench.reset(2);
    constexpr int s = TestType::SUBSTAGES;
    for (std::size_t i = 0; i < 10 * TestType::LANES; ++i) {
      const PairRequest request = requests.draw();
      const int beats = answer<TestType>(request).beats;
      // EXHAUSTIVE axes leave back to back; every other beat waits for the verdict before it
      const int together =
          request.mode == exhaustive ? defs::exhaustive_beats(TestType::VERTS_A, TestType::VERTS_B) : 1;
      const int waited = request.mode > directed ? 0 : beats - together;
      bench.push(request);
      bench.run();
      const Returned& r = bench.results.back();
      INFO(to_text(request.pair) << " mode " << static_cast<int>(request.mode) << " beats " << beats);
      REQUIRE(r.lane == i % TestType::LANES);
      REQUIRE(static_cast<int>(r.returned - r.accepted) ==
              defs::array_latency(TestType::LANES) + defs::pair_latency(s, together) + waited * defs::beat_latency(s));
    }
  });
}

CCHIP_CASE("one pair and one result per clock, limited by the places only") {
  sim::with_wave_on_failure(test_name(), [](const sim::SimulationOptions& options) {
    using Array = ArrayBench<TestType>;
    RequestSource<TestType> requests(options.seed);
    Array bench(options);
    bench.reset(2);
    constexpr std::uint64_t rounds = 5;
    for (std::uint64_t i = 0; i < rounds * Array::capacity; ++i) bench.push(requests.draw(reserved));
    bench.run();
    // a place is used again when its result has left
    constexpr std::uint64_t turn = short_latency<TestType> + defs::array_place_latency();
    const std::uint64_t first = bench.results.front().accepted;
    for (std::size_t i = 0; i < bench.results.size(); ++i) {
      const Returned& r = bench.results[i];
      const std::uint64_t round = i / Array::capacity;
      REQUIRE(r.lane == i % Array::lanes);
      REQUIRE(r.accepted == first + round * std::max(turn, Array::capacity) + i % Array::capacity);
      REQUIRE(r.returned == r.accepted + short_latency<TestType>);
    }
    for (std::size_t lane = 0; lane < Array::lanes; ++lane) {
      REQUIRE(bench.count_of(lane) == rounds * TestType::CONTEXTS);
    }
  });
}

CCHIP_CASE("lanes work at the same time") {
  sim::with_wave_on_failure(test_name(), [](const sim::SimulationOptions& options) {
    using Array = ArrayBench<TestType>;
    RequestSource<TestType> requests(options.seed);
    Array bench(options);
    bench.reset(2);
    constexpr int beats = defs::exhaustive_beats(TestType::VERTS_A, TestType::VERTS_B);
    constexpr std::uint64_t latency =
        defs::pair_latency(TestType::SUBSTAGES, beats) + defs::array_latency(TestType::LANES);
    constexpr std::uint64_t per_lane = 60;
    for (std::uint64_t i = 0; i < per_lane * Array::lanes; ++i) bench.push(requests.draw_plain());
    bench.run();
    const std::uint64_t clocks = bench.results.back().returned - bench.results.front().accepted;
    // the time that one lane needs for its own pairs, the last lane starting last; with too few places a lane waits for
    // them, but never for another lane
    const std::uint64_t busy = (per_lane - 1) * beats;
    const std::uint64_t waiting = (per_lane - 1) / TestType::CONTEXTS * (latency + defs::array_place_latency());
    if (busy >= waiting + latency) {
      REQUIRE(clocks == latency + busy + Array::lanes - 1);
    } else {
      REQUIRE(clocks <= latency + waiting + TestType::CONTEXTS * beats + Array::lanes - 1);
    }
    for (std::size_t lane = 0; lane < Array::lanes; ++lane) REQUIRE(bench.count_of(lane) == per_lane);
  });
}

CCHIP_CASE("full of results they leave in turn") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    using Array = ArrayBench<TestType>;
    RequestSource<TestType> requests(options.seed);
    for (const sim::Pattern& back_pressure : sim::standard_patterns(options.seed)) {
      Array bench(options, sim::Pattern::always(), sim::Pattern::never_for(10000));
      bench.reset(2);
      for (std::uint64_t i = 0; i < Array::capacity; ++i) bench.push(requests.draw(reserved));
      bench.steps(Array::capacity + short_latency<TestType> + 10);
      REQUIRE(bench.in_flight() == Array::capacity);
      bench.sink.set_pattern(back_pressure);
      bench.run();
      // results of each lane since the last one of this lane, whose next result became ready later than that
      std::array<std::array<int, Array::lanes>, Array::lanes> since{};
      std::array<bool, Array::lanes> seen{};
      for (const Returned& r : bench.results) {
        auto& others = since[r.lane];
        if (seen[r.lane]) {
          INFO("lane " << r.lane << ", " << back_pressure.name());
          const auto own = others.begin() + static_cast<std::ptrdiff_t>(r.lane);
          // every lane before this one got at most one result per result of this lane
          REQUIRE(std::accumulate(others.begin(), own, 0) <= static_cast<int>(r.lane));
          REQUIRE(std::accumulate(others.begin(), others.end(), 0) <= defs::array_wait_bound(TestType::LANES));
        }
        seen[r.lane] = true;
        others.fill(0);
        for (std::size_t lane = 0; lane < Array::lanes; ++lane) since[lane][r.lane] += lane == r.lane ? 0 : 1;
      }
      // the results that leave while all paths are full are shared equally
      constexpr std::size_t on_the_way = 4 * Array::lanes;
      constexpr std::size_t each = TestType::CONTEXTS / 3;
      if constexpr (each * Array::lanes + on_the_way <= Array::capacity) {
        const auto start = bench.results.begin() + on_the_way;
        for (std::size_t lane = 0; lane < Array::lanes; ++lane) {
          const auto share = static_cast<std::size_t>(
              std::count_if(start, start + each * Array::lanes, [&](const Returned& r) { return r.lane == lane; }));
          CAPTURE(lane, share, each);
          REQUIRE(share + 1 >= each);
          REQUIRE(share <= each + 1);
        }
      }
    }
  });
}

CCHIP_CASE("a lane with long pairs does not hold up the others") {
  sim::with_wave_on_failure(test_name(), [](const sim::SimulationOptions& options) {
    using Array = ArrayBench<TestType>;
    if constexpr (Array::lanes > 1) {
      RequestSource<TestType> requests(options.seed);
      PairRequest longest = requests.draw(directed);
      for (int i = 0; i < 2000; ++i) {
        const PairRequest request = requests.draw(directed);
        if (answer<TestType>(request).beats > answer<TestType>(longest).beats) longest = request;
      }
      const int beats = answer<TestType>(longest).beats;
      REQUIRE(beats > 20);
      Array bench(options);
      bench.reset(2);
      // lane 0 is full of long pairs before any other lane is full
      constexpr std::uint64_t others = (Array::lanes - 1) * TestType::CONTEXTS;
      for (std::uint64_t i = 0; i < Array::capacity; ++i) {
        PairRequest request = requests.draw(reserved);
        if (i % Array::lanes == 0) {
          const std::uint16_t tag = request.tag;
          request = longest;
          request.tag = tag;
        }
        bench.push(request);
      }
      for (std::uint64_t i = 0; i < 5 * others; ++i) bench.push(requests.draw(reserved));
      bench.run();
      // while lane 0 works on its first pairs the others take pairs at their full rate
      const std::uint64_t first = bench.results.front().accepted;
      const std::uint64_t until = first + static_cast<std::uint64_t>(beats) * defs::beat_latency(TestType::SUBSTAGES);
      const auto taken =
          static_cast<std::uint64_t>(std::count_if(bench.results.begin(), bench.results.end(), [&](const Returned& r) {
            return r.lane != 0 && r.accepted < until;
          }));
      constexpr std::uint64_t turn = short_latency<TestType> + defs::array_place_latency();
      const std::uint64_t rounds = (until - first) / std::max(turn, Array::capacity);
      REQUIRE(taken >= std::min(rounds, std::uint64_t{6}) * others);
    }
  });
}

CCHIP_CASE("drains within its bound, keeps all results without ready") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    using Array = ArrayBench<TestType>;
    RequestSource<TestType> requests(options.seed);
    {
      Array bench(options, sim::Pattern::always(), sim::Pattern::never_for(6000));
      bench.reset(2);
      for (std::uint64_t i = 0; i < Array::capacity + 10; ++i) bench.push(requests.draw());
      bench.steps(5900);
      REQUIRE(bench.in_flight() == Array::capacity);
      REQUIRE(bench.driver.waiting() == 10);
      bench.sink.set_pattern(sim::Pattern::always());
      bench.steps(Array::capacity);  // every verdict has arrived: one result per clock
      REQUIRE(bench.results.size() >= Array::capacity);
      bench.run();
    }
    PairRequest worst = requests.draw(exhaustive);
    for (int i = 0; i < 2000; ++i) {
      const PairRequest request = requests.draw(exhaustive);
      if (answer<TestType>(request).beats > answer<TestType>(worst).beats) worst = request;
    }
    Array bench(options);
    bench.reset(2);
    for (std::uint64_t i = 0; i < Array::capacity; ++i) {
      worst.tag = static_cast<std::uint16_t>(i);
      bench.push(worst);
    }
    bench.simulation.run_until([&] { return bench.driver.waiting() == 0; }, 10000, "all pairs accepted");
    constexpr std::uint64_t bound = defs::array_drain_bound(TestType::SUBSTAGES, TestType::CONTEXTS, TestType::LANES);
    const std::uint64_t start = bench.simulation.clock();
    bench.run();
    const std::uint64_t clocks = bench.simulation.clock() - start;
    INFO("drained in " << clocks << " of at most " << bound << " clocks");
    REQUIRE(clocks > static_cast<std::uint64_t>(answer<TestType>(worst).beats));
    REQUIRE(clocks <= bound);
  });
}

CCHIP_CASE("no old tag after reset, whenever it comes") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource<TestType> requests(options.seed);
    ArrayBench<TestType> bench(options);
    // a sender that is not itself in reset: what it offers on these clocks must not be accepted
    Bench careless(
        [&](const sim::ClockInfo& now) {
          if (now.in_reset) bench.simulation->s_pair_valid = 1;
        },
        [](const sim::ClockInfo&) {});
    bench.simulation.add(careless);
    bench.reset(2);
    const std::uint64_t moments = 2 * short_latency<TestType> + 20;
    for (std::uint64_t moment = 1; moment < moments; ++moment) {  // a pair or several at every place of the array
      for (int i = 0; i < 16; ++i) bench.push(requests.draw());
      bench.steps(moment);
      bench.reset(moment % 3 == 0 ? 2 : 1);  // the scoreboard is empty: any earlier result is an error
      bench.steps(moment % 2 == 0 ? 120 : moment % 5);
      bench.push(requests.draw());
      bench.run();
      REQUIRE(bench.results.size() == 1);
      REQUIRE(bench.results[0].lane == 0);
    }
  });
}

CCHIP_CASE("no output follows an input before the rising edge") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    RequestSource<TestType> requests(options.seed);
    Random random(options.seed);
    ArrayBench<TestType> bench(options, sim::Pattern::random(0.5, options.seed),
                               sim::Pattern::random(0.3, options.seed));
    typename TestType::Model& top = bench.simulation.top();
    sim::PairPort<typename TestType::Model> port(top, TestType::COORD_W);
    const auto outputs = [&] {
      return std::tuple(int{top.s_pair_ready}, int{top.m_result_valid}, int{top.idle}, int{top.rm_id}, port.result());
    };
    int seen_valid = 0;
    Bench toggler([](const sim::ClockInfo&) {},
                  [&](const sim::ClockInfo& now) {
                    if (now.in_reset) return;
                    const auto before = outputs();
                    const CData valid = top.s_pair_valid;
                    const CData ready = top.m_result_ready;
                    const auto tag = top.s_pair_tag;
                    const auto mode = top.s_pair_mode;
                    const auto err = top.s_pair_err;
                    const auto a = top.s_pair_a;
                    const auto b = top.s_pair_b;
                    for (unsigned i = 0; i < 4; ++i) {
                      top.s_pair_valid = i & 1U;
                      top.m_result_ready = i >> 1 & 1U;
                      top.rst = random() & 1U;
                      port.scramble(random);
                      top.eval();
                      sim::require(outputs() == before, "an output follows an input without a clock edge");
                    }
                    top.s_pair_valid = valid;
                    top.m_result_ready = ready;
                    top.rst = 0;
                    top.s_pair_tag = tag;
                    top.s_pair_mode = mode;
                    top.s_pair_err = err;
                    top.s_pair_a = a;
                    top.s_pair_b = b;
                    top.eval();
                    seen_valid += top.m_result_valid;
                  });
    bench.simulation.add(toggler);
    bench.reset(2);
    for (int i = 0; i < 60; ++i) bench.push(requests.draw());
    bench.run();
    REQUIRE(seen_valid >= 60);
  });
}

}  // namespace
}  // namespace cchip::test
