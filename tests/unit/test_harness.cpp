// SPDX-License-Identifier: Apache-2.0
// The harness must find the defects that it looks for, on a module that breaks one rule at a time.
#include <Vbad_stream.h>
#include <Vcchip_skid_buffer.h>

#include <catch2/catch.hpp>
#include <cchip/machines/pair_port.hpp>
#include <cchip/sim/bits.hpp>
#include <cchip/sim/scoreboard.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/sim/stream.hpp>
#include <cchip/sim/wave_on_failure.hpp>
#include <filesystem>
#include <random>
#include <vector>

using namespace cchip;
using namespace cchip::sim;

namespace {

enum class Fault : CData { none, drop_valid, change_payload, duplicate, assertion, hang, lose, corrupt };

constexpr int items = 40;

/// Sends `items` numbers and expects each of them back once.
void run(Fault fault, const SimulationOptions& options = {}, const Pattern& source = Pattern::always(),
         const Pattern& back_pressure = Pattern::alternate()) {
  Simulation<Vbad_stream> simulation(options);
  Vbad_stream& top = simulation.top();
  top.fault = static_cast<CData>(fault);
  StreamDriver<int> driver(
      "s_item", top.s_item_valid, top.s_item_ready, [&](int item) { top.s_item_data = static_cast<CData>(item); },
      source);
  StreamSink<int> sink(
      "m_item", top.m_item_valid, top.m_item_ready, [&] { return int{top.m_item_data}; }, back_pressure);
  std::mt19937_64 garbage(options.seed);
  driver.when_idle([&] { set_random(top.s_item_data, 8, garbage); });
  TagScoreboard<int> scoreboard("items");
  std::vector<int> order;
  driver.on_accept(
      [&](int item, std::uint64_t clock) { scoreboard.expect(static_cast<std::uint64_t>(item), item, clock); });
  sink.on_item([&](int item, std::uint64_t clock) {
    scoreboard.got(static_cast<std::uint64_t>(item & 0x3f), item, clock);
    order.push_back(item);
  });
  sink.expect_count(items);
  for (int item = 0; item < items; ++item) driver.push(item);
  simulation.add(driver);
  simulation.add(sink);
  simulation.reset();
  simulation.run_until([&] { return driver.waiting() == 0 && top.m_item_valid == 0; }, 2000, "all items to pass");
  simulation.steps(5);
  scoreboard.finish();
  for (int item = 0; item < items; ++item) require(order[static_cast<std::size_t>(item)] == item, "items out of order");
}

std::string wave(const std::string& name) { return wave_folder() + "/" + name + ".fst"; }

}  // namespace

TEST_CASE("harness: items pass in order under every pattern", "[unit][harness]") {
  const std::uint64_t seed = seed_from_environment();
  for (const Pattern& source : standard_patterns(seed)) {
    for (const Pattern& back_pressure : standard_patterns(seed + 100)) {
      INFO("source " << source.name() << ", sink " << back_pressure.name());
      REQUIRE_NOTHROW(run(Fault::none, {}, source, back_pressure));
    }
  }
}

TEST_CASE("harness: patterns are active on the clocks they promise", "[unit][harness]") {
  const auto active = [](Pattern pattern, int clocks) {
    std::string result;
    for (int i = 0; i < clocks; ++i) result += pattern.next() ? '1' : '0';
    return result;
  };
  CHECK(active(Pattern::always(), 6) == "111111");
  CHECK(active(Pattern::never_for(3), 6) == "000111");
  CHECK(active(Pattern::bursts(2, 3), 8) == "11000110");
  CHECK(active(Pattern::alternate(), 6) == "101010");
  CHECK(active(Pattern::single(4), 9) == "100010001");
  CHECK(active(Pattern::random(0.0, 1), 50).find('1') == std::string::npos);
  CHECK(active(Pattern::random(1.0, 1), 50).find('0') == std::string::npos);
  const std::string half = active(Pattern::random(0.5, 1), 1000);
  CHECK(half == active(Pattern::random(0.5, 1), 1000));
  CHECK(half != active(Pattern::random(0.5, 2), 1000));
  CHECK(std::abs(std::count(half.begin(), half.end(), '1') - 500) < 100);
}

TEST_CASE("harness: valid dropped while stalled is found", "[unit][harness]") {
  CHECK_THROWS_AS(run(Fault::drop_valid), StreamError);
  CHECK_THROWS_WITH(run(Fault::drop_valid), Catch::Contains("m_item: valid dropped") && Catch::Contains("(clock "));
}

