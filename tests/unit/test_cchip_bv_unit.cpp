// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/shapes.hpp>
#include <deque>
#include <models/cchip_bv_unit.hpp>

#include "bv_tools.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

constexpr int latency = 30;       // from the clock of s_ready to the verdict
constexpr int pose_latency = 21;  // from an accepted pose to m_pose_valid

struct NodePair {
  bvh::InnerLine a;
  bvh::InnerLine b;
  unsigned children_a = 15;  // with bits that no child has
  unsigned children_b = 15;
};

/// A query, and node pairs for it, which are random if there are none.
struct Scene {
  Query query;
  std::vector<NodePair> pairs;
};

/// What two meshes ask of the box test in one pose.
Scene traverse(Random& random, const bvh::Image& first, const bvh::Image& second) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto pose = [&](double reach) {
    Eigen::Affine3d p = Eigen::Translation3d(reach * unit(random), reach * unit(random), reach * unit(random)) *
                        Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized();
    return p;
  };
  std::optional<Query> query = bvh::make_query(first.header(), pose(0.6), second.header(), pose(0.6));
  REQUIRE(query);
  Scene scene{*query, {}};
  const bvh::Image& a = query->swapped ? second : first;
  const bvh::Image& b = query->swapped ? first : second;
  const model::PoseSetup setup = model::set_up(*query);
  struct Half {
    std::uint32_t line;
    unsigned children;
  };
  std::deque<std::pair<Half, Half>> todo = {{{1, 15}, {1, 15}}};
  while (!todo.empty() && scene.pairs.size() < 400) {
    const auto [at_a, at_b] = todo.front();
    todo.pop_front();
    const NodePair pair{bvh::decode_inner(a.lines[at_a.line]), bvh::decode_inner(b.lines[at_b.line]), at_a.children,
                        at_b.children};
    scene.pairs.push_back(pair);
    const model::ChildPairs found = sort_children(pair.a, pair.children_a, pair.b, pair.children_b,
                                                  test_boxes(pair.a, pair.b, setup, grid_of(pair.a, pair.b, setup)));
    for (unsigned n = 0; n < 16; ++n) {
      if ((found.waiting >> n & 1U) == 0) continue;
      const auto child = [](const bvh::InnerLine& node, const Half& half, unsigned i) {
        return node.kind[i] == bvh::NodeKind::inner ? Half{node.first + i, 15} : Half{half.line, 1U << i};
      };
      todo.push_back({child(pair.a, at_a, n / 4), child(pair.b, at_b, n % 4)});
    }
  }
  return scene;
}

/// Any query; in some of them a single bit of the pose decides.
Query decisive_query(Random& random) {
  Query query = random_query(random);
  const int kind = number(random, 0, 9);
  if (kind < 3) {  // along the axes, with nodes that lie on one grid: planes that meet exactly
    query.m = {};
    for (std::size_t i = 0; i < 3; ++i) query.m[i][i] = chance(random, 50) ? 1 << 30 : -(1 << 30);
    for (auto& t : query.t) t = t >> 14 << 14;
    query.shift = 0;
    query.error = 0;
  } else if (kind == 3) {  // the bound on the error decides how the pose's one is rounded
    query.shift = 8;
    query.error = static_cast<std::uint32_t>(number(random, 0, 4095));
  }
  return query;
}

/// Any two nodes, mostly near each other and of steps up to 24 powers of two apart.
NodePair random_pair(Random& random, const model::PoseSetup& pose) {
  NodePair pair{random_node(random), random_node(random), 15, 15};
  for (auto* node : {&pair.a, &pair.b}) {
    for (auto& kind : node->kind) kind = static_cast<bvh::NodeKind>(chance(random, 50) ? 0 : number(random, 1, 3));
  }
  const int e = chance(random, 60) ? number(random, -3, 6) : number(random, -24, 24);
  if (chance(random, 80)) pair.b.step = std::clamp(pair.a.step - pose.shift + e, 0, bvh::step_max);
  const bool fine = chance(random, 20);  // the slack may not fit
  if (fine) pair.a.step = pair.b.step = 0;
  if (fine || chance(random, 80)) {
    const bool exact = fine || chance(random, 30);  // the offset is that of the grid
    for (auto& o : pair.a.origin) o = exact ? 0 : number(random, -32, 32);
    for (std::size_t i = 0; i < 3; ++i) pair.b.origin[i] = std::clamp(pose.t[i] / 64, -131072, 131071);
  }
  if (chance(random, 50)) pair.children_a = static_cast<unsigned>(number(random, 0, 15));
  if (chance(random, 50)) pair.children_b = static_cast<unsigned>(number(random, 0, 15));
  return pair;
}

