// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_stream_merge.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// The merge, clock by clock: the first source with a beat behind the last one, into a skid buffer.
template <int SOURCES>
class MergeModel {
 public:
  /// Source whose beat is taken on this clock, SOURCES if none.
  int next(unsigned valid) const {
    for (int i = 1; i <= SOURCES; ++i) {
      const int source = (last_ + i) % SOURCES;
      if ((valid >> source & 1U) != 0) return source;
    }
    return SOURCES;
  }
  unsigned ready(unsigned valid) const {
    const int source = next(valid);
    return source < SOURCES && out.s_ready() ? 1U << source : 0;
  }
  void clock(unsigned valid, const std::array<std::uint64_t, SOURCES>& data, bool m_ready) {
    const int source = next(valid);
    const bool taken = ready(valid) != 0;
    out.clock(source < SOURCES, source < SOURCES ? data[static_cast<std::size_t>(source)] : 0, m_ready);
    if (taken) last_ = source;
  }
  void reset() {
    out.reset();
    last_ = SOURCES - 1;
  }
  model::SkidBuffer<std::uint64_t> out;

 private:
  int last_ = SOURCES - 1;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_stream_merge: every output on every clock is the model's", "[unit][cchip_stream_merge]",
                        cchip_stream_merge_configs) {
  constexpr int sources = TestType::SOURCES;
  constexpr int width = TestType::WIDTH;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    for (const sim::Pattern& sink : sim::standard_patterns(options.seed)) {
      for (const int percent : {100, 50, 10}) {
        INFO("sink " << sink.name() << ", sources " << percent << " %");
        Random random(options.seed);
        sim::Pattern accept = sink;
        sim::Simulation<typename TestType::Model> simulation(options);
        auto& top = simulation.top();
        MergeModel<sources> model;
        std::array<std::uint64_t, sources> data{};
        std::array<int, sources> passed{}, others{};
        unsigned valid = 0;
        bool defined = false;
        Bench bench(
            [&](const sim::ClockInfo&) {
              for (int i = 0; i < sources; ++i) {
                const bool offers = (valid >> i & 1U) != 0;
                if (offers && !chance(random, 2)) continue;  // now and then an offer is withdrawn
                valid &= ~(1U << i);
                if (!chance(random, percent)) continue;
                valid |= 1U << i;
                data[static_cast<std::size_t>(i)] = random() & ((1U << width) - 1);
              }
              top.s_valid = static_cast<CData>(valid);
              for (int i = 0; i < sources; ++i) {
                sim::set_bits(top.s_data, width * i, width, data[static_cast<std::size_t>(i)]);
              }
              top.m_ready = accept.next() ? 1 : 0;
            },
            [&](const sim::ClockInfo& now) {
              if (defined) {
                expect("s_ready", unsigned{top.s_ready}, model.ready(valid));
                expect("m_valid", top.m_valid != 0, model.out.m_valid());
                if (model.out.m_valid()) expect("m_data", std::uint64_t{top.m_data}, model.out.m_data());
              }
              if (now.in_reset) {
                model.reset();
                defined = true;
                valid = 0;
                others.fill(0);
                return;
              }
              const unsigned ready = model.ready(valid);
              model.clock(valid, data, top.m_ready != 0);
              for (std::size_t i = 0; i < sources; ++i) {
                if ((valid >> i & 1U) == 0 || (ready >> i & 1U) != 0) others[i] = 0;
                if ((ready >> i & 1U) != 0) {
                  ++passed[i];
                  continue;
                }
                others[i] += ready != 0 && (valid >> i & 1U) != 0 ? 1 : 0;
                sim::require(others[i] < sources, "a source waits for more than one beat of each other");
              }
              valid &= ~ready;
            });
        simulation.add(bench);
        for (int part = 0; part < 2; ++part) {
          simulation.reset(1);
          simulation.steps(500);
        }
        for (const int p : passed) REQUIRE(p > 5);
      }
    }
  });
}
