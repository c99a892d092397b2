// SPDX-License-Identifier: Apache-2.0
// Curved surfaces without triangles: bicubic Bezier patches in the chip's kind of tree, cut in half until two pieces
// are apart or as small as a tolerance; beside triangles that approximate them with a proven error
// (docs/hardware/nurbs.md).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cchip/distance.hpp>
#include <cchip/internal/tree/dop26.hpp>
#include <cchip/program/seed.hpp>
#include <cmath>
#include <ctime>
#include <memory>
#include <vector>

#include "mesh_pairs.hpp"

namespace cchip::testing {
namespace {

struct Settings {
  std::size_t poses = 100;
  std::uint64_t seed = sim::seed_from_environment();
  std::vector<double> tolerances = {0.01, 0.003, 0.001, 0.0003};
};

/// Row i, column k is control point b_ik of the patch sum_ik B_i(u) B_k(v) b_ik with the cubic Bernstein polynomials.
/// The patch lies in the hull of the sixteen. Of a rational patch with positive weights they are the projected ones,
/// and halving is the same on four coordinates.
using Patch = std::array<std::array<Vec3d, 4>, 4>;

/// De Casteljau at 1/2: exact but for rounding of sums, as all factors are powers of two.
void halve(const std::array<Vec3d, 4>& p, std::array<Vec3d, 4>& low, std::array<Vec3d, 4>& high) {
  const Vec3d a = 0.5 * (p[0] + p[1]);
  const Vec3d b = 0.5 * (p[1] + p[2]);
  const Vec3d c = 0.5 * (p[2] + p[3]);
  const Vec3d ab = 0.5 * (a + b);
  const Vec3d bc = 0.5 * (b + c);
  const Vec3d middle = 0.5 * (ab + bc);
  low = {p[0], a, ab, middle};
  high = {middle, bc, c, p[3]};
}

std::array<Patch, 2> halve(const Patch& patch, bool across) {
  std::array<Patch, 2> halves;
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<Vec3d, 4> line;
    std::array<Vec3d, 4> low;
    std::array<Vec3d, 4> high;
    for (std::size_t k = 0; k < 4; ++k) line[k] = across ? patch[k][i] : patch[i][k];
    halve(line, low, high);
    for (std::size_t k = 0; k < 4; ++k) {
      (across ? halves[0][k][i] : halves[0][i][k]) = low[k];
      (across ? halves[1][k][i] : halves[1][i][k]) = high[k];
    }
  }
  return halves;
}

/// Length of the longest control polygon in each direction.
std::array<double, 2> lengths(const Patch& patch) {
  std::array<double, 2> most = {0, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 2> sum = {0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      sum[0] += (patch[k + 1][i] - patch[k][i]).norm();
      sum[1] += (patch[i][k + 1] - patch[i][k]).norm();
    }
    for (std::size_t d = 0; d < 2; ++d) most[d] = std::max(most[d], sum[d]);
  }
  return most;
}

/// A closed surface of `rows` x `columns` patches, those of a periodic uniform bicubic B-spline whose control points
/// lie near a torus.
std::vector<Patch> spline_torus(std::size_t rows, std::size_t columns, double noise, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-noise, noise);
  std::vector<Vec3d> net;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < columns; ++k) {
      const double u = 2 * 3.14159265358979 * static_cast<double>(i) / static_cast<double>(rows);
      const double v = 2 * 3.14159265358979 * static_cast<double>(k) / static_cast<double>(columns);
      const double r = 0.35 + 0.15 * std::cos(v) * (1 + unit(random));
      net.emplace_back(r * std::cos(u), r * std::sin(u), 0.15 * std::sin(v) * (1 + unit(random)));
    }
  }
  const auto at = [&](std::size_t i, std::size_t k) { return net[(i % rows) * columns + k % columns]; };
  // Bezier points of one span of a uniform cubic B-spline.
  const auto span = [](const std::array<Vec3d, 4>& d) {
    const Vec3d one = (2 * d[1] + d[2]) / 3;
    const Vec3d two = (d[1] + 2 * d[2]) / 3;
    return std::array<Vec3d, 4>{0.5 * ((d[0] + 2 * d[1]) / 3 + one), one, two, 0.5 * (two + (2 * d[2] + d[3]) / 3)};
  };
  std::vector<Patch> patches;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < columns; ++k) {
      Patch half;
      for (std::size_t r = 0; r < 4; ++r)
        half[r] = span({at(i + r, k), at(i + r, k + 1), at(i + r, k + 2), at(i + r, k + 3)});
      Patch patch;
      for (std::size_t c = 0; c < 4; ++c) {
        const std::array<Vec3d, 4> line = span({half[0][c], half[1][c], half[2][c], half[3][c]});
        for (std::size_t r = 0; r < 4; ++r) patch[r][c] = line[r];
      }
      patches.push_back(patch);
    }
  }
  return patches;
}

