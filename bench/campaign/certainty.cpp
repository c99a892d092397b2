// SPDX-License-Identifier: Apache-2.0
// True vertices lie off the grid points, on a grid 1024 times finer, so that the exact oracle knows them.
#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <cmath>
#include <random>

#include "commands.hpp"

namespace cchip::campaign {
namespace {

using Random = std::mt19937_64;
using Vec3l = Eigen::Matrix<std::int64_t, 3, 1>;

/// Steps of the fine grid in one grid step.
constexpr int fine = 1024;

int uniform(Random& random, int least, int greatest) {
  return std::uniform_int_distribution<int>(least, greatest)(random);
}

Vec3d to_doubles(const Vec3i& p) { return p.cast<double>(); }

// --- the true vertices

/// How the true vertices are chosen within half of eta of the grid points; "at the bound": to the worst, for a pair
/// that was moved to where the comparison with the error turns.
constexpr std::array<const char*, 4> offset_kinds = {"anywhere", "at the limit", "to the worst", "at the bound"};
constexpr std::size_t worst = 2;
constexpr std::size_t at_the_bound = 3;

/// Edges of a primitive, diagonals of a quad included.
std::vector<Vec3d> edges(const GridPrimitive& p) {
  std::vector<Vec3d> result;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    for (std::size_t k = i + 1; k < p.vertex_count(); ++k) result.emplace_back(to_doubles(p.v[k]) - to_doubles(p.v[i]));
  }
  return result;
}

/// Axis on which the answer is closest to changing: for disjoint primitives the largest gap, otherwise the smallest
/// overlap, among the normals of faces and crosses of edges; pointing from A to B. Doubles only choose here.
struct Tightest {
  Vec3d axis = Vec3d::UnitX();
  double gap = -std::numeric_limits<double>::infinity();  ///< in units of |axis|_1; an overlap is negative
};
Tightest tightest_axis(const GridPair& pair) {
  std::vector<Vec3d> axes;
  const auto edges_a = edges(pair.a);
  const auto edges_b = edges(pair.b);
  for (const auto& own : {edges_a, edges_b}) {
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) axes.push_back(own[i].cross(own[k]));
    }
  }
  for (const Vec3d& e : edges_a) {
    for (const Vec3d& f : edges_b) axes.push_back(e.cross(f));
  }
  Tightest best;
  for (const Vec3d& axis : axes) {
    const double norm = axis.lpNorm<1>();
    if (norm == 0) continue;
    const auto range = [&axis](const GridPrimitive& p) {
      std::pair<double, double> r(axis.dot(to_doubles(p.v[0])), axis.dot(to_doubles(p.v[0])));
      for (std::size_t i = 1; i < p.vertex_count(); ++i) {
        r.first = std::min(r.first, axis.dot(to_doubles(p.v[i])));
        r.second = std::max(r.second, axis.dot(to_doubles(p.v[i])));
      }
      return r;
    };
    const auto a = range(pair.a);
    const auto b = range(pair.b);
    const double up = (b.first - a.second) / norm;
    const double down = (a.first - b.second) / norm;
    if (std::max(up, down) > best.gap) best = {up > down ? axis : Vec3d(-axis), std::max(up, down)};
  }
  return best;
}

