// SPDX-License-Identifier: Apache-2.0
// The ledger of a slot: a slot that answers in any order, invents results, or is decoupled with pairs inside.
#include <deque>
#include <map>
#include <models/cchip_slot_ledger.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

struct GrantedPair {
  std::uint16_t tag;
  int kind;
};

/// Gives pairs by the rules, plays the slot, checks every answer.
template <class Config>
class LedgerBench {
 public:
  LedgerBench(sim::Simulation<typename Config::Model>& s, Random& r) : simulation(s), top(s.top()), random(r) {
    top.grant = top.s_result_valid = top.stop = top.decouple = 0;
    top.m_ready = 1;
    top.module_id = 3;
    simulation.reset();
  }
  /// \param grants, results, ready  percent of the clocks
  void clock(int grants, int results, int ready, int garbage = 0) {
    top.m_ready = chance(random, ready) ? 1 : 0;
    if (chance(random, 5)) top.module_id = static_cast<CData>(1 + random() % 7);  // an answer names that of its result
    // a grant every third clock at most, while there is room, the slot is open and not stopped
    const bool grant = since_grant_ >= 3 && top.room != 0 && allowed_ && chance(random, grants);
    top.grant = grant ? 1 : 0;
    if (since_grant_ == 3) {
      top.s_tag = granted_.tag;
      top.s_kind = static_cast<CData>(granted_.kind);
    } else {
      top.s_tag = static_cast<SData>(random());
      top.s_kind = static_cast<CData>(random() & 7U);
    }
    // a result of a pair that has been inside for a while, or one without a request
    top.s_result_valid = 0;
    int answered = -1;
    sim::set_random(top.s_result_data, defs::slot_result_w, random);
    if (!inside.empty() && chance(random, results)) {
      auto it = inside.begin();
      std::advance(it, static_cast<std::ptrdiff_t>(random() % inside.size()));
      if (it->second.second + 6 < clocks_) {
        answered = it->first;
        sim::set_bits(top.s_result_data, defs::slot_result_id.lsb, defs::slot_result_id.width,
                      static_cast<std::uint64_t>(answered));
        top.s_result_valid = 1;
      }
    } else if (chance(random, garbage)) {
      const int id = chance(random, 50) ? last_id_ : static_cast<int>(random() & 255U);
      if (inside.count(id) == 0) {
        sim::set_bits(top.s_result_data, defs::slot_result_id.lsb, defs::slot_result_id.width,
                      static_cast<std::uint64_t>(id));
        top.s_result_valid = 1;
        ++invented;
      }
    }
    simulation.settle();
    if (since_grant_ == 2) {
      REQUIRE(int{top.id} < Config::CREDIT);
      REQUIRE(inside.count(top.id) == 0);
      inside[top.id] = {granted_, clocks_};
    }
    if (top.m_valid != 0 && top.m_ready != 0) take();
    if (grant) {
      granted_ = {static_cast<std::uint16_t>(random()), static_cast<int>(random() % 4) + 1};
      ++granted;
    }
    if (answered >= 0) {
      expected_.push_back(
          {inside.at(answered).first, sim::get_bits(top.s_result_data, 8, defs::slot_result_w - 8), top.module_id});
      inside.erase(answered);
      last_id_ = answered;
    }
    most = std::max<int>(most, top.outstanding);
    since_grant_ = grant ? 1 : since_grant_ + 1;
    ++clocks_;
    simulation.rise();
    if (top.decouple != 0) REQUIRE(top.open == 0);  // from the next clock on
    const bool may = top.open != 0 && top.stop == 0 && top.decouple == 0;
    allowed_ = may;
  }
  /// All pairs inside are to be answered as open, in any order.
  void give_up() {
    for (const auto& [id, pair] : inside) given_up_.emplace(pair.first.tag, pair.first.kind);
    lost = inside.size();
    inside.clear();
  }
  std::size_t owed() const { return expected_.size() + given_up_.size(); }

  sim::Simulation<typename Config::Model>& simulation;
  typename Config::Model& top;
  Random& random;
  std::map<int, std::pair<GrantedPair, std::uint64_t>> inside;
  std::uint64_t granted = 0, answers = 0, opens = 0, invented = 0;
  std::size_t lost = 0;
  int most = 0;

 private:
  struct Expected {
    GrantedPair pair;
    std::uint64_t found;
    int module_id;
  };
  void take() {
    const auto get = [&](int lsb, int width) { return sim::get_bits(top.m_data, lsb, width); };
    const auto tag =
        static_cast<std::uint16_t>(get(defs::answer_result.lsb + defs::result_tag.lsb, defs::result_tag.width));
    const int kind = static_cast<int>(get(defs::answer_kind.lsb, defs::answer_kind.width));
    const int by = static_cast<int>(get(defs::answer_module.lsb, defs::answer_module.width));
    const std::uint64_t found = get(defs::result_hit.lsb, defs::result_w - defs::result_hit.lsb);
    ++answers;
    if (by == 0) {
      const auto range = given_up_.equal_range(tag);
      auto it = range.first;
      while (it != range.second && it->second != kind) ++it;
      REQUIRE(it != range.second);
      given_up_.erase(it);
      REQUIRE(found == (3U | std::uint64_t{static_cast<unsigned>(AxisClass::illegal)} << 9));  // hit, grid, axis class
      ++opens;
      return;
    }
    REQUIRE(!expected_.empty());
    const Expected e = expected_.front();
    expected_.pop_front();
    REQUIRE(tag == e.pair.tag);
    REQUIRE(kind == e.pair.kind);
    REQUIRE(by == e.module_id);
    REQUIRE(found == e.found);
  }

