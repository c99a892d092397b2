// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <models/cchip_sat_compare.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

struct Task {
  bool cross = false;
  model::Word3 p{};
};

/// Eq. 3 of the paper, word for word: closed intervals, disjoint if one ends before the other begins.
bool intervals_disjoint(const Task& task) {
  const auto [p0, p1, p2] = task.p;
  const auto a = task.cross ? std::minmax({std::int64_t{0}, p0}) : std::pair<std::int64_t, std::int64_t>(0, 0);
  const auto b = task.cross ? std::minmax({p1, p2}) : std::minmax({p0, p1, p2});
  return a.second < b.first || b.second < a.first;
}

/// Every small case (touching by zero, missing by one), then numbers as large as differences allow.
std::vector<Task> tasks(Random& random, int proj_w) {
  std::vector<Task> list;
  for (const bool cross : {false, true}) {
    for (int i = 0; i < 125; ++i) list.push_back({cross, {i / 25 - 2, i / 5 % 5 - 2, i % 5 - 2}});
  }
  for (int i = 0; i < 20000; ++i) list.push_back({chance(random, 50), random_word3(random, proj_w - 1)});
  const auto large = extremes(proj_w - 1);
  for (const std::int64_t p : large) {  // sets that touch or miss by one step far from 0
    for (const int q : {-1, 0, 1}) {
      list.push_back({true, {p, model::wrap(static_cast<std::uint64_t>(p + q), proj_w - 1), p}});
      list.push_back({true, {p, p, model::wrap(static_cast<std::uint64_t>(p + q), proj_w - 1)}});
    }
  }
  return list;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_sat_compare: verdict and signs after the generated latency", "[unit][cchip_sat_compare]",
                        cchip_sat_compare_configs) {
  using Model = typename TestType::Model;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    const std::vector<Task> list = tasks(random, TestType::PROJ_W);
    sim::Simulation<Model> simulation(options);
    Model& top = simulation.top();
    model::Delay<std::optional<Task>> delay(static_cast<std::size_t>(defs::compare_latency()));
    std::size_t next = 0;
    int separated = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          const Task& task = list[std::min(next, list.size() - 1)];
          top.s_cross = task.cross ? 1 : 0;
          set_word3(top.s_projection, TestType::PROJ_W, task.p);
        },
        [&](const sim::ClockInfo&) {
          if (const auto& task = delay.q()) {
            const model::Verdict v = model::sat_compare(task->cross, task->p, TestType::PROJ_W);
            expect("m_separated", top.m_separated != 0, v.separated);
            expect("m_separated", top.m_separated != 0, intervals_disjoint(*task));
            for (unsigned i = 0; i < 3; ++i) {
              expect("m_negative", (top.m_negative >> i & 1) != 0, v.negative[i]);
              expect("m_negative", (top.m_negative >> i & 1) != 0, task->p[i] < 0);
              expect("m_zero", (top.m_zero >> i & 1) != 0, v.zero[i]);
              expect("m_zero", (top.m_zero >> i & 1) != 0, task->p[i] == 0);
            }
            separated += top.m_separated;
          }
          delay.clock(list[std::min(next++, list.size() - 1)]);
        });
    simulation.add(bench);
    simulation.steps(list.size() + static_cast<std::size_t>(defs::compare_latency()));
    REQUIRE(separated > 1000);
  });
}
