// SPDX-License-Identifier: Apache-2.0
// The box test in RTL on volumes that touch in a point. Equality with the model is half of a claim; the other half is
// the promise itself: volumes that share a point are never separated.
#include <Vbox_unit.h>

#include <cchip/internal/model/box_test.hpp>
#include <cchip/sim/bits.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/stimulus/touching_volumes.hpp>
#include <deque>
#include <stdexcept>

#include "commands.hpp"

namespace cchip::campaign {
namespace {

struct BoxCounts {
  std::uint64_t pairs = 0;
  std::uint64_t wrong = 0;        ///< separated although they share a point
  std::uint64_t differences = 0;  ///< from the functional model
  std::uint64_t near = 0, points = 0, with_cuts = 0;
  BoxCounts& operator+=(const BoxCounts& x) {
    pairs += x.pairs;
    wrong += x.wrong;
    differences += x.differences;
    near += x.near;
    points += x.points;
    with_cuts += x.with_cuts;
    return *this;
  }
};

struct BoxResult {
  BoxCounts counts;
  Bins bins;
  Examples examples;
  BoxResult& operator+=(const BoxResult& x) {
    counts += x.counts;
    bins += x.bins;
    examples += x.examples;
    return *this;
  }
};

void see(Bins& bins, const Touch& touch) {
  for (const auto* node : {&touch.a, &touch.b}) {
    const std::string role = node == &touch.a ? "A " : "B ";
    bins.see(role + "step", node->step, 0, bvh::step_max);
    bins.see(role + "cut exponent", node->cut_exponent, 2, 3);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string axis(1, static_cast<char>('x' + i));
      bins.see(role + "least " + axis, node->child[0].least[i], bvh::box_least, bvh::box_most);
      bins.see(role + "greatest " + axis, node->child[0].greatest[i], bvh::box_least, bvh::box_most);
      bins.see(role + "origin " + axis, node->origin[i], -131072, 131071);
    }
    for (std::size_t d = 0; d < node->child[0].cut.size(); ++d) {
      for (std::size_t side = 0; side < 2; ++side)
        bins.see(role + "cut " + std::to_string(2 * d + side), node->child[0].cut[d][side], 0, 7);
    }
  }
  bins.see("shift", touch.query.shift, 0, query_shift_max);
  for (std::size_t i = 0; i < 9; ++i) {
    bins.see("M " + std::to_string(i), touch.query.m[i / 3][i % 3], -(1 << query_m_fraction), 1 << query_m_fraction);
  }
  bins.end(false);
}

/// The box test with one pose for each node pair.
class BoxUnit {
 public:
  explicit BoxUnit(std::uint64_t seed) : simulation_(sim::without_timeout(seed)) {
    auto& top = simulation_.top();
    top.s_valid = 0;
    top.s_pose_valid = 0;
    simulation_.reset();
  }

  /// \param next the next case, whose number is below 2^64
  /// \param verdict called with the oldest case and whether its children overlap
  template <class Next, class Verdict>
  void run(std::uint64_t cases, const Next& next, const Verdict& verdict) {
    auto& top = simulation_.top();
    std::deque<Touch> poses;    // accepted, without m_pose_valid
    std::deque<Touch> ready;    // with it
    std::deque<Touch> waiting;  // in the box test
    std::uint64_t started = 0, done = 0, idle = 0, pose_number = 0, pair_number = 0;
    bool offered = false, pose_offered = false;
    Touch pose;
    while (done < cases) {
      if (!pose_offered && started < cases && poses.size() + ready.size() + waiting.size() < contexts) {
        pose = next(started++);
        pose_offered = true;
        set_pose(pose, pose_number++ % contexts);
      }
      top.s_pose_valid = pose_offered ? 1 : 0;
      if (!offered && !ready.empty()) {
        offered = true;
        set_pair(ready.front(), pair_number++ % contexts);
      }
      top.s_valid = offered ? 1 : 0;
      simulation_.settle();
      ++idle;
      if (top.m_valid != 0) {
        verdict(waiting.front(), (top.m_waiting & 1U) != 0);
        waiting.pop_front();
        ++done;
        idle = 0;
      }
      if (top.m_pose_valid != 0) {
        ready.push_back(poses.front());
        poses.pop_front();
      }
      if (offered && top.s_ready != 0) {
        waiting.push_back(ready.front());
        ready.pop_front();
        offered = false;
      }
      if (pose_offered && top.s_pose_ready != 0) {
        poses.push_back(pose);
        pose_offered = false;
      }
      if (idle > 1000) throw std::runtime_error("the box test gave no verdict for 1000 clocks");
      simulation_.rise();
    }
  }

