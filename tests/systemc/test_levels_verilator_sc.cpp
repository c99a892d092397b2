// SPDX-License-Identifier: Apache-2.0
// Real models of `verilator --sc` in the port group of level 3: closed components that neither the library nor the
// levels were written for.
#include <Vsc_quad_quad.h>
#include <Vsc_tri_tri.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/levels/c3.hpp>
#include <cchip/levels/generator.hpp>
#include <cchip/levels/simulate.hpp>
#include <cchip/levels/static_side.hpp>
#include <cchip/program/seed.hpp>

using namespace cchip;
using namespace cchip::levels;

namespace {

static_assert(
    std::is_same_v<decltype(pins_of(std::declval<Vsc_tri_tri&>())), decltype(pins_of(std::declval<RtlShell&>()))>,
    "RtlShell has the port types of a model of verilator --sc");

/// With reset on configuration: the registers are random, and keep their content while the module is absent.
template <class Model>
class Reconfigurable : public rc::reconfigurable<Model> {
 public:
  sc_core::sc_out<bool> roc_out{"roc_out"};
  sc_core::sc_signal<bool> roc{"roc"};

  explicit Reconfigurable(const sc_core::sc_module_name& name) : rc::reconfigurable<Model>(name) {
    roc_out(roc);
    this->rst(roc);
    RC_THREAD(write_roc);
    this->sensitive << this->clk.pos();
  }

 private:
  void write_roc() {
    roc_out.write(true);
    sc_core::wait();
    sc_core::wait();
    roc_out.write(false);
  }
};

/// Random registers; assertions would see them before the reset.
void power_up() {
  Verilated::randReset(2);
  Verilated::randSeed(static_cast<int>(sim::seed_from_environment() & 0x7FFFFFFF) | 1);
  Verilated::assertOn(false);
}

/// Object pairs of these kinds.
Stimulus stimulus_of(std::initializer_list<ModuleId> tests) {
  Stimulus stimulus;
  for (const StimulusPair& pair : generate({1200, 12, sim::seed_from_environment()})) {
    if (std::find(tests.begin(), tests.end(), test_of(pair)) != tests.end()) stimulus.push_back(pair);
  }
  return stimulus;
}

std::size_t wrong_answers(const Stimulus& stimulus, const LevelResult& result) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < stimulus.size(); ++i) {
    wrong += (result.answers.at(i) == 1) != eigen_intersects(placed(stimulus[i]), coord_w) ? 1 : 0;
  }
  return wrong;
}

LevelResult run_behind_portals(const Stimulus& stimulus) {
  power_up();
  Reconfigurable<Vsc_tri_tri> test("test");
  PinPortals portals("portals");
  portals.bind_dynamic(pins_of(test));
  StaticSide side(stimulus, {}, [](ModuleId) {});
  side.bind(portals);
  rc::control control("control");
  control.add(test);
  control.activate(test);
  return simulate(side.api);
}

LevelResult run_directly(const Stimulus& stimulus) {
  power_up();
  Vsc_tri_tri test("test");
  StaticReset reset("reset");
  sc_core::sc_signal<bool> rst("rst");
  StaticSide side(stimulus, {}, [](ModuleId) {});
  reset.clk(side.clk);
  reset.rst(rst);
  test.rst(rst);
  side.bind_test(test);
  return simulate(side.api);
}

}  // namespace

TEST_CASE("levels verilator --sc: models alternate behind one group of portals", "[systemc][levels][A.7]") {
  power_up();
  const Stimulus stimulus = stimulus_of({ModuleId::tri_tri, ModuleId::quad_quad});
  Reconfigurable<Vsc_tri_tri> tri_tri("tri_tri");
  Reconfigurable<Vsc_quad_quad> quad_quad("quad_quad");
  PinPortals portals("portals");
  portals.bind_dynamic(pins_of(tri_tri));
  portals.bind_dynamic(pins_of(quad_quad));
  rc::control control("control");
  control.add(tri_tri + quad_quad);
  int swaps = 0;
  StaticSide side(stimulus, {}, [&](ModuleId id) {
    rc::context& wanted = id == ModuleId::tri_tri ? static_cast<rc::context&>(tri_tri) : quad_quad;
    rc::context& other = id == ModuleId::tri_tri ? static_cast<rc::context&>(quad_quad) : tri_tri;
    if (wanted.is_active()) return;
    control.unload(other);
    control.activate(wanted);
    ++swaps;
  });
  side.bind(portals);
  const LevelResult result = simulate(side.api);
  CHECK(wrong_answers(stimulus, result) == 0);
  CHECK(swaps >= 2);
}

TEST_CASE("levels verilator --sc: portals add no delta and change no answer", "[systemc][levels][A.4]") {
  const Stimulus stimulus = stimulus_of({ModuleId::tri_tri});
  const LevelResult direct = in_child([&] { return run_directly(stimulus); });
  const LevelResult portals = in_child([&] { return run_behind_portals(stimulus); });
  CHECK(wrong_answers(stimulus, direct) == 0);
  CHECK(portals.answers == direct.answers);
  CHECK(portals.deltas == direct.deltas);
  CHECK(portals.simulated_seconds == direct.simulated_seconds);
}