TEST_CASE("harness: payload changed while stalled is found", "[unit][harness]") {
  CHECK_THROWS_AS(run(Fault::change_payload), StreamError);
  CHECK_THROWS_WITH(run(Fault::change_payload), Catch::Contains("payload changed while stalled, from 0 to 1"));
}

TEST_CASE("harness: neither rule is broken without back-pressure", "[unit][harness]") {
  CHECK_NOTHROW(run(Fault::drop_valid, {}, Pattern::always(), Pattern::always()));
  CHECK_NOTHROW(run(Fault::change_payload, {}, Pattern::always(), Pattern::always()));
}

TEST_CASE("harness: a result that comes twice is found", "[unit][harness]") {
  CHECK_THROWS_AS(run(Fault::duplicate), ScoreboardError);
  CHECK_THROWS_WITH(run(Fault::duplicate), Catch::Contains("tag 4 came twice"));
}

TEST_CASE("harness: a lost result is found", "[unit][harness]") {
  CHECK_THROWS_AS(run(Fault::lose), ScoreboardError);
  CHECK_THROWS_WITH(run(Fault::lose), Catch::Contains("8 results are missing, first tag 4"));
}

TEST_CASE("harness: a wrong result is found", "[unit][harness]") {
  CHECK_THROWS_AS(run(Fault::corrupt), ScoreboardError);
  CHECK_THROWS_WITH(run(Fault::corrupt), Catch::Contains("tag 59 was never sent: 251"));
  TagScoreboard<int> scoreboard("board");
  scoreboard.expect(7, 1, 100);
  CHECK_THROWS_WITH(scoreboard.got(7, 2, 120), "board: clock 120: tag 7 sent on clock 100: expected 1, got 2");
  CHECK_THROWS_WITH(scoreboard.expect(7, 1, 130), Catch::Contains("sent again before its result came"));
}

TEST_CASE("harness: a tag may be used again after its result", "[unit][harness]") {
  TagScoreboard<int> scoreboard("board");
  for (int i = 0; i < 3; ++i) {
    scoreboard.expect(7, i, 1);
    scoreboard.got(7, i, 2);
  }
  CHECK(scoreboard.matched() == 3);
  CHECK_NOTHROW(scoreboard.finish());
  scoreboard.expect(8, 0, 3);
  scoreboard.clear();
  CHECK_NOTHROW(scoreboard.finish());
  CHECK_THROWS_AS(scoreboard.got(8, 0, 4), ScoreboardError);
}

TEST_CASE("harness: a failed assertion ends the step", "[unit][harness]") {
  CHECK_THROWS_AS(run(Fault::assertion), AssertionFailure);
}

TEST_CASE("harness: a hang is a timeout that says who waited", "[unit][harness]") {
  CHECK_THROWS_AS(run(Fault::hang), SimulationTimeout);
  CHECK_THROWS_WITH(run(Fault::hang), Catch::Contains("timeout after 2000 clocks, waited for all items to pass") &&
                                          Catch::Contains("s_item still has 35 items to send") &&
                                          Catch::Contains("m_item delivered 5 of 40 items"));
  SimulationOptions options;
  options.timeout_clocks = 30;
  CHECK_THROWS_WITH(run(Fault::none, options), Catch::Contains("timeout after 30 clocks"));
}

TEST_CASE("harness: power-up values follow the seed", "[unit][harness]") {
  const auto power_up = [](std::uint64_t seed) {
    SimulationOptions options;
    options.seed = seed;
    Simulation<Vbad_stream> simulation(options);
    simulation->fault = 0;
    simulation->s_item_valid = 0;
    simulation->m_item_ready = 0;
    simulation.settle();
    return int{simulation->m_item_data};
  };
  CHECK(power_up(2) == power_up(2));
  std::vector<int> values;
  for (std::uint64_t seed = 1; seed < 20; ++seed) values.push_back(power_up(seed));
  CHECK(std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) != values.end());
}

TEST_CASE("harness: reset starts the clocks again and keeps what was not accepted", "[unit][harness]") {
  Simulation<Vbad_stream> simulation;
  Vbad_stream& top = simulation.top();
  top.fault = 0;
  StreamDriver<int> driver("s_item", top.s_item_valid, top.s_item_ready,
                           [&](int item) { top.s_item_data = static_cast<CData>(item); });
  std::vector<int> got;
  StreamSink<int> sink(
      "m_item", top.m_item_valid, top.m_item_ready, [&] { return int{top.m_item_data}; }, Pattern::never_for(20),
      [&](int item, std::uint64_t) { got.push_back(item); });
  for (int item = 0; item < 4; ++item) driver.push(item);
  simulation.add(driver);
  simulation.add(sink);
  simulation.reset(3);
  CHECK(simulation.clock() == 0);
  CHECK(simulation.total_clocks() == 3);
  simulation.steps(10);  // item 0 is inside, item 1 is offered
  REQUIRE(driver.waiting() == 3);
  CHECK_NOTHROW(simulation.reset());
  CHECK(simulation.clock() == 0);
  CHECK(simulation.total_clocks() == 15);
  simulation.steps(40);
  CHECK(got == std::vector<int>{1, 2, 3});
}

