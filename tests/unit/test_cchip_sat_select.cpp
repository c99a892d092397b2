// SPDX-License-Identifier: Apache-2.0
#include <models/cchip_sat_select.hpp>

#include "pair_tools.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

constexpr int max_slots = static_cast<int>(model::max_points);

/// The outputs of the stage.
struct Selected {
  model::Word3 e_from, e_to, f_from, f_to;
  std::vector<model::Word3> points;
  unsigned own = 0;
};

template <class Config>
Selected read(const typename Config::Model& top) {
  constexpr int w = Config::COORD_W;
  Selected s{get_word3(top.m_e_from, w),
             get_word3(top.m_e_to, w),
             get_word3(top.m_f_from, w),
             get_word3(top.m_f_to, w),
             {},
             top.m_own};
  for (int i = 0; i < defs::points(Config::VERTS_A, Config::VERTS_B); ++i) {
    s.points.push_back(get_word3(top.m_points, w, i));
  }
  return s;
}

void compare_with_model(const Selected& s, const model::Selection& expected, const std::string& code) {
  sim::require(s.e_from == to_word3(expected.e_from) && s.e_to == to_word3(expected.e_to) &&
                   s.f_from == to_word3(expected.f_from) && s.f_to == to_word3(expected.f_to),
               "wrong edge for " + code);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    sim::require(s.points[i] == to_word3(expected.points[i]), "wrong point " + std::to_string(i) + " for " + code);
  }
  sim::require(s.own == ((expected.own[0] ? 1U : 0U) | (expected.own[1] ? 2U : 0U)), "wrong m_own for " + code);
}

WideVector difference(const model::Word3& to, const model::Word3& from) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}
sim::Int128 along(const WideVector& axis, const model::Word3& p) {
  return axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
}

/// Least and greatest projection; starts with one point.
struct Interval {
  sim::Int128 low, high;
  explicit Interval(sim::Int128 x) : low(x), high(x) {}
  void add(sim::Int128 x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  friend bool operator==(const Interval& x, const Interval& y) { return x.low == y.low && x.high == y.high; }
};
Interval interval_of(const WideVector& axis, const GridPrimitive& p) {
  Interval all(along(axis, to_word3(p.v[0])));
  for (std::size_t i = 1; i < p.vertex_count(); ++i) all.add(along(axis, to_word3(p.v[i])));
  return all;
}

/// Without the model: e x f is the axis by its definition, and the intervals of what is projected are those of all
/// vertices (of an in-plane axis the own ones need no projection).
void check_by_definition(const Selected& s, const AxisCode& code, const GridPair& pair) {
  const std::string text = to_words(code);
  const bool own_b = code.cls == AxisClass::normal_b || code.cls == AxisClass::in_plane_b;
  const bool in_plane = code.cls == AxisClass::in_plane_a || code.cls == AxisClass::in_plane_b;
  const GridPrimitive& own = own_b ? pair.b : pair.a;
  const WideVector axis = detail::cross(difference(s.e_to, s.e_from), difference(s.f_to, s.f_from));
  sim::require(axis == axis_of(code, pair), "axis is not that of " + text);

  Interval own_interval(along(axis, s.e_from));
  std::optional<Interval> other_interval;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const sim::Int128 x = along(axis, s.points[i]);
    if (i < 2 && (s.own >> i & 1U) != 0) {
      own_interval.add(x);
    } else if (other_interval) {
      other_interval->add(x);
    } else {
      other_interval = Interval(x);
    }
  }
  sim::require(other_interval && *other_interval == interval_of(axis, own_b ? pair.a : pair.b),
               "interval of the other primitive, " + text);
  if (in_plane) {
    sim::require(s.e_from == to_word3(own.v[code.k]), "reference of " + text);
    expect("m_own of an in-plane axis", s.own, 0U);
  } else {
    sim::require(own_interval == interval_of(axis, own), "interval of the own primitive, " + text);
  }
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_sat_select: edges, points and flags of every axis code", "[unit][cchip_sat_select]",
                        cchip_sat_select_configs) {
  using Model = typename TestType::Model;
  constexpr int w = TestType::COORD_W;
  const model::Shape shape{TestType::VERTS_A, TestType::VERTS_B};
  const std::vector<AxisCode> codes = axis_codes(shape);
  static_assert(defs::points(TestType::VERTS_A, TestType::VERTS_B) <= max_slots, "more slots than the model has");
  for_two_power_ups<Model>([&](auto& simulation, Random& random) {
    auto& top = simulation.top();
    struct Task {
      AxisCode code;
      GridPair pair;
    };
    model::Delay<std::optional<Task>> delay(static_cast<std::size_t>(defs::select_latency()));
    model::Delay<std::optional<Task>> vertices(static_cast<std::size_t>(defs::ram_latency()));
    Task in;
    std::size_t next = 0;
    std::size_t compared = 0;
    Bench bench(
        [&](const sim::ClockInfo&) {
          if (const auto& before = vertices.q()) {  // its vertices come now
            set_primitive(top.s_a, before->pair.a, w);
            set_primitive(top.s_b, before->pair.b, w);
          }
          in.code = codes[next++ % codes.size()];
          // quads as the host sends them: the normal of another order of vertices in a plane may be zero
          const auto canonical = [](const GridPrimitive& p) { return p.kind == Kind::quad ? canonical_quad(p) : p; };
          in.pair.a = canonical(random_primitive(random, shape.a, w));
          in.pair.b = canonical(random_primitive(random, shape.b, w));
          top.s_code = to_bits(in.code);
        },
        [&](const sim::ClockInfo&) {
          if (const auto& task = delay.q()) {
            const Selected s = read<TestType>(top);
            compare_with_model(s, model::sat_select(shape, task->code, task->pair.a, task->pair.b),
                               to_words(task->code));
            check_by_definition(s, task->code, task->pair);
            ++compared;
          }
          delay.clock(in);
          vertices.clock(in);
        });
    simulation.add(bench);
    simulation.steps(100 * codes.size());
    REQUIRE(compared == 100 * codes.size() - static_cast<std::size_t>(defs::select_latency()));
  });
}
