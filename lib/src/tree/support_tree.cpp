// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/tree/support_tree.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <utility>

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

using Words = std::array<Word, 2 * directions.size()>;

Words make_words() {
  Words words = {};
  std::size_t count = 0;
  for (std::size_t w = 0; w < support_words; ++w) {
    const std::array<int, 3> v = support_direction(w);
    const double length = std::sqrt(static_cast<double>(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const std::array<int, 3>& u = directions[d];
      const bool negative = v[0] == -u[0] && v[1] == -u[1] && v[2] == -u[2];
      if (v == u || negative) words[count++] = {w, d, negative, length};
    }
  }
  return words;
}

/// Trivial to destroy: the destructors of static objects may ask for it.
const Words& words() {
  static const Words all = make_words();
  return all;
}

double along(const std::array<int, 3>& d, const Vec3d& v) { return d[0] * v[0] + d[1] * v[1] + d[2] * v[2]; }

/// Bound on the error of adding up the coordinates of the centre and of what lies around it.
double sum_slack(const Vec3d& centre, double unit) {
  return 0x1p-49 * (centre.cwiseAbs().sum() + 4.0 * support_most * unit) + 0x1p-1060;
}

/// Makes the lines of single vertices: the word of a node is the greatest word of its vertices.
class LineMaker {
 public:
  LineMaker(const Vec3d& centre, double unit) : slack_(sum_slack(centre, unit)) {
    per_step_.fill(1);
    for (std::size_t w = 0; w < support_words; ++w) {
      const std::array<int, 3> v = support_direction(w);
      if (v == std::array<int, 3>{0, 0, 0}) continue;
      centre_[w] = along(v, centre);
      per_step_[w] = 1 / (std::sqrt(static_cast<double>(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])) * unit);
    }
  }

  /// \param vertex at most 2^1000 in magnitude
  SupportLine line(const Vec3d& vertex) const {
    const double x = vertex.x();
    const double y = vertex.y();
    const double z = vertex.z();
    // How far it lies along the direction of each word. Loops without branches, each over numbers of one type, because
    // compilers vectorise these.
    alignas(64) std::array<double, support_words> at;
    const std::array<double, 8> axes = {x, -x, y, -y, z, -z, 0, 0};
    std::copy(axes.begin(), axes.end(), at.begin());
    alignas(64) const std::array<double, 16> u = {y, -y, y, -y, z, -z, z, -z, x, -x, x, -x, 0, 0, 0, 0};
    alignas(64) const std::array<double, 16> v = {z, z, -z, -z, x, x, -x, -x, y, y, -y, -y, 0, 0, 0, 0};
    for (std::size_t i = 0; i < u.size(); ++i) at[first_face_word + i] = u[i] + v[i];
    const double* const xy = at.data() + first_face_word + 8;
    for (std::size_t i = 0; i < 4; ++i) {
      at[first_corner_word + i] = xy[i] + z;
      at[first_corner_word + 4 + i] = xy[i] - z;
    }
    // The sums are off by less than the slack. The product and its operands are off by a few units in the last place of
    // a number below 2^17. The object lies in the ball, so the bound may be cut off there. An overflow leaves the ball,
    // too. Counted from its other end steps are not negative, so that dropping digits rounds them down.
    constexpr double most = support_most;
    for (std::size_t w = 0; w < support_words; ++w) {
      const double steps = (at[w] - centre_[w] + slack_) * per_step_[w] + (most + 0x1p-30);
      const double below = steps < 2 * most - 0.5 ? steps : 2 * most - 0.5;
      at[w] = below > 0 ? below : 0;
    }
    alignas(64) std::array<std::int32_t, support_words> whole;
    for (std::size_t w = 0; w < support_words; ++w) whole[w] = static_cast<std::int32_t>(at[w]);
    SupportLine line;
    for (std::size_t w = 0; w < support_words; ++w) {
      line.word[w] = static_cast<std::int16_t>(whole[w] + 1 - support_most);
    }
    line.word[6] = line.word[7] = 0;
    for (std::size_t w = first_face_word + 12; w < support_words; ++w) line.word[w] = 0;
    return line;
  }

 private:
  double slack_;
  alignas(64) std::array<double, support_words> centre_ = {};
  alignas(64) std::array<double, support_words> per_step_;
};

