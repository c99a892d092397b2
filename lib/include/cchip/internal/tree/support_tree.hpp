// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tree of 26-DOPs in 16 bits: what a CPU traverses. Made from the same tree as the chip's image.
#ifndef CCHIP_INTERNAL_TREE_SUPPORT_TREE_HPP
#define CCHIP_INTERNAL_TREE_SUPPORT_TREE_HPP

#include <array>
#include <cchip/internal/tree/tree.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace cchip::bvh {

/// What a node is and where what lies below it begins.
class NodeRef {
 public:
  NodeRef() = default;
  /// An inner node: its children are lines first..first + count - 1.
  static NodeRef inner(std::uint32_t first, std::uint32_t count) { return NodeRef(first << 5U | count << 1U); }
  /// A leaf of one or two primitives, in the places first..first + count - 1.
  /// \param four_corners a quad, or two triangles that have an edge in common
  static NodeRef leaf(std::uint32_t first, std::uint32_t count, bool four_corners) {
    return NodeRef(first << 5U | (four_corners ? 16U : 0U) | count << 1U | 1U);
  }
  static NodeRef from_bits(std::uint32_t bits) { return NodeRef(bits); }
  bool is_leaf() const { return (bits_ & 1U) != 0; }
  bool is_quad() const { return (bits_ & 0x1FU) == 0x13U; }
  /// Two triangles with an edge in common, a fan: vertices 0 1 2 and 0 2 3 of four.
  bool is_fan() const { return (bits_ & 0x1FU) == 0x15U; }
  std::uint32_t first() const { return bits_ >> 5U; }
  std::uint32_t count() const { return bits_ >> 1U & 7U; }
  /// Of a leaf: sets of four vertices that it has.
  std::uint32_t vertex_sets() const { return is_fan() ? 1 : count(); }
  std::uint32_t bits() const { return bits_; }

 private:
  explicit NodeRef(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};

/// Words of a SupportLine. Those of the axes, of the corners (cube diagonals) and of the first eight faces (face
/// diagonals) lie within 16 bytes each, because instruction sets permute bytes within 16.
///  word 2 axis + negative;  8 + (x<0) + 2 (y<0) + 4 (z<0);  16 + 4 missing axis + (u<0) + 2 (v<0), where u and v are
///  the axes after the missing one, in cyclic order
inline constexpr std::size_t support_words = 32;
inline constexpr std::size_t first_corner_word = 8;
inline constexpr std::size_t first_face_word = 16;
///  words 28 to 31 are the node's slab
inline constexpr std::size_t first_slab_word = 28;
/// Direction of a word, not normalised; 0, 0, 0 for those without one: 6, 7 (the reference) and 28..31 (the slab).
constexpr std::array<int, 3> support_direction(std::size_t word) {
  std::array<int, 3> d = {0, 0, 0};
  const auto sign = [word](std::size_t bit) { return (word >> bit & 1U) != 0 ? -1 : 1; };
  if (word < 6) {
    d[word / 2] = sign(0);
  } else if (word >= first_face_word && word < first_face_word + 12) {
    const std::size_t missing = (word - first_face_word) / 4;
    d[(missing + 1) % 3] = sign(0);
    d[(missing + 2) % 3] = sign(1);
  } else if (word >= first_corner_word && word < first_face_word) {
    d = {sign(0), sign(1), sign(2)};
  }
  return d;
}

/// A node: how far it reaches along each direction from the object's centre, divided by the direction's length, in
/// units of the object, rounded up. At most support_most in magnitude.
struct alignas(64) SupportLine {
  std::array<std::int16_t, support_words> word = {};
  NodeRef ref() const {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &word[6], sizeof bits);
    return NodeRef::from_bits(bits);
  }
};
inline constexpr int support_most = 29000;

/// Two planes across the mean normal of a node's faces: what lies below the node is thinner between them than between
/// any others, nearly. Normals are on the octahedron |x| + |y| + |z| = 1, unfolded into the square of two words.
struct Slab {
  Vec3d normal = Vec3d::Zero();  ///< of |normal|_1 = 1, nearly
  double along = 0;              ///< normal . (x - centre) is at most this in units of the object, for all x below
  double against = 0;            ///< and at least minus this
};
/// \returns false if the node has none: it is large, or its normals cancel
bool slab_of(const SupportLine& line, Slab& slab);

