// SPDX-License-Identifier: Apache-2.0
// Who gets what when: queues and takers are numbers here.
#include <models/cchip_dispatch_sequencer.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Queues with pairs, takers with room; checks every launch.
template <class Config>
struct SequencerBench {
  static constexpr int queues = Config::KINDS + 1;
  static constexpr int takers = Config::TAKERS;
  sim::Simulation<typename Config::Model>& simulation;
  typename Config::Model& top;
  std::array<int, queues> waiting{};
  std::array<int, takers> room{};
  std::uint64_t serves = 0;
  std::array<std::array<int, takers>, queues> launched{};
  std::array<int, queues> others{};  ///< launches of other kinds since the kind could be launched
  int most_others = 0;
  int launch_clock = 100;  ///< clocks since the last launch
  int kind = 0, taker = 0;
  bool looked = false;

  explicit SequencerBench(sim::Simulation<typename Config::Model>& s) : simulation(s), top(s.top()) {
    top.some = top.room = 0;
    top.serves = 0;
    simulation.reset();
  }
  bool possible(int k) const {
    for (int t = 0; t < takers; ++t) {
      if ((serves >> (queues * t + k) & 1U) != 0 && room[static_cast<std::size_t>(t)] > 0)
        return waiting[static_cast<std::size_t>(k)] > 0;
    }
    return false;
  }
  static int index(unsigned one) {
    int i = 0;
    while ((one >> i & 1U) == 0) ++i;
    return i;
  }
  /// One clock. \returns a pair was launched
  bool clock() {
    unsigned some = 0, has_room = 0;
    for (int k = 0; k < queues; ++k) some |= waiting[static_cast<std::size_t>(k)] > 0 ? 1U << k : 0;
    for (int t = 0; t < takers; ++t) has_room |= room[static_cast<std::size_t>(t)] > 0 ? 1U << t : 0;
    top.some = static_cast<CData>(some);
    top.room = static_cast<CData>(has_room);
    sim::set_bits(top.serves, 0, queues * takers, serves);
    simulation.settle();
    const Vertex& arrives = read_[0];
    expect("m_valid", top.m_valid != 0, arrives.valid);
    if (arrives.valid) {
      expect("m_first", top.m_first != 0, arrives.first);
      expect("m_last", top.m_last != 0, arrives.last);
      expect("m_kind", int{top.m_kind}, arrives.kind);
      expect("m_taker", unsigned{top.m_taker}, 1U << arrives.taker);
    }
    const bool launch = top.launch != 0;
    if (launch) {
      sim::require(looked, "launch without look");
      sim::require(launch_clock >= vertices(), "launched while the last pair is read");
      kind = index(top.kind);
      taker = index(top.grant);
      expect("grant", unsigned{top.grant}, 1U << taker);
      sim::require((serves >> (queues * taker + kind) & 1U) != 0 || served_before_, "a taker that does not serve");
      sim::require(--waiting[static_cast<std::size_t>(kind)] >= 0, "an empty queue");
      sim::require(--room[static_cast<std::size_t>(taker)] >= 0, "a taker without room");
      ++launched[static_cast<std::size_t>(kind)][static_cast<std::size_t>(taker)];
      launch_clock = 0;
    }
    const bool reads = launch_clock < vertices();
    if (reads) expect("m_vertex", int{top.m_vertex}, launch_clock);
    read_ = {read_[1], {reads, launch_clock == 0, launch_clock == vertices() - 1, kind, taker}};
    for (int k = 0; k < queues; ++k) {
      int& n = others[static_cast<std::size_t>(k)];
      if (!possible(k) || (launch && k == kind)) {
        n = 0;
      } else if (launch) {
        most_others = std::max(most_others, ++n);
      }
    }
    looked = top.look != 0;
    ++launch_clock;
    simulation.rise();
    return launch;
  }
  bool served_before_ = false;
  static int vertices(int of_kind) { return of_kind == 2 || of_kind == 3 ? 4 : 3; }

