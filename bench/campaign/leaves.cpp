// SPDX-License-Identifier: Apache-2.0
// What reaches a primitive test after a bounding volume test: pairs of faces whose 26-DOPs overlap.
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/grid/local_grid.hpp>
#include <cchip/internal/tree/dop26.hpp>
#include <cchip/mesh_file.hpp>
#include <cchip/shapes.hpp>
#include <cchip/stimulus/quads.hpp>
#include <cmath>
#include <random>

#include "commands.hpp"

namespace cchip::campaign {
namespace {

constexpr std::array<int, 4> widths = {14, 16, 18, 20};
constexpr std::size_t default_width = 1;
static_assert(widths[default_width] == defs::coord_w_default);

// --- pairs

struct LeafPair {
  Primitive a;
  Primitive b;
};

/// Two meshes; the second one is moved.
struct Scene {
  std::string name;
  Mesh a;
  Mesh b;
};

std::vector<Scene> scenes(const LeavesOptions& options) {
  std::vector<Scene> result;
  const FaceKinds kinds = options.quads ? FaceKinds::triangles_and_quads : FaceKinds::triangles;
  for (const std::string& path : options.meshes) {
    const Mesh mesh = load_mesh(path, kinds);
    result.push_back({path.substr(path.find_last_of('/') + 1), mesh, mesh});
  }
  if (!result.empty()) return result;
  const Mesh torus = make_torus(2, 0.7, 48, 24);
  result.push_back({"torus, gear", torus, make_gear(1.4, 2, 0.6, 0.8, 24, 6)});
  const Mesh quads = make_torus(2, 0.7, 48, 24, Kind::quad);
  result.push_back({"quad torus", quads, quads});
  result.push_back({"torus, quad torus", torus, quads});
  return result;
}

/// The mesh turned about its centre by up to 0.3 rad and moved by up to a tenth of its size.
Mesh posed(const Mesh& mesh, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vec3d(unit(random), unit(random), unit(random)); };
  Vec3d least = mesh.vertices.front();
  Vec3d greatest = least;
  for (const Vec3d& v : mesh.vertices) {
    least = least.cwiseMin(v);
    greatest = greatest.cwiseMax(v);
  }
  const Vec3d centre = (least + greatest) / 2;
  const Vec3d move = vector().cwiseProduct(greatest - least) / 10;
  const Vec3d axis = vector().normalized();
  return transformed(mesh, Eigen::Translation3d(centre + move) * Eigen::AngleAxisd(0.3 * unit(random), axis) *
                               Eigen::Translation3d(-centre));
}

/// Pairs of one shape; every n-th if there are too many.
std::vector<LeafPair> leaf_pairs(const Mesh& a, const Mesh& b, std::uint64_t most) {
  const auto dops = [](const Mesh& mesh) {
    std::vector<bvh::Dop26> result;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) result.push_back(bvh::make_dop26(mesh.primitive(i)));
    return result;
  };
  const auto dops_a = dops(a);
  const auto dops_b = dops(b);
  std::vector<CandidatePair> found;
  sweep_box_pairs(a, b, [&](CandidatePair c) {
    if (overlap(dops_a[c.face_a], dops_b[c.face_b])) found.push_back(c);
  });
  const std::size_t stride = most == 0 ? 1 : (found.size() + most - 1) / most;
  std::vector<LeafPair> pairs;
  for (std::size_t i = 0; i < found.size(); i += stride) {
    LeafPair pair{a.primitive(found[i].face_a), b.primitive(found[i].face_b)};
    if (pair.a.kind > pair.b.kind) std::swap(pair.a, pair.b);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

// --- what is measured

struct WidthRow {
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;  ///< exact answer for the doubles
  std::uint64_t rounded = 0;
  std::uint64_t warped = 0;
  std::uint64_t grid_differs = 0;  ///< grid answer is not the exact one
  std::array<Spread, 2> beats;
  std::array<std::uint64_t, 2> open_no = {};   ///< indefinite, grid answer "no"
  std::array<std::uint64_t, 2> open_hit = {};  ///< indefinite, grid answer "hit"
  std::uint64_t wrong = 0;                     ///< definite and not exact, or a "no" for primitives that meet
  WidthRow& operator+=(const WidthRow& x) {
    pairs += x.pairs;
    hits += x.hits;
    rounded += x.rounded;
    warped += x.warped;
    grid_differs += x.grid_differs;
    for (std::size_t mode = 0; mode < 2; ++mode) {
      beats[mode] += x.beats[mode];
      open_no[mode] += x.open_no[mode];
      open_hit[mode] += x.open_hit[mode];
    }
    wrong += x.wrong;
    return *this;
  }
};

/// Smallest height of the thinner primitive, in grid steps, upper limits.
constexpr std::array<double, 7> thickness_limits = {16, 64, 256, 1024, 4096, 16384, 1e300};

struct ThicknessRow {
  std::uint64_t pairs = 0;
  std::uint64_t open = 0;  ///< indefinite, DIRECTED, default width
};

struct Measured {
  std::array<WidthRow, widths.size()> width;
  std::array<ThicknessRow, thickness_limits.size()> thickness;
  Examples examples;
  Measured& operator+=(const Measured& x) {
    for (std::size_t i = 0; i < width.size(); ++i) width[i] += x.width[i];
    for (std::size_t i = 0; i < thickness.size(); ++i) {
      thickness[i].pairs += x.thickness[i].pairs;
      thickness[i].open += x.thickness[i].open;
    }
    examples += x.examples;
    return *this;
  }
};

/// Twice the area over the longest edge or diagonal.
double thickness(const Primitive& p) {
  double longest = 0;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    for (std::size_t k = 0; k < i; ++k) longest = std::max(longest, (p.v[i] - p.v[k]).norm());
  }
  const std::size_t last = p.vertex_count() - 1;
  const Vec3d normal =
      p.kind == Kind::tri ? (p.v[1] - p.v[0]).cross(p.v[2] - p.v[0]) : (p.v[2] - p.v[0]).cross(p.v[last] - p.v[1]);
  return longest == 0 ? 0 : normal.norm() / longest;
}

std::size_t thickness_class(const LeafPair& pair, int exponent) {
  const double steps = std::ldexp(std::min(thickness(pair.a), thickness(pair.b)), -exponent);
  std::size_t i = 0;
  while (steps >= thickness_limits[i]) ++i;
  return i;
}

void measure(const model::Options& of, const LeafPair& pair, int eta, std::uint64_t part, Measured& result) {
  const bool hit = exact_intersects(pair.a, pair.b);
  for (std::size_t w = 0; w < widths.size(); ++w) {
    QuantisedPair quantised = quantise(pair.a, pair.b, widths[w]);
    GridPair& grid = quantised.pair;
    if (grid.eta != 0) grid.eta = std::max(grid.eta, eta);
    grid.a = canonical_quad(grid.a);
    grid.b = canonical_quad(grid.b);
    WidthRow row;
    row.pairs = 1;
    row.hits = hit ? 1 : 0;
    row.rounded = grid.eta != 0 ? 1 : 0;
    row.warped = is_warped(grid.a) || is_warped(grid.b) ? 1 : 0;
    for (std::size_t mode = 0; mode < 2; ++mode) {
      const model::Outcome o = model::run_programme(of, grid, static_cast<PairMode>(mode), widths[w]);
      row.beats[mode].add(o.beats);
      row.grid_differs = o.grid != hit ? 1 : 0;
      if (!o.definite) ++(o.grid ? row.open_hit : row.open_no)[mode];
      row.wrong += (o.definite && o.grid != hit) || (hit && !o.hit()) ? 1 : 0;
    }
    if (row.wrong != 0) result.examples.add(part, fmt::format("{} bit: {}", widths[w], to_text(grid)));
    if (w == default_width) {
      ThicknessRow& t = result.thickness[thickness_class(pair, quantised.grid.exponent)];
      ++t.pairs;
      t.open += row.open_no[1] + row.open_hit[1];
    }
    result.width[w] += row;
  }
}

Measured measure(const ShapeInfo& shape, const std::vector<LeafPair>& pairs, const LeavesOptions& options) {
  constexpr std::size_t chunk = 1024;
  model::Options of = shape.options();
  of.depth = options.depth;
  return sum_of_parts<Measured>((pairs.size() + chunk - 1) / chunk, options.threads, [&](std::uint64_t part) {
    Measured result;
    for (std::size_t i = part * chunk; i < std::min(pairs.size(), (part + 1) * chunk); ++i) {
      measure(of, pairs[i], options.eta, part, result);
    }
    return result;
  });
}

void print(const std::string& name, const ShapeInfo& shape, const Measured& m) {
  for (std::size_t w = 0; w < widths.size(); ++w) {
    const WidthRow& r = m.width[w];
    const auto open = [&r](std::size_t mode) { return r.open_no[mode] + r.open_hit[mode]; };
    fmt::print(
        "{:<20} {:<10} {:>5} {:>9} {:>6.2f} {:>8.2f} {:>8.2f} {:>7.3f} {:>7.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} "
        "{:>6}\n",
        name, shape.name, widths[w], r.pairs, percent(r.hits, r.pairs), percent(r.warped, r.pairs),
        percent(r.grid_differs, r.pairs), r.beats[0].mean(), r.beats[1].mean(), percent(open(0), r.pairs),
        percent(open(1), r.pairs), percent(r.open_no[1], r.pairs), percent(r.open_hit[1], r.pairs), r.wrong);
  }
}

void print_thickness(const Measured& m) {
  std::uint64_t pairs = 0;
  std::uint64_t open = 0;
  for (const ThicknessRow& t : m.thickness) {
    pairs += t.pairs;
    open += t.open;
  }
  fmt::print("  at {} bit, by height of the thinner primitive in grid steps:\n", widths[default_width]);
  for (std::size_t i = 0; i < m.thickness.size(); ++i) {
    const ThicknessRow& t = m.thickness[i];
    if (t.pairs == 0) continue;
    const bool last = i + 1 == m.thickness.size();
    fmt::print(
        "    {:<9} {:>8.3f} % of the pairs, {:>8.3f} % of the indefinite ones, {:>8.3f} % of these pairs are "
        "indefinite\n",
        last ? "more" : fmt::format("< {:.0f}", thickness_limits[i]), percent(t.pairs, pairs), percent(t.open, open),
        percent(t.open, t.pairs));
  }
}

}  // namespace

