// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/image/image.hpp>
#include <cmath>
#include <optional>
#include <string>

#include "tree/rounding.hpp"

namespace cchip::bvh {
namespace {

constexpr int unit_bits = 24;  // boxes are computed in 2^-24 of the object's unit

struct Frame {
  Vec3d centre = Vec3d::Zero();
  Dop26 centre_dop;  // of the centre alone
  int exponent = 0;
};

Frame frame_of(const Dop26& object) {
  Frame frame;
  double half = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = object.least[i] + (object.greatest[i] - object.least[i]) / 2;
    frame.centre[static_cast<Eigen::Index>(i)] = middle;
    half = std::max({half, sum_up(object.greatest[i], -middle), sum_up(middle, -object.least[i])});
  }
  frame.centre_dop = make_dop26(frame.centre);
  if (half == 0) return frame;  // a single point has no size
  // The least exponent for which half <= (1/2 - 2^-24) 2^exponent; at least -1000, so that a step of a leaf is a
  // double.
  frame.exponent = std::max(std::ilogb(half) + 1, -1000);
  while (half > std::ldexp(0.5 - 0x1p-24, frame.exponent)) ++frame.exponent;
  return frame;
}

/// Bounds in the object's frame, in 2^-24, each exact or outward.
Dop26 in_frame(const Dop26& dop, const Frame& frame) {
  Dop26 result;
  const int exponent = unit_bits - frame.exponent;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    result.least[d] = scale_down(sum_down(dop.least[d], -frame.centre_dop.greatest[d]), exponent);
    result.greatest[d] = scale_up(sum_up(dop.greatest[d], -frame.centre_dop.least[d]), exponent);
  }
  return result;
}

// --- inner nodes

/// Integer nearest to the middle of an interval in units of 2^unit, clamped to a signed field.
std::int32_t origin_of(double least, double greatest, int unit, const Field& field) {
  const double limit = std::ldexp(1.0, static_cast<int>(field.width) - 1);
  const double middle = std::nearbyint(std::ldexp(least / 2 + greatest / 2, -unit));
  return static_cast<std::int32_t>(std::clamp(middle, -limit, limit - 1));
}

constexpr int origin_unit = unit_bits - 18;  // 2^-18 in 2^-24

/// Box in steps, rounded outward: the box holds every vertex. False if it does not fit into the field.
/// A box that is flat at the least number becomes one step thick: the box test of bitstreams made before its terms had
/// 15 bits takes -1 times such a box for its opposite and separates what touches (CHANGELOG.md).
bool set_box(ChildVolume& child, const Dop26& dop, const InnerLine& node) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double origin = std::ldexp(node.origin[i], origin_unit);
    const double least = std::floor(scale_down(sum_down(dop.least[i], -origin), -node.step));
    const double greatest = std::ceil(scale_up(sum_up(dop.greatest[i], -origin), -node.step));
    if (least < box_least || greatest > box_most) return false;
    child.least[i] = static_cast<int>(least);
    child.greatest[i] = std::max(static_cast<int>(greatest), box_least + 1);
  }
  return true;
}

using Cuts = std::array<std::array<double, 2>, directions.size() - first_face>;

/// What could be cut off the corners of the box, in half steps, rounded down: a plane behind a vertex would lose it.
Cuts cuts_of(const ChildVolume& child, const Dop26& dop, const InnerLine& node) {
  Cuts cuts;
  for (std::size_t d = first_face; d < directions.size(); ++d) {
    std::int64_t upper = 0;  // corner of the box along d, in 2^-24: whole, less than 2^27
    std::int64_t lower = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const int sign = directions[d][i];
      const std::int64_t origin = std::int64_t{node.origin[i]} * (1 << origin_unit);
      upper += sign * (origin + std::int64_t{sign > 0 ? child.greatest[i] : child.least[i]} * (1 << node.step));
      lower += sign * (origin + std::int64_t{sign > 0 ? child.least[i] : child.greatest[i]} * (1 << node.step));
    }
    const auto half_steps = [&node](double length) { return std::max(0.0, scale_down(length, 1 - node.step)); };
    cuts[d - first_face] = {half_steps(sum_down(static_cast<double>(upper), -dop.greatest[d])),
                            half_steps(sum_down(dop.least[d], -static_cast<double>(lower)))};
  }
  return cuts;
}

/// Exponent of the unit of a direction's cuts, in half steps.
int cut_unit(std::size_t direction, int cut_exponent) {
  return direction < first_corner - first_face ? cut_exponent : cut_exponent + 1;
}

double stored_cut(double cut, int unit) { return std::min(7.0, std::floor(std::ldexp(cut, -unit))); }

/// What storing loses, relative to the cuts, squared.
double loss(const Cuts& cuts, int cut_exponent) {
  double lost = 0;
  double whole = 0;
  for (std::size_t d = 0; d < cuts.size(); ++d) {
    const int unit = cut_unit(d, cut_exponent);
    for (const double cut : cuts[d]) {
      const double difference = cut - std::ldexp(stored_cut(cut, unit), unit);
      lost += difference * difference;
      whole += cut * cut;
    }
  }
  return whole > 0 ? lost / whole : 0;
}

