// SPDX-License-Identifier: Apache-2.0
// What a hierarchy is worth to the chip: node pairs a query in trees that are built in three ways, and in trees that
// are refitted as their object deforms. The functional model traverses their images.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/program/seed.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "mesh_pairs.hpp"

namespace cchip::testing {
namespace {

struct Settings {
  std::vector<std::string> meshes = {"body-body", "limbs-limbs", "gear-ring", "quads-limbs"};
  std::size_t poses = 60;
  std::uint64_t seed = sim::seed_from_environment();
};

struct Box {
  Vec3d least = Vec3d::Constant(std::numeric_limits<double>::infinity());
  Vec3d greatest = Vec3d::Constant(-std::numeric_limits<double>::infinity());
  void add(const Vec3d& v) {
    least = least.cwiseMin(v);
    greatest = greatest.cwiseMax(v);
  }
  void add(const Box& box) {
    add(box.least);
    add(box.greatest);
  }
  double area() const {
    const Vec3d e = greatest - least;
    return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
  }
};

/// A binary tree from below. A leaf has one or two faces and no children.
struct Cluster {
  Box box;
  std::vector<std::uint32_t> faces;
  std::size_t left = 0, right = 0;  ///< places in the list of clusters; 0, 0: leaf
};

/// 10 bits of each coordinate, interleaved: the order of the curve along which a sorter would lay the faces.
std::uint32_t morton(const Vec3d& v, const Box& all) {
  std::uint32_t code = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double size = std::max(all.greatest[axis] - all.least[axis], 1e-300);
    const auto at = static_cast<std::uint32_t>(std::clamp((v[axis] - all.least[axis]) / size, 0.0, 0.999999) * 1024);
    for (unsigned bit = 0; bit < 10; ++bit) code |= (at >> bit & 1U) << (3 * bit + static_cast<unsigned>(axis));
  }
  return code;
}

/// Faces along the curve, each with its code.
struct Curve {
  std::vector<std::uint32_t> face, code;
  std::vector<Box> box;  ///< by face
};

Curve curve_of(const Mesh& mesh) {
  Curve curve;
  Box all;
  std::vector<Vec3d> centre;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Primitive p = mesh.primitive(f);
    Box box;
    for (std::size_t v = 0; v < p.vertex_count(); ++v) box.add(p.v[v]);
    curve.box.push_back(box);
    centre.emplace_back(0.5 * (box.least + box.greatest));
    all.add(box);
  }
  std::vector<std::uint32_t> code_of;
  for (const Vec3d& v : centre) code_of.push_back(morton(v, all));
  curve.face.resize(mesh.faces.size());
  std::iota(curve.face.begin(), curve.face.end(), 0U);
  std::stable_sort(curve.face.begin(), curve.face.end(),
                   [&](std::uint32_t i, std::uint32_t k) { return code_of[i] < code_of[k]; });
  for (const std::uint32_t f : curve.face) curve.code.push_back(code_of[f]);
  return curve;
}

bool may_share_leaf(const Mesh& mesh, std::uint32_t f, std::uint32_t g) {
  return mesh.faces[f].kind == Kind::tri && mesh.faces[g].kind == Kind::tri;
}

/// LBVH: a range of the curve is cut where the highest bit of the codes changes, in the middle if none does. Karras,
/// "Maximizing parallelism in the construction of BVHs, octrees, and k-d trees", 2012, has the rule.
std::size_t cut_ranges(const Mesh& mesh, const Curve& curve, std::size_t first, std::size_t last,
                       std::vector<Cluster>& clusters) {
  const std::size_t place = clusters.size();
  clusters.emplace_back();
  if (first == last || (first + 1 == last && may_share_leaf(mesh, curve.face[first], curve.face[last]))) {
    for (std::size_t i = first; i <= last; ++i) {
      clusters[place].faces.push_back(curve.face[i]);
      clusters[place].box.add(curve.box[curve.face[i]]);
    }
    return place;
  }
  std::size_t cut = (first + last) / 2;
  const std::uint32_t differ = curve.code[first] ^ curve.code[last];
  if (differ != 0) {
    std::uint32_t bit = std::uint32_t{1} << 31U;
    while ((differ & bit) == 0) bit >>= 1U;
    const auto begin = curve.code.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = curve.code.begin() + static_cast<std::ptrdiff_t>(last) + 1;
    const auto one = std::partition_point(begin, end, [bit](std::uint32_t code) { return (code & bit) == 0; });
    cut = static_cast<std::size_t>(one - curve.code.begin()) - 1;
  }
  const std::size_t left = cut_ranges(mesh, curve, first, cut, clusters);
  const std::size_t right = cut_ranges(mesh, curve, cut + 1, last, clusters);
  clusters[place].left = left;
  clusters[place].right = right;
  clusters[place].box.add(clusters[left].box);
  clusters[place].box.add(clusters[right].box);
  return place;
}

