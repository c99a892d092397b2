// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/bvh/support_tree.hpp>
#include <cmath>
#include <memory>
#include <new>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

#include "rounding.hpp"

namespace cchip::bvh {
namespace {

constexpr double least_unit = 0x1p-1000;
constexpr std::size_t cache_line = 64;

/// A word, the number of its direction among the 13, which way it points along that, and the direction's length.
struct Word {
  std::size_t word;
  std::size_t direction;
  bool negative;
  double length;
};

std::vector<Word> make_words() {
  std::vector<Word> words;
  for (std::size_t w = 0; w < support_words; ++w) {
    const std::array<int, 3> v = support_direction(w);
    const double length = std::sqrt(static_cast<double>(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const std::array<int, 3>& u = directions[d];
      if (v == u) words.push_back({w, d, false, length});
      if (v[0] == -u[0] && v[1] == -u[1] && v[2] == -u[2]) words.push_back({w, d, true, length});
    }
  }
  return words;
}

const std::vector<Word>& words() {
  static const std::vector<Word> all = make_words();
  return all;
}

double along(const std::array<int, 3>& d, const Vec3d& v) { return d[0] * v[0] + d[1] * v[1] + d[2] * v[2]; }

/// Bound on the error of adding up the coordinates of the centre and of what lies around it.
double sum_slack(const Vec3d& centre, double unit) {
  return 0x1p-49 * (centre.cwiseAbs().sum() + 4.0 * support_most * unit) + 0x1p-1060;
}

/// Makes the lines of an object.
class LineMaker {
 public:
  LineMaker(const Vec3d& centre, double unit) : slack_(sum_slack(centre, unit)) {
    for (const Word& w : words()) {
      centre_[w.word] = along(directions[w.direction], centre);
      step_[w.word] = w.length * unit;
    }
  }

  SupportLine line(const Dop26& dop, NodeRef ref) const {
    SupportLine line;
    for (const Word& w : words()) {
      const double at = centre_[w.word];
      const double reach = (w.negative ? at - dop.least[w.direction] : dop.greatest[w.direction] - at) + slack_;
      // The division and its operands are off by a few units in the last place of a number below 2^16.
      const double steps = reach / step_[w.word] + 0x1p-30;
      // The object lies in the ball, so the bound may be cut off there. An overflow leaves the ball, too.
      const double most = support_most;
      const double cut = steps < most ? std::max(steps, -most) : most;
      const int whole = static_cast<int>(cut);  // towards zero; ceil() would be a call
      line.word[w.word] = static_cast<std::int16_t>(whole + (whole < cut ? 1 : 0));
    }
    const std::uint32_t bits = ref.bits();
    std::memcpy(&line.word[6], &bits, sizeof bits);
    return line;
  }

 private:
  double slack_;
  std::array<double, support_words> centre_ = {};
  std::array<double, support_words> step_ = {};
};

/// Two triangles as the corners of a fan: three of the first one, then the one that only the second one has.
/// \returns false if no edge of one is an edge of the other
bool make_fan(const Primitive& one, const Primitive& two, std::array<Vec3d, 4>& corners) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      // Edge i, i + 1 against edge k, k + 1 in either direction: a fan needs no orientation.
      const Vec3d& from = one.v[i];
      const Vec3d& to = one.v[(i + 1) % 3];
      const Vec3d& p = two.v[k];
      const Vec3d& q = two.v[(k + 1) % 3];
      if (!((from == q && to == p) || (from == p && to == q))) continue;
      corners = {to, one.v[(i + 2) % 3], from, two.v[(k + 2) % 3]};
      return true;
    }
  }
  return false;
}

}  // namespace

void* allocate_bytes(std::size_t bytes) {
  void* const memory = ::operator new (bytes, std::align_val_t{cache_line});
#ifdef MADV_HUGEPAGE
  constexpr std::size_t large_page = std::size_t{1} << 21U;  // of x86-64 and of most Arm systems
  constexpr std::size_t page = std::size_t{1} << 16U;        // the others are as large or smaller
  void* begin = memory;
  std::size_t left = bytes;
  // Best effort: madvise() may fail.
  if (bytes >= large_page && std::align(page, 1, begin, left) != nullptr) madvise(begin, left, MADV_HUGEPAGE);
#endif
  return memory;
}

void free_bytes(void* memory) noexcept { ::operator delete (memory, std::align_val_t{cache_line}); }

SupportTree::SupportTree(const Mesh& mesh, const Tree& tree) : depth_(tree.depth) {
  const Dop26& all = tree.nodes.front().dop;
  for (std::size_t k = 0; k < 3; ++k) {
    centre_[static_cast<Eigen::Index>(k)] = all.least[k] / 2 + all.greatest[k] / 2;
  }
  double radius = 0;
  for (const std::uint32_t face : tree.faces) {
    const Primitive p = mesh.primitive(face);
    for (std::size_t i = 0; i < p.vertex_count(); ++i) {
      const Vec3d v = p.v[i] - centre_;
      radius = std::max(radius, std::hypot(v.x(), v.y(), v.z()));
    }
  }
  unit_ = std::max(radius * (1 + 0x1p-40) / support_most, least_unit);  // up: hypot() and the difference are rounded

  std::vector<float> vertices;
  const std::vector<NodeRef> refs = place_leaves(mesh, tree, vertices);
  root_ = refs.front();
  size_ = tree.nodes.size() - 1;
  vertices_at_ = (size_ + 4) * sizeof(SupportLine);
  memory_.resize(vertices_at_ + vertices.size() * sizeof(float));
  const LineMaker maker(centre_, unit_);
  const auto put = [&](std::size_t at, const SupportLine& line) {
    std::memcpy(memory_.data() + at * sizeof line, &line, sizeof line);
  };
  for (std::size_t n = 1; n < tree.nodes.size(); ++n) put(n - 1, maker.line(tree.nodes[n].dop, refs[n]));
  const SupportLine whole_line = maker.line(all, root_);
  put(size_, whole_line);
  std::memcpy(memory_.data() + vertices_at_, vertices.data(), vertices.size() * sizeof(float));
  whole_words_ = whole_line.word;
  extent_ = centre_.cwiseAbs().maxCoeff() + support_most * unit_;
  for (std::size_t k = 0; k < 3; ++k) half_[k] = unit_ * std::max(whole_words_[2 * k], whole_words_[2 * k + 1]);
}

