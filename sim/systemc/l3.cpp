// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/bitstream_length.hpp>
#include <cchip/levels/c3.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/levels/pin_driver.hpp>
#include <cchip/levels/simulate.hpp>
#include <cchip/rc/timed_control.hpp>
#include <functional>
#include <stdexcept>

namespace cchip::levels {
namespace {

using sc_core::SC_MS;
using sc_core::SC_NS;
using sc_core::sc_time;

/// Pins of a test but the reset, in the order of PrimtestSignals.
template <class Test>
auto pins_of(Test& t) {
  return rc::ports(t.clk, t.s_pair_valid, t.s_pair_ready, t.s_pair_tag, t.s_pair_mode, t.s_pair_a, t.s_pair_b,
                   t.s_pair_err, t.m_result_valid, t.m_result_ready, t.m_result_tag, t.m_result_hit, t.m_result_grid,
                   t.m_result_definite, t.m_result_axis, t.m_result_beats, t.rm_id, t.idle);
}

/// The closed component made reconfigurable, with a generator of a reset on configuration beside it (paper, listing 3.3
/// and figure 8). Whoever uses it feeds roc_out back to rst.
class ReconfigurableRtl : public rc::reconfigurable<RtlShell> {
 public:
  sc_core::sc_out<bool> roc_out{"roc_out"};

  ReconfigurableRtl(const sc_core::sc_module_name& name, ModuleId id, const LevelOptions& options)
      : reconfigurable(name, id), seed_(options.seed) {
    if (!options.reset_on_configuration) return;
    RC_THREAD(write_roc);
    sensitive << clk.pos();
  }

  /// What power_up() is called with; another seed each time.
  std::uint64_t next_seed() { return seed_ = 6364136223846793005U * seed_ + 1442695040888963407U; }

 private:
  void on_load() override { power_up(next_seed() >> 32); }
  void write_roc() {
    roc_out.write(true);
    wait();
    wait();
    roc_out.write(false);
  }

  std::uint64_t seed_;
};

/// Listing 3.3 once more, for a static test.
class StaticReset : public sc_core::sc_module {
 public:
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_out<bool> rst{"rst"};

  SC_HAS_PROCESS(StaticReset);
  explicit StaticReset(const sc_core::sc_module_name&) {
    SC_THREAD(write_rst);
    sensitive << clk.pos();
  }

 private:
  void write_rst() {
    rst.write(true);
    wait();
    wait();
    rst.write(false);
  }
};

/// Before each object pair: configures, waits until the reset on configuration is over, couples the driver.
class Api3 : public RtlApi {
 public:
  sc_core::sc_in<bool> clk{"clk"};

  Api3(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_time patience, PinDriver& driver,
       std::function<void(ModuleId)> configure)
      : RtlApi(name, stimulus, patience), driver_(driver), configure_(std::move(configure)) {}

 private:
  void prepare(const ObjectPair& objects) override {
    driver_.couple(false);
    configure_(objects.test);
    for (int clock = 0; clock < reset_clocks; ++clock) wait(clk.posedge_event());
    if (driver_.rm_id.read() != static_cast<unsigned>(objects.test)) {
      throw std::runtime_error("the module has rm_id " + std::to_string(driver_.rm_id.read()));
    }
    driver_.couple(true);
  }

  static constexpr int reset_clocks = defs::roc_clocks_default + 2;
  PinDriver& driver_;
  std::function<void(ModuleId)> configure_;
};

/// Clock, signals, driver and API: the static side.
struct StaticSide {
  StaticSide(const Stimulus& stimulus, const LevelOptions& options, std::function<void(ModuleId)> configure)
      : api("api", stimulus, patience(options), driver, std::move(configure)) {
    driver.clk(clk);
    driver.requests(requests);
    driver.results(results);
    bind_pins(driver, signals);
    api.clk(clk);
    api.requests(requests);
    api.results(results);
  }
  static sc_time patience(const LevelOptions& options) {
    return 10 * (rc::bitstream_timing().configuration(8 * longest_payload_bytes(options)) + sc_time(1, SC_MS));
  }

  sc_core::sc_clock clk{"clk", sc_time(10, SC_NS)};
  PrimtestSignals signals;
  sc_core::sc_fifo<RtlRequest> requests{"requests_fifo"};
  sc_core::sc_fifo<RtlResult> results{"results_fifo"};
  PinDriver driver{"driver"};
  Api3 api;
};

/// The three tests behind one group of portals.
struct Tests {
  explicit Tests(const LevelOptions& options)
      : tri_tri("tri_tri", ModuleId::tri_tri, options),
        tri_quad("tri_quad", ModuleId::tri_quad, options),
        quad_quad("quad_quad", ModuleId::quad_quad, options),
        tri_tri_bits(tri_tri, 8 * payload_bytes(options, ModuleId::tri_tri)),
        tri_quad_bits(tri_quad, 8 * payload_bytes(options, ModuleId::tri_quad)),
        quad_quad_bits(quad_quad, 8 * payload_bytes(options, ModuleId::quad_quad)) {}

  void bind(StaticSide& side) {
    PrimtestSignals& s = side.signals;
    portals.bind_static(side.clk, s.s_pair_valid, s.s_pair_ready, s.s_pair_tag, s.s_pair_mode, s.s_pair_a, s.s_pair_b,
                        s.s_pair_err, s.m_result_valid, s.m_result_ready, s.m_result_tag, s.m_result_hit,
                        s.m_result_grid, s.m_result_definite, s.m_result_axis, s.m_result_beats, s.rm_id, s.idle);
    for (std::size_t i = 0; i < 3; ++i) {
      portals.bind_dynamic(pins_of(*all[i]));
      all[i]->roc_out(roc[i]);
      all[i]->rst(roc[i]);
    }
  }
  std::array<rc::context*, 3> contexts() { return {&tri_tri, &tri_quad, &quad_quad}; }

  ReconfigurableRtl tri_tri;
  ReconfigurableRtl tri_quad;
  ReconfigurableRtl quad_quad;
  rc::bitfile_size tri_tri_bits;
  rc::bitfile_size tri_quad_bits;
  rc::bitfile_size quad_quad_bits;
  std::array<ReconfigurableRtl*, 3> all = {&tri_tri, &tri_quad, &quad_quad};
  std::array<sc_core::sc_signal<bool>, 3> roc;
  rc::portal_group<decltype(pins_of(tri_tri))> portals{"portals"};
};

/// \param first module that is active from the beginning, or blank
LevelResult run_with_portals(const Stimulus& stimulus, const LevelOptions& options, ModuleId first) {
  Tests tests(options);
  rc::timed_control control("control");
  C3 c3(control, tests.contexts());
  StaticSide side(stimulus, options, [&c3](ModuleId test) { c3.configure(test); });
  tests.bind(side);
  if (first != ModuleId::blank) {
    ReconfigurableRtl& test = *tests.all.at(static_cast<std::size_t>(first) - 1);
    control.activate(test);
    test.power_up(test.next_seed());
  }
  LevelResult result = simulate(side.api);
  result.swaps = c3.swaps();
  return result;
}

}  // namespace

LevelResult run_l3(const Stimulus& stimulus, const LevelOptions& options) {
  return run_with_portals(stimulus, options, ModuleId::blank);
}

LevelResult run_l3_preloaded(const Stimulus& stimulus, const LevelOptions& options) {
  return run_with_portals(stimulus, options, object_pairs(stimulus).at(0).test);
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
  test.clk(side.clk);
  test.rst(rst);
  bind_pins(test, side.signals);
  test.power_up(options.seed);
  return simulate(side.api);
}

}  // namespace cchip::levels
