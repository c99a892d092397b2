// SPDX-License-Identifier: Apache-2.0
// The sphere of a point and a triangle: RTL = model on every clock = exact distance; the rules of
// docs/modules/cchip_primtest_point_tri.md by counting, without the model's clocks.
#include <cchip/internal/model/point_tri.hpp>
#include <deque>
#include <iostream>
#include <map>
#include <models/cchip_primtest_point_tri.hpp>
#include <set>

#include "bench.hpp"
#include "point_pair.hpp"

using namespace cchip;
using namespace cchip::test;
using cchip_test::Int256;
using cchip_test::PointTriangle;
using cchip_test::PointTriangleSource;
using cchip_test::Region;

namespace {

constexpr std::uint64_t axes = 7;

/// A pair on the wires; what the module ignores is garbage.
PairRequest request_of(const PointTriangle& pair, std::uint16_t tag, int coord_w, Random& random) {
  PairRequest request;
  request.pair = cchip_test::grid_pair(pair, coord_w);
  for (int i = 0; i < 8; ++i) {
    const int slot = 1 + (i + 1) / 3;
    request.pair.a.v[static_cast<std::size_t>(slot)][(i + 1) % 3] = random_point(random, coord_w).x();
  }
  request.pair.b.v[3] = random_point(random, coord_w);
  request.tag = tag;
  request.mode = chance(random, 50) ? PairMode::exhaustive : PairMode::directed;
  return request;
}

/// The pair that is on the wires, read with nothing of the model.
PointTriangle pair_of(const PairRequest& request, int coord_w) {
  PointTriangle pair;
  for (int d = 0; d < 3; ++d) {
    const auto at = static_cast<std::size_t>(d);
    pair.point[at] = request.pair.a.v[0][d];
    for (std::size_t i = 0; i < 3; ++i) pair.triangle[i][at] = request.pair.b.v[i][d];
  }
  const std::int64_t x = request.pair.a.v[1].x();
  pair.radius = x < 0 ? x + (std::int64_t{1} << coord_w) : x;
  return pair;
}

/// Number of the axis, as the oracle counts.
std::size_t axis_number(const AxisCode& code) {
  sim::require(code.k == 0 && code.l < 3, "axis code with k or l out of range");
  switch (code.cls) {
    case AxisClass::normal_b:
      sim::require(code.l == 0, "normal of the face with an index");
      return 0;
    case AxisClass::cross:
      return 1 + static_cast<std::size_t>(code.l);
    case AxisClass::normal_a:
      return 4 + static_cast<std::size_t>(code.l);
    default:
      throw sim::SimulationError("a no without an axis");
  }
}

/// What the exact distance says of an answer.
void judge(const PairRequest& request, const PairResult& result, int coord_w) {
  expect("tag", result.tag, request.tag);
  if (request.mode > PairMode::directed) {
    const PairResult illegal = {request.tag, true, true, false, {AxisClass::illegal, 0, 0}, 0};
    expect("answer to a reserved mode", result, illegal);
    return;
  }
  const PointTriangle pair = pair_of(request, coord_w);
  const auto t = pair.relative();
  expect("grid", result.grid, compare(cchip_test::nearest<Int256>(t).square, pair.radius) <= 0);
  expect("definite", result.definite, request.pair.eta == 0);
  expect("hit", result.hit, result.grid || !result.definite);
  expect("beats", result.beats, 7);
  if (result.grid) {
    sim::require(result.axis == AxisCode{}, "a hit with an axis");
  } else {
    sim::require(cchip_test::separates<Int256>(t, pair.radius, axis_number(result.axis)),
                 "the witness does not separate");
  }
}

/// A Verilated module under its clock with drivers; compares every clock with the model and every answer with the
/// exact one.
template <class Config>
class Machine : public sim::Agent {
 public:
  using Model = typename Config::Model;
  static constexpr int W = Config::COORD_W;

  explicit Machine(const sim::SimulationOptions& options)
      : simulation(options),
        port(simulation.top(), W),
        driver(port.driver()),
        sink(port.sink()),
        random_(options.seed),
        source_(W, options.seed),
        model_(W, Config::CONTEXTS) {
    driver.when_idle([this] { port.scramble(random_); });
    driver.on_accept([this](const PairRequest& r, std::uint64_t clock) {
      expected_.push_back(r);
      accepted_at.push_back(clock);
    });
    sink.on_item([this](const PairResult& result, std::uint64_t clock) {
      sim::require(!expected_.empty(), "a result without a pair");
      judge(expected_.front(), result, W);
      if (on_result) on_result(expected_.front(), result);
      expected_.pop_front();
      answered_at.push_back(clock);
    });
    simulation.add(driver);
    simulation.add(sink);
    simulation.add(*this);
  }

