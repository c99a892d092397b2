// SPDX-License-Identifier: Apache-2.0
#include <cchip/stimulus/witness.hpp>
#include <models/cchip_sat_bound.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// Outputs of stage 1, and the error.
struct Task {
  model::Selection selection;
  int error_shift = 0;
};

constexpr model::Shape shape{3, 3};

model::Word3 difference(const Vec3i& to, const Vec3i& from) {
  return {std::int64_t{to.x()} - from.x(), std::int64_t{to.y()} - from.y(), std::int64_t{to.z()} - from.z()};
}
sim::Int128 norm1(const model::Word3& v) {
  sim::Int128 sum = 0;
  for (const std::int64_t x : v) sum += x < 0 ? -x : x;
  return sum;
}

/// Any point, a small one, or a corner of the grid.
Vec3i draw_point(Random& random, int coord_w, std::uint64_t kind) {
  Vec3i p;
  for (int d = 0; d < 3; ++d) {
    if (kind == 0) p[d] = static_cast<int>(random() % 7) - 3;
    if (kind == 1) p[d] = chance(random, 50) ? -(1 << (coord_w - 1)) : (1 << (coord_w - 1)) - 1;
    if (kind >= 2) p[d] = static_cast<int>(random_word(random, coord_w));
  }
  return p;
}
Task draw_task(Random& random, int coord_w) {
  Task task;
  const std::uint64_t kind = random() % 4;
  model::Selection& s = task.selection;
  for (Vec3i* p : {&s.e_from, &s.e_to, &s.f_from, &s.f_to}) *p = draw_point(random, coord_w, kind);
  s.points[model::sign_slot(shape)] = draw_point(random, coord_w, kind);
  task.error_shift = static_cast<int>(random() % 5);
  return task;
}

/// The formula of the datasheet, written out.
sim::Int128 sign_bound(const Task& task) {
  const model::Selection& s = task.selection;
  const model::Word3 a = difference(s.e_to, s.e_from);
  const model::Word3 b = difference(s.f_to, s.f_from);
  sim::Int128 axis_norm = 0;
  for (const sim::Int128 x : detail::cross({a[0], a[1], a[2]}, {b[0], b[1], b[2]})) axis_norm += x < 0 ? -x : x;
  const sim::Int128 error = sim::Int128{1} << task.error_shift;
  const sim::Int128 length = norm1(difference(s.points[model::sign_slot(shape)], s.e_from)) + 2 * error;
  sim::Int128 power = 1;
  while (power < length) power *= 2;
  return error * (axis_norm + (norm1(a) + norm1(b) + 2 * error) * power);
}