/// PLOC: clusters along the curve look for the partner within `radius` places whose common box is smallest; those that
/// choose each other become one, until one is left. Meister and Bittner, "Parallel locally-ordered clustering for
/// bounding volume hierarchy construction", 2018.
std::size_t merge_neighbours(const Mesh& mesh, const Curve& curve, std::size_t radius, std::vector<Cluster>& clusters) {
  std::vector<std::size_t> alive;
  for (const std::uint32_t f : curve.face) {
    alive.push_back(clusters.size());
    Cluster& leaf = clusters.emplace_back();
    leaf.faces = {f};
    leaf.box = curve.box[f];
  }
  while (alive.size() > 1) {
    std::vector<std::size_t> partner(alive.size());
    for (std::size_t i = 0; i < alive.size(); ++i) {
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t k = i > radius ? i - radius : 0; k < std::min(alive.size(), i + radius + 1); ++k) {
        if (k == i) continue;
        Box box = clusters[alive[i]].box;
        box.add(clusters[alive[k]].box);
        if (box.area() < best) {
          best = box.area();
          partner[i] = k;
        }
      }
    }
    std::vector<std::size_t> next;
    for (std::size_t i = 0; i < alive.size(); ++i) {
      const std::size_t k = partner[i];
      if (partner[k] != i) {
        next.push_back(alive[i]);
        continue;
      }
      if (k < i) continue;  // was merged at its partner's place
      const std::size_t p = alive[i];
      const std::size_t q = alive[k];
      next.push_back(clusters.size());
      Cluster both;
      both.box = clusters[p].box;
      both.box.add(clusters[q].box);
      const bool leaf = clusters[p].faces.size() == 1 && clusters[q].faces.size() == 1 &&
                        may_share_leaf(mesh, clusters[p].faces[0], clusters[q].faces[0]);
      if (leaf) {
        both.faces = {clusters[p].faces[0], clusters[q].faces[0]};
      } else {
        both.left = p;
        both.right = q;
      }
      clusters.push_back(std::move(both));
    }
    if (next.size() == alive.size()) throw std::logic_error("no two clusters chose each other");
    alive = std::move(next);
  }
  return alive.front();
}

/// The binary tree with up to four children each, as an image wants it.
class Collapse {
 public:
  Collapse(const Mesh& mesh, const std::vector<Cluster>& clusters, std::size_t root)
      : mesh_(mesh), clusters_(clusters) {
    tree.nodes.emplace_back();
    place(0, root, 1);
    bvh::refit(tree, mesh);
  }
  bvh::Tree tree;

 private:
  bool is_leaf(std::size_t cluster) const { return clusters_[cluster].left == clusters_[cluster].right; }
  void place(std::size_t node, std::size_t cluster, int level) {
    std::vector<std::size_t> children = {cluster};
    while (children.size() < 4) {
      auto widest = children.end();
      double size = -1;
      for (auto i = children.begin(); i != children.end(); ++i) {
        const Box& box = clusters_[*i].box;
        const double diagonal = (box.greatest - box.least).squaredNorm();
        if (!is_leaf(*i) && diagonal > size) {
          size = diagonal;
          widest = i;
        }
      }
      if (widest == children.end()) break;
      const std::size_t opened = *widest;
      *widest = clusters_[opened].left;
      children.insert(widest + 1, clusters_[opened].right);
    }
    const std::size_t first = tree.nodes.size();
    tree.nodes[node].kind = bvh::NodeKind::inner;
    tree.nodes[node].count = static_cast<std::uint8_t>(children.size());
    tree.nodes[node].first = static_cast<std::uint32_t>(first);
    tree.nodes.resize(first + children.size());
    tree.depth = std::max(tree.depth, level + 1);
    if (tree.depth > bvh::tree_depth_max) throw std::runtime_error("the tree is deeper than the chip's stack allows");
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (!is_leaf(children[i])) {
        place(first + i, children[i], level + 1);
        continue;
      }
      const std::vector<std::uint32_t>& faces = clusters_[children[i]].faces;
      bvh::TreeNode& leaf = tree.nodes[first + i];
      leaf.kind = faces.size() == 2                          ? bvh::NodeKind::two_triangles
                  : mesh_.faces[faces[0]].kind == Kind::quad ? bvh::NodeKind::quad
                                                             : bvh::NodeKind::triangle;
      leaf.count = static_cast<std::uint8_t>(faces.size());
      leaf.first = static_cast<std::uint32_t>(tree.faces.size());
      tree.faces.insert(tree.faces.end(), faces.begin(), faces.end());
    }
  }

  const Mesh& mesh_;
  const std::vector<Cluster>& clusters_;
};