/// The pieces of a surface that queries have asked for so far: a binary tree over the patches, and below each of them
/// its halves.
class Surface {
 public:
  struct Node {
    std::vector<Vec3d> hull;  ///< control points of a piece, eight corners of a box above the patches
    double size = 0;          ///< diagonal of the box
    Patch patch;
    bool is_piece = false;
    std::size_t left = 0;  ///< the right child is the next one; 0: not made yet
  };

  explicit Surface(std::vector<Patch> patches) : patches_(std::move(patches)) {
    nodes_.emplace_back();
    std::vector<std::size_t> all(patches_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    build(0, all);
  }
  const std::vector<Patch>& patches() const { return patches_; }
  const Node& node(std::size_t number) const { return nodes_[number]; }
  std::size_t nodes() const { return nodes_.size(); }
  /// Number of the left child.
  std::size_t open(std::size_t number) {
    if (nodes_[number].left != 0) return nodes_[number].left;
    const std::array<double, 2> length = lengths(nodes_[number].patch);
    const std::array<Patch, 2> halves = halve(nodes_[number].patch, length[0] > length[1]);
    const std::size_t left = nodes_.size();
    for (const Patch& half : halves) set_piece(nodes_.emplace_back(), half);
    nodes_[number].left = left;
    return left;
  }

 private:
  static void measure(Node& node) {
    Vec3d least = node.hull.front();
    Vec3d greatest = least;
    for (const Vec3d& v : node.hull) {
      least = least.cwiseMin(v);
      greatest = greatest.cwiseMax(v);
    }
    node.size = (greatest - least).norm();
  }
  static void set_piece(Node& node, const Patch& patch) {
    node.patch = patch;
    node.is_piece = true;
    for (const auto& row : patch) node.hull.insert(node.hull.end(), row.begin(), row.end());
    measure(node);
  }
  void build(std::size_t number, std::vector<std::size_t> part) {
    if (part.size() == 1) return set_piece(nodes_[number], patches_[part[0]]);
    Vec3d least = patches_[part[0]][0][0];
    Vec3d greatest = least;
    for (const std::size_t i : part) {
      for (const auto& row : patches_[i]) {
        for (const Vec3d& v : row) {
          least = least.cwiseMin(v);
          greatest = greatest.cwiseMax(v);
        }
      }
    }
    for (unsigned corner = 0; corner < 8; ++corner) {
      nodes_[number].hull.emplace_back((corner & 1U) != 0 ? greatest.x() : least.x(),
                                       (corner & 2U) != 0 ? greatest.y() : least.y(),
                                       (corner & 4U) != 0 ? greatest.z() : least.z());
    }
    measure(nodes_[number]);
    Eigen::Index axis = 0;
    (greatest - least).maxCoeff(&axis);
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end(),
                     [&](std::size_t i, std::size_t k) { return patches_[i][1][1][axis] < patches_[k][1][1][axis]; });
    const std::size_t left = nodes_.size();
    nodes_[number].left = left;
    nodes_.emplace_back();
    nodes_.emplace_back();
    build(left, {part.begin(), middle});
    build(left + 1, {middle, part.end()});
  }

  std::vector<Patch> patches_;
  std::vector<Node> nodes_;
};

struct Answer {
  bool apart = true;  ///< proved; else two points of the surfaces lie within the tolerance, proved, too
  std::size_t pairs = 0;
  std::size_t stack = 0;
};

/// How far two 26-DOPs are apart, at least, along the best of their directions; negative: their overlap.
double gap(const bvh::Dop26& p, const bvh::Dop26& q) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t d = 0; d < bvh::directions.size(); ++d) {
    const double length = std::sqrt(static_cast<double>(bvh::directions[d][0] * bvh::directions[d][0] +
                                                        bvh::directions[d][1] * bvh::directions[d][1] +
                                                        bvh::directions[d][2] * bvh::directions[d][2]));
    most = std::max(most, std::max(p.least[d] - q.greatest[d], q.least[d] - p.greatest[d]) / length);
  }
  return most;
}

/// Of the box along the axes.
double diagonal(const bvh::Dop26& p) {
  return std::hypot(p.greatest[0] - p.least[0], p.greatest[1] - p.least[1], p.greatest[2] - p.least[2]);
}

