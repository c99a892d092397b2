// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/tree/tree.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace cchip::bvh {
namespace {

constexpr int bins = 24;
static_assert(bins <= 32);        // a bit each
constexpr std::size_t width = 4;  // children of a node

struct Box {
  /// The least coordinates, then the greatest ones negated: Eigen vectorises an even number of them.
  Eigen::Array<double, 6, 1> bound = decltype(bound)::Constant(std::numeric_limits<double>::infinity());
  Box() = default;
  explicit Box(const Vec3d& v) { bound << v.array(), -v.array(); }
  void add(const Box& box) { bound = bound.min(box.bound); }
  Vec3d extent() const { return {-bound[3] - bound[0], -bound[4] - bound[1], -bound[5] - bound[2]}; }
  /// Half the surface; 0 for an empty box.
  double area() const {
    if (!(bound[0] <= -bound[3])) return 0;
    const Vec3d e = extent();
    return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
  }
};

/// A face that is being sorted.
struct Item {
  Box box;
  Vec3d centre;
  std::uint32_t face = 0;
  Kind kind = Kind::tri;
};

struct BinaryNode {
  Box box;
  std::size_t first = 0;  // items first..first + count - 1
  std::size_t count = 0;
  std::size_t left = 0;  // number of the left child, the right one is the next; 0: leaf
};

int ceil_log2(std::size_t n) {
  int bits = 0;
  while ((std::size_t{1} << bits) < n) ++bits;
  return bits;
}

Item make_item(const Mesh& mesh, std::size_t face) {
  const Primitive p = mesh.primitive(face);
  Item item;
  item.face = static_cast<std::uint32_t>(face);
  item.kind = p.kind;
  item.centre = Vec3d::Zero();
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    item.box.add(Box(p.v[i]));
    item.centre += p.v[i] / static_cast<double>(p.vertex_count());
  }
  return item;
}

/// A plane between bins: items whose bin on `axis` is at most `bin` go left.
struct Split {
  int axis = -1;
  int bin = 0;
  double least = 0;
  double scale = 0;
  Box left;  ///< of the items on each side
  Box right;
  int bin_of(const Vec3d& centre) const { return std::min(bins - 1, static_cast<int>((centre[axis] - least) * scale)); }
};