void take_greatest(SupportLine& line, const SupportLine& other) {
  for (std::size_t w = 0; w < support_words; ++w) {
    line.word[w] = line.word[w] < other.word[w] ? other.word[w] : line.word[w];
  }
}

void set_ref(SupportLine& line, NodeRef ref) {
  const std::uint32_t bits = ref.bits();
  std::memcpy(&line.word[6], &bits, sizeof bits);
}

bool same_place(const Mesh& mesh, std::uint32_t p, std::uint32_t q) {
  if (p == q) return true;
  const Vec3d& u = mesh.vertices[p];
  const Vec3d& v = mesh.vertices[q];
  return u.x() == v.x() && u.y() == v.y() && u.z() == v.z();
}

/// Numbers of four vertices.
using Corners = std::array<std::uint32_t, 4>;

/// Two triangles as the corners of a fan: three of the first one, then the one that only the second one has.
/// \returns false if no edge of one is an edge of the other
bool make_fan(const Mesh& mesh, const Mesh::Face& one, const Mesh::Face& two, Corners& corners) {
  std::array<std::array<bool, 3>, 3> same;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) same[i][k] = same_place(mesh, one.vertex[i], two.vertex[k]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t to = (i + 1) % 3;
    for (std::size_t k = 0; k < 3; ++k) {
      // Edge i, i + 1 against edge k, k + 1 in either direction: a fan needs no orientation.
      const std::size_t q = (k + 1) % 3;
      if (!((same[i][q] && same[to][k]) || (same[i][k] && same[to][q]))) continue;
      corners = {one.vertex[to], one.vertex[(i + 2) % 3], one.vertex[i], two.vertex[(k + 2) % 3]};
      return true;
    }
  }
  return false;
}

/// For each vertex, whether a face uses it: others may be anything.
std::vector<std::uint8_t> used_vertices(const Mesh& mesh) {
  std::vector<std::uint8_t> used(mesh.vertices.size());
  for (const Mesh::Face& face : mesh.faces) {
    for (std::size_t v = 0; v < 3; ++v) used[face.vertex[v]] = 1;
    if (face.kind == Kind::quad) used[face.vertex[3]] = 1;
  }
  return used;
}

// Words of slabs are not negative: a search that has no direction for them adds them, saturated, to what never
// separates. So a part of a normal, from -1 to 1, and a height are both moved up and halved.
constexpr double slab_scale = 16383;
constexpr double slab_bias = support_most + 2;
constexpr std::int16_t no_slab = 32767;

/// The normal of two words on the octahedron; its lower half is folded outward over the corners of the square.
Vec3d unfolded(std::int16_t word_u, std::int16_t word_v) {
  const double u = word_u / slab_scale - 1;
  const double v = word_v / slab_scale - 1;
  const double z = 1 - std::abs(u) - std::abs(v);
  const double fold = z < 0 ? -z : 0;
  return {u > 0 ? u - fold : u + fold, v > 0 ? v - fold : v + fold, z};
}

std::int16_t height_word(double height) { return static_cast<std::int16_t>(std::ceil((height + slab_bias) / 2)); }
double height_of(std::int16_t word) { return 2 * word - slab_bias; }