int run_leaves(const LeavesOptions& options) {
  const StopWatch watch;
  fmt::print("seed={} poses={} eta={} depth={}\n", options.seed, options.poses, options.eta, options.depth ? 1 : 0);
  fmt::print("{:<20} {:<10} {:>5} {:>9} {:>6} {:>8} {:>8} {:>7} {:>7} {:>8} {:>8} {:>8} {:>8} {:>6}\n", "", "", "", "",
             "hits", "warped", "grid", "beats", "beats", "open exh", "open dir", "dir, no", "dir, hit", "");
  fmt::print("{:<20} {:<10} {:>5} {:>9} {:>6} {:>8} {:>8} {:>7} {:>7} {:>8} {:>8} {:>8} {:>8} {:>6}\n", "meshes",
             "shape", "width", "pairs", "%", "%", "differs %", "exh", "dir", "%", "%", "%", "%", "wrong");
  std::array<Measured, all_shapes.size()> all;
  for (const Scene& scene : scenes(options)) {
    std::mt19937_64 random(options.seed);
    std::vector<LeafPair> pairs;
    for (int pose = 0; pose < options.poses; ++pose) {
      const auto more = leaf_pairs(scene.a, posed(scene.b, random), options.pairs_max);
      pairs.insert(pairs.end(), more.begin(), more.end());
    }
    for (std::size_t s = 0; s < all_shapes.size(); ++s) {
      const ShapeInfo& shape = all_shapes[s];
      std::vector<LeafPair> chosen;
      std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(chosen),
                   [&shape](const LeafPair& p) { return p.a.kind == shape.a && p.b.kind == shape.b; });
      if (chosen.empty()) continue;
      const Measured m = measure(shape, chosen, options);
      print(scene.name, shape, m);
      print_thickness(m);
      m.examples.print();
      all[s] += m;
    }
  }
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;
  std::uint64_t wrong = 0;
  Goals goals;
  for (std::size_t s = 0; s < all_shapes.size(); ++s) {
    if (all[s].width[0].pairs == 0) continue;
    const WidthRow& row = all[s].width[default_width];
    const std::string of = std::string(" of ") + all_shapes[s].name + ", directed";
    hits += row.hits;
    goals.at_most("share of indefinite answers" + of + ", %", percent(row.open_no[1] + row.open_hit[1], row.pairs),
                  options.most_indefinite);
    goals.at_most("mean number of beats" + of, row.beats[1].mean(), options.most_beats);
    print("all", all_shapes[s], all[s]);
    pairs += all[s].width[0].pairs;
    for (const WidthRow& w : all[s].width) wrong += w.wrong;
  }
  const WidthRow& triangles = all[0].width[default_width];
  fmt::print(
      "pairs={} wrong={} tri_tri_beats_directed={:.3f} tri_tri_indefinite_percent={:.3f} seconds={:.1f} seed={}\n",
      pairs, wrong, triangles.beats[1].mean(), percent(triangles.open_no[1] + triangles.open_hit[1], triangles.pairs),
      watch.seconds(), options.seed);
  options.check(goals, pairs, hits);
  return wrong == 0 && !goals.missed() ? 0 : wrong_result;
}

}  // namespace cchip::campaign