class Builder {
 public:
  Builder(const Mesh& mesh, const TreeOptions& options) : options_(options) {
    items_.reserve(mesh.faces.size());
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) items_.push_back(make_item(mesh, i));
    nodes_.push_back(node_over(0, items_.size()));
    divide(0, 1);
  }

  Tree collapse() {
    Tree tree;
    tree.faces.reserve(items_.size());
    for (const Item& item : items_) tree.faces.push_back(item.face);
    tree.nodes.reserve(nodes_.size());
    tree.nodes.emplace_back();
    tree.depth = 1;
    place(tree, 0, 0, 1);
    return tree;
  }

 private:
  BinaryNode node_over(std::size_t first, std::size_t count) const {
    BinaryNode node;
    node.first = first;
    node.count = count;
    for (std::size_t i = first; i < first + count; ++i) node.box.add(items_[i].box);
    return node;
  }

  bool is_leaf(const BinaryNode& node) const {
    if (node.count == 1) return true;
    const Item& p = items_[node.first];
    const Item& q = items_[node.first + 1];
    if (node.count > 2 || p.kind != Kind::tri || q.kind != Kind::tri) return false;
    // Cost of one leaf: both triangles are tested where the node is met. Cost of two leaves: the node is visited, and
    // each triangle is tested where its own box is met. The chance to meet a box grows with its surface.
    const double area = node.box.area();
    return options_.visit_cost > 0 && 2 * area <= options_.visit_cost * area + p.box.area() + q.box.area();
  }

  void divide(std::size_t number, int level) {
    const BinaryNode node = nodes_[number];
    if (is_leaf(node)) return;
    const std::size_t left = nodes_.size();
    nodes_[number].left = left;
    nodes_.resize(left + 2);
    split(node, level, &nodes_[left]);
    divide(left, level + 1);
    divide(left + 1, level + 1);
  }

  /// Reorders the items of the node and makes its two children. Both can be halved down to single items within the
  /// levels that are left.
  void split(const BinaryNode& node, int level, BinaryNode* children) {
    const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(node.first);
    const auto end = begin + static_cast<std::ptrdiff_t>(node.count);
    Box centres;
    for (auto i = begin; i != end; ++i) centres.add(Box(i->centre));
    const Split best = node.count == 2 ? split_of_two(node, centres) : best_split(node, centres);
    if (best.axis >= 0) {
      const auto middle =
          std::partition(begin, end, [&](const Item& item) { return best.bin_of(item.centre) <= best.bin; });
      const auto left = static_cast<std::size_t>(middle - begin);
      const int levels = 1 + ceil_log2(std::max(left, node.count - left));
      if (left > 0 && left < node.count && level + levels <= tree_depth_max) {
        children[0] = {best.left, node.first, left, 0};
        children[1] = {best.right, node.first + left, node.count - left, 0};
        return;
      }
    }
    Eigen::Index axis = 0;
    centres.extent().maxCoeff(&axis);
    std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(node.count / 2), end,
                     [axis](const Item& p, const Item& q) {
                       return p.centre[axis] != q.centre[axis] ? p.centre[axis] < q.centre[axis] : p.face < q.face;
                     });
    children[0] = node_over(node.first, node.count / 2);
    children[1] = node_over(node.first + node.count / 2, node.count - node.count / 2);
  }

  /// Into bins, or none if the centres are too close together or too far apart along the axis.
  static bool bins_along(int axis, const Box& centres, Split& split) {
    split.axis = axis;
    split.least = centres.bound[axis];
    split.scale = bins / centres.extent()[axis];
    return split.scale > 0 && split.scale < std::numeric_limits<double>::infinity();
  }

  /// All splits of two items cost the same: the first one that parts them.
  Split split_of_two(const BinaryNode& node, const Box& centres) const {
    Split split;
    for (int axis = 0; axis < 3; ++axis) {
      if (!bins_along(axis, centres, split)) continue;
      const Item& first = items_[node.first];
      const Item& second = items_[node.first + 1];
      const bool first_is_left = split.bin_of(first.centre) == 0;
      split.left = (first_is_left ? first : second).box;
      split.right = (first_is_left ? second : first).box;
      if (split.left.area() + split.right.area() < std::numeric_limits<double>::infinity()) return split;
      break;
    }
    return {};
  }

  struct Bin {
    Box box;
    std::size_t count = 0;
    void add(const Bin& other) {
      box.add(other.box);
      count += other.count;
    }
    double cost() const { return box.area() * static_cast<double>(count); }
  };

  Split best_split(const BinaryNode& node, const Box& centres) {
    Split best;
    double best_cost = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      Split split;
      if (!bins_along(axis, centres, split)) continue;
      std::uint32_t is_filled = 0;  // most bins of a small node are empty
      for (std::size_t i = node.first; i < node.first + node.count; ++i) {
        const int number = split.bin_of(items_[i].centre);
        Bin& bin = bins_[static_cast<std::size_t>(number)];
        if ((is_filled >> number & 1U) == 0) {
          bin = {items_[i].box, 1};
          is_filled |= 1U << number;
        } else {
          bin.box.add(items_[i].box);
          ++bin.count;
        }
      }
      std::array<int, bins> filled;
      std::size_t count = 0;
      for (int number = 0; number < bins; ++number) {
        if ((is_filled >> number & 1U) != 0) filled[count++] = number;
      }
      const auto bin = [&](std::size_t k) -> const Bin& { return bins_[static_cast<std::size_t>(filled[k])]; };
      Bin right;
      for (std::size_t k = count - 1; k > 0; --k) {
        right.add(bin(k));
        right_[k - 1] = right;
      }
      Bin left;
      for (std::size_t k = 0; k + 1 < count; ++k) {
        left.add(bin(k));
        const double cost = left.cost() + right_[k].cost();
        if (!(cost < best_cost)) continue;
        best_cost = cost;
        best = split;
        best.bin = filled[k];
        best.left = left.box;
        best.right = right_[k].box;
      }
    }
    return best;
  }

  /// Up to four nodes of the binary tree that together are below `number`, in its order.
  std::vector<std::size_t> open(std::size_t number) const {
    if (nodes_[number].left == 0) return {number};
    std::vector<std::size_t> children = {nodes_[number].left, nodes_[number].left + 1};
    while (children.size() < width) {
      auto greatest = children.end();
      double size = -1;
      for (auto i = children.begin(); i != children.end(); ++i) {
        const BinaryNode& node = nodes_[*i];
        const double diagonal = node.box.extent().squaredNorm();
        if (node.left != 0 && diagonal > size) {
          size = diagonal;
          greatest = i;
        }
      }
      if (greatest == children.end()) break;
      const std::size_t left = nodes_[*greatest].left;
      *greatest = left;
      children.insert(greatest + 1, left + 1);
    }
    return children;
  }

  /// Makes node `place` of the tree the inner node over binary node `number`, and everything below.
  void place(Tree& tree, std::size_t place_of, std::size_t number, int level) {
    const std::vector<std::size_t> children = open(number);
    const std::size_t first = tree.nodes.size();
    tree.nodes[place_of].kind = NodeKind::inner;
    tree.nodes[place_of].count = static_cast<std::uint8_t>(children.size());
    tree.nodes[place_of].first = static_cast<std::uint32_t>(first);
    tree.nodes.resize(first + children.size());
    tree.depth = std::max(tree.depth, level + 1);
    for (std::size_t i = 0; i < children.size(); ++i) {
      const BinaryNode& child = nodes_[children[i]];
      if (child.left != 0) {
        place(tree, first + i, children[i], level + 1);
        continue;
      }
      TreeNode& leaf = tree.nodes[first + i];
      const bool quad = items_[child.first].kind == Kind::quad;
      leaf.kind = quad ? NodeKind::quad : child.count == 2 ? NodeKind::two_triangles : NodeKind::triangle;
      leaf.count = static_cast<std::uint8_t>(child.count);
      leaf.first = static_cast<std::uint32_t>(child.first);
    }
  }

  TreeOptions options_;
  std::vector<Item> items_;
  std::array<Bin, bins> bins_;
  std::array<Bin, bins> right_;  ///< of all bins behind one
  std::vector<BinaryNode> nodes_;
};

