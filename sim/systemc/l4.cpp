// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/wire/bitstream.hpp>
#include <cchip/levels/bitstream_length.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/levels/platform.hpp>
#include <cchip/levels/simulate.hpp>
#include <cchip/levels/software_c3.hpp>

namespace cchip::levels {
namespace {

using sc_core::SC_NS;
using sc_core::sc_time;

/// With the C3 in it, as in the paper.
class Api4 : public RtlApi {
 public:
  Api4(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_time patience, SoftwareC3& c3,
       BitstreamMemory& memory, const LevelOptions& options)
      : RtlApi(name, stimulus, patience), c3_(c3), memory_(memory), options_(options) {}

  std::uint64_t swaps() const { return swaps_; }

 private:
  void prepare(const ObjectPair& objects) override {
    if (!announced_) announce_all();
    if (objects.test == present_) return;
    c3_.configure(objects.test);
    present_ = objects.test;
    ++swaps_;
  }

  void announce_all() {
    for (const ModuleId id : {ModuleId::tri_tri, ModuleId::tri_quad, ModuleId::quad_quad, ModuleId::point_tri}) {
      const Bytes payload = make_payload(0, id, payload_bytes(options_, id), static_cast<std::uint32_t>(options_.seed));
      const Bytes bitstream = make_bitstream(0, id, payload);
      c3_.announce(id, memory_.append(bitstream), bitstream.size());
    }
    announced_ = true;
  }

  SoftwareC3& c3_;
  BitstreamMemory& memory_;
  const LevelOptions& options_;
  ModuleId present_ = ModuleId::blank;
  std::uint64_t swaps_ = 0;
  bool announced_ = false;
};

}  // namespace

LevelResult run_l4(const Stimulus& stimulus, const LevelOptions& options) {
  const sc_time period(10, SC_NS);
  const sc_time patience = (20.0 * static_cast<double>(longest_payload_bytes(options)) + 100000) * period;
  Platform platform(options.seed, period, 4 * period);
  SoftwareC3 c3("c3", patience);
  Api4 api("api", stimulus, 2 * patience, c3, platform.memory, options);
  c3.registers.bind(platform.subsystem.registers);
  c3.irq(platform.irq);
  api.requests(platform.requests);
  api.results(platform.results);
  LevelResult result = simulate(api);
  result.swaps = api.swaps();
  return result;
}

}  // namespace cchip::levels