  PairRequest draw() {
    PairRequest request = request_of(source_.draw(), tag_of(tag_++), W, random_);
    if (chance(random_, 20)) request.pair.eta = static_cast<int>(random_() % 16);
    if (chance(random_, 5)) request.mode = static_cast<PairMode>(random_() % 4);
    return request;
  }
  void push(int pairs) {
    for (int i = 0; i < pairs; ++i) driver.push(draw());
  }
  /// Until every pair has been answered.
  void run() {
    while (driver.waiting() != 0 || in_flight() != 0) simulation.step();
  }
  /// Drops the pairs inside; those in the queue of the driver stay.
  void reset(int clocks = 2) {
    simulation.reset(clocks);
    accepted_at.clear();
    answered_at.clear();
  }
  std::size_t in_flight() const { return expected_.size(); }

  void sample(const sim::ClockInfo& now) override {
    auto& top = simulation.top();
    if (defined_) {
      expect("s_pair_ready", top.s_pair_ready != 0, model_.s_pair_ready());
      expect("m_result_valid", top.m_result_valid != 0, model_.m_result_valid());
      expect("idle", top.idle != 0, model_.idle());
      expect("rm_id", int{top.rm_id}, 4);
      if (model_.m_result_valid()) expect("m_result", port.result(), model_.m_result());
    }
    if (now.in_reset) {
      model_.reset();
      expected_.clear();
      defined_ = true;
      return;
    }
    std::optional<PairRequest> request;
    if (top.s_pair_valid != 0) request = port.request(Kind::tri, Kind::tri);
    model_.clock(request, top.m_result_ready != 0);
    most_in_flight = std::max(most_in_flight, in_flight());
    sim::require(in_flight() <= std::size_t{Config::CONTEXTS}, "more than CONTEXTS pairs in flight");
  }

  sim::Simulation<Model> simulation;
  sim::PairPort<Model> port;
  sim::StreamDriver<PairRequest> driver;
  sim::StreamSink<PairResult> sink;
  std::vector<std::uint64_t> accepted_at;
  std::vector<std::uint64_t> answered_at;
  std::size_t most_in_flight = 0;
  std::function<void(const PairRequest&, const PairResult&)> on_result;