/// Moves A by whole grid steps so that the gap, or the overlap, on the tightest axis is eta, or the power of two E >=
/// eta of the hardware, times |axis|_1, or as little more or less as the axis allows.
void move_to_the_bound(GridPair& pair, int eta, int coord_w, Random& random) {
  const Tightest now = tightest_axis(pair);
  const int bound = uniform(random, 0, 1) == 0 ? eta : 1 << model::error_shift(eta);
  const double goal = uniform(random, 0, 1) == 0 ? bound : -bound;
  const bool more = uniform(random, 0, 1) == 0;
  const double by = (now.gap - goal) * now.axis.lpNorm<1>();  // axis . move
  Eigen::Index d = 0;
  const double largest = now.axis.cwiseAbs().maxCoeff(&d);
  if (largest == 0 || std::abs(by / largest) > 1 << coord_w) return;
  double least = std::numeric_limits<double>::infinity();
  Vec3i best = Vec3i::Zero();
  for (int n = 0; n < 25; ++n) {
    Vec3i move = Vec3i::Zero();
    move[(d + 1) % 3] = n % 5 - 2;
    move[(d + 2) % 3] = n / 5 - 2;
    const double rest = (by - now.axis.dot(to_doubles(move))) / now.axis[d];
    move[d] = static_cast<int>(more ? std::ceil(rest) : std::floor(rest));
    const double off = std::abs(rest - move[d]);
    if (off < least) {
      least = off;
      best = move;
    }
  }
  const auto fits = [&](const Vec3i& v) { return (v + best).cwiseAbs().maxCoeff() < 1 << (coord_w - 1); };
  if (!std::all_of(pair.a.v.begin(), pair.a.v.begin() + static_cast<std::ptrdiff_t>(pair.a.vertex_count()), fits))
    return;
  for (std::size_t i = 0; i < pair.a.vertex_count(); ++i) pair.a.v[i] += best;
}

/// Moves the vertices by up to `reach` fine steps.
GridPair true_pair(const GridPair& pair, std::size_t kind, int reach, bool grid_hit, Random& random) {
  GridPair result = pair;
  const Vec3d axis = kind >= worst ? tightest_axis(pair).axis : Vec3d::Zero();
  for (GridPrimitive* p : {&result.a, &result.b}) {
    // The worst direction: primitives that are apart move towards each other, primitives that meet move apart.
    const double towards = (p == &result.a) == grid_hit ? -1 : 1;
    for (std::size_t i = 0; i < p->vertex_count(); ++i) {
      for (Eigen::Index d = 0; d < 3; ++d) {
        int by = uniform(random, -reach, reach);
        if (kind == 1) by = reach * uniform(random, -1, 1);
        if (kind >= worst && axis[d] != 0) by = axis[d] * towards > 0 ? reach : -reach;
        p->v[i][d] = fine * p->v[i][d] + by;
      }
    }
  }
  return result;
}

/// A quad in any order, or (rarely) with a vertex inside the triangle of the others: what hosts make canonical.
GridPrimitive any_order(GridPrimitive p, int coord_w, Random& random) {
  if (p.kind != Kind::quad || uniform(random, 0, 3) != 0) return p;
  if (uniform(random, 0, 3) == 0) {
    const Vec3i e = p.v[1] - p.v[0];
    const Vec3i f = p.v[2] - p.v[0];
    const GridPrimitive dented{Kind::quad,
                               {p.v[0], Vec3i(p.v[0] + 4 * e), Vec3i(p.v[0] + 4 * f), Vec3i(p.v[0] + e + f)}};
    const bool fits = std::all_of(dented.v.begin(), dented.v.end(),
                                  [coord_w](const Vec3i& v) { return v.cwiseAbs().maxCoeff() < 1 << (coord_w - 1); });
    if (fits) p = dented;
  }
  std::shuffle(p.v.begin(), p.v.end(), random);
  return p;
}

// --- pairs

constexpr std::array<const char*, 4> eta_groups = {"0", "1", "2..14", "15"};

int draw_eta(std::size_t group, Random& random) {
  if (group == 2) return uniform(random, 2, 14);
  return group == 3 ? defs::err_unknown : static_cast<int>(group);
}

struct Row {
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;     ///< of the true primitives
  std::uint64_t changed = 0;  ///< true answer differs from the grid's
  std::array<std::uint64_t, 2> definite_no = {};
  std::array<std::uint64_t, 2> definite_hit = {};
  std::uint64_t contradictions = 0;  ///< definite and not the exact answer, both programmes
  std::uint64_t false_no = 0;        ///< answer "no", true primitives meet
  std::uint64_t other = 0;           ///< grid answer wrong, eta 0 not definite or eta 15 definite