TEST_CASE("harness: a failure leaves a wave and names it", "[unit][harness]") {
  const std::string name = "harness_test_failure";
  std::filesystem::remove(wave(name));
  int runs = 0;
  const auto body = [&](const SimulationOptions& options) {
    ++runs;
    run(Fault::drop_valid, options);
  };
  CHECK_THROWS_WITH(with_wave_on_failure(name, body), Catch::Contains(wave(name)));
  CHECK(runs == 2);
  CHECK(std::filesystem::file_size(wave(name)) > 0);

  const std::string good = "harness_test_success";
  std::filesystem::remove(wave(good));
  CHECK_NOTHROW(with_wave_on_failure(good, [&](const SimulationOptions& options) { run(Fault::none, options); }));
  CHECK(!std::filesystem::exists(wave(good)));
}

TEST_CASE("harness: a waveform of a model without one is an error", "[unit][harness]") {
  SimulationOptions options;
  options.trace_path = wave("harness_test_none");
  CHECK_THROWS_WITH(Simulation<Vcchip_skid_buffer>(options),
                    options.trace_path +
                        ": no waveform, the model was built without; run: scripts/run wave-of "
                        "MODEL=Vcchip_skid_buffer");
  CHECK_NOTHROW(with_wave_on_failure(
      "harness_test_none", [](const SimulationOptions& given) { Simulation<Vcchip_skid_buffer> simulation(given); }));
  int runs = 0;
  CHECK_THROWS_AS(with_wave_on_failure("harness_test_none",
                                       [&](const SimulationOptions& given) {
                                         Simulation<Vcchip_skid_buffer> simulation(given);
                                         ++runs;
                                         throw std::out_of_range("mine");
                                       }),
                  std::out_of_range);
  CHECK(runs == 2);
}

TEST_CASE("harness: other exceptions also leave a wave", "[unit][harness]") {
  const std::string name = "harness_test_other_exception";
  std::filesystem::remove(wave(name));
  const auto body = [](const SimulationOptions& options) {
    run(Fault::none, options);
    throw std::out_of_range("mine");
  };
  CHECK_THROWS_AS(with_wave_on_failure(name, body), std::out_of_range);
  CHECK(std::filesystem::exists(wave(name)));
}

TEST_CASE("harness: fields of vectors come back as written", "[unit][harness]") {
  std::mt19937_64 random(seed_from_environment());
  VlWide<7> wide = {};
  QData quad = 0;
  set_random(wide, 216, random);
  CHECK(wide[6] >> 24 == 0);
  for (int lsb = 0; lsb < 216; ++lsb) {
    for (int width = 1; width <= 64 && lsb + width <= 216; width += 7) {
      const auto before = wide;
      const std::uint64_t value = random();
      set_bits(wide, lsb, width, value);
      const std::uint64_t expected = width == 64 ? value : value & ((std::uint64_t{1} << width) - 1);
      REQUIRE(get_bits(wide, lsb, width) == expected);
      if (lsb > 0) REQUIRE(get_bits(wide, lsb - 1, 1) == get_bits(before, lsb - 1, 1));
      if (lsb + width < 216) REQUIRE(get_bits(wide, lsb + width, 1) == get_bits(before, lsb + width, 1));
    }
  }
  for (int lsb = 0; lsb < 57; lsb += 7) {
    set_signed(quad, lsb, 64 - lsb, -1 - lsb);
    REQUIRE(get_signed(quad, lsb, 64 - lsb) == -1 - lsb);
  }
  set_bits(wide, 3, 64, 5);
  set_bits(wide, 67, 38, ~std::uint64_t{0} << 37);
  CHECK(get_signed_wide(wide, 3, 102) == -(Int128{1} << 101) + 5);
  CData byte = 0;
  CHECK_THROWS_AS(set_signed(byte, 0, 8, 128), std::invalid_argument);
  CHECK_THROWS_AS(set_signed(byte, 0, 8, -129), std::invalid_argument);
  CHECK_NOTHROW(set_signed(byte, 0, 8, -128));
  CHECK(byte == 0x80);
}
