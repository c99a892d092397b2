// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_config_controller.hpp>

#include "swap_bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

constexpr ModuleId tri = ModuleId::tri_tri;
constexpr ModuleId quad = ModuleId::quad_quad;
const std::vector<SwapPhase> every_phase = {SwapPhase::header, SwapPhase::shutdown, SwapPhase::decouple,
                                            SwapPhase::reset,  SwapPhase::transfer, SwapPhase::check,
                                            SwapPhase::roc,    SwapPhase::recouple, SwapPhase::report};

/// Body with a bench, for two states at power-up.
template <class Config, class Body>
void with_bench(Body&& body) {
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    SwapBench<Config> bench(options);
    body(bench);
  });
}

/// A slot that holds tri keeps working when a bad header asks for quad.
template <class Config>
void require_header_refused(const BitstreamHeader& header, std::uint32_t size, SwapCode code) {
  with_bench<Config>([&](SwapBench<Config>& bench) {
    bench.require_good_swap(0, tri);
    SwapRequest request = bench.load(join_bitstream(header, make_payload(0, quad, 64)), 0, quad);
    request.size = size;
    const SwapReport report = bench.swap(request);
    REQUIRE(report.code == code);
    REQUIRE(report.slot == 0);
    REQUIRE(report.module_id == static_cast<int>(quad));
    REQUIRE(bench.phases() == std::vector<SwapPhase>{SwapPhase::header, SwapPhase::report});
    REQUIRE(bench.passed().empty());
    bench.require_at_work(0, tri);
    REQUIRE(bench.rejected() == 1);
    bench.require_good_swap(0, quad);
  });
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: a swap passes every phase and every byte",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    std::uint32_t swaps = 0;
    for (int slot = 0; slot < TestType::SLOTS; ++slot) {
      for (const ModuleId module_id : {tri, quad, ModuleId::blank, ModuleId::tri_quad}) {
        const SwapReport report = bench.swap(bench.load(slot, module_id, 100, 0x7FFFFFC0));
        REQUIRE(report.code == SwapCode::ok);
        REQUIRE(report.slot == slot);
        REQUIRE(report.module_id == static_cast<int>(module_id));
        REQUIRE(report.lost == 0);
        REQUIRE(bench.phases() == every_phase);
        REQUIRE(bench.passed() == bench.payload());
        bench.require_at_work(slot, module_id);
        REQUIRE(bench.swaps() == ++swaps);
      }
    }
    REQUIRE(bench.rejected() == 0);
    REQUIRE(bench.reports().size() == swaps);
    REQUIRE(bench.phase_clocks(SwapPhase::transfer) != 0);
    bench.top().clear = 1;
    bench.simulation().step();
    bench.top().clear = 0;
    REQUIRE(bench.phase_clocks(SwapPhase::transfer) == 0);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: clocks of a swap are eq. (4) and a fixed rest",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    const std::size_t step = TestType::CFG_W / 8;
    int swaps = 0;
    for (const std::uint64_t latency : {1, 2, 9}) {
      for (std::size_t bytes : {16, 17, 18, 19, 20, 59, 60, 61, 100, 255, 256, 1000}) {
        if (bytes % step != 0) continue;
        for (const int drain : {2, 3, 20}) {
          sim::AxiMemoryOptions options;
          options.latency = latency;
          bench.memory().set_options(options);
          bench.behaviour().drain = drain;
          const SwapReport report = bench.swap(bench.load(0, ++swaps % 2 != 0 ? tri : quad, bytes));
          bench.simulation().steps(3);
          REQUIRE(report.code == SwapCode::ok);
          REQUIRE(bench.stalls() == 0);
          const std::uint64_t transfer = transfer_clocks(bytes, TestType::CFG_W, TestType::CFG_DIVIDER);
          const auto drained = static_cast<std::uint64_t>(drain);
          REQUIRE(bench.phase_clocks(SwapPhase::header) == 17 + latency);
          REQUIRE(bench.phase_clocks(SwapPhase::shutdown) == 3 + drained);
          REQUIRE(bench.phase_clocks(SwapPhase::decouple) == 4);
          REQUIRE(bench.phase_clocks(SwapPhase::reset) == 2);
          REQUIRE(bench.phase_clocks(SwapPhase::transfer) == transfer + 8 + latency);
          REQUIRE(bench.phase_clocks(SwapPhase::check) == 9);
          REQUIRE(bench.phase_clocks(SwapPhase::roc) == 35 + 2);  // the reset itself
          REQUIRE(bench.phase_clocks(SwapPhase::recouple) == 4);
          REQUIRE(bench.phase_clocks(SwapPhase::report) == 1);
          REQUIRE(report.clock - bench.accepted() == transfer + 2 * latency + drained + 85);
        }
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: bad headers", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  const Bytes payload = make_payload(0, quad, 64);
  const BitstreamHeader good{defs::bitstream_magic, 0, quad, 64, crc32(payload)};
  const auto refused = [&](const char* what, auto BitstreamHeader::*field, auto value, std::uint32_t size,
                           SwapCode code) {
    DYNAMIC_SECTION(what) {
      BitstreamHeader bad = good;
      bad.*field = static_cast<std::decay_t<decltype(bad.*field)>>(value);
      require_header_refused<TestType>(bad, size, code);
    }
  };
  refused("magic", &BitstreamHeader::magic, good.magic ^ 0x100, 80, SwapCode::magic);
  refused("slot", &BitstreamHeader::slot, 1, 80, SwapCode::slot);
  refused("module", &BitstreamHeader::module_id, tri, 80, SwapCode::module);
  refused("length beyond the end: truncated", &BitstreamHeader::length, 68, 80, SwapCode::length);
  refused("length before the end: over-long", &BitstreamHeader::length, 60, 80, SwapCode::length);
  refused("payload too short", &BitstreamHeader::length, 12, 28, SwapCode::length);
  refused("less than a header", &BitstreamHeader::length, 0xFFFFFFFC, 12, SwapCode::length);
  if (TestType::CFG_W == 32) refused("no whole words", &BitstreamHeader::length, 63, 79, SwapCode::length);
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: requests refused", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    const SwapRequest good = bench.load(0, quad, 64);
    const auto refused = [&](const SwapRequest& request, SwapCode code) {
      const std::uint64_t bursts = bench.memory().bursts();
      REQUIRE(bench.swap(request).code == code);
      REQUIRE(bench.memory().bursts() == bursts);
      bench.require_at_work(0, tri);
    };
    SwapRequest r = good;
    r.slot = TestType::SLOTS;
    refused(r, SwapCode::request);
    r = good;
    r.slot = 128;
    refused(r, SwapCode::request);
    r = good;
    r.module_id = defs::kinds_max + 1;
    refused(r, SwapCode::request);
    r = good;
    r.address += 16;
    refused(r, SwapCode::request);
    r = good;
    r.size = 0;
    refused(r, SwapCode::request);
    r = good;
    r.address = 0xFFFFFFC0;
    r.size = 80;
    refused(r, SwapCode::request);
    r = good;
    r.module_id = static_cast<int>(tri);
    refused(r, SwapCode::same);
    REQUIRE(bench.rejected() == 6);
    REQUIRE(bench.swaps() == 1);
    bench.require_good_swap(0, quad);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: each bit of a number, an end of file, a count of lost pairs",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    for (int slot = 0; slot < TestType::SLOTS; ++slot) bench.require_good_swap(slot, tri);
    const SwapRequest good = bench.load(0, quad, 64);
    const auto refused = [&](const SwapRequest& request) {
      CAPTURE(request.slot, request.module_id, request.address, request.size);
      const SwapReport report = bench.swap(request);
      REQUIRE(report.code == SwapCode::request);
      REQUIRE(report.slot == request.slot);
      REQUIRE(report.module_id == request.module_id);
      REQUIRE(report.lost == 0);
    };
    for (int bit = 0; bit < 8; ++bit) {
      SwapRequest r = good;
      r.slot = 1 << bit;
      if (r.slot >= TestType::SLOTS) refused(r);
      r.slot |= TestType::SLOTS;
      refused(r);
      r = good;
      r.module_id = 1 << bit | (defs::kinds_max + 1);
      refused(r);
    }
    for (int bit = 0; bit < 32; ++bit) {
      SwapRequest r = good;
      r.address = 0xFFFFFFC0;
      r.size = 64 + (1U << bit);  // ends at 2^32 + 2^bit
      refused(r);
      if (bit < 6) {
        r = good;
        r.address += 1U << bit;
        refused(r);
      }
    }
    for (std::size_t bytes = 2048; bytes <= 32768; bytes *= 2) {
      bench.start(bench.load(0, bytes % 3 == 2 ? quad : ModuleId::tri_quad, bytes));
      REQUIRE(bench.finish(400000).code == SwapCode::ok);
      REQUIRE(bench.passed() == bench.payload());
    }
    bench.require_good_swap(0, tri);
    bench.top().shutdown_limit = 20;
    for (int slot = 0; slot < TestType::SLOTS; ++slot) {
      for (int other = 0; other < TestType::SLOTS; ++other) {  // what another slot lost is not counted here
        if (other == slot) continue;
        SwapRequest request = bench.load(other, ModuleId::tri_quad, 16);
        bench.behaviour(other).inside = 0xFFFF;
        bench.behaviour(other).drain = -1;
        request.force = true;
        REQUIRE(bench.swap(request).lost == 0xFFFF);
      }
      for (int bit = 0; bit < 16; ++bit) {
        CAPTURE(slot, bit);
        for (int other = 0; other < TestType::SLOTS; ++other) bench.behaviour(other).inside = other * 37;
        SwapRequest request = bench.load(slot, bit % 2 == 0 ? quad : tri, 16);
        bench.behaviour(slot).inside = 1 << bit;
        bench.behaviour(slot).drain = -1;
        request.force = true;
        const SwapReport report = bench.swap(request);
        REQUIRE(report.code == SwapCode::ok);
        REQUIRE(report.slot == slot);
        REQUIRE(report.module_id == request.module_id);
        REQUIRE(report.lost == 1U << bit);
        bench.behaviour(slot) = SlotBehaviour{};
      }
      for (int bit = 0; bit < 8; ++bit) {  // a region that shows another number
        CAPTURE(slot, bit);
        bench.behaviour(slot).becomes = static_cast<int>(quad) ^ 1 << bit;
        REQUIRE(bench.swap(bench.load(slot, quad, 16)).code == SwapCode::wrong_module);
        bench.require_shut(slot);
        bench.require_good_swap(slot, quad);
        bench.require_good_swap(slot, tri);
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: requests that are offered on any clock of a swap wait for its end",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bool ended = false;
    for (std::uint64_t wait = 0; !ended; ++wait) {
      const SwapRequest good = bench.load(0, wait % 2 != 0 ? tri : quad, 16);
      const std::size_t before = bench.reports().size();
      bench.start(good);
      bench.simulation().steps(wait);
      ended = bench.phase() == SwapPhase::idle;
      if (ended) break;
      std::vector<SwapRequest> others(4, good);
      for (std::size_t i = 0; i < others.size(); ++i) {
        others[i].module_id = static_cast<int>((wait * 91 + i) % 256);
        others[i].slot = static_cast<int>(4 + (wait * 37 + i) % 252);
      }
      bench.offer(others);
      bench.simulation().run_until([&] { return bench.reports().size() > before; }, 500, "the end of the swap");
      REQUIRE(bench.waiting() == others.size());
      REQUIRE(bench.passed() == bench.payload());
      bench.simulation().run_until([&] { return bench.reports().size() == before + 1 + others.size(); }, 500,
                                   "a report for each request");
      bench.simulation().steps(20);
      CAPTURE(wait);
      REQUIRE(bench.reports().size() == before + 1 + others.size());
      REQUIRE(bench.reports()[before].code == SwapCode::ok);
      REQUIRE(bench.reports()[before].slot == 0);
      for (std::size_t i = 0; i < others.size(); ++i) {
        const SwapReport& report = bench.reports()[before + 1 + i];
        REQUIRE(report.code == SwapCode::request);
        REQUIRE(report.slot == others[i].slot);
        REQUIRE(report.module_id == others[i].module_id);
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: a file of any size passes its header, each bit of the size alone",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    const Bytes payload = make_payload(0, quad, 64);
    for (int bit = 6; bit < 32; ++bit) {
      CAPTURE(bit);
      const std::uint32_t length = (1U << bit) + 48;
      SwapRequest request =
          bench.load(join_bitstream({defs::bitstream_magic, 0, quad, length, 0}, payload), 0, quad, 0x1000);
      request.size = length + 16;
      bench.start(request);
      bench.simulation().run_until(
          [&] { return bench.phase() == SwapPhase::transfer || bench.phase() == SwapPhase::report; }, 500, "a verdict");
      REQUIRE(bench.phase() == SwapPhase::transfer);
      bench.top().abort_swap = 1;
      REQUIRE(bench.finish().code == SwapCode::aborted);
      bench.top().abort_swap = 0;
      bench.simulation().steps(100);  // words that are still owed
      bench.require_good_swap(0, tri);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: each bit of the limit of a shutdown alone gives its time",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    for (int bit = 8; bit < 32; ++bit) {
      CAPTURE(bit);
      bench.top().shutdown_limit = (1U << bit) + 16;
      const SwapRequest request = bench.load(0, bit % 2 == 0 ? quad : tri, 16);
      bench.behaviour(0).drain = 200;
      REQUIRE(bench.swap(request).code == SwapCode::ok);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: a slot that is shut stays so, whatever becomes of the other",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  if constexpr (TestType::SLOTS > 1) {
    with_bench<TestType>([](SwapBench<TestType>& bench) {
      for (const int shut : {0, 1}) {
        const int other = 1 - shut;
        bench.require_good_swap(shut, tri);
        bench.require_good_swap(other, tri);
        bench.behaviour(shut).spoilt = true;
        REQUIRE(bench.swap(bench.load(shut, quad, 16)).code == SwapCode::wrong_module);
        bench.require_shut(shut);
        // it shows any numbers meanwhile
        for (int i = 0; i < 5; ++i) bench.require_good_swap(other, i % 2 == 0 ? quad : tri);
        bench.require_shut(shut);
        SwapRequest request = bench.load(other, tri, 16);
        request.size += 4;
        REQUIRE(bench.swap(request).code == SwapCode::length);
        bench.require_shut(shut);
        bench.require_at_work(other, quad);
        bench.behaviour(other).spoilt = true;
        REQUIRE(bench.swap(bench.load(other, tri, 16)).code == SwapCode::wrong_module);
        bench.require_shut(shut);
        bench.require_shut(other);
        bench.require_good_swap(shut, quad);
        bench.require_shut(other);
        bench.require_good_swap(other, quad);
      }
    });
  }
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: wrong CRC", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    for (const std::size_t at : {0, 37, 99}) {
      Bytes bytes = make_bitstream(0, quad, make_payload(0, quad, 100));
      bytes[defs::bitstream_header + at] ^= 0x10;
      REQUIRE(bench.swap(bench.load(bytes, 0, quad)).code == SwapCode::crc);
      REQUIRE(bench.phases().back() == SwapPhase::report);
      REQUIRE(bench.passed().size() == 100);
      bench.require_shut(0);
      bench.reset();
      bench.require_shut(0);
      bench.require_good_swap(0, tri);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: faults of the bus", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  using Burst = std::vector<sim::AxiBeat>;
  const auto fault = GENERATE(0, 1, 2, 3, 4, 5);
  const auto spoil = [fault](Burst& burst, std::size_t i) {
    switch (fault) {
      case 0:
        burst[i].response = sim::AxiResponse::slave_error;
        break;
      case 1:
        burst[i].response = sim::AxiResponse::decode_error;
        break;
      case 2:
        burst[i].response = sim::AxiResponse::exclusive_okay;
        break;
      case 3:  // ends early, unless it was the last anyway
        burst.resize(i + 1);
        burst[i].last = true;
        break;
      case 4:  // ends after the last word
        burst.back().last = false;
        burst.push_back(burst.back());
        burst.back().last = true;
        break;
      default:  // ends long after it
        burst.back().last = false;
        for (int extra = 0; extra < 40; ++extra) burst.push_back(burst.back());
        burst.back().last = true;
        break;
    }
  };
  with_bench<TestType>([&](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    for (const std::uint32_t at : {0U, 1U, 2U, 4U, 9U, 14U, 16U, 30U, 48U, 66U}) {  // word of the file
      const SwapRequest request = bench.load(0, quad, 256);
      bool spoilt = false;
      bench.memory().set_fault([&](Burst& burst) {
        for (std::size_t i = 0; i < burst.size() && !spoilt; ++i) {
          if (burst[i].address != request.address + 4 * at) continue;
          spoilt = true;
          spoil(burst, i);
        }
      });
      REQUIRE(bench.swap(request).code == SwapCode::bus);
      REQUIRE(spoilt);
      if (at < 4) {
        bench.require_at_work(0, tri);
        REQUIRE(bench.passed().empty());
      } else {
        bench.require_shut(0);
      }
      bench.simulation().steps(100);
      REQUIRE(bench.memory().owed() == 0);
      bench.require_good_swap(0, quad);
      bench.require_good_swap(0, tri);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: file that ends in memory that does not exist",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    Bytes bytes = make_bitstream(0, quad, make_payload(0, quad, 200));
    SwapRequest request = bench.load(Bytes(bytes.begin(), bytes.begin() + 150), 0, quad);
    request.size = static_cast<std::uint32_t>(bytes.size());
    REQUIRE(bench.swap(request).code == SwapCode::bus);
    bench.require_shut(0);
    bench.simulation().steps(100);
    bench.require_good_swap(0, quad);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: memory that stops, and its late beats",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    for (const int beats : {-1, 0, 1, 3, 4, 5, 15, 16, 33}) {  // -1: not even an address is taken
      const SwapRequest request = bench.load(0, quad, 256);
      if (beats < 0) bench.memory().refuse_addresses();
      if (beats >= 0) bench.memory().stop_after(static_cast<std::uint64_t>(beats));
      REQUIRE(bench.swap(request).code == SwapCode::memory);
      const bool at_work = beats < 4;
      if (at_work) bench.require_at_work(0, tri);
      if (!at_work) bench.require_shut(0);
      // no other swap may start while beats are outstanding
      REQUIRE(bench.swap(request).code == SwapCode::owed);
      REQUIRE(bench.phases() == std::vector<SwapPhase>{SwapPhase::header, SwapPhase::report});
      bench.memory().resume();
      bench.simulation().steps(100);
      REQUIRE(bench.memory().owed() == 0);
      bench.require_good_swap(0, quad);
      bench.require_good_swap(0, tri);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: the limit of the memory is exact", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    for (const std::uint64_t limit : {5, 20}) {
      bench.top().memory_limit = static_cast<std::uint32_t>(limit);
      sim::AxiMemoryOptions options;
      options.latency = limit;  // the beat comes on the last clock that is allowed
      bench.memory().set_options(options);
      REQUIRE(bench.swap(bench.load(0, quad, 16)).code == SwapCode::ok);
      options.latency = limit + 1;
      bench.memory().set_options(options);
      REQUIRE(bench.swap(bench.load(0, tri, 16)).code == SwapCode::memory);
      bench.memory().set_options({});
      bench.simulation().steps(50);
      bench.require_good_swap(0, tri);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: abort on every clock of a swap", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    std::vector<int> seen(10);
    for (std::uint64_t wait = 0;; ++wait) {
      const SwapRequest request = bench.load(0, quad, 16);
      bench.start(request);
      bench.simulation().steps(wait);
      const SwapPhase phase = bench.phase();
      if (phase == SwapPhase::idle) break;
      ++seen[static_cast<std::size_t>(phase)];
      const std::size_t before = bench.reports().size();
      bench.top().abort_swap = 1;
      bench.simulation().step();
      bench.top().abort_swap = 0;
      bench.simulation().run_until([&] { return bench.phase() == SwapPhase::idle; }, 300, "the end of the swap");
      bench.simulation().steps(40);
      REQUIRE(bench.reports().size() == before + 1);
      const SwapCode code = bench.reports().back().code;
      // an abort takes effect a clock later, so the last clock of a phase belongs to the next one; the wait for a
      // decoupling slot belongs to RESET
      const SwapPhase last = bench.phases()[bench.phases().size() - 2];
      if (code == SwapCode::aborted) {
        REQUIRE(last <= SwapPhase::roc);
        REQUIRE(last != SwapPhase::decouple);
        const int first = static_cast<int>(phase == SwapPhase::shutdown ? SwapPhase::decouple : phase);
        REQUIRE(static_cast<int>(last) - first <= 1);
        if (last < SwapPhase::decouple) bench.require_at_work(0, tri);
        if (last >= SwapPhase::decouple) bench.require_shut(0);
        if (last == SwapPhase::reset) REQUIRE(bench.passed().empty());
      } else {
        REQUIRE(code == SwapCode::ok);
        REQUIRE(phase >= SwapPhase::roc);
        bench.require_at_work(0, quad);
      }
      bench.require_good_swap(0, ModuleId::tri_quad);
      bench.require_good_swap(0, tri);
    }
    for (const SwapPhase phase : every_phase) REQUIRE(seen[static_cast<std::size_t>(phase)] > 0);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: reset on every clock of a swap", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    for (std::uint64_t wait = 0;; ++wait) {
      bench.start(bench.load(0, quad, 16));
      bench.simulation().steps(wait);
      const SwapPhase phase = bench.phase();
      if (phase == SwapPhase::idle) break;
      const std::size_t before = bench.reports().size();
      bench.reset();
      bench.simulation().steps(300);
      REQUIRE(bench.phase() == SwapPhase::idle);
      REQUIRE(bench.reports().size() == before);
      if (phase < SwapPhase::transfer) bench.require_at_work(0, tri);
      if (phase >= SwapPhase::transfer && phase <= SwapPhase::roc) bench.require_shut(0);
      if (phase > SwapPhase::roc) bench.require_at_work(0, quad);
      bench.require_good_swap(0, ModuleId::tri_quad);
      bench.require_good_swap(0, tri);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: a slot that never becomes quiet", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    for (const std::uint32_t limit : {1U, 30U}) {
      bench.top().shutdown_limit = limit;
      bench.behaviour().drain = -1;
      SwapRequest request = bench.load(0, quad, 64);
      SwapReport report = bench.swap(request);
      REQUIRE(report.code == SwapCode::shutdown);
      REQUIRE(report.lost == 0);
      bench.require_at_work(0, tri);
      REQUIRE(bench.phase_clocks(SwapPhase::shutdown) == limit + 2);
      request.force = true;
      report = bench.swap(request);
      REQUIRE(report.code == SwapCode::ok);
      REQUIRE(report.lost == 7);
      REQUIRE(bench.phase_clocks(SwapPhase::shutdown) == limit + 2);
      bench.require_at_work(0, quad);
      // force without need loses nothing
      bench.top().shutdown_limit = 40;
      bench.behaviour().drain = 3;
      request = bench.load(0, tri, 64);
      request.force = true;
      report = bench.swap(request);
      REQUIRE(report.code == SwapCode::ok);
      REQUIRE(report.lost == 0);
    }
  });
}

TEMPLATE_LIST_TEST_CASE(
    "cchip_config_controller: a limit that changes during a swap counts from then on, 0 is the default",
    "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    const auto start = [&](SwapPhase phase) {
      bench.start(bench.load(0, quad, 64));
      bench.simulation().run_until([&] { return bench.phase() == phase; }, 100, "the phase");
    };
    for (const std::uint32_t high : {100000U, 0U, ~0U}) {
      for (const std::uint32_t low : {1U, 30U}) {
        CAPTURE(high, low);
        // pairs
        bench.top().shutdown_limit = high;
        bench.behaviour().drain = -1;
        for (const std::uint32_t other : {0U, ~0U, 5000U}) {
          CAPTURE(other);
          start(SwapPhase::shutdown);
          bench.simulation().steps(40);
          bench.top().shutdown_limit = other;  // up or down, but far away
          bench.simulation().steps(200);
          REQUIRE(bench.phase() == SwapPhase::shutdown);
          bench.top().shutdown_limit = low;  // has passed
          bench.simulation().steps(5);
          REQUIRE(bench.reports().back().code == SwapCode::shutdown);
          REQUIRE(bench.phase() == SwapPhase::idle);
          bench.top().shutdown_limit = low;
          bench.start(bench.load(0, quad, 64));
          if (low > 10) {
            bench.simulation().run_until([&] { return bench.phase() == SwapPhase::shutdown; }, 100, "the phase");
            bench.simulation().steps(low - 3);
            bench.top().shutdown_limit = other;  // just in time
            bench.simulation().steps(200);
            REQUIRE(bench.phase() == SwapPhase::shutdown);
            bench.top().shutdown_limit = low;
          }
          REQUIRE(bench.finish().code == SwapCode::shutdown);
          bench.top().shutdown_limit = high;
        }
        bench.top().shutdown_limit = 40;
        bench.behaviour().drain = 3;
        // memory
        bench.top().memory_limit = high;
        sim::AxiMemoryOptions options;
        options.latency = 2000;
        bench.memory().set_options(options);
        for (const std::uint32_t other : {0U, ~0U, 5000U}) {
          CAPTURE(other);
          start(SwapPhase::header);
          bench.simulation().steps(100);
          bench.top().memory_limit = other;
          bench.simulation().steps(200);
          REQUIRE(bench.phase() == SwapPhase::header);
          bench.top().memory_limit = low;
          bench.simulation().steps(7);
          REQUIRE(bench.reports().back().code == SwapCode::memory);
          REQUIRE(bench.phase() == SwapPhase::idle);
          bench.top().memory_limit = high;
          bench.simulation().run_until([&] { return bench.memory().owed() == 0; }, 4000, "the late beats");
          bench.simulation().steps(5);
        }
        bench.memory().set_options({});
        bench.require_at_work(0, tri);
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: force and abort together lose count of nothing",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    for (std::uint64_t wait = 0; wait < 12; ++wait) {
      bench.top().shutdown_limit = 10;
      bench.behaviour().drain = -1;
      SwapRequest request = bench.load(0, quad, 64);
      request.force = true;
      bench.start(request);
      bench.simulation().run_until([&] { return bench.phase() == SwapPhase::shutdown; }, 100, "the shutdown");
      bench.simulation().steps(5 + wait);
      bench.top().abort_swap = 1;
      bench.simulation().step();
      bench.top().abort_swap = 0;
      if (bench.phase() != SwapPhase::report) bench.finish();
      bench.simulation().steps(5);
      const SwapReport report = bench.reports().back();
      REQUIRE(report.code == SwapCode::aborted);
      const bool decoupled = bench.top().decouple % 2 != 0;
      REQUIRE(report.lost == (decoupled ? 7 : 0));
      bench.top().shutdown_limit = 40;
      bench.require_good_swap(0, quad);
      bench.require_good_swap(0, tri);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: error of the device", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    int failed = 0;
    int unharmed = 0;
    for (std::uint64_t wait = 0;; ++wait) {
      bench.start(bench.load(0, quad, 16));
      bench.simulation().steps(wait);
      const SwapPhase phase = bench.phase();
      if (phase == SwapPhase::idle) break;
      bench.top().cfg_error = 1;
      bench.simulation().step();
      bench.top().cfg_error = 0;
      bench.simulation().run_until([&] { return bench.phase() == SwapPhase::idle; }, 300, "the end of the swap");
      const SwapCode code = bench.reports().back().code;
      if (code == SwapCode::device) {
        REQUIRE((phase == SwapPhase::transfer || phase == SwapPhase::check));
        bench.require_shut(0);
        ++failed;
      } else {
        REQUIRE(code == SwapCode::ok);
        REQUIRE(phase != SwapPhase::transfer);
        ++unharmed;
      }
      bench.require_good_swap(0, tri);
    }
    REQUIRE(failed > 15);
    REQUIRE(unharmed > 15);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: another module than the one asked for",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    const SwapRequest request = bench.load(0, quad, 64);
    bench.behaviour().becomes = static_cast<int>(ModuleId::tri_quad);
    REQUIRE(bench.swap(request).code == SwapCode::wrong_module);
    bench.require_shut(0);
    // garbage may show any number now and then
    bench.behaviour().spoilt = true;
    for (int i = 0; i < 300; ++i) REQUIRE(bench.swap(request).code == SwapCode::wrong_module);
    bench.require_shut(0);
    bench.behaviour().spoilt = false;
    // decoupled: the same number does not count as the same module
    bench.behaviour().becomes = static_cast<int>(quad);
    REQUIRE(bench.swap(request).code == SwapCode::ok);
    bench.require_at_work(0, quad);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: a module without reset on configuration is not coupled",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    for (const int clocks : {1, 2, 32}) {
      SwapRequest request = bench.load(0, quad, 64);
      bench.behaviour().roc_clocks = 0;
      REQUIRE(bench.swap(request).code == SwapCode::wrong_module);
      bench.require_shut(0);
      bench.behaviour().roc_clocks = clocks;
      REQUIRE(bench.swap(request).code == SwapCode::ok);
      bench.require_at_work(0, quad);
      bench.require_good_swap(0, tri);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: the time in which a module has to show its number is exact",
                        "[unit][cchip_config_controller]", cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    for (const int roc_clocks : {1, 2, 7, 32}) {
      for (const int settles : {0, 1, defs::rm_settle_clocks, defs::rm_settle_clocks + 1}) {
        CAPTURE(roc_clocks, settles);
        const SwapRequest request = bench.load(0, quad, 64);
        bench.behaviour().roc_clocks = roc_clocks;
        bench.behaviour().settles = settles;
        const bool in_time = settles <= defs::rm_settle_clocks;
        REQUIRE(bench.swap(request).code == (in_time ? SwapCode::ok : SwapCode::wrong_module));
        if (!in_time) bench.require_shut(0);
        bench.require_good_swap(0, tri);
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: slots that do not follow", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    bench.require_good_swap(0, tri);
    bench.behaviour().follows = false;
    REQUIRE(bench.swap(bench.load(0, quad, 64)).code == SwapCode::device);
    REQUIRE(bench.phase_clocks(SwapPhase::decouple) == TestType::SLOT_LIMIT + 2);
    REQUIRE(bench.passed().empty());
    bench.require_good_swap(0, quad);
    const SwapRequest request = bench.load(0, tri, 64);
    bench.behaviour().roc_clocks = -1;
    REQUIRE(bench.swap(request).code == SwapCode::device);
    bench.require_shut(0);
    bench.require_good_swap(0, tri);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_config_controller: random memories, slots and faults", "[unit][cchip_config_controller]",
                        cchip_config_controller_configs) {
  with_bench<TestType>([](SwapBench<TestType>& bench) {
    Random random(bench.simulation().seed());
    const std::size_t step = TestType::CFG_W / 8;
    std::vector<int> codes(16);
    bench.top().memory_limit = 500;
    for (int round = 0; round < 400; ++round) {
      sim::AxiMemoryOptions options;
      options.latency = 1 + random() % 30;
      const auto patterns = sim::standard_patterns(random());
      options.address_ready = patterns[random() % patterns.size()];
      options.beat_valid = patterns[random() % patterns.size()];
      bench.memory().set_options(options);
      bench.memory().set_fault({});
      const int slot = static_cast<int>(random()) & (TestType::SLOTS - 1);
      const auto module_id = static_cast<ModuleId>(random() % (defs::kinds_max + 1));
      bench.behaviour(slot) = SlotBehaviour{};
      bench.behaviour(slot).drain = static_cast<int>(random() % 50) + 2;
      const std::size_t bytes = (16 + random() % 300) / step * step;
      SwapRequest request = bench.load(slot, module_id, bytes, static_cast<std::uint32_t>(random()) & 0x7FFFFFC0U);
      request.force = random() % 4 == 0;
      const int before = bench.region(slot);
      if (chance(random, 20)) {
        bench.memory().set_fault([&](std::vector<sim::AxiBeat>& burst) {
          if (chance(random, 10)) burst[random() % burst.size()].response = sim::AxiResponse::slave_error;
          if (chance(random, 10)) burst[random() % burst.size()].data ^= 1U << random() % 32;
        });
      }
      const bool aborts = chance(random, 15);
      const std::uint64_t when = random() % 600;
      const std::size_t count = bench.reports().size();
      bench.start(request);
      std::uint64_t clocks = 0;
      bench.simulation().run_until(
          [&] {
            bench.top().abort_swap = aborts && clocks == when ? 1 : 0;
            if (chance(random, 5)) bench.top().memory_limit = any_limit(random, 500);
            if (chance(random, 5)) bench.top().shutdown_limit = any_limit(random, 40);
            ++clocks;
            return bench.reports().size() > count;
          },
          40000, "a report");
      bench.top().abort_swap = 0;
      const SwapReport report = bench.reports().back();
      REQUIRE(report.slot == slot);
      REQUIRE(report.module_id == static_cast<int>(module_id));
      REQUIRE(report.code !=
              SwapCode::memory);  // the changing limit is never below 500: a pattern may pause for more than 100
      ++codes[static_cast<std::size_t>(report.code)];
      bench.simulation().steps(5);
      REQUIRE(bench.reports().size() == count + 1);
      switch (report.code) {
        case SwapCode::ok:
          REQUIRE(bench.passed() == bench.payload());
          bench.require_at_work(slot, module_id);
          break;
        case SwapCode::same:
          bench.require_at_work(slot, module_id);
          REQUIRE(before == static_cast<int>(module_id));
          break;
        case SwapCode::crc:
        case SwapCode::device:
        case SwapCode::wrong_module:
          bench.require_shut(slot);
          break;
        default:
          break;
      }
      bench.memory().set_options({});
      bench.simulation().steps(200);
      REQUIRE(bench.memory().owed() == 0);
    }
    for (const SwapCode code :
         {SwapCode::ok, SwapCode::same, SwapCode::crc, SwapCode::bus, SwapCode::aborted, SwapCode::shutdown}) {
      INFO(static_cast<int>(code));
      REQUIRE(codes[static_cast<std::size_t>(code)] > 0);
    }
  });
}
