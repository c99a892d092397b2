// SPDX-License-Identifier: Apache-2.0
// Which entries rest, on every clock, after random reports; and that the rests are exact and double up to their limit.
#include <cchip/machines/swap_port.hpp>
#include <models/cchip_swap_retry.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// What the datasheet says.
class RetryModel {
 public:
  RetryModel(int slots, int kinds) : slots_(slots), kinds_(kinds) {}
  unsigned resting() const { return left_ > 0 ? failed_ : 0; }
  unsigned hopeless() const { return level_ >= defs::retry_doublings - 1 ? resting() : 0; }
  void clock(const std::optional<SwapReport>& report, unsigned valid) {
    const int code = report ? static_cast<int>(report->code) : 0;
    const bool put_off = report && defs::swap_put_off(code) != 0;
    // the entries of a slot are a power of two, so that some have no module
    const int bits = defs::kind_bits(kinds_);
    const bool exists = report && report->module_id < 1 << bits && report->slot < slots_;
    const unsigned entry = exists ? 1U << ((report->slot << bits) + report->module_id) : 0U;
    const bool forgotten = failed_ == 0;
    if (put_off) {
      left_ = std::uint64_t{defs::retry_clocks} << level_;
      failed_ |= entry;
    } else if (left_ > 0 && --left_ == 0) {
      level_ = std::min(level_ + 1, defs::retry_doublings);
    }
    if (report && report->code == SwapCode::ok) failed_ &= ~entry;
    failed_ &= valid;
    if (forgotten && !put_off) level_ = 0;
  }
  int level() const { return level_; }

 private:
  int slots_;
  int kinds_;
  unsigned failed_ = 0;
  std::uint64_t left_ = 0;
  int level_ = 0;
};

template <class Config, class Body>
void with_model(Body&& body) {
  for_two_power_ups<typename Config::Model>([&](auto& simulation, Random& random) {
    auto& top = simulation.top();
    constexpr int entries = Config::SLOTS << defs::kind_bits(Config::KINDS);
    RetryModel model(Config::SLOTS, Config::KINDS);
    top.report_valid = 0;
    sim::put_swap_report(top.report_data, SwapReport{});
    top.valid = (1U << entries) - 1;
    simulation.reset();
    const auto step = [&](const std::optional<SwapReport>& report) {
      top.report_valid = report ? 1 : 0;
      if (report) sim::put_swap_report(top.report_data, *report);
      simulation.step();
      model.clock(report, top.valid);
      REQUIRE(unsigned{top.resting} == model.resting());
      REQUIRE(unsigned{top.hopeless} == model.hopeless());
    };
    body(top, random, model, step);
  });
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_swap_retry: entries that rest after random reports", "[unit][cchip_swap_retry]",
                        cchip_swap_retry_configs) {
  with_model<TestType>([](auto& top, Random& random, RetryModel& model, const auto& step) {
    int highest = 0;
    int rested = 0;
    for (int clock = 0; clock < 400000; ++clock) {
      std::optional<SwapReport> report;
      if (random() % 300 == 0) {
        const bool well = chance(random, 8);
        report = SwapReport{static_cast<int>(random() % (TestType::SLOTS + 1)), static_cast<int>(random() % 9),
                            well ? SwapCode::ok : static_cast<SwapCode>(1 + random() % 15), 3};
        if (random() % 8 == 0) report->slot += 128;
      }
      constexpr int entries = TestType::SLOTS << defs::kind_bits(TestType::KINDS);
      const std::uint64_t all = (std::uint64_t{1} << entries) - 1;
      if (random() % 20000 == 0) sim::set_bits(top.valid, 0, entries, random() & all);
      if (random() % 5000 == 0) sim::set_bits(top.valid, 0, entries, all);
      step(report);
      highest = std::max(highest, model.level());
      rested += model.resting() != 0 ? 1 : 0;
    }
    REQUIRE(highest >= 1);
    REQUIRE(rested > 1000);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_swap_retry: the rest doubles up to its limit, and begins anew after a good swap",
                        "[unit][cchip_swap_retry]", cchip_swap_retry_configs) {
  with_model<TestType>([](auto& top, Random&, RetryModel&, const auto& step) {
    const int slot = TestType::SLOTS - 1;
    for (int round = 0; round < 2; ++round) {
      for (int failure = 0; failure < defs::retry_doublings + 2; ++failure) {
        step(SwapReport{slot, 2, SwapCode::bus, 0});
        REQUIRE((top.hopeless != 0) == (failure + 1 >= defs::retry_doublings));
        std::uint64_t clocks = 0;
        for (; top.resting != 0; ++clocks) step(std::nullopt);
        REQUIRE(clocks == std::uint64_t{defs::retry_clocks} << std::min(failure, defs::retry_doublings));
      }
      step(SwapReport{slot, 2, SwapCode::bus, 0});
      REQUIRE(top.hopeless != 0);
      step(SwapReport{slot, 2, SwapCode::ok, 0});
      REQUIRE(top.hopeless == 0);
      step(std::nullopt);
    }
  });
}