/// The words of the nearest normal that they can be of, and no heights yet.
std::array<std::int16_t, 4> slab_words(const Vec3d& sum) {
  const double size = sum.cwiseAbs().sum();
  if (!(size > 0x1p-900 && size < 0x1p900)) return {0, 0, no_slab, no_slab};
  double u = sum.x() / size;
  double v = sum.y() / size;
  if (sum.z() < 0) {
    const double old = u;
    u = (u < 0 ? -1 : 1) * (1 - std::abs(v));
    v = (v < 0 ? -1 : 1) * (1 - std::abs(old));
  }
  const auto word = [](double x) { return static_cast<std::int16_t>(std::lround((x + 1) * slab_scale)); };
  return {word(u), word(v), 0, 0};
}

/// A triangle has its vertex 0 twice.
Corners four_corners(const Mesh::Face& face) {
  return {face.vertex[0], face.vertex[1], face.vertex[2], face.vertex[face.kind == Kind::quad ? 3 : 0]};
}

Vec3d middle_of(const Mesh& mesh, const std::vector<std::uint8_t>& used) {
  Vec3d least = Vec3d::Constant(std::numeric_limits<double>::infinity());
  Vec3d greatest = -least;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    least = least.cwiseMin(mesh.vertices[v]);
    greatest = greatest.cwiseMax(mesh.vertices[v]);
  }
  return least / 2 + greatest / 2;
}

/// The greatest distance from the centre, as hypot() rounds it. It is called for few vertices: one that is closer by
/// 2^-40 of the distance, computed without care, cannot be the farthest.
double radius_of(const Mesh& mesh, const std::vector<std::uint8_t>& used, const Vec3d& centre) {
  const auto square = [&](std::size_t v) {
    const Vec3d& at = mesh.vertices[v];
    const double x = at.x() - centre.x();
    const double y = at.y() - centre.y();
    const double z = at.z() - centre.z();
    return x * x + y * y + z * z;
  };
  double greatest = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    const double size = square(v);
    greatest = size > greatest ? size : greatest;
  }
  // Where squares underflow or overflow, all are candidates.
  const double candidate = greatest > 0x1p-900 && greatest < 0x1p1000 ? greatest * (1 - 0x1p-40) : 0;
  double radius = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0 || square(v) < candidate) continue;
    const Vec3d at = mesh.vertices[v] - centre;
    radius = std::max(radius, std::hypot(at.x(), at.y(), at.z()));
  }
  return radius;
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
  std::vector<Leaf> leaves;
  leaves.reserve(tree.faces.size());
  for (std::size_t at = 0; at < tree.faces.size();) {
    const std::size_t count = tree.nodes[leaf_at[at]].count;
    leaves.push_back({leaf_at[at], static_cast<std::uint32_t>(count), {tree.faces[at], tree.faces[at + count - 1]}});
    at += count;
  }
  fill(mesh, std::move(refs), leaves);
}

SupportTree SupportTree::moved(const Mesh& mesh) const {
  std::vector<NodeRef> refs(size_ + 1);
  refs[0] = root_;
  // A leaf begins at an even place. 0 where none begins: the root is no leaf.
  std::vector<std::uint32_t> leaf_at(faces_.size() / 2);
  for (std::uint32_t n = 1; n <= size_; ++n) {
    const NodeRef ref = refs[n] = lines()[n - 1].ref();
    if (ref.is_leaf()) leaf_at[ref.first() / 2] = n;
  }
  std::vector<Leaf> leaves;
  leaves.reserve(leaf_at.size());
  for (std::size_t i = 0; i < leaf_at.size(); ++i) {
    if (leaf_at[i] == 0) continue;
    const std::uint32_t count = refs[leaf_at[i]].count();
    leaves.push_back({leaf_at[i], count, {faces_[2 * i], faces_[2 * i + count - 1]}});
  }
  SupportTree tree;
  tree.depth_ = depth_;
  tree.fill(mesh, std::move(refs), leaves);
  return tree;
}