  std::deque<Expected> expected_;
  std::multimap<std::uint16_t, int> given_up_;
  GrantedPair granted_{};
  std::uint64_t clocks_ = 0;
  int since_grant_ = 100;
  int last_id_ = 0;
  bool allowed_ = false;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE(
    "cchip_slot_ledger: every pair is answered once, with its tag and kind, an answer without a request is dropped",
    "[unit][cchip_slot_ledger]", cchip_slot_ledger_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    LedgerBench<TestType> bench(simulation, random);
    for (int part = 0; part < 12; ++part) {
      const int results = part % 3 == 0 ? 90 : 20;
      const int ready = part % 4 == 0 ? 5 : 80;
      const int garbage = part % 3 == 1 ? 70 : 10;  // often: a number said again on any of the next clocks
      for (int clock = 0; clock < 1000; ++clock) bench.clock(90, results, ready, garbage);
    }
    REQUIRE(bench.most == TestType::CREDIT);  // no pair more than the credit, and all of it is used
    for (int clock = 0; clock < 3000; ++clock) bench.clock(0, 100, 100);
    REQUIRE(bench.owed() == 0);
    REQUIRE(bench.answers == bench.granted);
    REQUIRE(bench.opens == 0);
    REQUIRE(bench.granted > 300);
    REQUIRE(bench.invented > 100);
    REQUIRE(bench.top.outstanding == 0);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_slot_ledger: stop and quiet, decoupled with pairs inside they are left open and counted",
                        "[unit][cchip_slot_ledger]", cchip_slot_ledger_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    LedgerBench<TestType> bench(simulation, random);
    auto& top = bench.top;
    int lossless = 0, lossy = 0;
    for (int round = 0; round < 120; ++round) {
      for (int clock = static_cast<int>(random() % 400); clock > 0; --clock) bench.clock(60, 10, 60, 5);
      const bool force = chance(random, 60);
      const int ready = chance(random, 30) ? 0 : 70;  // a receiver that is gone does not matter
      top.stop = 1;
      if (!force) {
        int clocks = 0;
        while (top.quiet == 0) {
          REQUIRE(++clocks < 5000);
          bench.clock(0, 50, ready);
        }
        REQUIRE(bench.inside.empty());
        REQUIRE(top.outstanding == 0);
      } else {
        bench.clock(0, 0, ready);
      }
      top.decouple = 1;  // the slot is cut off: no result from now on
      bench.clock(0, 0, ready);
      bench.clock(0, 0, ready);
      bench.give_up();
      int clocks = 0;
      while (top.decoupled == 0) {
        REQUIRE(++clocks < 2 * TestType::CREDIT + 60);
        bench.clock(0, 0, ready);
      }
      REQUIRE(std::size_t{top.lost} == bench.lost);
      REQUIRE(top.outstanding == 0);
      (bench.lost == 0 ? lossless : lossy) += 1;
      for (int i = 0; i < 20; ++i) bench.clock(0, 0, ready, 20);
      REQUIRE(top.decoupled == 1);
      REQUIRE(top.open == 0);
      top.decouple = 0;
      bench.clock(0, 0, ready);
      REQUIRE(top.decoupled == 0);
      top.stop = 0;
    }
    for (int clock = 0; clock < 3000; ++clock) bench.clock(0, 100, 100);
    REQUIRE(bench.owed() == 0);
    REQUIRE(bench.answers == bench.granted);
    REQUIRE(bench.opens > 30);
    REQUIRE(lossless > 10);
    REQUIRE(lossy > 10);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_slot_ledger: a reset drops all pairs, a slot that was decoupled stays so",
                        "[unit][cchip_slot_ledger]", cchip_slot_ledger_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    for (int round = 0; round < 20; ++round) {
      LedgerBench<TestType> bench(simulation, random);
      auto& top = bench.top;
      for (int clock = static_cast<int>(random() % 300); clock > 0; --clock) bench.clock(60, 10, 60, 5);
      top.grant = 0;
      top.decouple = top.stop = round & 1;
      top.rst = 1;
      simulation.step();
      top.rst = 0;
      top.m_ready = 1;
      for (int clock = 0; clock < 2 * TestType::CREDIT + 60; ++clock) {
        simulation.settle();
        REQUIRE(top.m_valid == 0);
        REQUIRE(int{top.decoupled} == (round & 1));
        REQUIRE(top.outstanding == 0);
        simulation.rise();
      }
      REQUIRE((top.open != 0) == ((round & 1) == 0));
      top.decouple = top.stop = 0;
    }
  });
}
