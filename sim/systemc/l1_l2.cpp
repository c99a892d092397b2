// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/bitstream_length.hpp>
#include <cchip/levels/c3.hpp>
#include <cchip/levels/functional_api.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/levels/simulate.hpp>
#include <cchip/rc/timed_control.hpp>

namespace cchip::levels {
namespace {

using sc_core::SC_MS;
using sc_core::sc_time;

template <class Test>
auto ports_of(Test& test) {
  return rc::ports(test.m, test.a, test.b, test.hit);
}

/// API with the C3 in it (paper, figure 5).
class ReconfiguringApi : public FunctionalApi {
 public:
  ReconfiguringApi(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_time patience, C3& c3)
      : FunctionalApi(name, stimulus, patience, 1), c3_(c3) {}

 private:
  void prepare(const ObjectPair& objects) override {
    c3_.configure(objects.test);
    transmit(objects);
  }
  virtual void transmit(const ObjectPair&) {}

  C3& c3_;
};

/// The data of an object pair pass the same bus as the bitstream, after it: equations (5) and (6).
class TimedApi : public ReconfiguringApi {
 public:
  TimedApi(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_time patience, C3& c3,
           const rc::bitstream_timing& timing)
      : ReconfiguringApi(name, stimulus, patience, c3), timing_(timing) {}

 private:
  void transmit(const ObjectPair& objects) override {
    const StimulusPair& pair = stimulus()[objects.first];
    // a radius counts as a coordinate
    const std::size_t coordinates = 3 * (vertex_count_a(pair) + pair.b.vertex_count()) + (pair.radius ? 1 : 0);
    const std::size_t bits = 32 * pair.m.entry.size() + static_cast<std::size_t>(coord_w) * coordinates;
    wait(timing_.transmission(bits * objects.count));
  }

  const rc::bitstream_timing& timing_;
};

/// The tests of level 0, reconfigurable (figure 4), behind one set of portals.
struct Tests {
  rc::reconfigurable<FunctionalTriTri> tri_tri{"tri_tri"};
  rc::reconfigurable<FunctionalTriQuad> tri_quad{"tri_quad"};
  rc::reconfigurable<FunctionalQuadQuad> quad_quad{"quad_quad"};
  rc::reconfigurable<FunctionalPointTri> point_tri{"point_tri"};
  rc::portal_group<decltype(ports_of(tri_tri))> portals{"portals", {"m", "a", "b", "hit"}};
  FunctionalChannels channels{"channel"};

  Tests() {
    portals.bind_static(channels.m, channels.a, channels.b, channels.hit);
    portals.bind_dynamic(ports_of(tri_tri));
    portals.bind_dynamic(ports_of(tri_quad));
    portals.bind_dynamic(ports_of(quad_quad));
    portals.bind_dynamic(ports_of(point_tri));
  }
  std::array<rc::context*, defs::kinds_max> all() { return {&tri_tri, &tri_quad, &quad_quad, &point_tri}; }
};

LevelResult run(FunctionalApi& api, Tests& tests, const C3& c3) {
  tests.channels.bind(api, 0);
  LevelResult result = simulate(api);
  result.swaps = c3.swaps();
  return result;
}

}  // namespace

LevelResult run_l1(const Stimulus& stimulus, const LevelOptions&) {
  Tests tests;
  rc::control control("control");
  C3 c3(control, tests.all());
  ReconfiguringApi api("api", stimulus, sc_time(1, SC_MS), c3);
  return run(api, tests, c3);
}

LevelResult run_l2(const Stimulus& stimulus, const LevelOptions& options) {
  Tests tests;
  const auto bits = [&](ModuleId id) { return 8 * payload_bytes(options, id); };
  const rc::bitfile_size tri_tri(tests.tri_tri, bits(ModuleId::tri_tri));
  const rc::bitfile_size tri_quad(tests.tri_quad, bits(ModuleId::tri_quad));
  const rc::bitfile_size quad_quad(tests.quad_quad, bits(ModuleId::quad_quad));
  const rc::bitfile_size point_tri(tests.point_tri, bits(ModuleId::point_tri));
  rc::timed_control control("control");
  C3 c3(control, tests.all());
  const sc_time patience =
      10 * (control.timing().configuration(8 * longest_payload_bytes(options)) + sc_time(1, SC_MS));
  TimedApi api("api", stimulus, patience, c3, control.timing());
  return run(api, tests, c3);
}

}  // namespace cchip::levels