void SupportTree::fill(const Mesh& mesh, std::vector<NodeRef> refs, const std::vector<Leaf>& leaves) {
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  centre_ = middle_of(mesh, used);
  // Up: hypot() and the difference are rounded.
  unit_ = std::max(radius_of(mesh, used, centre_) * (1 + 0x1p-40) / support_most, least_unit);
  const LineMaker maker(centre_, unit_);
  std::vector<SupportLine> vertex_lines;
  std::vector<std::array<float, 3>> points;
  vertex_lines.reserve(used.size());
  points.reserve(used.size());
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) {
      vertex_lines.emplace_back();
      points.emplace_back();
      continue;
    }
    vertex_lines.push_back(maker.line(mesh.vertices[v]));
    const Vec3d at = (mesh.vertices[v] - centre_) / unit_;
    points.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())});
  }

  std::vector<std::array<Corners, 2>> corners(leaves.size());
  faces_.reserve(4 * leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Leaf& leaf = leaves[i];
    const Mesh::Face& one = mesh.faces[leaf.faces[0]];
    const Mesh::Face& two = mesh.faces[leaf.faces[1]];
    const bool fan = leaf.count == 2 && make_fan(mesh, one, two, corners[i][0]);
    if (!fan) {
      corners[i][0] = four_corners(one);
      corners[i][1] = four_corners(two);
    }
    const auto first = static_cast<std::uint32_t>(faces_.size());
    const bool quad = leaf.count == 1 && one.kind == Kind::quad;
    refs[leaf.node] = NodeRef::leaf(first, leaf.count, fan || quad);
    faces_.push_back(leaf.faces[0]);
    faces_.push_back(leaf.faces[1]);
    if (refs[leaf.node].vertex_sets() == 2) faces_.insert(faces_.end(), 2, leaf.faces[1]);
  }
  faces_.shrink_to_fit();

  root_ = refs.front();
  size_ = refs.size() - 1;
  vertices_at_ = (size_ + 4) * sizeof(SupportLine);
  constexpr std::size_t behind = 24;  // two primitives can always be read
  memory_.resize(vertices_at_ + (6 * faces_.size() + behind) * sizeof(float));
  std::byte* const lines = memory_.data();
  const auto put = [lines](std::size_t at, const SupportLine& line) {
    std::memcpy(lines + at * sizeof line, &line, sizeof line);
  };
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const NodeRef ref = refs[leaves[i].node];
    const std::size_t sets = ref.vertex_sets();
    SupportLine line = vertex_lines[corners[i][0][0]];
    alignas(64) std::array<float, 24> floats;
    for (std::size_t s = 0; s < sets; ++s) {
      for (std::size_t v = 0; v < 4; ++v) {
        const std::uint32_t vertex = corners[i][s][v];
        take_greatest(line, vertex_lines[vertex]);
        for (std::size_t k = 0; k < 3; ++k) floats[4 * (sets * k + s) + v] = points[vertex][k];
      }
    }
    set_ref(line, ref);
    put(leaves[i].node - 1, line);
    std::memcpy(lines + vertices_at_ + 6 * ref.first() * sizeof(float), floats.data(), 12 * sets * sizeof(float));
  }
  // Children come behind their parent, so one pass from the end sees them first.
  for (std::size_t n = refs.size(); n-- > 0;) {
    const NodeRef ref = refs[n];
    if (ref.is_leaf()) continue;
    SupportLine line = this->lines()[ref.first()];
    for (std::uint32_t k = 1; k < ref.count(); ++k) take_greatest(line, this->lines()[ref.first() + k]);
    set_ref(line, ref);
    put(n == 0 ? size_ : n - 1, line);
  }
  put_slabs(refs, leaves);
  for (std::size_t i = 1; i < 4; ++i) put(size_ + i, SupportLine());
  std::memset(lines + vertices_at_ + 6 * faces_.size() * sizeof(float), 0, behind * sizeof(float));
  whole_words_ = this->lines()[size_].word;
  extent_ = centre_.cwiseAbs().maxCoeff() + support_most * unit_;
  for (std::size_t k = 0; k < 3; ++k) half_[k] = unit_ * std::max(whole_words_[2 * k], whole_words_[2 * k + 1]);
}