/// Descends in both trees at once; the larger piece is cut.
Answer meet(Surface& a, const Pose& pose_a, Surface& b, const Pose& pose_b, double tolerance) {
  const auto volume = [](const Surface::Node& node, const Pose& pose) {
    bvh::Dop26 dop = bvh::make_dop26(Vec3d(pose * node.hull[0]));
    for (std::size_t i = 1; i < node.hull.size(); ++i) dop = enclose(dop, bvh::make_dop26(Vec3d(pose * node.hull[i])));
    return dop;
  };
  struct Pair {
    std::size_t a, b;
    bvh::Dop26 volume_a, volume_b;
  };
  std::vector<Pair> stack = {{0, 0, volume(a.node(0), pose_a), volume(b.node(0), pose_b)}};
  Answer answer;
  while (!stack.empty()) {
    answer.stack = std::max(answer.stack, stack.size());
    const Pair pair = stack.back();
    stack.pop_back();
    ++answer.pairs;
    if (gap(pair.volume_a, pair.volume_b) > 0x1p-40) continue;
    // Boxes along the axes of the world overlap if they do along the three, and each holds points of its surface.
    if (a.node(pair.a).is_piece && b.node(pair.b).is_piece &&
        diagonal(pair.volume_a) + diagonal(pair.volume_b) <= tolerance) {
      answer.apart = false;
      return answer;
    }
    const double size_a = a.node(pair.a).size;
    const double size_b = b.node(pair.b).size;
    const bool cut_a = size_a >= size_b;
    const std::size_t left = cut_a ? a.open(pair.a) : b.open(pair.b);
    for (const std::size_t child : {left, left + 1}) {
      if (cut_a) {
        stack.push_back({child, pair.b, volume(a.node(child), pose_a), pair.volume_b});
      } else {
        stack.push_back({pair.a, child, pair.volume_a, volume(b.node(child), pose_b)});
      }
    }
  }
  return answer;
}

Vec3d point(const Patch& p, double u, double v) {
  const auto bernstein = [](double t) {
    const double s = 1 - t;
    return std::array<double, 4>{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
  };
  Vec3d at = Vec3d::Zero();
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c < 4; ++c) at += bernstein(u)[r] * bernstein(v)[c] * p[r][c];
  }
  return at;
}

/// Triangles whose distance from the surface, either way, is at most `error`: a patch cut n x n times is off by at most
/// (D_uu + 2 D_uv + D_vv) / (8 n^2) (Filip, Magedson, Markot, "Surface algorithms using bounds on derivatives", 1986),
/// with bounds on its second derivatives from the second differences of the control points.
Mesh triangles(const std::vector<Patch>& patches, double error) {
  Mesh mesh;
  for (const Patch& p : patches) {
    double uu = 0;
    double uv = 0;
    double vv = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        uu = std::max(uu, 6 * (p[k][i] - 2 * p[k + 1][i] + p[k + 2][i]).norm());
        vv = std::max(vv, 6 * (p[i][k] - 2 * p[i][k + 1] + p[i][k + 2]).norm());
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        uv = std::max(uv, 9 * (p[i + 1][k + 1] - p[i + 1][k] - p[i][k + 1] + p[i][k]).norm());
      }
    }
    const auto n = static_cast<std::uint32_t>(std::ceil(std::sqrt((uu + 2 * uv + vv) / (8 * error))));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t i = 0; i <= n; ++i) {
      for (std::uint32_t k = 0; k <= n; ++k) {
        mesh.vertices.push_back(point(p, static_cast<double>(i) / n, static_cast<double>(k) / n));
      }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t k = 0; k < n; ++k) {
        const std::uint32_t corner = first + i * (n + 1) + k;
        mesh.faces.push_back({Kind::tri, {corner, corner + 1, corner + n + 1, 0}});
        mesh.faces.push_back({Kind::tri, {corner + 1, corner + n + 2, corner + n + 1, 0}});
      }
    }
  }
  return mesh;
}

