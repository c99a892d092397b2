// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_sat_project.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Inputs of the stage: an axis that is a cross product of two edges, as the stage before makes it.
struct Task {
  model::Word3 axis{};
  Vec3i reference = Vec3i::Zero();
  std::vector<Vec3i> points;
};

Task random_task(Random& random, int coord_w, int points) {
  Task task;
  task.reference = random_point(random, coord_w);
  for (int i = 0; i < points; ++i) task.points.push_back(random_point(random, coord_w));
  model::Selection s{task.reference, random_point(random, coord_w), task.points[0], random_point(random, coord_w), {}};
  if (chance(random, 5)) s.f_to = s.f_from;  // zero axis
  task.axis = model::sat_axis(s, coord_w);
  return task;
}

template <class Model>
void put(Model& top, const Task& task, int coord_w) {
  set_word3(top.s_axis, defs::axis_w(coord_w), task.axis);
  set_word3(top.s_reference, coord_w, to_word3(task.reference));
  for (int i = 0; i < static_cast<int>(task.points.size()); ++i) {
    for (int d = 0; d < 3; ++d) {
      sim::set_signed(top.s_points, coord_w * (3 * i + d), coord_w, task.points[static_cast<std::size_t>(i)][d]);
    }
  }
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_sat_project: projections after SUBSTAGES clocks", "[unit][cchip_sat_project]",
                        cchip_sat_project_configs) {
  using Model = typename TestType::Model;
  constexpr int w = TestType::COORD_W;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    sim::Simulation<Model> simulation(options);
    Model& top = simulation.top();
    model::Delay<std::optional<Task>> delay(TestType::SUBSTAGES);
    Task in;
    int zero_axes = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          in = random_task(random, w, TestType::POINTS);
          put(top, in, w);
        },
        [&](const sim::ClockInfo&) {
          if (const auto& task = delay.q()) {
            for (int i = 0; i < TestType::POINTS; ++i) {
              const Vec3i& point = task->points[static_cast<std::size_t>(i)];
              const std::int64_t p = sim::get_signed(top.m_projection, defs::proj_w(w) * i, defs::proj_w(w));
              const model::Projections expected =
                  model::sat_project(task->axis, task->reference, {point, point, point}, w);
              expect("projection", p, expected.p[0]);
              expect("m_axis_zero", top.m_axis_zero != 0, expected.axis_zero);
              sim::require(p == wide_dot(task->axis, to_word3(point)) - wide_dot(task->axis, to_word3(task->reference)),
                           "inexact projection");
            }
            zero_axes += top.m_axis_zero;
          }
          delay.clock(in);
        });
    simulation.add(bench);
    simulation.steps(10000);
    REQUIRE(zero_axes > 100);
    REQUIRE(zero_axes < 5000);
  });
}

TEST_CASE("cchip_sat_project: relative and absolute give identical outputs", "[unit][cchip_sat_project]") {
  constexpr int w = 16;
  const sim::SimulationOptions options;
  Random random(options.seed);
  sim::Simulation<Vcchip_sat_project> relative(options);
  sim::Simulation<Vcchip_sat_project_abs> absolute(options);
  for (int clock = 0; clock < 20000; ++clock) {
    const Task task = random_task(random, w, 3);
    put(relative.top(), task, w);
    put(absolute.top(), task, w);
    relative.step();
    absolute.step();
    if (clock < 10) continue;
    for (int i = 0; i < 3; ++i) {
      const auto get = [&](const auto& port) { return sim::get_signed(port, defs::proj_w(w) * i, defs::proj_w(w)); };
      if (get(relative->m_projection) != get(absolute->m_projection)) FAIL("projection " << i << " on clock " << clock);
    }
    if (relative->m_axis_zero != absolute->m_axis_zero) FAIL("axis_zero on clock " << clock);
  }
}