std::vector<NodeRef> SupportTree::place_leaves(const Mesh& mesh, const Tree& tree, std::vector<float>& vertices) {
  std::vector<NodeRef> refs(tree.nodes.size());
  std::vector<std::uint32_t> leaf_at(tree.faces.size());  // number of the node whose primitives begin there
  for (std::uint32_t n = 0; n < tree.nodes.size(); ++n) {
    const TreeNode& node = tree.nodes[n];
    if (node.kind == NodeKind::inner) {
      // The root has no line, so the children of a node begin at the line one before their number.
      refs[n] = NodeRef::inner(node.first - 1, node.count);
    } else {
      leaf_at[node.first] = n;
    }
  }
  faces_.reserve(tree.faces.size());
  vertices.reserve(6 * tree.faces.size());
  const auto add_vertices = [&](const std::array<std::array<Vec3d, 4>, 2>& corners, std::size_t count) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      for (std::size_t i = 0; i < count; ++i) {
        for (const Vec3d& v : corners[i]) {
          vertices.push_back(static_cast<float>((v[axis] - centre_[axis]) / unit_));
        }
      }
    }
  };
  for (std::size_t at = 0; at < tree.faces.size();) {
    const std::uint32_t n = leaf_at[at];
    const std::size_t count = tree.nodes[n].count;
    const auto first = static_cast<std::uint32_t>(faces_.size());
    std::array<std::array<Vec3d, 4>, 2> corners;
    std::array<Primitive, 2> primitives;
    for (std::size_t i = 0; i < count; ++i) {
      const Primitive p = primitives[i] = mesh.primitive(tree.faces[at + i]);
      for (std::size_t v = 0; v < 4; ++v) corners[i][v] = p.v[v < p.vertex_count() ? v : 0];
      faces_.push_back(tree.faces[at + i]);
    }
    const bool fan = count == 2 && make_fan(primitives[0], primitives[1], corners[0]);
    const std::size_t sets = fan ? 1 : count;
    add_vertices(corners, sets);
    faces_.resize(first + 2 * sets, faces_.back());
    refs[n] = NodeRef::leaf(first, static_cast<std::uint32_t>(count), fan || tree.nodes[n].kind == NodeKind::quad);
    at += count;
  }
  vertices.resize(vertices.size() + 24);  // two primitives can always be read
  faces_.shrink_to_fit();
  return refs;
}

std::array<float, 24> SupportTree::vertices_of(const Primitive& primitive) const {
  std::array<float, 24> vertices = {};
  for (std::size_t v = 0; v < 4; ++v) {
    const Vec3d at = (primitive.v[v < primitive.vertex_count() ? v : 0] - centre_) / unit_;
    for (std::size_t k = 0; k < 3; ++k) vertices[4 * k + v] = static_cast<float>(at[static_cast<Eigen::Index>(k)]);
  }
  return vertices;
}

Tree SupportTree::topology() const {
  Tree tree;
  tree.depth = depth_;
  tree.nodes.resize(size_ + 1);
  const auto ref_of = [this](std::size_t n) { return n == 0 ? root_ : lines()[n - 1].ref(); };
  std::vector<std::uint8_t> used(faces_.size());  // places that hold a primitive of their own
  for (std::size_t n = 0; n <= size_; ++n) {
    const NodeRef ref = ref_of(n);
    if (ref.is_leaf()) std::fill_n(used.begin() + ref.first(), ref.count(), std::uint8_t{1});
  }
  std::vector<std::uint32_t> number(faces_.size());  // of the primitive in a place, among those of the tree
  for (std::size_t place = 0; place < faces_.size(); ++place) {
    number[place] = static_cast<std::uint32_t>(tree.faces.size());
    if (used[place] != 0) tree.faces.push_back(faces_[place]);
  }
  for (std::size_t n = 0; n <= size_; ++n) {
    const NodeRef ref = ref_of(n);
    TreeNode& node = tree.nodes[n];
    node.count = static_cast<std::uint8_t>(ref.count());
    if (ref.is_leaf()) {
      node.first = number[ref.first()];
      node.kind = ref.is_quad() ? NodeKind::quad : ref.count() == 2 ? NodeKind::two_triangles : NodeKind::triangle;
    } else {
      node.first = ref.first() + 1;  // see place_leaves()
    }
  }
  return tree;
}

Dop26 dop_of(const SupportTree& tree, const SupportLine& line) {
  Dop26 dop;
  const double slack = sum_slack(tree.centre(), tree.unit());
  for (const Word& w : words()) {
    const double at = along(directions[w.direction], tree.centre());
    const double reach = w.length * tree.unit() * line.word[w.word] + slack;
    if (w.negative) {
      dop.least[w.direction] = at - reach;
    } else {
      dop.greatest[w.direction] = at + reach;
    }
  }
  return dop;
}

}  // namespace cchip::bvh