/// Points of a patch, from its definition, that lie outside a piece which should hold them: what "apart" rests on.
std::size_t points_outside(const Patch& patch, std::mt19937_64& random) {
  Surface surface({patch});
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t outside = 0;
  for (int sample = 0; sample < 50; ++sample) {
    double u = unit(random);
    double v = unit(random);
    const Vec3d at = point(patch, u, v);
    std::size_t node = 0;
    for (int level = 0; level < 12; ++level) {
      bvh::Dop26 dop = bvh::make_dop26(surface.node(node).hull[0]);
      for (const Vec3d& control : surface.node(node).hull) dop = enclose(dop, bvh::make_dop26(control));
      outside += gap(dop, bvh::make_dop26(at)) > 1e-14 ? 1 : 0;
      const std::array<double, 2> length = lengths(surface.node(node).patch);
      double& t = length[0] > length[1] ? u : v;
      const std::size_t left = surface.open(node);
      node = t < 0.5 ? left : left + 1;
      t = t < 0.5 ? 2 * t : 2 * t - 1;
    }
  }
  return outside;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

int run(const Settings& settings) {
  std::mt19937_64 random(settings.seed);
  const std::vector<Patch> net_a = spline_torus(12, 8, 0.2, random);
  const std::vector<Patch> net_b = spline_torus(10, 8, 0.2, random);
  const auto device = open_cpu_device({1, ""});
  fmt::print("seed={} poses={} of each class, {} and {} patches\n", settings.seed, settings.poses, net_a.size(),
             net_b.size());
  fmt::print("{:<10}{:<7}{:>7}{:>14}{:>9}{:>10}{:>12}{:>12}{:>11}{:>11}{:>8}\n", "tolerance", "class", "apart",
             "patch pairs", "stack", "pieces", "triangles", "steps", "patches us", "meshes us", "times");
  std::size_t queries = 0;
  std::size_t wrong = 0;
  for (const Patch& patch : net_a) wrong += points_outside(patch, random);
  for (const double tolerance : settings.tolerances) {
    Surface a(net_a);
    Surface b(net_b);
    // Triangles off by a fourth of the tolerance, and those within a half of it: the same promise.
    const double error = tolerance / 4;
    const Object mesh_a(triangles(net_a, error));
    const Object mesh_b(triangles(net_b, error));
    PoseMaker maker(*device, mesh_a, mesh_b, settings.seed);
    std::vector<Approach> approaches;
    for (std::size_t i = 0; i < settings.poses; ++i) approaches.push_back(maker.approach());
    for (const PoseClass c : {PoseClass::touch, PoseClass::near, PoseClass::deep}) {
      std::size_t apart = 0;
      std::size_t pairs = 0;
      std::size_t stack = 0;
      std::uint64_t steps = 0;
      double patch_time = 0;
      double mesh_time = 0;
      for (const Approach& approach : approaches) {
        const PosePair poses = maker.pose(approach, c);
        double start = cpu_seconds();
        const Answer answer = meet(a, poses.a, b, poses.b, tolerance);
        patch_time += cpu_seconds() - start;
        start = cpu_seconds();
        const CollisionResult result = within(*device, mesh_a, poses.a, mesh_b, poses.b, 2 * error);
        mesh_time += cpu_seconds() - start;
        ++queries;
        apart += answer.apart ? 1 : 0;
        pairs += answer.pairs;
        stack = std::max(stack, answer.stack);
        steps += result.stats.steps;
        // The meshes' distance differs from the surfaces' by at most twice the error.
        const DistanceResult d = distance(mesh_a, poses.a, mesh_b, poses.b, {0.001});
        if (!answer.apart && d.lower > tolerance + 2 * error + 1e-9) ++wrong;
      }
      const double n = static_cast<double>(settings.poses);
      fmt::print("{:<10}{:<7}{:>7}{:>14.0f}{:>9}{:>10}{:>12}{:>12.1f}{:>11.1f}{:>11.1f}{:>8.0f}\n", tolerance,
                 name_of(c), apart, static_cast<double>(pairs) / n, stack, a.nodes() + b.nodes(),
                 mesh_a.mesh().faces.size() + mesh_b.mesh().faces.size(), static_cast<double>(steps) / n,
                 1e6 * patch_time / n, 1e6 * mesh_time / n, patch_time / mesh_time);
      std::fflush(stdout);
    }
  }
  fmt::print("queries={} wrong={}\n", queries, wrong);
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  cchip::testing::Settings s;
  CLI::App app{
      "Bicubic Bezier patches, halved until two pieces are apart or within a tolerance, beside triangles with a proven "
      "error.\n"
      "Exit codes: 0 done, 1 an answer contradicts the distance of the triangles, 2 the run could not be made."};
  app.add_option("--poses", s.poses, "poses of each class")->check(CLI::Range(1, 100000))->capture_default_str();
  app.add_option("--tolerances", s.tolerances, "by the size of the surfaces, which is about 1")
      ->delimiter(',')
      ->check(CLI::Range(1e-5, 0.1))
      ->capture_default_str();
  app.add_option("--seed", s.seed, "repeats the poses (or CCHIP_SEED)")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return cchip::testing::run(s);
} catch (const std::exception& error) {
  std::fprintf(stderr, "cchip_bezier: %s\n", error.what());
  return 2;
}
