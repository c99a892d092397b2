// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <models/cchip_box_compare.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

struct Task {
  GridPair pair;
  unsigned component = 0;  ///< as on the pins: 3 like 0
  int error_shift = 0;
  int gap = 0;  ///< of the intervals in that component; <= 0 if they touch or overlap

  Eigen::Index axis() const { return component == 3 ? 0 : static_cast<Eigen::Index>(component); }
};

int gap_of(const Task& task) {
  const auto ends = [&](const GridPrimitive& p) {
    std::pair<int, int> range(p.v[0][task.axis()], p.v[0][task.axis()]);
    for (std::size_t i = 1; i < p.vertex_count(); ++i) {
      range.first = std::min(range.first, p.v[i][task.axis()]);
      range.second = std::max(range.second, p.v[i][task.axis()]);
    }
    return range;
  };
  const auto a = ends(task.pair.a);
  const auto b = ends(task.pair.b);
  return std::max(a.first - b.second, b.first - a.second);
}

/// Boxes a chosen gap apart, in either order, every vertex in turn the nearest; then arbitrary boxes.
std::vector<Task> tasks(Random& random, const model::Shape& shape, int coord_w) {
  const int least = -(1 << (coord_w - 1));
  const int greatest = (1 << (coord_w - 1)) - 1;
  const auto between = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  std::vector<Task> list;
  const auto add = [&](int shift, int gap, bool b_above, std::size_t near_low, std::size_t near_high) {
    Task task;
    task.component = static_cast<unsigned>(random() % 4);
    task.error_shift = shift;
    task.pair.a = random_primitive(random, shape.a, coord_w);
    task.pair.b = random_primitive(random, shape.b, coord_w);
    GridPrimitive& low = b_above ? task.pair.a : task.pair.b;
    GridPrimitive& high = b_above ? task.pair.b : task.pair.a;
    const int end = chance(random, 20) ? least : between(least, greatest - std::max(gap, 0));
    for (std::size_t i = 0; i < low.vertex_count(); ++i) low.v[i][task.axis()] = between(least, end);
    low.v[near_low % low.vertex_count()][task.axis()] = end;
    const int begin = std::max(end + gap, least);
    for (std::size_t i = 0; i < high.vertex_count(); ++i) high.v[i][task.axis()] = between(begin, greatest);
    high.v[near_high % high.vertex_count()][task.axis()] = begin;
    task.gap = gap_of(task);
    list.push_back(task);
  };
  for (int shift = 0; shift <= model::error_shift(defs::err_unknown); ++shift) {
    const int error = 1 << shift;
    for (const int gap : {-1, 0, 1, error - 1, error, error + 1, greatest - least}) {
      if (gap > greatest - least) continue;
      for (std::size_t i = 0; i < 16; ++i) {
        for (const bool b_above : {false, true}) add(shift, gap, b_above, i % 4, i / 4);
      }
    }
  }
  for (int i = 0; i < 3000; ++i) {
    Task task;
    task.component = static_cast<unsigned>(random() % 4);
    task.error_shift = static_cast<int>(random() % 5);
    task.pair.a = random_primitive(random, shape.a, coord_w);
    task.pair.b = random_primitive(random, shape.b, coord_w);
    task.gap = gap_of(task);
    list.push_back(task);
  }
  return list;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_box_compare: touching is not separated, a gap of E is not certain",
                        "[unit][cchip_box_compare]", cchip_box_compare_configs) {
  using Model = typename TestType::Model;
  constexpr int w = TestType::COORD_W;
  const model::Shape shape{TestType::VERTS_A, TestType::VERTS_B};
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Random random(options.seed);
    const std::vector<Task> list = tasks(random, shape, w);
    sim::Simulation<Model> simulation(options);
    Model& top = simulation.top();
    model::Delay<std::optional<Task>> delay(static_cast<std::size_t>(defs::box_latency()));
    std::size_t next = 0;
    std::size_t compared = 0;
    int touching = 0, one_step = 0, at_error = 0, beyond_error = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          const Task& task = list[std::min(next, list.size() - 1)];
          set_primitive(top.s_a, task.pair.a, w);
          set_primitive(top.s_b, task.pair.b, w);
          top.s_component = static_cast<CData>(task.component);
          top.s_error_shift = static_cast<CData>(task.error_shift);
        },
        [&](const sim::ClockInfo&) {
          if (const auto& task = delay.q()) {
            const model::BoxComparison expected = model::box_compare(
                shape, task->pair.a, task->pair.b, static_cast<std::size_t>(task->axis()), task->error_shift);
            expect("m_separated", top.m_separated != 0, expected.separated);
            expect("m_certain_gap", top.m_certain_gap != 0, expected.certain_gap);
            const int error = 1 << task->error_shift;
            expect("m_separated, by the gap", top.m_separated != 0, task->gap >= 1);
            expect("m_certain_gap, by the gap", top.m_certain_gap != 0, task->gap >= error + 1);
            touching += task->gap == 0 ? 1 : 0;
            one_step += task->gap == 1 ? 1 : 0;
            at_error += task->gap == error ? 1 : 0;
            beyond_error += task->gap == error + 1 ? 1 : 0;
            ++compared;
          }
          delay.clock(list[std::min(next++, list.size() - 1)]);
        });
    simulation.add(bench);
    simulation.steps(list.size() + static_cast<std::size_t>(defs::box_latency()));
    REQUIRE(compared == list.size());
    for (const int count : {touching, one_step, at_error, beyond_error}) REQUIRE(count > 100);
  });
}