/// What a node says of its children, without their volumes.
InnerLine structure_line(const Tree& tree, const TreeNode& parent) {
  InnerLine node;
  node.first = parent.first + 1;
  node.children = parent.count;
  for (std::size_t i = 0; i < parent.count; ++i) node.kind[i] = tree.nodes[parent.first + i].kind;
  return node;
}

InnerLine inner_line(const Tree& tree, const TreeNode& parent, const Frame& frame) {
  InnerLine node = structure_line(tree, parent);
  const auto count = static_cast<std::size_t>(parent.count);
  const Dop26 whole = in_frame(parent.dop, frame);
  for (std::size_t i = 0; i < 3; ++i) {
    node.origin[i] = origin_of(whole.least[i], whole.greatest[i], origin_unit, inner_field::origin);
  }
  std::array<Dop26, 4> dops;
  for (std::size_t i = 0; i < count; ++i) {
    dops[i] = in_frame(tree.nodes[parent.first + i].dop, frame);
  }
  const auto fits = [&] {
    for (std::size_t i = 0; i < count; ++i) {
      if (!set_box(node.child[i], dops[i], node)) return false;
    }
    return true;
  };
  while (!fits()) ++node.step;  // ends at 18: half an object is 32 steps then, and the origin is off by half of 2^-18
  std::array<Cuts, 4> cuts;
  std::array<double, 2> losses = {};
  for (std::size_t i = 0; i < count; ++i) {
    cuts[i] = cuts_of(node.child[i], dops[i], node);
    for (int k = 2; k <= 3; ++k) losses[static_cast<std::size_t>(k - 2)] += loss(cuts[i], k);
  }
  node.cut_exponent = losses[1] < losses[0] ? 3 : 2;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t d = 0; d < cuts[i].size(); ++d) {
      for (std::size_t side = 0; side < 2; ++side) {
        node.child[i].cut[d][side] = static_cast<int>(stored_cut(cuts[i][d][side], cut_unit(d, node.cut_exponent)));
      }
    }
  }
  return node;
}

// --- leaves

struct Rounded {
  double steps = 0;  ///< from the leaf's origin
  bool exact = false;
};

/// (x - centre) 2^-exponent - origin in whole steps, to nearest: exactly at most half a step off.
Rounded round_vertex(double x, double centre, double origin, int step) {
  // x - centre is high + low without error, |low| at most half a unit in the last place of high. Every double that is
  // compared with it below is a whole number of half steps of fewer than 53 bits, so the sign of the last sum is exact.
  const double high = x - centre;
  const double low = sum_error(x, -centre);
  const auto excess = [&](double steps) {
    const double position = std::ldexp(steps, step) + std::ldexp(origin, step);
    return (high - position) + (sum_error(high, -position) + low);
  };
  Rounded r;
  r.steps = std::nearbyint(std::ldexp(high, -step) - origin);
  if (excess(r.steps + 0.5) > 0) r.steps += 1;
  if (excess(r.steps - 0.5) < 0) r.steps -= 1;
  r.exact = excess(r.steps) == 0;
  return r;
}

/// False if a vertex does not fit into its field.
bool set_vertices(LeafLine& leaf, NodeKind kind, const std::array<Vec3d, 6>& vertices, const Frame& frame) {
  const int step = leaf_step(kind, leaf.extent);
  const Field& field = kind == NodeKind::quad ? leaf_field::quad : leaf_field::triangle;
  const double limit = std::ldexp(1.0, static_cast<int>(field.width) - 1);
  leaf.rounded = false;
  for (std::size_t n = 0; n < vertices_in(kind); ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double origin = std::ldexp(leaf.origin[i], -unit_bits - step);
      const Rounded r = round_vertex(vertices[n][k], frame.centre[k], origin, step + frame.exponent);
      if (r.steps < -limit || r.steps >= limit) return false;
      leaf.vertex[n][i] = static_cast<std::int32_t>(r.steps);
      leaf.rounded = leaf.rounded || !r.exact;
    }
  }
  return true;
}

/// True if the quad, seen along the cross product of its diagonals, is clearly convex. Only then is it also canonical
/// (docs/develop/architecture.md) after a small change of its vertices, or warped.
bool clearly_convex(const Primitive& quad) {
  const Vec3d across = quad.v[2] - quad.v[0];
  const Vec3d normal = across.cross(quad.v[3] - quad.v[1]);
  const double margin = 0x1p-40 * normal.squaredNorm();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d edge = quad.v[(i + 1) % 4] - quad.v[i];
    const Vec3d next = quad.v[(i + 2) % 4] - quad.v[(i + 1) % 4];
    if (!(normal.dot(edge.cross(next)) > margin)) return false;
  }
  return true;
}

