// SPDX-License-Identifier: Apache-2.0
// The rules of the bus: legal traffic breaks none, and each fault of a master or of memory is reported under its name.
#include <deque>
#include <functional>
#include <models/cchip_axi_rules.hpp>
#include <set>

#include "bench.hpp"
#include "reported.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Names of the rules that `body` breaks.
template <class Body>
std::set<std::string> broken(Body&& body) {
  std::set<std::string> names;
  for (const std::string& name : reported(body)) names.insert(name.substr(name.find('.') + 1));
  return names;
}

/// A bus whose both sides are played by the test.
template <class Model>
struct Bus {
  explicit Bus(std::uint64_t seed = 1) : simulation(sim::without_timeout(seed)), top(simulation.top()) {
    quiet();
    simulation.reset();
  }
  void quiet() {
    top.m_axi_arvalid = top.m_axi_arready = top.m_axi_rvalid = top.m_axi_rready = 0;
    top.m_axi_awvalid = top.m_axi_awready = top.m_axi_wvalid = top.m_axi_wready = 0;
    top.m_axi_bvalid = top.m_axi_bready = 0;
  }
  /// One clock. Then nothing is offered.
  void step() {
    simulation.settle();
    ok = top.memory_ok != 0;
    simulation.rise();
    quiet();
  }

  void ar(unsigned id, std::uint64_t address, unsigned length, bool ready = true) {
    top.m_axi_arvalid = 1;
    top.m_axi_arready = ready ? 1 : 0;
    top.m_axi_arid = static_cast<CData>(id);
    top.m_axi_araddr = static_cast<std::decay_t<decltype(top.m_axi_araddr)>>(address);
    top.m_axi_arlen = static_cast<CData>(length);
    top.m_axi_arsize = size;
    top.m_axi_arburst = 1;
    top.m_axi_arcache = 3;
    top.m_axi_arprot = 0;
  }
  void r(unsigned id, bool last, bool ready = true) {
    top.m_axi_rvalid = 1;
    top.m_axi_rready = ready ? 1 : 0;
    top.m_axi_rid = static_cast<CData>(id);
    sim::set_bits(top.m_axi_rdata, 0, 32, 0x1234);
    top.m_axi_rresp = 0;
    top.m_axi_rlast = last ? 1 : 0;
  }
  void aw(std::uint64_t address, unsigned length, bool ready = true) {
    top.m_axi_awvalid = 1;
    top.m_axi_awready = ready ? 1 : 0;
    top.m_axi_awid = 0;
    top.m_axi_awaddr = static_cast<std::decay_t<decltype(top.m_axi_awaddr)>>(address);
    top.m_axi_awlen = static_cast<CData>(length);
    top.m_axi_awsize = size;
    top.m_axi_awburst = 1;
    top.m_axi_awcache = 2;
    top.m_axi_awprot = 0;
  }
  void w(bool last, bool ready = true) {
    top.m_axi_wvalid = 1;
    top.m_axi_wready = ready ? 1 : 0;
    sim::set_bits(top.m_axi_wdata, 0, 32, 0x5678);
    top.m_axi_wstrb = 0xF;
    top.m_axi_wlast = last ? 1 : 0;
  }
  void b(bool ready = true) {
    top.m_axi_bvalid = 1;
    top.m_axi_bready = ready ? 1 : 0;
    top.m_axi_bid = 0;
    top.m_axi_bresp = 0;
  }
  /// An address and all its data, taken.
  void written() {
    aw(0, 0);
    w(true);
    step();
  }

  sim::Simulation<Model> simulation;
  Model& top;
  CData size = 4;
  bool ok = true;  ///< memory_ok on the last clock
};

using All = axi_rules::Model;
using Told = axi_rules_told::Model;
using Two = axi_rules_two::Model;

/// Legal up to the last clock, on which exactly one rule is broken.
template <class Model>
struct Wrong {
  const char* rule;
  std::function<void(Bus<Model>&)> run;
};