/// Aligned to a cache line; free_bytes() takes it back.
/// \throws std::bad_alloc
void* allocate_bytes(std::size_t bytes);
void free_bytes(void* memory) noexcept;

/// Memory in large pages where the system has them to give: a search jumps through all of a tree.
template <class T>
struct LargePages {
  using value_type = T;
  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) {}  // NOLINT: allocators convert
  T* allocate(std::size_t count) { return static_cast<T*>(allocate_bytes(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { free_bytes(memory); }
  /// Leaves bytes as they are: whoever asks for them writes all.
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U>
  bool operator==(const LargePages<U>&) const {
    return true;
  }
  template <class U>
  bool operator!=(const LargePages<U>&) const {
    return false;
  }
};

/// Lines and faces of an object. The object lies in a ball of support_most units around its centre.
class SupportTree {
 public:
  /// \param tree of this mesh; its volumes do not matter
  SupportTree(const Mesh& mesh, const Tree& tree);

  /// The same nodes over a mesh with the same faces and other vertices: what the constructor makes of topology() and
  /// that mesh. Takes O(faces) time.
  /// \pre check_faces() and check_vertices() accept the mesh
  SupportTree moved(const Mesh& mesh) const;

  /// The nodes that the tree was made from, without their volumes, which refit() computes from a mesh.
  Tree topology() const;

  const Vec3d& centre() const { return centre_; }
  /// Length of a unit; at least 2^-1000.
  double unit() const { return unit_; }
  /// The root's children.
  NodeRef root() const { return root_; }
  /// The whole object as one node, whose line refers to the root.
  NodeRef whole() const { return NodeRef::inner(static_cast<std::uint32_t>(size_), 1); }
  /// Sum of the centre's greatest coordinate in magnitude and of the ball's radius, rounded.
  double extent() const { return extent_; }
  /// How far the object reaches from the centre along an axis, either way, at most; up to a rounding of the product of
  /// a word and the unit.
  double half(std::size_t axis) const { return half_[axis]; }
  /// Words of the line of whole(), beside the centre and the unit: what a first look at the object needs.
  const std::array<std::int16_t, support_words>& whole_words() const { return whole_words_; }
  /// Lines below the root. That of whole() follows, and three that nothing refers to, so that four can always be read.
  std::size_t size() const { return size_; }
  const SupportLine* lines() const { return reinterpret_cast<const SupportLine*>(memory_.data()); }
  /// Number in the mesh of the primitive in each place. A leaf begins at an even place and has two of them, or four if
  /// it is of two triangles that are no fan; places that it does not need repeat its last primitive.
  const std::vector<std::uint32_t>& faces() const { return faces_; }
  /// Vertices of the leaf that begins at place `first`: x of the four vertices of its first primitive (of the fan), of
  /// the second one, then y, then z; (position - centre) / unit, rounded to nearest. Vertex 3 of a triangle is vertex
  /// 0.
  const float* vertices(std::uint32_t first) const {
    return reinterpret_cast<const float*>(memory_.data() + vertices_at_) + std::size_t{6} * first;
  }
  /// What vertices() would refer to if the primitive were a leaf of this tree alone, and zeros behind it.
  std::array<float, 24> vertices_of(const Primitive& primitive) const;

 private:
  struct Leaf {
    std::uint32_t node;
    std::uint32_t count;                 ///< of its faces
    std::array<std::uint32_t, 2> faces;  ///< the same twice if there is one
  };

  SupportTree() = default;
  /// Fills in all but depth_.
  /// \param refs what each node refers to; those of leaves do not matter
  /// \param leaves in the order of their places
  void fill(const Mesh& mesh, std::vector<NodeRef> refs, const std::vector<Leaf>& leaves);
  void put_slabs(const std::vector<NodeRef>& refs, const std::vector<Leaf>& leaves);

  Vec3d centre_;
  double unit_;
  double extent_;
  std::array<double, 3> half_;
  std::array<std::int16_t, support_words> whole_words_;
  NodeRef root_;
  int depth_;
  std::size_t size_;
  // Lines and vertices together: pages are large only where they lie wholly within one array.
  std::vector<std::byte, LargePages<std::byte>> memory_;
  std::size_t vertices_at_;
  std::vector<std::uint32_t> faces_;
};

/// The 26-DOP of a line in the coordinates of the mesh; the line's is contained in it.
Dop26 dop_of(const SupportTree& tree, const SupportLine& line);

}  // namespace cchip::bvh

#endif