/// Children come behind their parent, so one pass from the end sees them first. Faces share vertices, whose positions
/// on the directions are the larger part of the work, so these come first.
void enclose_all(Tree& tree, const Mesh& mesh) {
  std::vector<Dop26> points;
  points.reserve(mesh.vertices.size());
  for (const Vec3d& vertex : mesh.vertices) points.push_back(make_dop26(vertex));
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    TreeNode& node = tree.nodes[i];
    const bool inner = node.kind == NodeKind::inner;
    node.dop = inner ? tree.nodes[node.first].dop : points[mesh.faces[tree.faces[node.first]].vertex[0]];
    for (std::size_t k = inner ? 1 : 0; k < node.count; ++k) {
      if (inner) {
        node.dop = enclose(node.dop, tree.nodes[node.first + k].dop);
        continue;
      }
      const Mesh::Face& face = mesh.faces[tree.faces[node.first + k]];
      for (std::size_t v = 0; v < static_cast<std::size_t>(face.kind); ++v) {
        node.dop = enclose(node.dop, points[face.vertex[v]]);
      }
    }
  }
}

}  // namespace

/// Areas may become infinite within 2^1000; a split then falls back to the median.
void check_vertices(const Mesh& mesh) {
  // NaN is not at most 2^1000.
  const auto is_good = [](const Vec3d& v) {
    return std::abs(v[0]) <= 0x1p1000 && std::abs(v[1]) <= 0x1p1000 && std::abs(v[2]) <= 0x1p1000;
  };
  if (std::all_of(mesh.vertices.begin(), mesh.vertices.end(), is_good)) return;  // there are fewer of them than corners
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Mesh::Face& face = mesh.faces[i];
    for (std::size_t v = 0; v < static_cast<std::size_t>(face.kind); ++v) {
      if (is_good(mesh.vertices[face.vertex[v]])) continue;
      throw std::invalid_argument("face " + std::to_string(i) + ": vertex " + std::to_string(v) +
                                  " is not finite or beyond 2^1000; scale the mesh");
    }
  }
}

Tree build_topology(const Mesh& mesh, const TreeOptions& options) {
  constexpr std::size_t most = (std::size_t{1} << 24U) - 2;
  if (mesh.faces.empty())
    throw std::invalid_argument("mesh" + (mesh.name.empty() ? "" : " " + mesh.name) + " has no faces");
  if (mesh.faces.size() > most) {
    throw std::invalid_argument("mesh " + mesh.name + " has " + std::to_string(mesh.faces.size()) +
                                " faces: cut it into objects of at most " + std::to_string(most));
  }
  check_faces(mesh);
  check_vertices(mesh);
  return Builder(mesh, options).collapse();
}

Tree build_tree(const Mesh& mesh, const TreeOptions& options) {
  Tree tree = build_topology(mesh, options);
  enclose_all(tree, mesh);
  return tree;
}

void refit(Tree& tree, const Mesh& mesh) {
  if (mesh.faces.size() != tree.faces.size()) {
    throw std::invalid_argument("mesh " + mesh.name + " has " + std::to_string(mesh.faces.size()) +
                                " faces, the tree was built over " + std::to_string(tree.faces.size()));
  }
  check_faces(mesh);
  check_vertices(mesh);
  enclose_all(tree, mesh);
}

}  // namespace cchip::bvh
