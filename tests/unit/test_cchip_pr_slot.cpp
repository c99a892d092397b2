// SPDX-License-Identifier: Apache-2.0
// A slot whose modules are exchanged through the configuration port, and what happens when a step is left out.
#include <cchip/blocks/reconfig.hpp>
#include <models/cchip_pr_slot.hpp>
#include <set>

#include "slot_bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using Simulated = std::tuple<slot_8, slot_32>;
using All = std::tuple<slot_8, slot_32, slot_partition>;

/// The modules of a slot from this one on.
template <class Config>
std::vector<ModuleId> modules_from(ModuleId first) {
  std::vector<ModuleId> modules;
  for (int m = static_cast<int>(first); m <= Config::KINDS; ++m) modules.push_back(static_cast<ModuleId>(m));
  return modules;
}
template <class Config>
std::vector<ModuleId> tests() {
  return modules_from<Config>(ModuleId::tri_tri);
}

/// A swap to every module, decoupled, without any pair: answers come afterwards if and only if `transfer(bench,
/// payload, reset)` makes no reset on configuration.
template <class Config, class Transfer>
void for_answers_never_requested(Transfer transfer) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    for (const ModuleId id : tests<Config>()) {
      for (const bool reset : {false, true}) {
        SlotBench<Config> bench(options);
        bench.power_up();
        int unrequested = 0;
        bench.on_result = [&](const PairResult&) { ++unrequested; };
        bench.stop();
        bench.decouple();
        transfer(bench, bench.payload(id), reset);
        bench.recouple();
        bench.steps(2000);
        INFO("module " << static_cast<int>(id) << ", reset on configuration " << reset);
        REQUIRE((unrequested > 0) == !reset);
      }
    }
  });
}

}  // namespace

TEST_CASE("cchip_pr_slot: the partition answers pairs like the model, two clocks later than its module",
          "[unit][cchip_pr_slot]") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    for (const int percent : {100, 40}) {
      SlotBench<slot_partition> bench(options, sim::Pattern::random(percent / 100.0, options.seed));
      bench.power_up();
      REQUIRE(int{bench.top.region_rm_id} == slot_partition::RM_ID);
      bench.steps(4);
      REQUIRE(bench.top.idle == 1);
      bench.work(ModuleId::tri_quad, 200);
      bench.work(ModuleId::tri_tri, 100);  // B as the quad V3 = V2
      REQUIRE(int{bench.top.rm_id} == slot_partition::RM_ID);
      REQUIRE(bench.returned == 300);
    }
    SlotBench<slot_partition> bench(options);
    bench.power_up();
    bench.steps(20);
    std::uint64_t sent = 0;
    PairRequest request = bench.requests.draw(ModuleId::tri_quad);
    std::uint64_t latency = 0;
    int beats = -1;
    bench.on_result = [&](const PairResult& r) {
      beats = r.beats;
      latency = bench.simulation.clock() - sent;
    };
    bench.port.on_sent = [&](const PairRequest&) { sent = bench.simulation.clock(); };
    request.mode = static_cast<PairMode>(2);  // reserved: answered at once
    bench.port.push(request);
    bench.steps(8);
    REQUIRE(bench.top.idle == 0);
    bench.steps(200);
    REQUIRE(bench.top.idle == 1);
    REQUIRE(beats == 0);
    // a register each way, one for the complete pair
    REQUIRE(latency == static_cast<std::uint64_t>(defs::pair_latency(slot_partition::SUBSTAGES, 1)) + 3);
  });
}

TEST_CASE("cchip_pr_slot: pairs inside the partition are gone after either reset of its module",
          "[unit][cchip_pr_slot]") {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SlotBench<slot_partition> bench(options);
    bench.power_up();
    std::size_t lost = 0;
    for (int i = 0; i < 40; ++i) {
      for (int n = 0; n < 8; ++n) bench.port.push(bench.requests.draw(ModuleId::tri_quad));
      bench.steps(5 + 3 * (i / 2));
      bench.decouple();  // at any vertex
      lost += bench.port.inside();
      bench.port.clear();
      bench.scoreboard.clear();
      if (i % 2 == 0) {
        bench.hold_reset();
        bench.steps(4);
        bench.top.hold_reset = 0;
        bench.steps(4);
      } else {
        bench.reset_on_configuration();
      }
      bench.recouple();
      bench.steps(500);  // a result would be one without a request
      bench.work(ModuleId::tri_quad, 3);
    }
    REQUIRE(lost > 40);
  });
}