  Row& operator+=(const Row& x) {
    pairs += x.pairs;
    hits += x.hits;
    changed += x.changed;
    for (std::size_t mode = 0; mode < 2; ++mode) {
      definite_no[mode] += x.definite_no[mode];
      definite_hit[mode] += x.definite_hit[mode];
    }
    contradictions += x.contradictions;
    false_no += x.false_no;
    other += x.other;
    return *this;
  }
  bool failed() const { return contradictions + false_no + other != 0; }
};

constexpr std::size_t rows_per_shape = eta_groups.size() * offset_kinds.size();

Row judge(const model::Options& of, const GridPair& grid, bool grid_hit, const GridPair& truth, int coord_w) {
  Row row;
  const Relation relation = exact_relation(truth);
  const bool hit = relation != Relation::apart;
  row.pairs = 1;
  row.hits = hit ? 1 : 0;
  row.changed = hit != grid_hit ? 1 : 0;
  for (std::size_t mode = 0; mode < 2; ++mode) {
    const model::Outcome o = model::run_programme(of, grid, static_cast<PairMode>(mode), coord_w);
    if (o.definite) ++(o.grid ? row.definite_hit : row.definite_no)[mode];
    // A definite hit of inexact numbers must cross: the bounds are strict, so it survives any small translation.
    const bool as_promised = o.grid == hit && (!o.grid || grid.eta == 0 || relation == Relation::crossing);
    row.contradictions += o.definite && !as_promised ? 1 : 0;
    row.false_no += !o.hit() && hit ? 1 : 0;
    const bool promised = grid.eta == 0 ? o.definite : grid.eta != defs::err_unknown || !o.definite;
    row.other += o.grid != grid_hit || !promised ? 1 : 0;
  }
  return row;
}

Table<Row> run_part(const ShapeInfo& shape, const CertaintyOptions& options, std::uint64_t pairs, std::uint64_t part,
                    std::uint64_t seed) {
  Random random(seed);
  model::Options of = shape.options();
  of.depth = options.depth;
  // the size differs from part to part, because it decides what is definite
  const int size_w = uniform(random, std::min(defs::coord_w_min + 1, options.coord_w), options.coord_w);
  PairSource source(size_w, random(), shape.a, shape.b);
  const auto classes = classes_of(shape.a, shape.b);
  std::discrete_distribution<std::size_t> group({4, 50, 42, 4});
  Table<Row> table(rows_per_shape);
  for (std::uint64_t i = 0; i < pairs_of_part(pairs, part); ++i) {
    GridPair raw = source.draw(classes[source.draw_class()].value);
    raw.a = any_order(raw.a, options.coord_w, random);
    raw.b = any_order(raw.b, options.coord_w, random);
    const std::size_t drawn = group(random);
    const std::size_t g = options.eta == 0 ? drawn : options.eta == 1 ? 1 : 2;
    const auto kind = static_cast<std::size_t>(uniform(random, 0, static_cast<int>(offset_kinds.size()) - 1));
    const int eta = options.eta == 0 ? draw_eta(g, random) : options.eta;
    if (kind == at_the_bound) move_to_the_bound(raw, eta, options.coord_w, random);
    const GridPair grid{canonical_quad(raw.a), canonical_quad(raw.b), eta};
    const bool grid_hit = exact_intersects(grid);
    const int reach = static_cast<int>(options.offset * grid.eta * fine / 2);
    const GridPair truth = true_pair(raw, kind, reach, grid_hit, random);
    const Row one = judge(of, grid, grid_hit, truth, options.coord_w);
    if (one.failed()) {
      table.examples.add(
          part, fmt::format("{}: {}, true vertices times {}: {}", shape.name, to_text(grid), fine, to_text(truth)));
    }
    table.rows[g * offset_kinds.size() + kind] += one;
  }
  return table;
}