/// The slabs of all nodes but large ones, from the vertices in single precision.
void SupportTree::put_slabs(const std::vector<NodeRef>& refs, const std::vector<Leaf>& leaves) {
  constexpr std::uint32_t most_sets = 128;  // of four vertices
  struct Below {
    Vec3d normal = Vec3d::Zero();
    std::uint32_t sets = 0;
    std::size_t first = std::numeric_limits<std::size_t>::max();  ///< leaves, which lie side by side
    std::size_t last = 0;
  };
  std::vector<Below> below(refs.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const NodeRef leaf = refs[leaves[i].node];
    const float* const v = vertices(leaf.first());
    const std::size_t stride = std::size_t{4} * leaf.vertex_sets();
    Below& here = below[leaves[i].node];
    here.sets = leaf.vertex_sets();
    here.first = here.last = i;
    const auto between = [v, stride](std::size_t from, std::size_t to) {
      return Vec3d(v[to] - v[from], v[stride + to] - v[stride + from], v[2 * stride + to] - v[2 * stride + from]);
    };
    for (std::size_t at = 0; at < stride; at += 4) here.normal += between(at, at + 2).cross(between(at + 1, at + 3));
  }
  for (std::size_t n = refs.size(); n-- > 0;) {
    const NodeRef ref = refs[n];
    Below& here = below[n];
    for (std::uint32_t k = 0; k < ref.count() && !ref.is_leaf(); ++k) {
      const Below& child = below[ref.first() + k + 1];
      here.normal += child.normal;
      here.sets += child.sets;
      here.first = std::min(here.first, child.first);
      here.last = std::max(here.last, child.last);
    }
    std::array<std::int16_t, 4> words = {0, 0, no_slab, no_slab};
    if (here.sets <= most_sets) words = slab_words(here.normal);
    if (words[2] != no_slab) {
      const Vec3d normal = unfolded(words[0], words[1]);
      const auto x = static_cast<float>(normal.x());
      const auto y = static_cast<float>(normal.y());
      const auto z = static_cast<float>(normal.z());
      // Four at a time, without branches, because compilers vectorise that.
      std::array<float, 4> greatest;
      std::array<float, 4> least;
      greatest.fill(-support_most);
      least.fill(support_most);
      for (std::size_t i = here.first; i <= here.last; ++i) {
        const NodeRef leaf = refs[leaves[i].node];
        const float* const v = vertices(leaf.first());
        const std::size_t stride = std::size_t{4} * leaf.vertex_sets();
        for (std::size_t at = 0; at < stride; at += 4) {
          for (std::size_t lane = 0; lane < 4; ++lane) {
            const std::size_t k = at + lane;
            const float height = x * v[k] + y * v[stride + k] + z * v[2 * stride + k];
            greatest[lane] = greatest[lane] < height ? height : greatest[lane];
            least[lane] = least[lane] > height ? height : least[lane];
          }
        }
      }
      // A vertex is off by less than 2^-8 units in each coordinate, of which the normal takes 1 in all; the heights,
      // below 2^15, by 5 2^-24 of that.
      constexpr double slack = 0.02;
      words[2] = height_word(*std::max_element(greatest.begin(), greatest.end()) + slack);
      words[3] = height_word(slack - *std::min_element(least.begin(), least.end()));
    }
    std::byte* const line = memory_.data() + (n == 0 ? size_ : n - 1) * sizeof(SupportLine);
    std::memcpy(line + first_slab_word * sizeof words[0], words.data(), sizeof words);
  }
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

bool slab_of(const SupportLine& line, Slab& slab) {
  const std::int16_t* const words = line.word.data() + first_slab_word;
  if (words[2] == no_slab) return false;
  slab.normal = unfolded(words[0], words[1]);
  slab.along = height_of(words[2]);
  slab.against = height_of(words[3]);
  return true;
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