sim::Int128 determinant(const model::Word3& a, const model::Word3& b, const model::Word3& c) {
  const WideVector n = detail::cross({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
  return n[0] * c[0] + n[1] * c[1] + n[2] * c[2];
}

/// Greatest |det(a + x, b + y, c + z) - det(a, b, c)| over |x|, |y|, |z| <= error in every component. The determinant
/// is linear in each of the nine components, so the corners will do.
sim::Int128 greatest_error(const model::Word3& a, const model::Word3& b, const model::Word3& c, int error) {
  const sim::Int128 exact = determinant(a, b, c);
  const auto moved = [error](model::Word3 v, unsigned signs) {
    for (std::size_t d = 0; d < 3; ++d) v[d] += (signs >> d & 1U) != 0 ? error : -error;
    return v;
  };
  sim::Int128 greatest = 0;
  for (unsigned corner = 0; corner < 512; ++corner) {
    const sim::Int128 e = determinant(moved(a, corner), moved(b, corner >> 3U), moved(c, corner >> 6U)) - exact;
    greatest = std::max(greatest, e < 0 ? -e : e);
  }
  return greatest;
}

/// Sends tasks, one per clock, and hands each with its outputs to a check.
template <class Config, class Draw, class Check>
void stream(const sim::SimulationOptions& options, std::size_t count, Draw draw, Check check) {
  constexpr int w = Config::COORD_W;
  constexpr std::size_t latency = Config::SUBSTAGES + defs::bound_lag();
  sim::Simulation<typename Config::Model> simulation(options);
  auto& top = simulation.top();
  model::Delay<std::optional<Task>> delay(latency);
  std::optional<Task> before;  // its differences come one clock after its axis
  Task in;
  std::size_t compared = 0;
  Bench bench(
      [&](const sim::ClockInfo&) {
        in = draw();
        const model::Axis axis = model::sat_axis(in.selection, w);
        set_word3(top.s_axis, defs::axis_w(w), axis.axis);
        sim::set_bits(top.s_edge_norm, 0, defs::norm_w(w), static_cast<std::uint64_t>(axis.edge_norm));
        top.s_error_shift = static_cast<CData>(in.error_shift);
        if (before) {
          const model::Selection& s = before->selection;
          set_word3(top.s_difference, defs::edge_w(w), difference(s.points[model::sign_slot(shape)], s.e_from));
        }
      },
      [&](const sim::ClockInfo&) {
        if (const auto& task = delay.q()) {
          check(*task, static_cast<std::int64_t>(sim::get_bits(top.m_sign_bound, 0, defs::bound_w(w))),
                static_cast<std::int64_t>(sim::get_bits(top.m_gap_bound, 0, defs::bound_w(w))));
          ++compared;
        }
        delay.clock(in);
        before = in;
      });
  simulation.add(bench);
  simulation.steps(count + latency);
  REQUIRE(compared == count);
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_sat_bound: bounds of the model and of the formula two clocks after the projections",
                        "[unit][cchip_sat_bound]", cchip_sat_bound_configs) {
  constexpr int w = TestType::COORD_W;
  for_two_power_ups([](const sim::SimulationOptions& options) {
    Random random(options.seed);
    stream<TestType>(
        options, 10000, [&] { return draw_task(random, w); },
        [](const Task& task, std::int64_t bound, std::int64_t gap_bound) {
          const model::Axis axis = model::sat_axis(task.selection, w);
          const model::Projections expected = model::sat_project(shape, axis, task.selection, task.error_shift, w);
          expect("m_gap_bound", gap_bound, expected.gap_bound);
          sim::require(gap_bound == norm1(axis.axis) << task.error_shift, "m_gap_bound is not E |axis|_1");
          expect("m_sign_bound", bound, expected.sign_bound);
          sim::require(bound == sign_bound(task), "m_sign_bound is not that of the formula");
        });
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_sat_bound: never below the exact greatest error", "[unit][cchip_sat_bound]",
                        cchip_sat_bound_configs) {
  const sim::SimulationOptions options;
  Random random(options.seed);
  sim::Int128 most_used = 0;  // per cent of a bound
  stream<TestType>(
      options, 4000, [&] { return draw_task(random, TestType::COORD_W); },
      [&](const Task& task, std::int64_t bound, std::int64_t gap_bound) {
        const model::Selection& s = task.selection;
        const model::Word3 a = difference(s.e_to, s.e_from);
        const model::Word3 b = difference(s.f_to, s.f_from);
        const int error = 1 << task.error_shift;
        const model::Word3 c = difference(s.points[model::sign_slot(shape)], s.e_from);
        const sim::Int128 greatest = greatest_error(a, b, c, error);
        sim::require(greatest <= bound, "a sign bound is smaller than an error");
        if (bound > 0) most_used = std::max(most_used, greatest * 100 / bound);
        // the axis is fixed, only the difference of two points errs: by E in each component
        const WideVector axis = detail::cross({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
        sim::Int128 farthest = 0;
        for (const sim::Int128 x : axis) farthest += (x < 0 ? -x : x) << task.error_shift;
        sim::require(farthest <= gap_bound, "the gap bound is smaller than an error");
      });
  REQUIRE(most_used > 30);  // the errors tried are not negligible
}