bvh::Tree lbvh(const Mesh& mesh) {
  const Curve curve = curve_of(mesh);
  std::vector<Cluster> clusters;
  const std::size_t root = cut_ranges(mesh, curve, 0, curve.face.size() - 1, clusters);
  return Collapse(mesh, clusters, root).tree;
}

bvh::Tree ploc(const Mesh& mesh, std::size_t radius) {
  std::vector<Cluster> clusters;
  const Curve curve = curve_of(mesh);
  const std::size_t root = merge_neighbours(mesh, curve, radius, clusters);
  return Collapse(mesh, clusters, root).tree;
}

/// Steps of a query, by class of pose.
struct Steps {
  double touch = 0, near = 0, deep = 0;
};

class Study {
 public:
  explicit Study(const Settings& settings) : settings_(settings), device_(open_cpu_device({1, ""})) {}

  int run() {
    fmt::print("seed={} poses={} of each class\n", settings_.seed, settings_.poses);
    ways();
    deformed();
    fmt::print("queries={} answers_differ={}\n", queries_, differ_);
    return differ_ == 0 ? 0 : 1;
  }

 private:
  using Way = std::function<bvh::Tree(const Mesh&)>;

  /// Images of both meshes by the same way, in the same poses as for every other way.
  Steps steps(const Mesh& a, const bvh::Tree& tree_a, const Mesh& b, const bvh::Tree& tree_b) {
    const Object object_a(a);
    const Object object_b(b);
    PoseMaker maker(*device_, object_a, object_b, settings_.seed);
    const bvh::Image image_a = bvh::make_image(a, tree_a);
    const bvh::Image image_b = bvh::make_image(b, tree_b);
    Steps mean;
    for (std::size_t i = 0; i < settings_.poses; ++i) {
      const Approach approach = maker.approach();
      for (const auto& [pose_class, sum] : {std::pair{PoseClass::touch, &Steps::touch},
                                            {PoseClass::near, &Steps::near},
                                            {PoseClass::deep, &Steps::deep}}) {
        const PosePair poses = maker.pose(approach, pose_class);
        std::optional<Query> query = bvh::make_query(image_a.header(), poses.a, image_b.header(), poses.b);
        if (!query) throw std::runtime_error("a pose that the chip does not take");
        const model::BroadPhaseResult result = model::run_query(*query, image_a, image_b);
        mean.*sum += static_cast<double>(result.counts.steps) / static_cast<double>(settings_.poses);
        ++queries_;
        // An open answer is the host's to decide; a definite one is the CPU device's.
        const bool hit = collide(*device_, object_a, poses.a, object_b, poses.b).hit;
        const bool no = result.done.answer == QueryAnswer::no;
        const bool yes = result.done.answer == QueryAnswer::yes;
        if ((no && hit) || (yes && !hit)) ++differ_;
      }
    }
    return mean;
  }

  void ways() {
    const std::vector<std::pair<const char*, Way>> all = {
        {"SAH", [](const Mesh& mesh) { return bvh::build_tree(mesh); }},
        {"LBVH", lbvh},
        {"PLOC, radius 8", [](const Mesh& mesh) { return ploc(mesh, 8); }},
        {"PLOC, radius 16", [](const Mesh& mesh) { return ploc(mesh, 16); }}};
    fmt::print(
        "\nnode pairs a query, by how both trees are built; nodes and depth of the tree of "
        "A\n{:<14}{:<18}{:>9}{:>7}{:>9}{:>9}{:>9}\n",
        "meshes", "tree", "nodes", "depth", "touch", "near", "deep");
    for (const std::string& name : settings_.meshes) {
      const MeshPair meshes = mesh_pair(name);
      for (const auto& [way, make] : all) {
        const bvh::Tree a = make(meshes.a);
        const Steps s = steps(meshes.a, a, meshes.b, make(meshes.b));
        fmt::print("{:<14}{:<18}{:>9}{:>7}{:>9.1f}{:>9.1f}{:>9.1f}\n", name, way, a.nodes.size(), a.depth, s.touch,
                   s.near, s.deep);
        std::fflush(stdout);
      }
    }
  }