/// \param bounds of the leaf; those on the axes count
LeafLine leaf_line(const Mesh& mesh, const Tree& tree, const TreeNode& node, const Dop26& bounds, const Frame& frame) {
  LeafLine leaf;
  std::array<Vec3d, 6> vertices;
  std::size_t n = 0;
  for (std::size_t i = 0; i < node.count; ++i) {
    leaf.id[i] = tree.faces[node.first + i];
    const Primitive p = mesh.primitive(leaf.id[i]);
    for (std::size_t v = 0; v < p.vertex_count(); ++v) vertices[n++] = p.v[v];
    leaf.open = p.kind == Kind::quad && !clearly_convex(p);
  }
  const Dop26 whole = in_frame(bounds, frame);
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    leaf.origin[i] = origin_of(whole.least[i], whole.greatest[i], 0, leaf_field::origin);
    size = std::max({size, whole.greatest[i] - leaf.origin[i], leaf.origin[i] - whole.least[i]});
  }
  leaf.extent = size > 1 ? std::ilogb(size) : 0;  // at most the least that fits, so one or two attempts
  while (!set_vertices(leaf, node.kind, vertices, frame)) ++leaf.extent;
  return leaf;
}

/// Bounds of a leaf on the three axes; 0 on the other directions.
Dop26 box_of(const Mesh& mesh, const Tree& tree, const TreeNode& leaf) {
  Dop26 box;
  for (std::size_t i = 0; i < leaf.count; ++i) {
    const Primitive p = mesh.primitive(tree.faces[leaf.first + i]);
    for (std::size_t v = 0; v < p.vertex_count(); ++v) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = p.v[v][static_cast<Eigen::Index>(k)];
        const bool is_first = i == 0 && v == 0;
        box.least[k] = is_first ? x : std::min(box.least[k], x);
        box.greatest[k] = is_first ? x : std::max(box.greatest[k], x);
      }
    }
  }
  return box;
}

/// An image.
/// \param inner, leaf  make the line of a node
template <class Inner, class Leaf>
Image make_lines(const Tree& tree, const Frame& frame, const Inner& inner, const Leaf& leaf) {
  HeaderLine header;
  header.exponent = frame.exponent;
  header.centre = frame.centre;
  header.lines = static_cast<std::uint32_t>(tree.nodes.size() + 1);
  header.depth = tree.depth;
  Image image;
  image.lines.reserve(header.lines);
  image.lines.emplace_back();
  for (const TreeNode& node : tree.nodes) {
    if (node.kind == NodeKind::inner) {
      ++header.inner;
      image.lines.push_back(encode(inner(node)));
      continue;
    }
    ++header.leaves;
    (node.kind == NodeKind::quad ? header.quads : header.triangles) += node.count;
    image.lines.push_back(encode(leaf(node), node.kind));
  }
  header.has_triangles = header.triangles > 0;
  header.has_quads = header.quads > 0;
  image.lines.front() = encode(header);
  header.crc = image_crc(image);
  image.lines.front() = encode(header);
  return image;
}

void check_lines(const Mesh& mesh, const Tree& tree) {
  constexpr std::size_t most = std::size_t{1} << inner_field::first.width;
  if (tree.nodes.size() + 1 <= most) return;
  throw std::invalid_argument("mesh " + mesh.name + ": its image has " + std::to_string(tree.nodes.size() + 1) +
                              " lines, " + std::to_string(most) + " are possible; cut it into objects");
}

}  // namespace

std::uint32_t image_crc(const Image& image) {
  constexpr std::size_t from = header_field::crc.end() / 8;
  return crc32(image.lines.front().data() + from, image.lines.size() * line_bytes - from);
}

Image make_image(const Mesh& mesh, const Tree& tree) {
  check_lines(mesh, tree);
  const Frame frame = frame_of(tree.nodes.front().dop);
  return make_lines(
      tree, frame, [&](const TreeNode& node) { return inner_line(tree, node, frame); },
      [&](const TreeNode& node) { return leaf_line(mesh, tree, node, node.dop, frame); });
}

Image make_leaves(const Mesh& mesh, const Tree& topology) {
  check_lines(mesh, topology);
  std::optional<Dop26> whole;
  for (const TreeNode& node : topology.nodes) {
    if (node.kind == NodeKind::inner) continue;
    const Dop26 box = box_of(mesh, topology, node);
    whole = whole ? enclose(*whole, box) : box;
  }
  const Frame frame = frame_of(*whole);
  return make_lines(
      topology, frame, [&](const TreeNode& node) { return structure_line(topology, node); },
      [&](const TreeNode& node) { return leaf_line(mesh, topology, node, box_of(mesh, topology, node), frame); });
}

Bytes to_bytes(const Image& image) {
  Bytes bytes;
  bytes.reserve(image.lines.size() * line_bytes);
  for (const Line& line : image.lines) bytes.insert(bytes.end(), line.begin(), line.end());
  return bytes;
}

}  // namespace cchip::bvh
