// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <models/cchip_sat_compare.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

struct Task {
  unsigned own = 0;  ///< bit i: slot i holds a point of the axis' own primitive
  bool allow_above = true;
  bool allow_below = true;
  model::Projections in;
};

/// Eq. 3 of the paper, word for word: closed intervals, each `margin` away from the other, on an allowed side.
bool apart(const Task& task, int points, std::int64_t margin) {
  std::pair<std::int64_t, std::int64_t> own(0, 0);  // the reference
  std::optional<std::pair<std::int64_t, std::int64_t>> other;
  for (std::size_t i = 0; i < static_cast<std::size_t>(points); ++i) {
    const std::int64_t p = task.in.p[i];
    if (i < 2 && (task.own >> i & 1U) != 0) {
      own = {std::min(own.first, p), std::max(own.second, p)};
    } else if (other) {
      other = {std::min(other->first, p), std::max(other->second, p)};
    } else {
      other = {p, p};
    }
  }
  return (task.allow_above && other->first - own.second > margin) ||
         (task.allow_below && own.first - other->second > margin);
}

/// Each point of the other set lies beyond all own points by more than the gap bound, above or below.
bool clear(const Task& task, int points) {
  std::vector<std::int64_t> own = {0};
  for (std::size_t i = 0; i < 2; ++i) {
    if ((task.own >> i & 1U) != 0) own.push_back(task.in.p[i]);
  }
  const auto [low, high] = std::minmax_element(own.begin(), own.end());
  for (std::size_t i = 0; i < static_cast<std::size_t>(points); ++i) {
    if (i < 2 && (task.own >> i & 1U) != 0) continue;
    if (task.in.p[i] - *high <= task.in.gap_bound && *low - task.in.p[i] <= task.in.gap_bound) return false;
  }
  return true;
}

/// The intervals overlap by more than the gap bound, whichever of them is moved up.
bool deep(const Task& task, int points) {
  std::vector<std::int64_t> own = {0};
  std::vector<std::int64_t> other;
  for (std::size_t i = 0; i < static_cast<std::size_t>(points); ++i) {
    (i < 2 && (task.own >> i & 1U) != 0 ? own : other).push_back(task.in.p[i]);
  }
  const auto [own_low, own_high] = std::minmax_element(own.begin(), own.end());
  const auto [other_low, other_high] = std::minmax_element(other.begin(), other.end());
  return *other_high - *own_low > task.in.gap_bound && *own_high - *other_low > task.in.gap_bound;
}

/// |value| > bound without overflow.
bool exceeds(std::int64_t value, std::int64_t bound) { return value > bound || value < -bound; }