TEMPLATE_LIST_TEST_CASE(
    "cchip_pr_slot: swaps between all modules under traffic, every answer right, none lost or twice",
    "[unit][cchip_pr_slot]", Simulated) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SlotBench<TestType> bench(options, sim::Pattern::random(0.6, options.seed));
    bench.power_up();
    REQUIRE(int{bench.top.region_rm_id} == TestType::RM_ID);
    std::set<std::pair<ModuleId, ModuleId>> swaps;
    auto now = static_cast<ModuleId>(TestType::RM_ID);
    const std::vector<ModuleId> modules = modules_from<TestType>(ModuleId::blank);
    for (const ModuleId from : modules) {
      for (const ModuleId to : modules) {
        for (const ModuleId id : {from, to}) {
          bench.swap(id);
          swaps.emplace(now, id);
          now = id;
          if (id == ModuleId::blank) {
            REQUIRE(int{bench.top.rm_id} == 0);  // the dispatcher gives it no pairs; nothing comes out of it
            const auto before = bench.returned;
            bench.steps(200);
            REQUIRE(bench.returned == before);
          } else {
            // the swap begins while pairs are inside
            const std::vector<ModuleId> kinds = kinds_served(id);
            for (std::size_t i = 0; i < 12; ++i) bench.port.push(bench.requests.draw(kinds[i % kinds.size()]));
            bench.simulation.run_until([&] { return bench.port.waiting() == 0; }, 100000, "all vertices");
          }
        }
      }
    }
    bench.stop();
    bench.scoreboard.finish();
    REQUIRE(swaps.size() == modules.size() * modules.size());
    REQUIRE(bench.returned == bench.accepted);
    REQUIRE(bench.returned > 200);
    REQUIRE(bench.decoupled_clocks > 1000);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_slot: without decoupling, garbage of the transfer gets out", "[unit][cchip_pr_slot]",
                        Simulated) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SlotBench<TestType> bench(options);
    bench.power_up();
    std::set<int> results;
    std::set<int> numbers;
    bench.on_result = [&](const PairResult& r) { results.insert(static_cast<int>(to_bits(r.axis))); };
    bench.during = [&] { numbers.insert(bench.top.rm_id); };
    bench.stop();
    bench.hold_reset();  // a reset alone is not enough
    bench.transfer(bench.payload(ModuleId::tri_tri));
    REQUIRE(results.size() > 4);
    REQUIRE(numbers.size() > 4);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_slot: recoupled two words too early, garbage gets out", "[unit][cchip_pr_slot]",
                        Simulated) {
  int leaks = 0;
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    for (int i = 0; i < 10; ++i) {
      SlotBench<TestType> bench(options);
      bench.power_up();
      bench.on_result = [&](const PairResult&) { ++leaks; };
      bench.stop();
      bench.decouple();
      bench.hold_reset();
      const Bytes bytes = bench.payload(ModuleId::tri_tri);
      const std::size_t words = bytes.size() / SlotBench<TestType>::port_bytes;
      std::size_t word = 0;
      bench.during = [&] {
        if (++word + 2 == words) bench.top.decouple = 0;
      };
      bench.transfer(bytes);
      bench.steps(i);
    }
  });
  REQUIRE(leaks > 0);
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_slot: without reset after a swap, answers to pairs never sent",
                        "[unit][cchip_pr_slot]", Simulated) {
  for_answers_never_requested<TestType>([](SlotBench<TestType>& bench, const Bytes& payload, bool reset) {
    bench.transfer(payload);
    if (reset) bench.reset_on_configuration();
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_slot: the reset of the transfer does not stand in for that on configuration",
                        "[unit][cchip_pr_slot]", Simulated) {
  for_answers_never_requested<TestType>([](SlotBench<TestType>& bench, const Bytes& payload, bool reset) {
    bench.hold_reset();
    bench.transfer(payload);
    bench.steps(8);
    bench.top.hold_reset = 0;
    if (reset) bench.reset_on_configuration();
    bench.steps(8);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_slot: a bad payload leaves garbage behind the decoupler until a good one has passed",
                        "[unit][cchip_pr_slot]", Simulated) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SlotBench<TestType> bench(options);
    bench.power_up();
    bench.swap(ModuleId::tri_tri);
    for (int i = 1; i < faults; ++i) {
      const auto fault = static_cast<Fault>(i);
      INFO("fault " << i);
      for (const ModuleId id : tests<TestType>()) {
        bench.stop();
        bench.decouple();
        bench.hold_reset();
        bench.transfer(spoil(bench.payload(id), fault, TestType::SLOT_ID, bench.random));
        bench.reset_on_configuration();
        if (fault == Fault::other_slot || fault == Fault::cut_sync) {  // not for this slot: it keeps its module
          REQUIRE(bench.numbers(100) == 1);
        } else {
          REQUIRE(bench.numbers(100) > 10);
        }
        bench.swap(id);
        bench.work(id, 5);
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_slot: pairs inside a slot that is decoupled by force never come back",
                        "[unit][cchip_pr_slot]", Simulated) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SlotBench<TestType> bench(options);
    bench.power_up();
    bench.swap(ModuleId::quad_quad);
    std::size_t lost = 0;
    for (int i = 0; i < 20; ++i) {
      for (int n = 0; n < 8; ++n) bench.port.push(bench.requests.draw(ModuleId::quad_quad));
      bench.steps(5 + 3 * i);
      bench.decouple();  // at any vertex
      lost += bench.port.inside();
      bench.port.clear();
      bench.scoreboard.clear();
      bench.swap(ModuleId::quad_quad);
      bench.steps(500);
      bench.work(ModuleId::quad_quad, 3);
    }
    REQUIRE(lost > 20);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_slot: a reset neither couples nor configures, and nothing old comes out",
                        "[unit][cchip_pr_slot]", Simulated) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SlotBench<TestType> bench(options);
    auto& top = bench.top;
    bench.power_up();
    for (const ModuleId id : tests<TestType>()) {
      bench.swap(id);
      for (int n = 0; n < 8; ++n) bench.port.push(bench.requests.draw(id));
      bench.steps(60);
      bench.simulation.reset(1);  // pairs inside are lost
      bench.port.clear();
      bench.scoreboard.clear();
      bench.accepted = bench.returned = 0;
      bench.wait_reset();
      REQUIRE(int{top.region_rm_id} == static_cast<int>(id));
      bench.steps(1000);
      REQUIRE(bench.returned == 0);
      bench.work(id, 10);

      // in the middle of a transfer: still decoupled, still garbage
      bench.stop();
      bench.decouple();
      bench.hold_reset();
      const Bytes bytes = bench.payload(id);
      bench.transfer(Bytes(bytes.begin(), bytes.begin() + 32));
      bench.simulation.reset(1);
      bench.accepted = bench.returned = 0;
      REQUIRE(top.decoupled == 1);
      REQUIRE(bench.numbers(100) > 10);
      bench.swap(id);
      bench.work(id, 5);
    }
  });
}

TEMPLATE_LIST_TEST_CASE(
    "cchip_pr_slot: the module's reset lasts ROC_CYCLES clocks after the start and covers hold_reset",
    "[unit][cchip_pr_slot]", All) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    SlotBench<TestType> bench(options);
    auto& top = bench.top;
    bench.power_up();
    bench.steps(5);
    model::RocGenerator roc(TestType::ROC_CYCLES);
    for (int clock = 0; clock < 20; ++clock) roc.clock(false, false);
    bench.decouple();
    int busy = 0;
    bool before = false;  // roc a clock ago
    for (int clock = 0; clock < 60; ++clock) {
      top.roc_start = clock == 3 || clock == 30 || clock == 31 ? 1 : 0;
      bench.simulation.settle();
      REQUIRE((top.roc_busy != 0) == (roc.roc() || before));
      busy += top.roc_busy;
      before = roc.roc();
      roc.clock(false, top.roc_start != 0);
      bench.simulation.rise();
    }
    REQUIRE(busy == 2 * TestType::ROC_CYCLES + 3);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_pr_slot: no output follows an input before the rising edge", "[unit][cchip_pr_slot]",
                        Simulated) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    const auto drive = [&] {
      sim::set_random(top.s_vertex_data, defs::vertex_w(TestType::COORD_W), random);
      top.s_vertex_valid = random() & 1;
      top.decouple = chance(random, 5) ? 1 : 0;
      top.hold_reset = chance(random, 5) ? 1 : 0;
      top.roc_start = chance(random, 5) ? 1 : 0;
      top.cfg_valid = random() & 1;
      sim::set_random(top.cfg_data, TestType::CFG_W, random);
    };
    const auto outputs = [&] {
      return std::vector<std::uint64_t>{top.decoupled,
                                        top.roc_busy,
                                        top.region_rm_id,
                                        top.rm_id,
                                        top.idle,
                                        top.m_result_valid,
                                        sim::get_bits(top.m_result_data, 0, defs::slot_result_w)};
    };
    drive();
    simulation.reset();
    for (int clock = 0; clock < 400; ++clock) {
      drive();
      simulation.settle();
      const auto before = outputs();
      for (int i = 0; i < 3; ++i) {
        drive();
        top.rst = random() & 1;
        top.eval();
        REQUIRE(outputs() == before);
      }
      top.rst = chance(random, 2) ? 1 : 0;
      top.eval();
      simulation.rise();
    }
  });
}