/// The lower half of a line, or the upper one.
template <class Port>
void set_beat(Port& port, const bvh::InnerLine& node, std::size_t beat) {
  const Line line = encode(node);
  for (std::size_t i = 0; i < 32; ++i) sim::set_bits(port, static_cast<int>(8 * i), 8, line[32 * beat + i]);
}

int counting(const bvh::InnerLine& node, unsigned children) {
  int n = 0;
  for (int i = 0; i < node.children; ++i) n += static_cast<int>(children >> i & 1U);
  return n;
}

template <int queries, int tag_w, class Simulation>
void run(Simulation& simulation, Random& random, const std::vector<bvh::Image>& images, int percent, int clocks) {
  auto& top = simulation.top();
  struct Context {
    bool usable = false;  // its pose is in memory
    int at_work = 0;      // node pairs without a verdict
    Scene scene;
    model::PoseSetup pose;
    std::size_t next = 0;
  };
  std::array<Context, queries> contexts;
  struct PoseAtWork {
    int clock;  // of m_pose_valid
    std::size_t context;
  };
  std::deque<PoseAtWork> poses;
  struct Verdict {
    int clock;
    std::size_t context;
    std::uint64_t tag;
    int tests;
    model::ChildPairs pairs;
  };
  std::deque<Verdict> verdicts;

  bool pose_offered = false;
  std::size_t pose_context = 0;
  std::optional<Verdict> offered;
  NodePair lines;         // of the node pair that is offered
  std::size_t beats = 0;  // of these that it has given
  int left = 0;           // clocks of the node pair after this one
  int pairs_of_four = 0, waiting = 0, leaves = 0, strong = 0, far = 0, near = 0, done = 0, busy = 0;
  std::array<int, 17> tests{};
  top.s_valid = 0;
  top.s_pose_valid = 0;
  simulation.reset();
  for (int clock = 0; clock < clocks; ++clock) {
    // a pose
    if (!pose_offered && chance(random, percent)) {
      const auto c = static_cast<std::size_t>(number(random, 0, queries - 1));
      const auto resting = std::count_if(contexts.begin(), contexts.end(), [](const Context& k) { return !k.usable; });
      if (contexts[c].usable && resting < queries / 2 && chance(random, 5)) contexts[c].usable = false;
      const bool at_work = contexts[c].at_work != 0 || (offered && offered->context == c);
      const bool on_its_way =
          std::any_of(poses.begin(), poses.end(), [&](const PoseAtWork& pose) { return pose.context == c; });
      if (!contexts[c].usable && !at_work && !on_its_way) {
        pose_offered = true;
        pose_context = c;
        contexts[c].next = 0;
        contexts[c].scene = chance(random, 50)
                                ? Scene{decisive_query(random), {}}
                                : traverse(random, images[random() % images.size()], images[random() % images.size()]);
        const Query& query = contexts[c].scene.query;
        contexts[c].pose = model::set_up(query);
        top.s_pose_context = static_cast<CData>(c);
        for (std::size_t i = 0; i < 9; ++i)
          sim::set_bits(top.s_pose_m, static_cast<int>(32 * i), 32, static_cast<std::uint32_t>(query.m[i / 3][i % 3]));
        for (std::size_t i = 0; i < 3; ++i)
          sim::set_bits(top.s_pose_t, static_cast<int>(36 * i), 36, static_cast<std::uint64_t>(query.t[i]));
        top.s_pose_shift = static_cast<CData>(query.shift);
        top.s_pose_error = static_cast<SData>(query.error);
      }
    }
    top.s_pose_valid = pose_offered ? 1 : 0;
    if (!pose_offered) {
      sim::set_random(top.s_pose_m, 288, random);
      top.s_pose_context = static_cast<CData>(random() % queries);
    }

    // a node pair
    if (!offered && chance(random, percent)) {
      const auto begin = static_cast<std::size_t>(number(random, 0, queries - 1));
      for (std::size_t k = 0; k < queries && !offered; ++k) {
        const std::size_t c = (begin + k) % queries;
        Context& context = contexts[c];
        if (!context.usable) continue;
        NodePair pair = context.next < context.scene.pairs.size() ? context.scene.pairs[context.next++]
                                                                  : random_pair(random, context.pose);
        const model::NodeGrid grid = grid_of(pair.a, pair.b, context.pose);
        const model::BoxVerdict verdict = test_boxes(pair.a, pair.b, context.pose, grid);
        const int count_a = counting(pair.a, pair.children_a);
        const int count_b = counting(pair.b, pair.children_b);
        const int length = std::max({3, count_a, count_b});
        offered = Verdict{clock + length - 1 + latency, c, random() % (1U << tag_w), count_a * count_b,
                          sort_children(pair.a, pair.children_a, pair.b, pair.children_b, verdict)};
        left = length;
        far += grid.far ? 1 : 0;
        near += grid.near && !grid.far ? 1 : 0;
        top.s_tag = static_cast<CData>(offered->tag);
        top.s_context = static_cast<CData>(c);
        lines = pair;
        beats = 0;
        top.s_a_children = static_cast<CData>(pair.children_a);
        top.s_b_children = static_cast<CData>(pair.children_b);
        pairs_of_four += length == 4 ? 1 : 0;
      }
    }
    top.s_valid = offered ? 1 : 0;
    if (offered && beats < 2) {
      set_beat(top.s_a, lines.a, beats);
      set_beat(top.s_b, lines.b, beats);
      ++beats;
    } else {
      sim::set_random(top.s_a, 256, random);
      sim::set_random(top.s_b, 256, random);
    }
    if (!offered) {
      top.s_context = static_cast<CData>(random() % queries);
      top.s_a_children = static_cast<CData>(random() % 16);
      top.s_b_children = static_cast<CData>(random() % 16);
    }
    simulation.settle();

    // what comes out
    const bool due = !verdicts.empty() && verdicts.front().clock == clock;
    REQUIRE((top.m_valid != 0) == due);
    if (due) {
      const Verdict& verdict = verdicts.front();
      CAPTURE(clock, verdict.context);
      REQUIRE(top.m_tag == verdict.tag);
      REQUIRE(top.m_waiting == verdict.pairs.waiting);
      REQUIRE(top.m_leaves == verdict.pairs.leaves);
      REQUIRE(top.m_strong == verdict.pairs.strong);
      REQUIRE(top.m_tests == verdict.tests);
      if (verdict.pairs.waiting != 0) REQUIRE(top.m_best == verdict.pairs.best);
      ++tests[static_cast<std::size_t>(verdict.tests)];
      waiting += verdict.pairs.waiting != 0 ? 1 : 0;
      leaves += verdict.pairs.leaves != 0 ? 1 : 0;
      strong += verdict.pairs.strong != 0 && verdict.pairs.strong != verdict.pairs.waiting ? 1 : 0;
      --contexts[verdict.context].at_work;
      ++done;
      verdicts.pop_front();
    }
    const bool pose_due = !poses.empty() && poses.front().clock == clock;
    REQUIRE((top.m_pose_valid != 0) == pose_due);
    if (pose_due) {
      REQUIRE(top.m_pose_context == poses.front().context);
      contexts[poses.front().context].usable = true;
      poses.pop_front();
    }

    // what goes in
    if (offered) {
      ++busy;
      --left;
      REQUIRE((top.s_ready != 0) == (left == 0));
      REQUIRE((top.s_soon != 0) == (left == 1));
      if (left == 0) {
        ++contexts[offered->context].at_work;
        verdicts.push_back(*offered);
        offered.reset();
      }
    }
    if (pose_offered && top.s_pose_ready != 0) {
      poses.push_back({clock + pose_latency, pose_context});
      pose_offered = false;
    }
    simulation.rise();
  }
  CAPTURE(percent, done, busy, pairs_of_four, waiting, leaves, strong, far, near);
  REQUIRE(done > clocks * percent / 1000);
  if (percent == 100) REQUIRE(busy > clocks * 9 / 10);
  for (const int n : {0, 1, 2, 3, 4, 6, 8, 9, 12, 16}) REQUIRE(tests[static_cast<std::size_t>(n)] > done / 1000);
  REQUIRE(pairs_of_four > done / 10);
  REQUIRE(pairs_of_four < done * 9 / 10);
  REQUIRE(waiting > done / 10);
  REQUIRE(leaves > done / 50);
  REQUIRE(strong > done / 100);
  REQUIRE(far > done / 100);
  REQUIRE(far < done / 2);
  REQUIRE(near > done / 400);
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_bv_unit: verdicts are the functional model's, back to back and with gaps",
                        "[unit][cchip_bv_unit]", cchip_bv_unit_configs) {
  std::vector<bvh::Image> images;
  for (const Mesh& mesh : {make_torus(1, 0.4, 24, 12, Kind::quad), make_gear(0.8, 1, 0.3, 0.4, 12, 2),
                           make_sphere(0.02, 6, 0.1), make_body(10, 0.5)})
    images.push_back(bvh::make_image(mesh, bvh::build_tree(mesh)));
  for_two_power_ups<typename TestType::Model>([&](auto& simulation, Random& random) {
    for (const int percent : {100, 20})
      run<TestType::QUERIES, TestType::TAG_W>(simulation, random, images, percent, 20000);
  });
}