/// Every small case (touching by zero, missing by one), then large ones at and beside their bounds.
std::vector<Task> tasks(Random& random, int proj_w, int bound_w, int points, unsigned own_slots) {
  // sets of own points: none, slot 0, both
  const auto draw_own = [&] { return own_slots == 2 && chance(random, 33) ? 3U : static_cast<unsigned>(random() % 2); };
  std::vector<Task> list;
  const auto n = static_cast<std::size_t>(points);
  const auto flags = [&](Task& task) {
    task.own = draw_own();
    const auto allowed = random() % 6;
    task.allow_above = allowed != 0;
    task.allow_below = allowed != 1;
    if (allowed == 2) task.allow_above = task.allow_below = chance(random, 50);
  };
  int cases = 1;
  for (int i = 0; i < points; ++i) cases *= 5;
  for (const unsigned own : {0U, 1U, 3U}) {  // each coordinate -2..2, every set of own points
    if (own == 3 && own_slots < 2) continue;
    for (int c = 0; c < cases; ++c) {
      Task task;
      flags(task);
      task.own = own;
      int rest = c;
      for (std::size_t i = 0; i < n; ++i) {
        task.in.p[i] = rest % 5 - 2;
        rest /= 5;
      }
      task.in.sign_bound = static_cast<std::int64_t>(random() % 4);
      task.in.gap_bound = static_cast<std::int64_t>(random() % 4);
      list.push_back(task);
    }
  }
  const std::int64_t bound_max = (std::int64_t{1} << bound_w) - 1;
  for (int c = 0; c < 20000; ++c) {  // differences of two projections fit
    Task task;
    flags(task);
    const bool one_side = chance(random, 60);
    const bool near_bound = chance(random, 70);
    const std::int64_t sign = chance(random, 50) ? 1 : -1;
    task.in.gap_bound = static_cast<std::int64_t>(random()) & (bound_max >> random() % static_cast<unsigned>(bound_w));
    if (chance(random, 5)) task.in.gap_bound = bound_max;
    for (std::size_t i = 0; i < n; ++i) {
      std::int64_t p = random_word(random, proj_w - 1);
      if (one_side) p = sign * (p < 0 ? -(p + 1) : p);
      if (one_side && i < 2 && (task.own >> i & 1U) != 0) p = -p;
      const std::int64_t base = i >= 2 && (task.own & 2U) != 0   ? task.in.p[1]
                                : i >= 1 && (task.own & 1U) != 0 ? task.in.p[0]
                                                                 : 0;
      if (near_bound && task.in.gap_bound < std::int64_t{1} << (proj_w - 4)) {
        const std::int64_t side = one_side || chance(random, 50) ? sign : -sign;
        p = base + side * (task.in.gap_bound + static_cast<std::int64_t>(random() % 3) - 1);
        if (p != model::wrap(static_cast<std::uint64_t>(p), proj_w - 1)) p = 0;
      }
      task.in.p[i] = p;
      const std::int64_t size = p < 0 ? -p : p;
      const std::int64_t beside = size + static_cast<std::int64_t>(random() % 3) - 1;
      if (i == own_slots) task.in.sign_bound = std::clamp<std::int64_t>(beside, 0, bound_max);
    }
    if (chance(random, 20)) task.in.sign_bound = static_cast<std::int64_t>(random()) & bound_max;
    list.push_back(task);
  }
  // Values and bounds of one bit, or beside one: each bit of each difference decides alone.
  const auto power = [&](int most) {
    return (std::int64_t{1} << random() % static_cast<unsigned>(most)) - (chance(random, 30) ? 1 : 0);
  };
  for (int c = 0; c < 20000; ++c) {
    Task task;
    flags(task);
    const std::int64_t sign = chance(random, 50) ? 1 : -1;
    task.in.gap_bound = chance(random, 40) ? 0 : power(bound_w);
    task.in.sign_bound = power(bound_w);
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t base = i > 0 && chance(random, 70) ? task.in.p[0] : 0;
      task.in.p[i] = base + (i > 0 && chance(random, 20) ? 0 : sign * power(proj_w - 3));
    }
    list.push_back(task);
  }
  return list;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_sat_compare: verdict, signs and their certainty after the generated latency",
                        "[unit][cchip_sat_compare]", cchip_sat_compare_configs) {
  using Model = typename TestType::Model;
  constexpr int points = TestType::POINTS;
  constexpr int proj_w = TestType::PROJ_W;
  constexpr int coord_w = proj_w / 3 - 1;
  static_assert(defs::proj_w(coord_w) == proj_w && defs::bound_w(coord_w) == TestType::BOUND_W,
                "widths of one COORD_W");
  const model::Shape shape{2 + TestType::OWN, points + 1 - TestType::OWN};
  for_two_power_ups([&](const sim::SimulationOptions& options) {
    Random random(options.seed);
    const std::vector<Task> list = tasks(random, proj_w, TestType::BOUND_W, points, TestType::OWN);
    sim::Simulation<Model> simulation(options);
    Model& top = simulation.top();
    model::Delay<std::optional<Task>> delay(static_cast<std::size_t>(defs::compare_latency()));
    model::Delay<std::optional<Task>> bounds(static_cast<std::size_t>(defs::bound_lag()));
    std::size_t next = 0;
    std::size_t compared = 0;
    int certain_gaps = 0, clear_on_both_sides = 0, only_separated = 0, at_gap_bound = 0, at_sign_bound = 0,
        beyond_sign_bound = 0, deeps = 0, deep_by_one = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          const Task& task = list[std::min(next, list.size() - 1)];
          top.s_own = static_cast<CData>(task.own);
          top.s_allow_above = task.allow_above ? 1 : 0;
          top.s_allow_below = task.allow_below ? 1 : 0;
          for (int i = 0; i < points; ++i) {
            const auto slot = static_cast<std::size_t>(i);
            sim::set_signed(top.s_projection, proj_w * i, proj_w, task.in.p[slot]);
          }
          if (const auto& before = bounds.q()) {
            sim::set_bits(top.s_sign_bound, 0, TestType::BOUND_W, static_cast<std::uint64_t>(before->in.sign_bound));
            sim::set_bits(top.s_gap_bound, 0, TestType::BOUND_W, static_cast<std::uint64_t>(before->in.gap_bound));
          }
        },
        [&](const sim::ClockInfo&) {
          if (const auto& task = delay.q()) {
            model::AxisBeat beat;
            beat.allow_above = task->allow_above;
            beat.allow_below = task->allow_below;
            const model::Comparison v =
                model::sat_compare(shape, beat, {(task->own & 1U) != 0, (task->own & 2U) != 0}, task->in, coord_w);
            const bool separated = top.m_separated != 0;
            const bool certain_gap = top.m_certain_gap != 0;
            expect("m_separated", separated, v.separated);
            expect("m_certain_gap", certain_gap, v.certain_gap);
            expect("m_clear", top.m_clear != 0, v.clear);
            expect("m_deep", top.m_deep != 0, v.deep);
            expect("m_separated, intervals", separated, apart(*task, points, 0));
            expect("m_certain_gap, intervals", certain_gap, apart(*task, points, task->in.gap_bound));
            expect("m_clear, intervals", top.m_clear != 0, clear(*task, points));
            expect("m_deep, intervals", top.m_deep != 0, deep(*task, points));
            for (unsigned i = 0; i < static_cast<unsigned>(points); ++i) {
              const std::int64_t p = task->in.p[i];
              expect("m_negative", (top.m_negative >> i & 1) != 0, v.negative[i]);
              expect("m_zero", (top.m_zero >> i & 1) != 0, v.zero[i]);
              expect("m_negative, p", (top.m_negative >> i & 1) != 0, p < 0);
              expect("m_zero, p", (top.m_zero >> i & 1) != 0, p == 0);
            }
            const std::int64_t p = task->in.p[TestType::OWN];
            const std::int64_t bound = task->in.sign_bound;
            expect("m_certain", top.m_certain != 0, v.certain);
            expect("m_certain, p", top.m_certain != 0, exceeds(p, bound));
            at_sign_bound += p == bound || p == -bound ? 1 : 0;
            beyond_sign_bound += p == bound + 1 || p == -bound - 1 ? 1 : 0;
            certain_gaps += certain_gap ? 1 : 0;
            const bool allowed = task->allow_above && task->allow_below;
            clear_on_both_sides += top.m_clear != 0 && !certain_gap && allowed ? 1 : 0;
            only_separated += separated && !certain_gap ? 1 : 0;
            const std::int64_t gap = task->in.gap_bound;
            at_gap_bound += gap > 0 && apart(*task, points, gap - 1) && !apart(*task, points, gap) ? 1 : 0;
            Task less = *task;
            --less.in.gap_bound;
            deep_by_one += gap > 0 && deep(less, points) && !deep(*task, points) ? 1 : 0;
            deeps += top.m_deep != 0 ? 1 : 0;
            ++compared;
          }
          const Task& sent = list[std::min(next++, list.size() - 1)];
          delay.clock(sent);
          bounds.clock(sent);
        });
    simulation.add(bench);
    simulation.steps(list.size() + static_cast<std::size_t>(defs::compare_latency()));
    REQUIRE(compared == list.size());
    for (const int count : {certain_gaps, clear_on_both_sides, only_separated, at_gap_bound, at_sign_bound,
                            beyond_sign_bound, deeps, deep_by_one}) {
      REQUIRE(count > 100);
    }
  });
}
