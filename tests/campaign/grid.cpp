// SPDX-License-Identifier: Apache-2.0
// The grid -1..1: 27 points, 27^3 ordered triangles.
#include <cchip/geometry/canonical.hpp>
#include <cchip/stimulus/judge.hpp>
#include <random>

#include "commands.hpp"
#include "rtl_stream.hpp"

namespace cchip::campaign {
namespace {

constexpr int points = 27;
constexpr int triangles = points * points * points;

Vec3i point(int number) { return {number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1}; }
int number_of(const Vec3i& p) { return p.x() + 1 + 3 * (p.y() + 1) + 9 * (p.z() + 1); }

GridPrimitive triangle(int number) {
  GridPrimitive p;
  p.v = {point(number % points), point(number / points % points), point(number / (points * points)), Vec3i::Zero()};
  return p;
}

/// Images of the 27 points under the 48 symmetries of the cube.
std::vector<std::array<int, points>> symmetries() {
  std::vector<std::array<int, points>> result;
  std::array<int, 3> axis = {0, 1, 2};
  do {
    for (int mirror = 0; mirror < 8; ++mirror) {
      std::array<int, points> image{};
      for (int i = 0; i < points; ++i) {
        const Vec3i p = point(i);
        Vec3i q;
        for (int d = 0; d < 3; ++d) {
          const int c = p[axis[static_cast<std::size_t>(d)]];
          q[d] = (mirror >> d & 1) != 0 ? -c : c;
        }
        image[static_cast<std::size_t>(i)] = number_of(q);
      }
      result.push_back(image);
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
  return result;
}

/// One ordered triangle, the smallest, of every class under the symmetries of the cube. Orders of the vertices are
/// kept: the programmes depend on them.
std::vector<int> first_triangles() {
  const auto images = symmetries();
  std::vector<int> result;
  for (int t = 0; t < triangles; ++t) {
    const std::array<int, 3> v = {t % points, t / points % points, t / (points * points)};
    bool least = true;
    for (const auto& image : images) {
      const auto to = [&image](int p) { return image[static_cast<std::size_t>(p)]; };
      least = least && to(v[0]) + points * (to(v[1]) + points * to(v[2])) >= t;
    }
    if (least) result.push_back(t);
  }
  return result;
}

GridPair triangle_pair(const std::vector<int>& firsts, std::uint64_t index) {
  return {triangle(firsts[index / triangles]), triangle(static_cast<int>(index % triangles)), 0};
}

GridPrimitive random_primitive(Kind kind, std::mt19937_64& random) {
  std::uniform_int_distribution<int> number(0, points - 1);
  GridPrimitive p;
  p.kind = kind;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] = point(number(random));
  return canonical_quad(p);
}

GridPair random_pair(const ShapeInfo& shape, std::mt19937_64& random) {
  const GridPrimitive a = random_primitive(shape.a, random);
  return {a, random_primitive(shape.b, random), 0};
}

/// Pair number `index` of `count`: all of them, or spread evenly over them.
std::uint64_t spread(std::uint64_t index, std::uint64_t count, std::uint64_t all) {
  return static_cast<std::uint64_t>(static_cast<double>(index) / static_cast<double>(count) * static_cast<double>(all));
}

/// Pairs of one shape, in parts.
class Pairs {
 public:
  Pairs(const ShapeInfo& shape, std::uint64_t count, const std::vector<int>& firsts)
      : shape_(shape), count_(count), firsts_(firsts) {}

  template <class Visit>
  void visit(std::uint64_t part, std::uint64_t seed, const Visit& visit) const {
    std::mt19937_64 random(seed);
    const std::uint64_t all = firsts_.size() * triangles;
    for (std::uint64_t i = 0; i < pairs_of_part(count_, part); ++i) {
      const std::uint64_t index = part * part_pairs + i;
      const bool triangles_only = shape_.b == Kind::tri;
      visit(triangles_only ? triangle_pair(firsts_, spread(index, count_, all)) : random_pair(shape_, random));
    }
  }

 private:
  const ShapeInfo& shape_;
  std::uint64_t count_;
  const std::vector<int>& firsts_;
};

Table<Judgement> model_pairs(const ShapeInfo& shape, const GridOptions& options, std::uint64_t count,
                             const std::vector<int>& firsts) {
  const Pairs pairs(shape, count, firsts);
  return sum_of_parts<Table<Judgement>>(part_count(count), options.threads, [&](std::uint64_t part) {
    Table<Judgement> counted(1);
    pairs.visit(part, options.seed_of(part), [&](const GridPair& pair) {
      const Judgement one = judge(shape, pair, defs::coord_w_default);
      if (one.failed()) counted.examples.add(part, to_text(pair));
      counted.rows[0] += one;
    });
    return counted;
  });
}

Table<RtlJudgement> rtl_pairs(const ShapeInfo& shape, const GridOptions& options, const std::vector<int>& firsts) {
  const Pairs pairs(shape, options.rtl, firsts);
  return sum_of_parts<Table<RtlJudgement>>(2 * part_count(options.rtl), options.threads, [&](std::uint64_t job) {
    const std::uint64_t part = job / 2;
    std::vector<PairRequest> requests;
    std::vector<bool> exact;
    pairs.visit(part, options.seed_of(part), [&](const GridPair& pair) {
      requests.push_back({pair, 0, static_cast<PairMode>(job % 2)});
      exact.push_back(exact_intersects(pair));
    });
    Table<RtlJudgement> counted(2);
    counted.rows[job % 2] = judge_rtl(shape, requests, exact, options.seed_of(job), job, counted.examples);
    return counted;
  });
}

}  // namespace

int run_grid(const GridOptions& options) {
  const StopWatch watch;
  const std::vector<int> firsts = first_triangles();
  fmt::print("seed={} first triangles={} ordered second triangles={}\n", options.seed, firsts.size(), triangles);
  std::vector<std::string> names;
  Table<Judgement> table;
  Table<RtlJudgement> rtl_table;
  for (const ShapeInfo& shape : options.shapes()) {
    const bool all = shape.b == Kind::tri && options.pairs == 0;
    const std::uint64_t count = all ? firsts.size() * triangles : options.pairs;
    const Table<Judgement> counted = model_pairs(shape, options, count, firsts);
    names.emplace_back(shape.name);
    table.rows.push_back(counted.sum());
    counted.examples.print();
    if (options.rtl == 0) continue;
    const Table<RtlJudgement> rtl = rtl_pairs(shape, options, firsts);
    rtl_table.rows.insert(rtl_table.rows.end(), rtl.rows.begin(), rtl.rows.end());
    rtl.examples.print();
  }
  const Judgement sum = print(names, table);
  if (options.rtl != 0) {
    fmt::print("\n{:<28} {:>11} {:>11} {:>14} {:>9} {:>9} {:>6}\n", "RTL", "pairs", "hits", "not as model", "wrong",
               "beats", "max");
    for (std::size_t i = 0; i < rtl_table.rows.size(); ++i) {
      const RtlJudgement& r = rtl_table.rows[i];
      fmt::print("{:<28} {:>11} {:>11} {:>14} {:>9} {:>9.3f} {:>6}\n", names[i / 2] + " " + programmes[i % 2], r.pairs,
                 r.hits, r.not_as_model, r.wrong, r.beats.mean(), r.beats.greatest);
    }
  }
  const RtlJudgement rtl = rtl_table.sum();
  fmt::print(
      "pairs={} wrong_exhaustive={} wrong_directed={} false_no={} too_many_beats={} rtl_results={} rtl_not_as_model={} "
      "rtl_wrong={} seconds={:.1f} seed={}\n",
      sum.pairs, sum.wrong[0], sum.wrong[1], sum.false_no, sum.too_many_beats + rtl.too_many_beats, rtl.pairs,
      rtl.not_as_model, rtl.wrong, watch.seconds(), options.seed);
  Goals goals;
  options.check(goals, sum.pairs, sum.hits);
  return sum.failed() || rtl.failed() || goals.missed() ? wrong_result : 0;
}

}  // namespace cchip::campaign
