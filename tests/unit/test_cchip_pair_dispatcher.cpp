// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_pair_dispatcher.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Heads of queues, slots and the path of refused pairs, at random; rules, not a model, decide which slot may get which
/// pair.
template <class Config>
class DispatcherBench {
 public:
  static constexpr int slots = Config::SLOTS;
  static constexpr int width = Config::WIDTH;

  explicit DispatcherBench(const sim::SimulationOptions& options)
      : random_(options.seed),
        simulation_(options),
        bench_([this](const auto&) { drive(); }, [this](const auto& now) { sample(now); }) {
    simulation_.add(bench_);
    simulation_.reset();
  }
  void steps(std::uint64_t clocks) { simulation_.steps(clocks); }

  std::array<int, 4> refused{};                           ///< by kind, 0: illegal
  std::array<std::array<int, 4>, Config::SLOTS> given{};  ///< by slot and kind
  int both_ready = 0, first_of_both = 0;

 private:
  auto& top() { return simulation_.top(); }

  void drive() {
    if (chance(random_, 10)) {
      for (auto& s : serves_) s = static_cast<unsigned>(random_() % 4);
      if (slots == 2 && chance(random_, 40)) serves_.back() = serves_.front();
      no_provider_ = static_cast<unsigned>(random_() & 7U);
      for (const unsigned s : serves_) {
        if (s != 0) no_provider_ &= ~(1U << (s - 1));
      }
    }
    for (std::size_t i = 0; i < 4; ++i) {
      if (!waits_[i] && chance(random_, 60)) {
        waits_[i] = true;
        pair_[i] = random_() & ((1U << width) - 1);
      }
    }
    unsigned serves = 0;
    for (std::size_t s = 0; s < slots; ++s) serves |= serves_[s] << (2 * s);
    top().serves = static_cast<CData>(serves);
    top().no_provider = static_cast<CData>(no_provider_);
    unsigned valid = 0;
    for (std::size_t k = 1; k < 4; ++k) {
      valid |= waits_[k] ? 1U << (k - 1) : 0;
      sim::set_bits(top().s_data, width * static_cast<int>(k - 1), width, pair_[k]);
    }
    top().s_valid = static_cast<CData>(valid);
    top().s_illegal_valid = waits_[0] ? 1 : 0;
    top().s_illegal_tag = static_cast<SData>(pair_[0]);
    top().m_pair_ready = static_cast<CData>(random_() & ((1U << slots) - 1));
    top().m_refused_ready = chance(random_, 60) ? 1 : 0;
  }

  void sample(const sim::ClockInfo& now) {
    if (now.in_reset) {
      served_.fill(0);
      refusing_ = 0;
      turn_ = 0;
      return;
    }
    std::array<int, 4> taken{};
    int ready_for[4] = {};
    for (std::size_t s = 0; s < slots; ++s) {
      const bool ready = (top().m_pair_ready >> s & 1U) != 0;
      const bool valid = (top().m_pair_valid >> s & 1U) != 0;
      const unsigned kind = served_[s];
      sim::require(!valid || ready, "a pair is offered to a slot that is not ready");
      sim::require(!valid || (kind != 0 && waits_[kind]), "a pair that does not wait, or for a slot that serves none");
      if (ready && kind != 0) ++ready_for[kind];
      if (!valid) continue;
      expect("m_pair_data", sim::get_bits(top().m_pair_data, width * static_cast<int>(s), width), pair_[kind]);
      ++taken[kind];
      ++given[s][kind];
    }
    for (std::size_t k = 1; k < 4; ++k) {
      // two slots must never get the same pair, and a slot that could take a pair must get it
      expect("pairs taken", taken[k], waits_[k] && ready_for[k] > 0 ? 1 : 0);
      if (ready_for[k] == 2 && waits_[k]) {
        ++both_ready;
        first_of_both += (top().m_pair_valid & 1U) != 0 ? 1 : 0;
      }
    }
    const auto refusable = [&](std::size_t kind) {
      return waits_[kind] && (kind == 0 || (refusing_ >> (kind - 1) & 1U) != 0);
    };
    const bool offered = refusable(turn_);
    expect("m_refused_valid", top().m_refused_valid != 0, offered);
    std::size_t next_turn = turn_;
    for (std::size_t i = 4; i-- > 1;) {
      if (refusable((turn_ + i) % 4)) next_turn = (turn_ + i) % 4;
    }
    if (offered) {
      expect("m_refused_kind", std::size_t{top().m_refused_kind}, turn_);
      expect("m_refused_tag", std::uint64_t{top().m_refused_tag}, pair_[turn_] & 0xFFFFU);
      if (top().m_refused_ready != 0) {
        ++taken[turn_];
        ++refused[turn_];
      }
    }
    if (!offered || top().m_refused_ready != 0) turn_ = next_turn;
    for (std::size_t k = 1; k < 4; ++k) {
      const bool ready = (top().s_ready >> (k - 1) & 1U) != 0;
      expect("s_ready & s_valid", ready && waits_[k], taken[k] != 0);
      sim::require(taken[k] <= 1, "a pair goes two ways");
    }
    expect("s_illegal_ready & valid", top().s_illegal_ready != 0 && waits_[0], taken[0] != 0);
    for (std::size_t k = 0; k < 4; ++k) waits_[k] = waits_[k] && taken[k] == 0;
    // registered: valid on the next clock
    unsigned works = 0;
    for (std::size_t s = 0; s < slots; ++s) {
      if (serves_[s] != 0) works |= 1U << (serves_[s] - 1);
      if (served_[s] != 0) works |= 1U << (served_[s] - 1);
      served_[s] = serves_[s];
    }
    refusing_ = no_provider_ & ~works;
  }

  Random random_;
  sim::Simulation<typename Config::Model> simulation_;
  Bench bench_;
  std::array<bool, 4> waits_{};  // 0: illegal
  std::array<std::uint64_t, 4> pair_{};
  std::array<unsigned, Config::SLOTS> serves_{}, served_{};
  unsigned no_provider_ = 0;
  unsigned refusing_ = 0;
  std::size_t turn_ = 0;  // of the refused pairs, by kind
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_pair_dispatcher: each pair once, to a slot of its kind that is ready, or refused",
                        "[unit][cchip_pair_dispatcher]", cchip_pair_dispatcher_configs) {
  for_two_power_ups([](const sim::SimulationOptions& options) {
    DispatcherBench<TestType> bench(options);
    bench.steps(20000);
    for (const int count : bench.refused) REQUIRE(count > 300);  // in turn: no kind starves
    for (const auto& of_slot : bench.given) {
      REQUIRE(of_slot[0] == 0);
      for (std::size_t k = 1; k < 4; ++k) REQUIRE(of_slot[k] > 300);
    }
    if (TestType::SLOTS == 2) {  // two slots of a kind get its pairs in turn
      REQUIRE(bench.both_ready > 200);
      REQUIRE(bench.first_of_both > bench.both_ready / 4);
      REQUIRE(bench.first_of_both < bench.both_ready * 3 / 4);
    }
  });
}
