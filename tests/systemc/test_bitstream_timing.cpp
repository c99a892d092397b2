// SPDX-License-Identifier: Apache-2.0
// Equations (4) to (6) in whole picoseconds, and the attribute that carries a module's bitstream length.
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/rc/rc.hpp>
#include <cchip/rc/timed_control.hpp>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

using namespace cchip;
using namespace cchip::rc;
using sc_core::sc_time;

namespace {

std::uint64_t picoseconds(const sc_time& time) { return time.value(); }  // the resolution is 1 ps

SC_MODULE(closed_module){SC_CTOR(closed_module){}};

}  // namespace

TEST_CASE("eq. (4): the paper's bitfiles through 8 bits at 50 MHz", "[systemc][timing]") {
  const bitstream_timing paper;
  // 688,011 and 676,247 bytes of 20 ns
  CHECK(paper.configuration(5'504'088) == sc_time(13'760'220, sc_core::SC_NS));
  CHECK(paper.configuration(5'409'976) == sc_time(13'524'940, sc_core::SC_NS));
  // the same bits on newer ports: 172,003 words of 10 ns, of 5 ns; the last one is not full
  CHECK(picoseconds(transfer_time(5'504'088, {32, 100'000'000})) == 1'720'030'000);
  CHECK(picoseconds(transfer_time(5'504'088, {32, 200'000'000})) == 860'015'000);
}

TEST_CASE("eq. (6): 32 bits at 66 MHz rounded up once", "[systemc][timing]") {
  const bitstream_timing paper;
  CHECK(picoseconds(paper.transmission(32)) == 15'152);     // 15,151.5 ps
  CHECK(picoseconds(paper.transmission(96)) == 45'455);     // 45,454.5 ps, not three times the above
  CHECK(picoseconds(paper.transmission(1056)) == 500'000);  // 33 clocks, exact
  CHECK(picoseconds(paper.transmission(66'000'000ull * 32)) == 1'000'000'000'000);
}

TEST_CASE("eq. (5): data and configuration over one bus add", "[systemc][timing]") {
  const bitstream_timing paper;
  CHECK(picoseconds(paper.overall(1056, 5'504'088)) == 500'000 + 13'760'220'000);
  CHECK(picoseconds(paper.overall(0, 0)) == 0);
}

TEST_CASE("transfer_time: words that are not full count as full", "[systemc][timing]") {
  CHECK(picoseconds(transfer_time(0, {8, 1'000'000'000})) == 0);
  for (std::uint64_t bits = 1; bits <= 8; ++bits) CHECK(picoseconds(transfer_time(bits, {8, 1'000'000'000})) == 1000);
  CHECK(picoseconds(transfer_time(9, {8, 1'000'000'000})) == 2000);
}

TEST_CASE("transfer_time: exact against wide integers", "[systemc][timing]") {
  using boost::multiprecision::cpp_int;
  std::mt19937_64 random(cchip::sim::seed_from_environment());
  for (int i = 0; i < 20'000; ++i) {
    const bit_path path{1 + random() % 1024, 1 + random() % (std::uint64_t{1} << (1 + random() % 40))};
    const std::uint64_t bits = random() >> (random() % 64);
    const cpp_int clocks = (cpp_int(bits) + path.width - 1) / path.width;
    const cpp_int exact = (clocks * 1'000'000'000'000 + path.clock - 1) / path.clock;
    if (clocks / path.clock >= 18'446'744) {
      CHECK_THROWS_AS(transfer_time(bits, path), std::overflow_error);
    } else {
      CHECK(cpp_int(picoseconds(transfer_time(bits, path))) == exact);
    }
  }
}

TEST_CASE("transfer_time: impossible paths are named", "[systemc][timing]") {
  CHECK_THROWS_WITH(transfer_time(1, {0, 50}), Catch::Contains("0 bits at 50 Hz"));
  CHECK_THROWS_WITH(transfer_time(1, {8, 0}), Catch::Contains("8 bits at 0 Hz"));
  CHECK_THROWS_WITH(transfer_time(1, {8, ~std::uint64_t{0}}), Catch::Contains("the clock at most"));
}

TEST_CASE("bitfile_size: attribute of an untouched module", "[systemc][timing]") {
  closed_module module("module");
  const bitstream_timing paper;
  CHECK_FALSE(bitfile_bits(module).has_value());
  CHECK(paper.configuration(module) == sc_core::SC_ZERO_TIME);
  {
    const bitfile_size size(module, 5'409'976);
    CHECK(bitfile_bits(module) == 5'409'976u);
    CHECK(paper.configuration(module) == paper.configuration(5'409'976));
    CHECK_THROWS_WITH(bitfile_size(module, 1), Catch::Contains("module: has two attributes"));
    CHECK(bitfile_bits(module) == 5'409'976u);
  }
  CHECK_FALSE(bitfile_bits(module).has_value());
  sc_core::sc_attribute<int> foreign(bitfile_size::attribute, 3);
  module.add_attribute(foreign);
  CHECK_THROWS_WITH(bitfile_bits(module), Catch::Contains("no std::uint64_t"));
  module.remove_attribute(bitfile_size::attribute);
}

TEST_CASE("timed_control: loads are computed, other delays looked up for each module and action", "[systemc][timing]") {
  reconfigurable<closed_module> sized("sized"), plain("plain");
  const bitfile_size size(static_cast<closed_module&>(sized), 5'409'976);
  const auto ms = [](double count) { return sc_time(count, sc_core::SC_MS); };
  sized.set_delay(action::load, ms(2));  // on top of eq. (4)
  sized.set_delay(action::activate, ms(3));
  sized.set_delay(action::deactivate, ms(5));
  sized.set_delay(action::unload, ms(7));
  plain.set_delay(action::load, ms(11));
  timed_control control("control");
  control.add(sized + plain);

  using step = void (rc::control::*)(const module_set&);
  const std::array<step, 4> steps = {&rc::control::load, &rc::control::activate, &rc::control::deactivate,
                                     &rc::control::unload};
  std::vector<sc_time> times;
  struct thread : sc_core::sc_module {
    SC_HAS_PROCESS(thread);
    thread(const sc_core::sc_module_name&, std::function<void()> run) : run_(std::move(run)) { SC_THREAD(body); }
    void body() { run_(); }
    std::function<void()> run_;
  } caller("caller", [&] {
    for (auto* module : std::array<reconfigurable<closed_module>*, 2>{&sized, &plain}) {
      for (const step& s : steps) {
        const std::uint64_t start = sc_core::sc_time_stamp().value();
        (control.*s)(*module);
        times.push_back(from_picoseconds(sc_core::sc_time_stamp().value() - start));
      }
    }
  });
  sc_core::sc_start();
  const sc_time eq4(13'524'940, sc_core::SC_NS), none;
  CHECK(times == std::vector<sc_time>{ms(2) + eq4, ms(3), ms(5), ms(7), ms(11), none, none, none});
}

TEST_CASE("transfer_time: finer time resolutions keep the value", "[systemc][timing]") {
  sc_core::sc_set_time_resolution(1, sc_core::SC_FS);
  CHECK(transfer_time(64, adm_xrc2_bus) == sc_time(30'304, sc_core::SC_PS));
  CHECK_THROWS_AS(from_picoseconds(~std::uint64_t{0}), std::overflow_error);
}

TEST_CASE("transfer_time: a coarser time resolution is an error", "[systemc][timing]") {
  sc_core::sc_set_time_resolution(1, sc_core::SC_NS);
  CHECK_THROWS_WITH(transfer_time(64, adm_xrc2_bus), Catch::Contains("leave it at 1 ps or finer"));
}