void print_row(const std::string& shape, const std::string& eta, const std::string& offsets, const Row& r) {
  const std::uint64_t definite = r.definite_no[1] + r.definite_hit[1];
  fmt::print("{:<10} {:<6} {:<13} {:>9} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8.2f} {:>8} {:>8} {:>6}\n", shape, eta,
             offsets, r.pairs, r.hits, r.changed, r.definite_no[0], r.definite_hit[0], r.definite_no[1],
             r.definite_hit[1], percent(definite, r.pairs), r.contradictions, r.false_no, r.other);
}

// --- the bounds alone

struct BoundRow {
  std::uint64_t cases = 0;
  std::uint64_t violations = 0;
  double tightest = 0;  ///< largest change / exact bound
  double rounded = 0;   ///< largest change / the hardware's bound
  BoundRow& operator+=(const BoundRow& x) {
    cases += x.cases;
    violations += x.violations;
    tightest = std::max(tightest, x.tightest);
    rounded = std::max(rounded, x.rounded);
    return *this;
  }
};

using Int128 = boost::multiprecision::int128_t;

Int128 determinant(const Vec3l& a, const Vec3l& b, const Vec3l& c) {
  const Vec3l n = a.cross(b);
  return Int128(n[0]) * c[0] + Int128(n[1]) * c[1] + Int128(n[2]) * c[2];
}

/// Each component -error, 0 or error; or all of them against the sign of `direction`, which changes a . direction most.
Vec3l change(const Vec3l& direction, std::int64_t error, Random& random, bool extremal) {
  Vec3l result;
  for (Eigen::Index d = 0; d < 3; ++d) {
    const int sign = extremal && direction[d] != 0 ? (direction[d] > 0 ? 1 : -1) : uniform(random, -1, 1);
    result[d] = error * sign;
  }
  return result;
}

/// det(a, b, c) of three differences of vertices, each wrong by up to eta: a and b are the edges of the axis, c is
/// the projected point. The change is multilinear, so corners are the worst.
BoundRow bound_case(int coord_w, Random& random) {
  const int scale = 1 << uniform(random, 1, coord_w - 1);
  const auto vector = [&] {
    const auto c = [&] { return std::int64_t{uniform(random, -scale, scale)}; };
    Vec3l v;
    for (Eigen::Index d = 0; d < 3; ++d) v[d] = uniform(random, 0, 5) == 0 ? 0 : c();
    return v;
  };
  const Vec3l a = vector();
  const Vec3l b = vector();
  const Vec3l c = vector();
  const std::int64_t error = uniform(random, 1, 14);
  const bool extremal = uniform(random, 0, 1) == 0;
  const Vec3l dc = change(a.cross(b), error, random, extremal);
  const Vec3l da = change(b.cross(c + dc), error, random, extremal);
  const Vec3l db = change((c + dc).cross(a + da), error, random, extremal);
  const Int128 changed = abs(determinant(a + da, b + db, c + dc) - determinant(a, b, c));
  const Int128 bound =
      Int128(error) * (Int128(a.cross(b).lpNorm<1>()) +
                       Int128(a.lpNorm<1>() + b.lpNorm<1>() + 2 * error) * (c.lpNorm<1>() + 2 * error));
  // the hardware's bound: stages 2 and 3 of the model, with the vertices 0, a, b and the point c
  model::Selection s;
  s.e_from = s.f_from = Vec3i::Zero();
  s.e_to = a.cast<std::int32_t>();
  s.f_to = b.cast<std::int32_t>();
  s.points.fill(c.cast<std::int32_t>());
  const model::Projections p =
      model::sat_project({3, 3}, model::sat_axis(s, coord_w), s, model::error_shift(static_cast<int>(error)), coord_w);
  const auto ratio = [&changed](const Int128& of) { return static_cast<double>(changed) / static_cast<double>(of); };
  return {1, changed > bound || bound > p.sign_bound ? 1U : 0U, ratio(bound), ratio(Int128(p.sign_bound))};
}