template <class Model>
std::vector<Wrong<Model>> wrong_masters() {
  using B = Bus<Model>;
  std::vector<Wrong<Model>> found = {
      {"a_ar_stable", [](B& x) { x.ar(1, 64, 3, false), x.step(), x.step(); }},
      {"a_ar_reset", [](B& x) { x.simulation.reset(), x.ar(1, 64, 3), x.step(); }},
      {"a_aw_reset", [](B& x) { x.simulation.reset(), x.aw(64, 0), x.step(); }},
      {"a_w_reset", [](B& x) { x.simulation.reset(), x.w(true), x.step(); }},
      {"a_ar_kind", [](B& x) { x.ar(1, 64, 3), x.top.m_axi_arburst = 2, x.step(); }},
      {"a_ar_kind", [](B& x) { x.ar(1, 64, 3), x.top.m_axi_arsize = 5, x.step(); }},
      {"a_ar_kind", [](B& x) { x.ar(1, 68, 1), x.step(); }},
      {"a_ar_boundary", [](B& x) { x.ar(1, 4096 - 16, 1), x.step(); }},
      {"a_ar_boundary", [](B& x) { x.ar(1, 4096 + 16, 255), x.step(); }},
      {"a_ar_id", [](B& x) { x.ar(1, 64, 0), x.step(), x.ar(2, 64, 0), x.step(), x.ar(1, 0, 0, false), x.step(); }},
      {"a_ar_id",
       [](B& x) { x.ar(7, 64, 1), x.step(), x.r(7, false), x.step(), x.ar(7, 0, 0), x.r(7, true), x.step(); }},
      {"a_aw_stable", [](B& x) { x.aw(64, 3, false), x.step(), x.step(); }},
      {"a_w_stable", [](B& x) { x.w(true, false), x.step(), x.step(); }},
      {"a_w_stable", [](B& x) { x.w(true, false), x.step(), x.w(true), x.top.m_axi_wstrb = 0xE, x.step(); }},
      {"a_w_stable", [](B& x) { x.w(true, false), x.step(), x.w(false), x.step(); }},
      {"a_w_stable", [](B& x) { x.w(true, false), x.step(), x.w(true), x.top.m_axi_wdata[3] ^= 1U, x.step(); }},
      {"a_aw_kind", [](B& x) { x.aw(64, 3), x.top.m_axi_awburst = 0, x.step(); }},
      {"a_aw_kind", [](B& x) { x.aw(64, 3), x.top.m_axi_awsize = 3, x.step(); }},
      {"a_aw_kind", [](B& x) { x.aw(64, 3), x.top.m_axi_awid = 1, x.step(); }},
      {"a_aw_kind", [](B& x) { x.aw(72, 3), x.step(); }},
      {"a_aw_boundary", [](B& x) { x.aw(4096 - 32, 2), x.step(); }},
      {"a_aw_room",
       [](B& x) {
         for (int i = 0; i < 4; ++i) x.aw(64, 0), x.step();
         x.aw(64, 0, false), x.step();
       }},
      {"a_aw_room",
       [](B& x) {
         for (int i = 0; i < 4; ++i) x.written();
         x.aw(64, 0, false), x.step();
       }},
      {"a_aw_length", [](B& x) { x.w(false), x.step(), x.w(true), x.step(), x.aw(64, 0), x.step(); }},
      {"a_aw_length", [](B& x) { x.w(true), x.step(), x.aw(64, 1), x.step(); }},
      {"a_w_ahead", [](B& x) { x.w(true), x.step(), x.w(true), x.step(), x.w(false, false), x.step(); }},
      {"a_w_last", [](B& x) { x.aw(64, 1), x.step(), x.w(true), x.step(); }},
      {"a_w_last", [](B& x) { x.aw(64, 1), x.step(), x.w(false), x.step(), x.w(false, false), x.step(); }},
      {"a_w_last", [](B& x) { x.aw(64, 1), x.w(true), x.step(); }},
      {"a_w_last", [](B& x) { x.aw(64, 0), x.w(false), x.step(); }},
      // of the second of two writes
      {"a_w_last", [](B& x) { x.aw(0, 0), x.step(), x.aw(0, 2), x.step(), x.w(true), x.step(), x.w(true), x.step(); }},
  };
  // each part of a payload
  const std::vector<std::function<void(Model&)>> reads = {
      [](Model& t) { t.m_axi_arid ^= 1U; }, [](Model& t) { t.m_axi_araddr ^= 64U; },
      [](Model& t) { t.m_axi_arlen ^= 1U; }, [](Model& t) { t.m_axi_arcache ^= 1U; },
      [](Model& t) { t.m_axi_arprot ^= 1U; }};
  const std::vector<std::function<void(Model&)>> writes = {
      [](Model& t) { t.m_axi_awaddr ^= 64U; }, [](Model& t) { t.m_axi_awlen ^= 1U; },
      [](Model& t) { t.m_axi_awcache ^= 1U; }, [](Model& t) { t.m_axi_awprot ^= 1U; }};
  for (const auto& change : reads)
    found.push_back({"a_ar_stable",
                     [change](B& x) { x.ar(1, 128, 2, false), x.step(), x.ar(1, 128, 2), change(x.top), x.step(); }});
  for (const auto& change : writes)
    found.push_back(
        {"a_aw_stable", [change](B& x) { x.aw(128, 2, false), x.step(), x.aw(128, 2), change(x.top), x.step(); }});
  return found;
}

