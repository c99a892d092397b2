// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_sat_project.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Outputs of stages 1 and 2: the axis is the cross product of two edges.
struct Task {
  model::Selection selection;
  model::Axis axis;
  int error_shift = 0;
};

Task draw_task(Random& random, int coord_w, int points) {
  Task task;
  model::Selection& s = task.selection;
  const bool corners = chance(random, 20);
  const auto point = [&]() -> Vec3i {
    if (!corners) return random_point(random, coord_w);
    Vec3i p;
    for (int d = 0; d < 3; ++d) p[d] = chance(random, 50) ? -(1 << (coord_w - 1)) : (1 << (coord_w - 1)) - 1;
    return p;
  };
  for (Vec3i* p : {&s.e_from, &s.e_to, &s.f_from, &s.f_to}) *p = point();
  for (std::size_t i = 0; i < static_cast<std::size_t>(points); ++i) s.points[i] = point();
  if (chance(random, 10)) {  // in-plane
    s.f_from = Vec3i::Zero();
    s.f_to = Vec3i::Unit(static_cast<Eigen::Index>(random() % 3));
  }
  if (chance(random, 5)) s.f_to = s.f_from;  // zero axis
  if (chance(random, 15)) {                  // one component of a single bit
    const auto d = static_cast<Eigen::Index>(random() % 3);
    const auto bit = [&] { return 1 << random() % static_cast<unsigned>(coord_w - 1); };
    s.e_from = s.f_from = Vec3i::Zero();
    s.e_to = Vec3i::Unit(d) * bit();
    s.f_to = Vec3i::Unit((d + 1 + static_cast<Eigen::Index>(random() % 2)) % 3) * bit();
  }
  task.axis = model::sat_axis(s, coord_w);
  task.error_shift = static_cast<int>(random() % 5);
  return task;
}

template <class Model>
void put(Model& top, const Task& task, int coord_w, int points) {
  set_word3(top.s_axis, defs::axis_w(coord_w), task.axis.axis);
  sim::set_bits(top.s_edge_norm, 0, defs::norm_w(coord_w), static_cast<std::uint64_t>(task.axis.edge_norm));
  top.s_error_shift = static_cast<CData>(task.error_shift);
  set_word3(top.s_reference, coord_w, to_word3(task.selection.e_from));
  for (int i = 0; i < points; ++i) {
    for (int d = 0; d < 3; ++d) {
      sim::set_signed(top.s_points, coord_w * (3 * i + d), coord_w,
                      task.selection.points[static_cast<std::size_t>(i)][d]);
    }
  }
}

/// The outputs of the stage.
template <class Model>
model::Projections get(const Model& top, int coord_w, int points) {
  model::Projections out;
  for (int i = 0; i < points; ++i) {
    const auto slot = static_cast<std::size_t>(i);
    out.p[slot] = sim::get_signed(top.m_projection, defs::proj_w(coord_w) * i, defs::proj_w(coord_w));
  }
  for (unsigned d = 0; d < 3; ++d) {
    out.axis_negative[d] = (top.m_axis_negative >> d & 1) != 0;
    out.axis_zero[d] = (top.m_axis_zero >> d & 1) != 0;
  }
  out.axis_largest = top.m_axis_largest;
  return out;
}

void compare(const model::Projections& got, const model::Projections& expected) {
  for (std::size_t i = 0; i < got.p.size(); ++i) {
    expect("m_projection", got.p[i], expected.p[i]);
  }
  sim::require(got.axis_negative == expected.axis_negative, "m_axis_negative differs");
  sim::require(got.axis_zero == expected.axis_zero, "m_axis_zero differs");
  expect("m_axis_largest", got.axis_largest, expected.axis_largest);
}