 private:
  static constexpr std::size_t contexts = 16;

  void set_pose(const Touch& touch, std::size_t context) {
    auto& top = simulation_.top();
    top.s_pose_context = static_cast<CData>(context);
    for (std::size_t i = 0; i < 9; ++i)
      sim::set_bits(top.s_pose_m, static_cast<int>(32 * i), 32,
                    static_cast<std::uint32_t>(touch.query.m[i / 3][i % 3]));
    for (std::size_t i = 0; i < 3; ++i)
      sim::set_bits(top.s_pose_t, static_cast<int>(36 * i), 36, static_cast<std::uint64_t>(touch.query.t[i]));
    top.s_pose_shift = static_cast<CData>(touch.query.shift);
    top.s_pose_error = static_cast<SData>(touch.query.error);
  }
  template <class Port>
  static void set_line(Port& port, const bvh::InnerLine& node) {
    const Line line = encode(node);
    for (std::size_t i = 0; i < line.size(); ++i) sim::set_bits(port, static_cast<int>(8 * i), 8, line[i]);
  }
  void set_pair(const Touch& touch, std::size_t context) {
    auto& top = simulation_.top();
    top.s_context = static_cast<CData>(context);
    top.s_tag = 0;
    set_line(top.s_a, touch.a);
    set_line(top.s_b, touch.b);
    top.s_a_children = 1;
    top.s_b_children = 1;
  }

  sim::Simulation<Vbox_unit> simulation_;
};

}  // namespace

int run_boxes(const BoxesOptions& options) {
  const StopWatch watch;
  fmt::print("seed={}\n", options.seed);
  const auto sum = sum_of_parts<BoxResult>(part_count(options.pairs), options.threads, [&](std::uint64_t part) {
    BoxResult result;
    TouchingVolumes volumes(options.seed_of(part));
    BoxUnit unit(options.seed_of(part));
    const auto next = [&](std::uint64_t) {
      const Touch touch = volumes.next();
      if (!share_the_point(touch)) throw std::logic_error("a case is no proof: the point is not in both volumes");
      see(result.bins, touch);
      return touch;
    };
    unit.run(pairs_of_part(options.pairs, part), next, [&](const Touch& touch, bool overlap) {
      const model::PoseSetup pose = model::set_up(touch.query);
      const model::NodeGrid grid = grid_of(touch.a, touch.b, pose);
      const bool model_overlap = (test_boxes(touch.a, touch.b, pose, grid).overlap & 1U) != 0;
      ++result.counts.pairs;
      result.counts.near += grid.near ? 1 : 0;
      result.counts.points += grid.a_is_point || grid.b_is_point ? 1 : 0;
      result.counts.with_cuts += grid.use_a_cuts && grid.use_b_cuts ? 1 : 0;
      result.counts.differences += overlap != model_overlap ? 1 : 0;
      if (overlap) return;
      if (result.counts.wrong++ == 0) {
        result.examples.add(
            part, fmt::format("boxes from {} {} {} to {} {} {} of A, steps {} {}, shift {}", touch.a.child[0].least[0],
                              touch.a.child[0].least[1], touch.a.child[0].least[2], touch.a.child[0].greatest[0],
                              touch.a.child[0].greatest[1], touch.a.child[0].greatest[2], touch.a.step, touch.b.step,
                              touch.query.shift));
      }
    });
    return result;
  });
  sum.examples.print();
  const BoxCounts& c = sum.counts;
  Goals goals;
  options.check(goals, c.pairs, c.pairs);
  fmt::print("bins: {} boundary_percent={}\n", sum.bins.summary(), boundary_percent);
  const std::string missing = options.least_pairs == 0 ? "" : sum.bins.missing_ends();
  if (!missing.empty()) fmt::print("goal missed: no case with {}\n", missing);
  fmt::print("pairs={} wrong={} differences={} near={} points={} with_cuts={} seconds={:.1f} seed={}\n", c.pairs,
             c.wrong, c.differences, c.near, c.points, c.with_cuts, watch.seconds(), options.seed);
  return c.wrong != 0 || c.differences != 0 || !missing.empty() || goals.missed() ? wrong_result : 0;
}

}  // namespace cchip::campaign