template <class Model>
std::vector<Wrong<Model>> wrong_memories() {
  using B = Bus<Model>;
  return {
      {"m_r_stable", [](B& x) { x.ar(1, 64, 0), x.step(), x.r(1, true, false), x.step(), x.step(); }},
      {"m_r_stable",
       [](B& x) {
         x.ar(1, 64, 0), x.step(), x.r(1, true, false), x.step(), x.r(1, true), x.top.m_axi_rresp = 2, x.step();
       }},
      {"m_r_stable",
       [](B& x) {
         x.ar(1, 0, 0), x.step(), x.r(1, true, false), x.step(), x.r(1, true),
             sim::set_bits(x.top.m_axi_rdata, 0, 32, 1), x.step();
       }},
      {"m_r_stable",
       [](B& x) {
         x.ar(1, 0, 0), x.step(), x.ar(2, 0, 0), x.step(), x.r(1, true, false), x.step(), x.r(2, true), x.step();
       }},
      {"m_r_owed", [](B& x) { x.r(1, true, false), x.step(); }},
      {"m_r_owed", [](B& x) { x.ar(1, 64, 0), x.step(), x.r(2, true), x.step(); }},
      {"m_r_owed", [](B& x) { x.ar(1, 64, 0), x.r(1, true), x.step(); }},
      {"m_r_owed", [](B& x) { x.ar(1, 64, 0), x.step(), x.r(1, true), x.step(), x.r(1, true), x.step(); }},
      {"m_r_last", [](B& x) { x.ar(1, 64, 2), x.step(), x.r(1, false), x.step(), x.r(1, true, false), x.step(); }},
      {"m_r_last", [](B& x) { x.ar(1, 64, 0), x.step(), x.r(1, false), x.step(); }},
      // of two that are mixed
      {"m_r_last",
       [](B& x) {
         x.ar(1, 64, 2), x.step(), x.ar(2, 0, 1), x.step(), x.r(1, false), x.step(), x.r(2, false), x.step(),
             x.r(1, true), x.step();
       }},
      {"m_r_response", [](B& x) { x.ar(1, 64, 0), x.step(), x.r(1, true), x.top.m_axi_rresp = 1, x.step(); }},
      {"m_b_stable", [](B& x) { x.written(), x.b(false), x.step(), x.step(); }},
      {"m_b_stable", [](B& x) { x.written(), x.b(false), x.step(), x.b(), x.top.m_axi_bresp = 2, x.step(); }},
      {"m_b_owed", [](B& x) { x.aw(64, 0), x.step(), x.b(false), x.step(); }},
      {"m_b_owed", [](B& x) { x.w(true), x.step(), x.b(), x.step(); }},
      {"m_b_owed", [](B& x) { x.aw(64, 0), x.w(true), x.b(), x.step(); }},
      {"m_b_owed", [](B& x) { x.aw(64, 1), x.step(), x.w(false), x.step(), x.b(), x.step(); }},
      {"m_b_owed", [](B& x) { x.written(), x.b(), x.step(), x.b(), x.step(); }},
      {"m_b_owed", [](B& x) { x.written(), x.b(), x.top.m_axi_bid = 1, x.step(); }},
      {"m_b_response", [](B& x) { x.written(), x.b(), x.top.m_axi_bresp = 1, x.step(); }},
  };
}

