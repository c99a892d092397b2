// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/bitstream_length.hpp>
#include <cchip/levels/c3.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/levels/simulate.hpp>
#include <cchip/levels/static_side.hpp>
#include <cchip/rc/timed_control.hpp>
#include <random>
#include <stdexcept>

namespace cchip::levels {
namespace {

/// The closed component made reconfigurable, with a generator of a reset on configuration beside it (paper, listing 3.3
/// and figure 8). The user must feed roc_out back to rst.
class ReconfigurableRtl : public rc::reconfigurable<RtlShell> {
 public:
  sc_core::sc_out<bool> roc_out{"roc_out"};

  ReconfigurableRtl(const sc_core::sc_module_name& name, ModuleId id, const LevelOptions& options)
      : reconfigurable(name, id), bits_(*this, 8 * payload_bytes(options, id)), seeds_(options.seed) {
    if (!options.reset_on_configuration) return;
    RC_THREAD(write_roc);
    sensitive << clk.pos();
  }

  /// Different power-up values each time.
  void on_load() override { power_up(seeds_()); }

 private:
  void write_roc() {
    roc_out.write(true);
    wait();
    wait();
    roc_out.write(false);
  }

  rc::bitfile_size bits_;
  std::mt19937 seeds_;
};

/// The tests behind one group of portals.
struct Tests {
  explicit Tests(const LevelOptions& options)
      : tri_tri("tri_tri", ModuleId::tri_tri, options),
        tri_quad("tri_quad", ModuleId::tri_quad, options),
        quad_quad("quad_quad", ModuleId::quad_quad, options),
        point_tri("point_tri", ModuleId::point_tri, options) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      portals.bind_dynamic(pins_of(*all.at(i)));
      all.at(i)->roc_out(roc.at(i));
      all.at(i)->rst(roc.at(i));
    }
  }
  std::array<rc::context*, defs::kinds_max> contexts() { return {&tri_tri, &tri_quad, &quad_quad, &point_tri}; }
  ReconfigurableRtl& test(ModuleId id) { return *all.at(static_cast<std::size_t>(id) - 1); }

  ReconfigurableRtl tri_tri;
  ReconfigurableRtl tri_quad;
  ReconfigurableRtl quad_quad;
  ReconfigurableRtl point_tri;
  std::array<ReconfigurableRtl*, defs::kinds_max> all = {&tri_tri, &tri_quad, &quad_quad, &point_tri};
  std::array<sc_core::sc_signal<bool>, defs::kinds_max> roc;
  PinPortals portals{"portals"};
};

/// \param first test that is active from the beginning; blank: none
LevelResult run(const Stimulus& stimulus, const LevelOptions& options, ModuleId first) {
  Tests tests(options);
  rc::timed_control control("control");
  C3 c3(control, tests.contexts());
  StaticSide side(stimulus, options, [&c3](ModuleId test) { c3.configure(test); });
  side.bind(tests.portals);
  if (first != ModuleId::blank) {
    control.activate(tests.test(first));
    tests.test(first).on_load();  // the library calls no hooks before the simulation
  }
  LevelResult result = simulate(side.api);
  result.swaps = c3.swaps();
  return result;
}

}  // namespace

LevelResult run_l3(const Stimulus& stimulus, const LevelOptions& options) {
  return run(stimulus, options, ModuleId::blank);
}

LevelResult run_l3_preloaded(const Stimulus& stimulus, const LevelOptions& options) {
  return run(stimulus, options, object_pairs(stimulus).at(0).test);
}

LevelResult run_l3_direct(const Stimulus& stimulus, const LevelOptions& options) {
  RtlShell test("test", object_pairs(stimulus).at(0).test);
  StaticSide side(stimulus, options, [&test](ModuleId id) {
    if (id != test.module_id()) throw std::invalid_argument("bound directly: a stimulus of one kind is needed");
  });
  StaticReset reset("reset");
  sc_core::sc_signal<bool> rst("rst");
  reset.clk(side.clk);
  reset.rst(rst);
  test.rst(rst);
  side.bind_test(test);
  test.power_up(options.seed);
  return simulate(side.api);
}

}  // namespace cchip::levels