  /// Turned about its longest axis, the further along it the more.
  static Mesh twisted(Mesh mesh, double degrees) {
    Box all;
    for (const Vec3d& v : mesh.vertices) all.add(v);
    Eigen::Index axis = 0;
    (all.greatest - all.least).maxCoeff(&axis);
    const Eigen::Index u = (axis + 1) % 3;
    const Eigen::Index w = (axis + 2) % 3;
    const Vec3d centre = 0.5 * (all.least + all.greatest);
    for (Vec3d& v : mesh.vertices) {
      const double along = (v[axis] - all.least[axis]) / (all.greatest[axis] - all.least[axis]);
      const double angle = degrees * along * 3.14159265358979 / 180;
      const double x = v[u] - centre[u];
      const double y = v[w] - centre[w];
      v[u] = centre[u] + std::cos(angle) * x - std::sin(angle) * y;
      v[w] = centre[w] + std::sin(angle) * x + std::cos(angle) * y;
    }
    return mesh;
  }
  /// Rolled up around an axis across the longest one: a straight object becomes an arc of so many degrees.
  static Mesh bent(Mesh mesh, double degrees) {
    if (degrees == 0) return mesh;
    Box all;
    for (const Vec3d& v : mesh.vertices) all.add(v);
    Eigen::Index axis = 0;
    (all.greatest - all.least).maxCoeff(&axis);
    const Eigen::Index u = (axis + 1) % 3;
    const double arc = degrees * 3.14159265358979 / 180;
    const double radius = (all.greatest[axis] - all.least[axis]) / arc;
    const double middle = 0.5 * (all.least[axis] + all.greatest[axis]);
    for (Vec3d& v : mesh.vertices) {
      const double angle = (v[axis] - middle) / radius;
      const double out = radius + v[u];
      v[axis] = out * std::sin(angle);
      v[u] = out * std::cos(angle) - radius;
    }
    return mesh;
  }

  void deformed() {
    fmt::print(
        "\nnode pairs a query when both objects deform: trees refitted, and built "
        "anew\n{:<14}{:<16}{:>18}{:>18}{:>18}{:>9}\n",
        "meshes", "deformation", "touch", "near", "deep", "ratio");
    for (const std::string& name : settings_.meshes) {
      const MeshPair meshes = mesh_pair(name);
      const bvh::Tree rest_a = bvh::build_tree(meshes.a);
      const bvh::Tree rest_b = bvh::build_tree(meshes.b);
      for (const bool twist : {true, false}) {
        for (const double degrees : {15.0, 45.0, 90.0, 180.0, 360.0}) {
          const Mesh a = twist ? twisted(meshes.a, degrees) : bent(meshes.a, degrees);
          const Mesh b = twist ? twisted(meshes.b, degrees) : bent(meshes.b, degrees);
          bvh::Tree refit_a = rest_a;
          bvh::Tree refit_b = rest_b;
          bvh::refit(refit_a, a);
          bvh::refit(refit_b, b);
          const Steps kept = steps(a, refit_a, b, refit_b);
          const Steps anew = steps(a, bvh::build_tree(a), b, bvh::build_tree(b));
          const double ratio = std::cbrt(kept.touch / anew.touch * kept.near / anew.near * kept.deep / anew.deep);
          const auto both = [](double x, double y) { return fmt::format("{:.1f}, {:.1f}", x, y); };
          fmt::print("{:<14}{:<16}{:>18}{:>18}{:>18}{:>9.2f}\n", name,
                     fmt::format("{} {:.0f}", twist ? "twist" : "bend", degrees), both(kept.touch, anew.touch),
                     both(kept.near, anew.near), both(kept.deep, anew.deep), ratio);
          std::fflush(stdout);
        }
      }
    }
  }

  Settings settings_;
  std::unique_ptr<Device> device_;
  std::size_t queries_ = 0;
  std::size_t differ_ = 0;
};

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  cchip::testing::Settings s;
  CLI::App app{
      "Node pairs a query of the chip in trees that are built in three ways, and in trees that are refitted as their "
      "objects deform.\n"
      "Exit codes: 0 done, 1 an answer differs from the CPU device's, 2 the run could not be made."};
  app.add_option("--meshes", s.meshes, "pairs of meshes")
      ->delimiter(',')
      ->check(CLI::IsMember(cchip::testing::mesh_pair_names()))
      ->capture_default_str();
  app.add_option("--poses", s.poses, "poses of each class")->check(CLI::Range(1, 100000))->capture_default_str();
  app.add_option("--seed", s.seed, "repeats the poses (or CCHIP_SEED)")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return cchip::testing::Study(s).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "cchip_trees: %s\n", error.what());
  return 2;
}