/// Random legal traffic of both sides; `most` reads of each of `ids` IDs.
template <class Model>
struct Traffic {
  Traffic(std::uint64_t seed, unsigned id_count, std::size_t most_reads, unsigned long_burst, bool with_writes)
      : bus(seed),
        random(seed),
        ids(id_count),
        most(most_reads),
        longest(long_burst),
        writes(with_writes),
        reads(id_count) {
    bus.step();  // no valid on the first clock
  }
  bool chance() { return random() % 3 != 0; }

  void step() {
    Model& top = bus.top;
    if (!ar_on) {
      const auto id = static_cast<unsigned>(random() % ids);
      if (reads[id].size() < most && chance()) {
        ar_on = true, ar_id = id, ar_length = static_cast<unsigned>(random() % longest);
      }
    }
    if (!r_on && chance()) {
      for (unsigned tries = 0; tries < ids && !r_on; ++tries) {
        r_id = static_cast<unsigned>(random() % ids);
        r_on = !reads[r_id].empty();
      }
    }
    // A new write is known to both channels at once, and either may be first.
    if (writes && in_flight < 4 && addresses.size() + bursts.size() < 4 && chance()) {
      const auto length = static_cast<unsigned>(random() % longest);
      addresses.push_back(length), bursts.push_back(length + 1), ++in_flight;
    }
    const bool address_late = bus.simulation.clock() % 200 < 100 && random() % 32 != 0;  // then data come first
    aw_on = aw_on || (!addresses.empty() && !address_late && chance());
    const std::size_t data_ahead = w_done > aw_done ? w_done - aw_done : 0;
    w_on = w_on || (!bursts.empty() && data_ahead < 2 && chance());
    b_on = b_on || (std::min(w_done, aw_done) > b_done && chance());
    if (ar_on) bus.ar(ar_id, 64 * (ar_length + 1), ar_length, chance());
    if (r_on) bus.r(r_id, reads[r_id].front() == 0, chance());
    if (aw_on) bus.aw(0, addresses.front(), chance());
    if (w_on) bus.w(bursts.front() == 1, chance());
    if (b_on) bus.b(chance());
    const bool ar = ar_on && top.m_axi_arready != 0, r = r_on && top.m_axi_rready != 0;
    const bool aw = aw_on && top.m_axi_awready != 0, w = w_on && top.m_axi_wready != 0;
    const bool b = b_on && top.m_axi_bready != 0;
    bus.step();
    expect("memory_ok", bus.ok, true);
    if (r) {
      r_on = false;
      if (reads[r_id].front() == 0)
        reads[r_id].pop_front(), ++done;
      else
        --reads[r_id].front();
    }
    if (ar) ar_on = false, reads[ar_id].push_back(ar_length);
    if (aw) aw_on = false, addresses.pop_front(), ++aw_done;
    if (w) {
      w_on = false;
      if (--bursts.front() == 0) bursts.pop_front(), ++w_done;
    }
    if (b) b_on = false, ++b_done, --in_flight, ++done;
    if (w_done == aw_done + 2) ++ahead;
    if (in_flight == 4) ++full;
  }

  Bus<Model> bus;
  Random random;
  unsigned ids;
  std::size_t most;
  unsigned longest;
  bool writes;
  std::vector<std::deque<unsigned>> reads;  // of each ID: beats behind the next one
  std::deque<unsigned> addresses, bursts;   // writes to come: lengths, beats
  bool ar_on = false, r_on = false, aw_on = false, w_on = false, b_on = false;
  unsigned ar_id = 0, ar_length = 0, r_id = 0;
  std::size_t aw_done = 0, w_done = 0, b_done = 0, in_flight = 0;
  int done = 0, ahead = 0, full = 0;
};

}  // namespace