 private:
  Random random_;
  PointTriangleSource source_;
  model::PointTri model_;
  bool defined_ = false;
  std::deque<PairRequest> expected_;
  std::size_t tag_ = 0;
};

/// Clocks of a lone pair, from the page: the front, G, two stages of products, the end.
std::uint64_t lone_latency(int coord_w) {
  const auto product = [](int width) { return width <= 18 ? 2U : width <= 35 ? 4U : 6U; };
  const unsigned dot = coord_w <= 16 ? 2 : coord_w == 17 ? 3 : 4;
  return 27 + dot + 2 * product(2 * coord_w + 3);
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_primtest_point_tri: every output on every clock is the model's, answers are exact",
                        "[unit][cchip_primtest_point_tri]", cchip_primtest_point_tri_configs) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    for (const sim::Pattern& source : sim::standard_patterns(options.seed)) {
      for (const sim::Pattern& sink : sim::standard_patterns(options.seed + 100)) {
        Machine<TestType> machine(options);
        machine.driver.set_pattern(source);
        machine.sink.set_pattern(sink);
        std::size_t results = 0;
        machine.on_result = [&](const PairRequest&, const PairResult&) { ++results; };
        machine.push(100);
        machine.reset();
        machine.simulation.steps(300);
        machine.reset(1);
        machine.simulation.steps(500);
        INFO("source " << source.name() << ", sink " << sink.name());
        REQUIRE(results > 5);
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_point_tri: clocks of a lone pair, of a stream, and the credit",
                        "[unit][cchip_primtest_point_tri]", cchip_primtest_point_tri_configs) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Machine<TestType> machine(options);
    const std::uint64_t latency = lone_latency(TestType::COORD_W);
    machine.reset();
    for (int i = 0; i < 20; ++i) {
      machine.push(1);
      machine.run();
      REQUIRE(machine.answered_at.back() - machine.accepted_at.back() == latency);
      machine.simulation.steps(static_cast<std::uint64_t>(i % 3));
    }
    // a stream: a pair per 7 clocks if its places allow
    machine.reset();
    machine.push(300);
    machine.run();
    const auto& at = machine.answered_at;
    const auto& from = machine.accepted_at;
    const std::uint64_t contexts = TestType::CONTEXTS;
    if (contexts * axes > latency + axes) {
      for (std::size_t i = 1; i < at.size(); ++i) REQUIRE(at[i] - at[i - 1] == axes);
    }
    for (std::size_t i = 0; i + contexts < at.size(); ++i) REQUIRE(from[i + contexts] > at[i]);
    REQUIRE(machine.most_in_flight == contexts);
    // drain: the last of a full module has waited for the others
    REQUIRE(at.back() - from.back() <= latency + axes * (contexts - 1));
    // without ready every result is kept
    machine.sink.set_pattern(sim::Pattern::never_for(1000));
    machine.reset();
    machine.push(3 * TestType::CONTEXTS);
    machine.simulation.steps(900);
    REQUIRE(machine.in_flight() == contexts);
    machine.run();
    REQUIRE(machine.answered_at.size() == 3 * contexts);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_point_tri: no pair from before a reset is answered, whenever it comes",
                        "[unit][cchip_primtest_point_tri]", cchip_primtest_point_tri_configs) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Machine<TestType> machine(options);
    const std::uint64_t most = lone_latency(TestType::COORD_W) + 12;
    for (std::uint64_t clocks = 0; clocks < most; ++clocks) {
      machine.push(4);
      machine.reset(1 + static_cast<int>(clocks % 2));  // the monitor and the model allow no old result
      machine.simulation.steps(clocks);
    }
    machine.reset();
    machine.run();
    REQUIRE(machine.simulation.top().idle == 1);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_point_tri: no output follows an input before the rising edge",
                        "[unit][cchip_primtest_point_tri]", cchip_primtest_point_tri_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    sim::PairPort<typename TestType::Model> port(top, TestType::COORD_W);
    const auto drive = [&] {
      port.scramble(random);
      top.s_pair_valid = random() & 1;
      top.m_result_ready = random() & 1;
    };
    const auto outputs = [&] {
      return std::make_pair(port.result(),
                            std::array<int, 4>{top.s_pair_ready, top.m_result_valid, top.idle, top.rm_id});
    };
    simulation.reset();
    for (int clock = 0; clock < 500; ++clock) {
      drive();
      simulation.settle();
      const auto before = outputs();
      for (int i = 0; i < 4; ++i) {
        drive();
        top.rst = random() & 1;
        top.eval();
        REQUIRE(outputs() == before);
      }
      top.rst = 0;
      top.eval();
      simulation.rise();
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_primtest_point_tri: boundary values, counted", "[unit][cchip_primtest_point_tri]",
                        cchip_primtest_point_tri_configs) {
  sim::SimulationOptions options;
  options.timeout_clocks = 10000000;
  Machine<TestType> machine(options);
  constexpr int W = TestType::COORD_W;
  const std::int64_t least = -(std::int64_t{1} << (W - 1));
  const std::int64_t most = -least - 1;
  Bins ends;
  std::map<std::string, std::size_t> bins;
  std::set<int> witnesses;
  std::size_t near = 0;
  machine.on_result = [&](const PairRequest& request, const PairResult& result) {
    if (request.mode > PairMode::directed) return;
    const PointTriangle pair = pair_of(request, W);
    const auto t = pair.relative();
    const auto nearest = cchip_test::nearest<Int256>(t);
    const std::string where = nearest.region == Region::vertex ? "vertex"
                              : nearest.region == Region::side ? "side"
                                                               : "face";
    const int order = compare(nearest.square, pair.radius);
    // touching, or apart only until the radius has grown one step
    if (order == 0) ++bins["touching " + where];
    if (order > 0 && compare(nearest.square, pair.radius + 1) <= 0) ++bins["missed by one step, " + where];
    if (pair.radius == 0) ++bins[result.grid ? "radius 0, on it" : "radius 0, beside it"];
    if (pair.radius == most - least) ++bins[result.grid ? "largest radius, hit" : "largest radius, miss"];
    const auto normal = cchip_test::axis_of<Int256>(t, 0);
    const bool flat = cchip_test::dot<Int256>(normal, normal) == 0;
    const bool one_point = t[0] == t[1] && t[1] == t[2];
    if (flat) ++bins[std::string(one_point ? "a point, " : "a segment, ") + (result.grid ? "hit" : "miss")];
    if (flat && order == 0) ++bins[one_point ? "a point, touching" : "a segment, touching"];
    if (!result.grid) witnesses.insert(static_cast<int>(axis_number(result.axis)));
    near += order == 0 ? 1 : 0;
    ends.see("radius", pair.radius, 0, most - least);
    for (std::size_t d = 0; d < 3; ++d) {
      ends.see("point " + std::to_string(d), pair.point[d], least, most);
      for (std::size_t i = 0; i < 3; ++i) {
        ends.see("vertex " + std::to_string(3 * i + d), pair.triangle[i][d], least, most);
      }
    }
    ends.end();
  };
  machine.reset();
  const int pairs = 20000;
  machine.push(pairs);
  machine.run();
  std::cout << "point_tri W=" << W << " CONTEXTS=" << TestType::CONTEXTS << ": pairs=" << machine.answered_at.size()
            << " wrong=0 touching=" << near << ' ' << ends.summary() << '\n';
  for (const auto& [name, count] : bins) std::cout << "  " << name << ": " << count << '\n';
  REQUIRE(machine.answered_at.size() == pairs);
  for (const char* where : {"vertex", "side", "face"}) {
    REQUIRE(bins[std::string("touching ") + where] >= 50);
    REQUIRE(bins[std::string("missed by one step, ") + where] >= 50);
  }
  for (const char* name :
       {"radius 0, on it", "radius 0, beside it", "largest radius, hit", "largest radius, miss", "a point, hit",
        "a point, miss", "a segment, hit", "a segment, miss", "a segment, touching"}) {
    INFO(name);
    REQUIRE(bins[name] >= 5);
  }
  REQUIRE(witnesses.size() == axes);
  REQUIRE(ends.missing() == "");
}
