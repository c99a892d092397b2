// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/image/image_line.hpp>
#include <cstring>
#include <functional>

namespace cchip::bvh {

Line encode(const HeaderLine& header) {
  namespace f = header_field;
  Line line = {};
  put(line, f::magic, header.magic);
  put(line, f::crc, header.crc);
  put(line, f::version, header.version);
  put(line, f::exponent, header.exponent);
  put(line, f::lines, header.lines);
  put(line, f::root, header.root);
  put(line, f::depth, header.depth);
  put(line, f::kinds, (header.has_triangles ? 1 : 0) | (header.has_quads ? 2 : 0));
  put(line, f::triangles, header.triangles);
  put(line, f::quads, header.quads);
  put(line, f::inner, header.inner);
  put(line, f::leaves, header.leaves);
  for (std::size_t i = 0; i < 3; ++i) {
    std::int64_t bits = 0;
    std::memcpy(&bits, &header.centre[static_cast<Eigen::Index>(i)], sizeof bits);
    put(line, f::centre, bits, i);
  }
  return line;
}

HeaderLine decode_header(const Line& line) {
  namespace f = header_field;
  const auto word = [&line](const Field& field) { return static_cast<std::uint32_t>(get(line, field)); };
  HeaderLine header;
  header.magic = word(f::magic);
  header.crc = word(f::crc);
  header.version = static_cast<std::uint16_t>(word(f::version));
  header.exponent = static_cast<int>(get(line, f::exponent));
  header.lines = word(f::lines);
  header.root = word(f::root);
  header.depth = static_cast<int>(word(f::depth));
  header.has_triangles = (word(f::kinds) & 1U) != 0;
  header.has_quads = (word(f::kinds) & 2U) != 0;
  header.triangles = word(f::triangles);
  header.quads = word(f::quads);
  header.inner = word(f::inner);
  header.leaves = word(f::leaves);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t bits = get(line, f::centre, i);
    std::memcpy(&header.centre[static_cast<Eigen::Index>(i)], &bits, sizeof bits);
  }
  return header;
}

Line encode(const InnerLine& node) {
  namespace f = inner_field;
  namespace c = child_field;
  Line line = {};
  for (std::size_t i = 0; i < 3; ++i) put(line, f::origin, node.origin[i], i);
  put(line, f::step, node.step);
  put(line, f::first, node.first);
  put(line, f::children, node.children - 1);
  put(line, f::cut_exponent, node.cut_exponent - 2);
  for (std::size_t n = 0; n < node.child.size(); ++n) {
    const ChildVolume& child = node.child[n];
    const std::size_t base = f::child.lsb + n * f::child.width;
    put(line, f::kind, static_cast<int>(node.kind[n]), n);
    for (std::size_t i = 0; i < 3; ++i) {
      put(line, c::box, child.least[i], 2 * i, base);
      put(line, c::box, child.greatest[i], 2 * i + 1, base);
    }
    for (std::size_t i = 0; i < c::face_cut.count; ++i) put(line, c::face_cut, child.cut[i / 2][i % 2], i, base);
    for (std::size_t i = 0; i < c::corner_cut.count; ++i) {
      put(line, c::corner_cut, child.cut[first_corner - first_face + i / 2][i % 2], i, base);
    }
  }
  return line;
}

bool has_inverted_box(const InnerLine& node) {
  return std::any_of(node.child.begin(), node.child.end(), [](const ChildVolume& child) {
    return !std::equal(child.least.begin(), child.least.end(), child.greatest.begin(), std::less_equal<>());
  });
}

InnerLine decode_inner(const Line& line) {
  namespace f = inner_field;
  namespace c = child_field;
  InnerLine node;
  for (std::size_t i = 0; i < 3; ++i) node.origin[i] = static_cast<std::int32_t>(get(line, f::origin, i));
  node.step = static_cast<int>(get(line, f::step));
  node.first = static_cast<std::uint32_t>(get(line, f::first));
  node.children = static_cast<int>(get(line, f::children)) + 1;
  node.cut_exponent = static_cast<int>(get(line, f::cut_exponent)) + 2;
  for (std::size_t n = 0; n < node.child.size(); ++n) {
    ChildVolume& child = node.child[n];
    const std::size_t base = f::child.lsb + n * f::child.width;
    node.kind[n] = static_cast<NodeKind>(get(line, f::kind, n));
    for (std::size_t i = 0; i < 3; ++i) {
      child.least[i] = static_cast<int>(get(line, c::box, 2 * i, base));
      child.greatest[i] = static_cast<int>(get(line, c::box, 2 * i + 1, base));
    }
    for (std::size_t i = 0; i < c::face_cut.count; ++i) {
      child.cut[i / 2][i % 2] = static_cast<int>(get(line, c::face_cut, i, base));
    }
    for (std::size_t i = 0; i < c::corner_cut.count; ++i) {
      child.cut[first_corner - first_face + i / 2][i % 2] = static_cast<int>(get(line, c::corner_cut, i, base));
    }
  }
  return node;
}

Line encode(const LeafLine& leaf, NodeKind kind) {
  namespace f = leaf_field;
  const Field& vertex = kind == NodeKind::quad ? f::quad : f::triangle;
  Line line = {};
  for (std::size_t i = 0; i < 3; ++i) put(line, f::origin, leaf.origin[i], i);
  put(line, f::extent, leaf.extent);
  put(line, f::rounded, leaf.rounded ? 1 : 0);
  put(line, f::open, leaf.open ? 1 : 0);
  for (std::size_t i = 0; i < primitives_in(kind); ++i) put(line, f::id, leaf.id[i], i);
  for (std::size_t i = 0; i < 3 * vertices_in(kind); ++i) put(line, vertex, leaf.vertex[i / 3][i % 3], i);
  return line;
}

LeafLine decode_leaf(const Line& line, NodeKind kind) {
  namespace f = leaf_field;
  const Field& vertex = kind == NodeKind::quad ? f::quad : f::triangle;
  LeafLine leaf;
  for (std::size_t i = 0; i < 3; ++i) leaf.origin[i] = static_cast<std::int32_t>(get(line, f::origin, i));
  leaf.extent = static_cast<int>(get(line, f::extent));
  leaf.rounded = get(line, f::rounded) != 0;
  leaf.open = get(line, f::open) != 0;
  for (std::size_t i = 0; i < primitives_in(kind); ++i) leaf.id[i] = static_cast<std::uint32_t>(get(line, f::id, i));
  for (std::size_t i = 0; i < 3 * vertices_in(kind); ++i) {
    leaf.vertex[i / 3][i % 3] = static_cast<std::int32_t>(get(line, vertex, i));
  }
  return leaf;
}

}  // namespace cchip::bvh