TEST_CASE("cchip_axi_rules: legal traffic breaks no rule", "[unit][cchip_axi_rules]") {
  for (std::uint64_t seed = sim::seed_from_environment(), end = seed + 4; seed != end; ++seed) {
    Traffic<All> all(seed, 8, 1, 5, true);
    for (int i = 0; i < 5000; ++i) all.step();
    CHECK(all.done > 500);
    CHECK(all.ahead > 10);  // data before their address as far as allowed
    CHECK(all.full > 10);
    Traffic<Two> two(seed, 2, 2, 1, false);
    two.bus.size = 2;
    for (int i = 0; i < 2000; ++i) two.step();
    CHECK(two.done > 500);
  }
  Bus<All> longest;
  longest.step();
  longest.ar(0, 4096, 255), longest.step();
  for (int i = 0; i < 256; ++i) longest.r(0, i == 255), longest.step();
  longest.ar(0, 4096 - 16, 0), longest.step();
}

TEST_CASE("cchip_axi_rules: each fault of a master is reported under the name of its rule", "[unit][cchip_axi_rules]") {
  for (const Wrong<All>& wrong : wrong_masters<All>()) {
    Bus<All> bus;
    const bool at_reset = std::string(wrong.rule).find("reset") != std::string::npos;
    if (!at_reset) bus.step();
    CAPTURE(wrong.rule);
    CHECK(broken([&] { wrong.run(bus); }) == std::set<std::string>{wrong.rule});
    CHECK(bus.ok);
  }
}

TEST_CASE("cchip_axi_rules: each fault of memory is reported under the name of its rule", "[unit][cchip_axi_rules]") {
  for (const Wrong<All>& wrong : wrong_memories<All>()) {
    Bus<All> bus;
    bus.step();
    CAPTURE(wrong.rule);
    CHECK(broken([&] { wrong.run(bus); }) == std::set<std::string>{wrong.rule});
  }
}

TEST_CASE("cchip_axi_rules: with MEMORY = 0 a fault of memory is memory_ok = 0 and no assertion",
          "[unit][cchip_axi_rules]") {
  for (const Wrong<Told>& wrong : wrong_memories<Told>()) {
    Bus<Told> bus;
    bus.step();
    CAPTURE(wrong.rule);
    CHECK(broken([&] { wrong.run(bus); }).empty());
    CHECK_FALSE(bus.ok);
  }
  for (const Wrong<Told>& wrong : wrong_masters<Told>()) {
    Bus<Told> bus;
    if (std::string(wrong.rule).find("reset") == std::string::npos) bus.step();
    CAPTURE(wrong.rule);
    CHECK(broken([&] { wrong.run(bus); }) == std::set<std::string>{wrong.rule});
  }
}

TEST_CASE("cchip_axi_rules: two reads of one ID end in their order, a third is one too many",
          "[unit][cchip_axi_rules]") {
  const auto begin = [](Bus<Two>& bus) {
    bus.size = 2;
    bus.step();
    bus.ar(0, 0, 1), bus.step();
    bus.ar(0, 64, 2), bus.step();
  };
  {
    Bus<Two> bus;
    begin(bus);
    CHECK(broken([&] { bus.ar(0, 0, 0, false), bus.step(); }) == std::set<std::string>{"a_ar_id"});
  }
  {
    Bus<Two> bus;
    begin(bus);
    CHECK(broken([&] { bus.r(0, false), bus.step(), bus.r(0, false), bus.step(); }) ==
          std::set<std::string>{"m_r_last"});
  }
  {
    Bus<Two> bus;
    begin(bus);
    for (int i : {0, 1, 0, 0}) bus.r(0, i == 1), bus.step();
    CHECK(broken([&] { bus.r(0, false), bus.step(); }) == std::set<std::string>{"m_r_last"});
  }
  {
    Bus<Two> bus;
    begin(bus);
    for (int i : {0, 1, 0, 0, 1}) bus.r(0, i == 1), bus.step();
    CHECK(broken([&] { bus.r(0, true), bus.step(); }) == std::set<std::string>{"m_r_owed"});
  }
  {
    Bus<Two> bus;
    bus.size = 2;
    bus.step();
    CHECK(broken([&] { bus.ar(0, 60, 1), bus.step(); }) == std::set<std::string>{"a_ar_boundary"});
  }
}
