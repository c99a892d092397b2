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

NodeRef ref_of(const TreeNode& node) {
  // The root has no line, so the children of node n begin at the line one before their number.
  if (node.kind == NodeKind::inner) return NodeRef::inner(node.first - 1, node.count);
  return NodeRef::leaf(node.first, node.count, node.kind == NodeKind::quad);
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

SupportTree::SupportTree(const Mesh& mesh, const Tree& tree) : depth_(tree.depth), faces_(tree.faces) {
  const Dop26& all = tree.nodes.front().dop;
  for (std::size_t k = 0; k < 3; ++k) {
    centre_[static_cast<Eigen::Index>(k)] = all.least[k] / 2 + all.greatest[k] / 2;
  }
  double radius = 0;
  for (const std::uint32_t face : faces_) {
    const Primitive p = mesh.primitive(face);
    for (std::size_t i = 0; i < p.vertex_count(); ++i) {
      const Vec3d v = p.v[i] - centre_;
      radius = std::max(radius, std::hypot(v.x(), v.y(), v.z()));
    }
  }
  unit_ = std::max(radius * (1 + 0x1p-40) / support_most, least_unit);  // up: hypot() and the difference are rounded

  root_ = ref_of(tree.nodes.front());
  size_ = tree.nodes.size() - 1;
  lines_.reserve(size_ + 4);
  const LineMaker maker(centre_, unit_);
  for (std::size_t n = 1; n < tree.nodes.size(); ++n) {
    lines_.push_back(maker.line(tree.nodes[n].dop, ref_of(tree.nodes[n])));
  }
  lines_.push_back(maker.line(all, root_));
  whole_words_ = lines_.back().word;
  extent_ = centre_.cwiseAbs().maxCoeff() + support_most * unit_;
  for (std::size_t k = 0; k < 3; ++k) half_[k] = unit_ * std::max(whole_words_[2 * k], whole_words_[2 * k + 1]);
  lines_.resize(size_ + 4);

  vertices_.resize(12 * faces_.size() + 12);  // two primitives can always be read
  for (const TreeNode& node : tree.nodes) {
    if (node.kind == NodeKind::inner) continue;
    float* const to = vertices_.data() + std::size_t{12} * node.first;
    for (std::size_t i = 0; i < node.count; ++i) {
      const Primitive p = mesh.primitive(faces_[node.first + i]);
      for (std::size_t v = 0; v < 4; ++v) {
        const Vec3d at = (p.v[v < p.vertex_count() ? v : 0] - centre_) / unit_;
        for (std::size_t k = 0; k < 3; ++k) {
          to[4 * (k * node.count + i) + v] = static_cast<float>(at[static_cast<Eigen::Index>(k)]);
        }
      }
    }
  }
}

Tree SupportTree::topology() const {
  Tree tree;
  tree.faces = faces_;
  tree.depth = depth_;
  tree.nodes.resize(size_ + 1);
  const auto node_of = [](NodeRef ref) {
    TreeNode node;
    node.count = static_cast<std::uint8_t>(ref.count());
    node.first = ref.first();
    if (ref.is_leaf()) {
      node.kind = ref.is_quad() ? NodeKind::quad : ref.count() == 2 ? NodeKind::two_triangles : NodeKind::triangle;
    } else {
      node.first += 1;  // see ref_of()
    }
    return node;
  };
  tree.nodes[0] = node_of(root_);
  for (std::size_t n = 1; n < tree.nodes.size(); ++n) tree.nodes[n] = node_of(lines_[n - 1].ref());
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
