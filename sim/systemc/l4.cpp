// SPDX-License-Identifier: Apache-2.0
#include <cchip/bitstream.hpp>
#include <cchip/levels/bitstream_length.hpp>
#include <cchip/levels/bitstream_memory.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/levels/simulate.hpp>
#include <cchip/levels/software_c3.hpp>
#include <cchip/levels/subsystem.hpp>

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
    for (const ModuleId id : {ModuleId::tri_tri, ModuleId::tri_quad, ModuleId::quad_quad}) {
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
  sc_core::sc_clock clk("clk", period);
  sc_core::sc_signal<bool> irq("irq");
  sc_core::sc_fifo<RtlRequest> requests("requests_fifo");
  sc_core::sc_fifo<RtlResult> results("results_fifo");
  Subsystem subsystem("subsystem", options.seed, period);
  BitstreamMemory memory("memory", 4 * period);
  SoftwareC3 c3("c3", patience);
  Api4 api("api", stimulus, 2 * patience, c3, memory, options);
  subsystem.clk(clk);
  subsystem.irq(irq);
  subsystem.requests(requests);
  subsystem.results(results);
  subsystem.memory.bind(memory.socket);
  c3.registers.bind(subsystem.registers);
  c3.irq(irq);
  api.requests(requests);
  api.results(results);
  LevelResult result = simulate(api);
  result.swaps = api.swaps();
  return result;
}

}  // namespace cchip::levels