BoundRow run_bounds(const CertaintyOptions& options) {
  return sum_of_parts<BoundRow>(part_count(options.bounds), options.threads, [&](std::uint64_t part) {
    Random random(options.seed_of(part) + 1);
    BoundRow row;
    for (std::uint64_t i = 0; i < pairs_of_part(options.bounds, part); ++i) row += bound_case(options.coord_w, random);
    return row;
  });
}

/// Shares of the pairs with eta = 1 that are definite.
void check_certainty(Goals& goals, const CertaintyOptions& options, const Table<Row>& table) {
  const auto shapes = options.shapes();
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    Row sum;
    for (std::size_t kind = 0; kind < offset_kinds.size(); ++kind) {
      sum += table.rows[s * rows_per_shape + offset_kinds.size() + kind];  // group 1 of eta_groups
    }
    for (std::size_t mode = 0; mode < 2; ++mode) {
      const std::string of = fmt::format(" of {} {} with eta 1, %", shapes[s].name, programmes[mode]);
      goals.at_least("share of definite answers" + of,
                     percent(sum.definite_no[mode] + sum.definite_hit[mode], sum.pairs), options.least_definite);
      goals.at_least("share of definite hits" + of, percent(sum.definite_hit[mode], sum.pairs),
                     options.least_definite_hits);
    }
  }
}

}  // namespace

int run_certainty(const CertaintyOptions& options) {
  const StopWatch watch;
  const auto shapes = options.shapes();
  const std::uint64_t pairs = (options.pairs + shapes.size() - 1) / shapes.size();
  const std::uint64_t parts = part_count(pairs);
  auto table = sum_of_parts<Table<Row>>(parts * shapes.size(), options.threads, [&](std::uint64_t job) {
    const std::size_t shape = job / parts;
    const Table<Row> part = run_part(shapes[shape], options, pairs, job % parts, options.seed_of(job));
    Table<Row> counted(shapes.size() * rows_per_shape);
    std::copy(part.rows.begin(), part.rows.end(),
              counted.rows.begin() + static_cast<std::ptrdiff_t>(shape * rows_per_shape));
    counted.examples = part.examples;
    return counted;
  });
  table.rows.resize(shapes.size() * rows_per_shape);  // it has none without pairs
  fmt::print("seed={} coord_w={} offset={} depth={}\n", options.seed, options.coord_w, options.offset,
             options.depth ? 1 : 0);
  fmt::print("{:<10} {:<6} {:<13} {:>9} {:>9} {:>8} {:>19} {:>28} {:>8} {:>8} {:>6}\n", "", "", "", "", "", "",
             "exhaustive definite", "directed definite", "contra-", "false", "other");
  fmt::print("{:<10} {:<6} {:<13} {:>9} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>6}\n", "shape", "eta",
             "offsets", "pairs", "hits", "changed", "no", "hit", "no", "hit", "%", "dictions", "no", "wrong");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::size_t row = i % rows_per_shape;
    print_row(shapes[i / rows_per_shape].name, eta_groups[row / offset_kinds.size()],
              offset_kinds[row % offset_kinds.size()], table.rows[i]);
  }
  const Row sum = table.sum();
  print_row("all", "", "", sum);
  table.examples.print();
  Goals goals;
  options.check(goals, sum.pairs, sum.hits);
  if (options.eta <= 1) check_certainty(goals, options, table);
  const BoundRow bounds = run_bounds(options);
  fmt::print("\nbounds: {} cases, {} violations, largest change {:.4f} of the exact bound, {:.4f} of the hardware's\n",
             bounds.cases, bounds.violations, bounds.tightest, bounds.rounded);
  fmt::print(
      "pairs={} contradictions={} false_no={} other_wrong={} bound_cases={} bound_violations={} seconds={:.1f} "
      "seed={}\n",
      sum.pairs, sum.contradictions, sum.false_no, sum.other, bounds.cases, bounds.violations, watch.seconds(),
      options.seed);
  return sum.failed() || bounds.violations != 0 || goals.missed() ? wrong_result : 0;
}

}  // namespace cchip::campaign