model::Shape shape_of(int points) {
  return points == 3 ? model::Shape{3, 3} : points == 4 ? model::Shape{3, 4} : model::Shape{4, 4};
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_sat_project: projections and signs after SUBSTAGES clocks, bounds two later",
                        "[unit][cchip_sat_project]", cchip_sat_project_configs) {
  using Model = typename TestType::Model;
  constexpr int w = TestType::COORD_W;
  constexpr int points = TestType::POINTS;
  for_two_power_ups<Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    model::Delay<std::optional<Task>> delay(TestType::SUBSTAGES);
    model::Delay<std::optional<Task>> bounds(static_cast<std::size_t>(TestType::SUBSTAGES + defs::bound_lag()));
    Task in;
    int zero_axes = 0;
    int ties = 0;
    std::array<int, 3> largest{};
    Bench bench(
        [&](const sim::ClockInfo&) {
          in = draw_task(random, w, points);
          put(top, in, w, points);
        },
        [&](const sim::ClockInfo&) {
          if (const auto& task = delay.q()) {
            const model::Projections got = get(top, w, points);
            compare(got, model::sat_project(shape_of(points), task->axis, task->selection, task->error_shift, w));
            // without the model
            const model::Word3& axis = task->axis.axis;
            const sim::Int128 reference = wide_dot(axis, to_word3(task->selection.e_from));
            for (std::size_t i = 0; i < static_cast<std::size_t>(points); ++i) {
              sim::require(got.p[i] == wide_dot(axis, to_word3(task->selection.points[i])) - reference,
                           "inexact projection");
            }
            const auto size = [&](std::size_t d) { return axis[d] < 0 ? -axis[d] : axis[d]; };
            const auto most = static_cast<std::size_t>(got.axis_largest);
            for (std::size_t d = 0; d < 3; ++d) {
              expect("m_axis_negative", got.axis_negative[d], axis[d] < 0);
              expect("m_axis_zero", got.axis_zero[d], axis[d] == 0);
              sim::require(d < most ? size(d) < size(most) : size(d) <= size(most), "not the lowest largest component");
              ties += d != most && size(d) == size(most) && size(d) > 0 ? 1 : 0;
            }
            ++largest[most];
            zero_axes += axis == model::Word3{} ? 1 : 0;
          }
          if (const auto& task = bounds.q()) {
            constexpr int bound_w = defs::bound_w(w);
            const model::Projections expected =
                model::sat_project(shape_of(points), task->axis, task->selection, task->error_shift, w);
            expect("m_sign_bound", static_cast<std::int64_t>(sim::get_bits(top.m_sign_bound, 0, bound_w)),
                   expected.sign_bound);
            expect("m_gap_bound", static_cast<std::int64_t>(sim::get_bits(top.m_gap_bound, 0, bound_w)),
                   expected.gap_bound);
          }
          delay.clock(in);
          bounds.clock(in);
        });
    simulation.add(bench);
    simulation.steps(10000);
    REQUIRE(zero_axes > 100);
    REQUIRE(zero_axes < 5000);
    REQUIRE(ties > 100);
    for (const int count : largest) REQUIRE(count > 500);
  });
}

using RelativeAndAbsolute = std::tuple<std::pair<cchip_sat_project, cchip_sat_project_abs>,
                                       std::pair<cchip_sat_project_p4, cchip_sat_project_p4_abs>,
                                       std::pair<cchip_sat_project_p5, cchip_sat_project_p5_abs>>;

TEMPLATE_LIST_TEST_CASE("cchip_sat_project: relative and absolute give identical outputs", "[unit][cchip_sat_project]",
                        RelativeAndAbsolute) {
  using Relative = typename TestType::first_type;
  using Absolute = typename TestType::second_type;
  constexpr int w = Relative::COORD_W;
  constexpr int points = Relative::POINTS;
  const sim::SimulationOptions options;
  Random random(options.seed);
  sim::Simulation<typename Relative::Model> relative(options);
  sim::Simulation<typename Absolute::Model> absolute(options);
  for (int clock = 0; clock < 10000; ++clock) {
    const Task task = draw_task(random, w, points);
    put(relative.top(), task, w, points);
    put(absolute.top(), task, w, points);
    relative.step();
    absolute.step();
    if (clock >= Relative::SUBSTAGES) compare(get(relative.top(), w, points), get(absolute.top(), w, points));
  }
}