 private:
  struct Vertex {
    bool valid = false, first = false, last = false;
    int kind = 0, taker = 0;
  };
  int vertices() const { return vertices(kind); }
  std::array<Vertex, 2> read_{};  ///< vertices read 2 clocks ago, 1 clock ago
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_dispatch_sequencer: a pair only from a queue that has one to a taker that has room",
                        "[unit][cchip_dispatch_sequencer]", cchip_dispatch_sequencer_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    using Bench = SequencerBench<TestType>;
    Bench bench(simulation);
    const std::uint64_t all = (std::uint64_t{1} << (Bench::queues * Bench::takers)) - 1;
    for (int part = 0; part < 40; ++part) {
      bench.serves = random() & all & (part % 2 == 0 ? all : random());
      bench.served_before_ = true;  // what is in flight when it changes
      for (int i = 0; i < 8; ++i) bench.clock();
      bench.served_before_ = false;
      const int arrivals = static_cast<int>(random() % 60);
      for (int clock = 0; clock < 500; ++clock) {
        for (int& n : bench.waiting) n += n < 3 && chance(random, arrivals) ? 1 : 0;
        for (int& n : bench.room) n += n < 2 && chance(random, 20) ? 1 : 0;
        bench.clock();
      }
    }
    int launches = 0;
    for (const auto& of_kind : bench.launched) {
      for (const int n : of_kind) launches += n;
    }
    REQUIRE(launches > 1000);
    REQUIRE(bench.most_others <= TestType::KINDS + 2);
  });
}

TEMPLATE_LIST_TEST_CASE(
    "cchip_dispatch_sequencer: a reset of one clock in mid traffic leaves no look, launch or vertex behind",
    "[unit][cchip_dispatch_sequencer]", cchip_dispatch_sequencer_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    using Bench = SequencerBench<TestType>;
    auto& top = simulation.top();
    for (int round = 0; round < 100; ++round) {
      Bench bench(simulation);
      bench.serves = (std::uint64_t{1} << (Bench::queues * Bench::takers)) - 1;
      bench.room.fill(1000);
      bench.waiting.fill(1000);
      for (int clock = static_cast<int>(random() % 40); clock > 0; --clock) bench.clock();
      top.rst = 1;
      top.some = 0;  // as of queues that are empty
      simulation.step();
      top.rst = 0;
      for (int clock = 0; clock < 4; ++clock) {
        simulation.settle();
        REQUIRE((top.look == 0 && top.launch == 0 && top.grant == 0 && top.m_valid == 0));
        simulation.rise();
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_dispatch_sequencer: a pair every 3 clocks, with quads every 4, kinds and takers in turn",
                        "[unit][cchip_dispatch_sequencer]", cchip_dispatch_sequencer_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random&) {
    using Bench = SequencerBench<TestType>;
    for (int kind = 0; kind <= Bench::queues; ++kind) {  // the last: all kinds
      Bench bench(simulation);
      bench.launch_clock = 100;
      bench.serves = (std::uint64_t{1} << (Bench::queues * Bench::takers)) - 1;
      for (int& n : bench.room) n = 1000000;
      for (int k = 0; k < Bench::queues; ++k) {
        bench.waiting[static_cast<std::size_t>(k)] = kind == Bench::queues || k == kind ? 1000000 : 0;
      }
      bench.clock();
      int first = 1;
      while (!bench.clock()) ++first;
      REQUIRE(first <= 6);
      int clocks = 0;
      constexpr int pairs = 200;
      for (int n = 0; n < pairs; ++clocks) n += bench.clock() ? 1 : 0;
      if (kind < Bench::queues) REQUIRE(clocks == pairs * Bench::vertices(kind));
      for (int t = 0; t < Bench::takers; ++t) {
        int of_taker = 0;
        for (const auto& of_kind : bench.launched) of_taker += of_kind[static_cast<std::size_t>(t)];
        REQUIRE(of_taker >= (pairs + 1) / Bench::takers - 1);
        REQUIRE(of_taker <= (pairs + 1) / Bench::takers + 1);
      }
      if (kind < Bench::queues) continue;
      for (const auto& of_kind : bench.launched) {
        int n = 0;
        for (const int of_taker : of_kind) n += of_taker;
        REQUIRE(n >= (pairs + 1) / Bench::queues - 1);
        REQUIRE(n <= (pairs + 1) / Bench::queues + 1);
      }
    }
  });
}
