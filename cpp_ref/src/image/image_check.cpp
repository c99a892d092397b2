// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/image/image.hpp>
#include <cmath>
#include <string>

namespace cchip::bvh {
namespace {

[[noreturn]] void fail(std::size_t line, const char* field, const std::string& what) {
  throw ImageError("image line " + std::to_string(line) + ", " + field + ": " + what);
}

void check_range(std::size_t line, const Field& field, std::int64_t value, std::int64_t least, std::int64_t most) {
  if (value >= least && value <= most) return;
  fail(line, field.name, std::to_string(value) + " is not in " + std::to_string(least) + ".." + std::to_string(most));
}

/// Decoding and encoding a line must give the same line: bits without a field, and the fields of absent children and
/// vertices, must be 0.
void check_reserved(std::size_t number, const Line& line, const Line& again) {
  if (line != again) fail(number, "reserved", "a bit that has no meaning here is not 0");
}

class Checker {
 public:
  explicit Checker(const Image& image) : image_(image), header_(image.header()) {}

  void check() {
    check_header();
    seen_.assign(image_.lines.size(), false);
    id_seen_.assign(std::size_t{header_.triangles} + header_.quads, false);
    check_tree();
    compare(header_field::depth, header_.depth, depth_);
    compare(header_field::inner, header_.inner, inner_);
    compare(header_field::leaves, header_.leaves, leaves_);
    compare(header_field::triangles, header_.triangles, triangles_);
    compare(header_field::quads, header_.quads, quads_);
    const auto unseen = std::find(seen_.begin() + 1, seen_.end(), false);
    if (unseen != seen_.end()) {
      fail(static_cast<std::size_t>(unseen - seen_.begin()), "line", "no node leads here");
    }
  }

 private:
  struct Visit {
    std::uint32_t line;
    NodeKind kind;
    int level;
  };

  void compare(const Field& field, std::int64_t said, std::int64_t counted) const {
    if (said != counted) {
      fail(0, field.name, "says " + std::to_string(said) + ", the tree has " + std::to_string(counted));
    }
  }

  void check_header() const {
    namespace f = header_field;
    if (header_.magic != image_magic) fail(0, f::magic.name, "this is no image of an object");
    if (header_.version != image_version) {
      fail(0, f::version.name,
           std::to_string(header_.version) + ", must be " + std::to_string(image_version) + "; build the image again");
    }
    compare(f::lines, header_.lines, static_cast<std::int64_t>(image_.lines.size()));
    if (header_.crc != image_crc(image_)) fail(0, f::crc.name, "does not match; the image is damaged");
    check_reserved(0, image_.lines[0], encode(header_));
    check_range(0, f::exponent, header_.exponent, -exponent_max, exponent_max);
    check_range(0, f::root, header_.root, 1, header_.lines - 1);
    check_range(0, f::depth, header_.depth, 2, tree_depth_max);
    // The counts decide how much is allocated, so they must be bounded by the size of the file.
    check_range(0, f::triangles, header_.triangles, 0, 2 * std::int64_t{header_.lines});
    check_range(0, f::quads, header_.quads, 0, header_.lines);
    if (header_.has_triangles != (header_.triangles > 0) || header_.has_quads != (header_.quads > 0)) {
      fail(0, f::kinds.name, "do not match the counts of triangles and quads");
    }
    if (!header_.centre.allFinite()) fail(0, f::centre.name, "is not finite");
  }

  void check_tree() {
    std::vector<Visit> open = {{header_.root, NodeKind::inner, 1}};
    seen_[header_.root] = true;
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      depth_ = std::max(depth_, visit.level);
      if (visit.kind != NodeKind::inner) {
        check_leaf(visit.line, visit.kind);
        continue;
      }
      const InnerLine node = check_inner(visit.line);
      if (visit.level >= tree_depth_max) {
        fail(visit.line, "depth", "more than " + std::to_string(tree_depth_max) + " levels");
      }
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(node.children); ++i) {
        const std::uint32_t child = node.first + i;
        if (seen_[child])
          fail(visit.line, inner_field::first.name, "line " + std::to_string(child) + " has two parents");
        seen_[child] = true;  // each line enters `open` once, so this ends
        open.push_back({child, node.kind[i], visit.level + 1});
      }
    }
  }

  InnerLine check_inner(std::uint32_t number) {
    namespace f = inner_field;
    ++inner_;
    const Line& line = image_.lines[number];
    const InnerLine node = decode_inner(line);
    check_range(number, f::step, node.step, 0, step_max);
    check_range(number, f::first, node.first, std::int64_t{number} + 1,
                static_cast<std::int64_t>(image_.lines.size()) - node.children);
    InnerLine used = node;
    for (auto i = static_cast<std::size_t>(node.children); i < node.child.size(); ++i) {
      used.kind[i] = NodeKind::inner;
      used.child[i] = {};
    }
    check_reserved(number, line, encode(used));
    for (std::size_t i = 0; i < static_cast<std::size_t>(node.children); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int greatest = node.child[i].greatest[axis];
        check_range(number, child_field::box, greatest, node.child[i].least[axis], box_most);
        if (greatest == box_least) {
          fail(number, child_field::box.name,
               "is flat at " + std::to_string(box_least) + ", which older chips get wrong; build the image again");
        }
      }
    }
    return node;
  }

  void check_leaf(std::uint32_t number, NodeKind kind) {
    namespace f = leaf_field;
    ++leaves_;
    const Line& line = image_.lines[number];
    const LeafLine leaf = decode_leaf(line, kind);
    check_reserved(number, line, encode(leaf, kind));
    check_range(number, f::extent, leaf.extent, 0, extent_max);
    if (leaf.open && kind != NodeKind::quad) fail(number, f::open.name, "is for quads");
    for (std::size_t i = 0; i < primitives_in(kind); ++i) {
      check_range(number, f::id, leaf.id[i], 0, static_cast<std::int64_t>(id_seen_.size()) - 1);
      if (id_seen_[leaf.id[i]]) fail(number, f::id.name, "face " + std::to_string(leaf.id[i]) + " is there twice");
      id_seen_[leaf.id[i]] = true;
    }
    (kind == NodeKind::quad ? quads_ : triangles_) += static_cast<std::int64_t>(primitives_in(kind));
  }

  const Image& image_;
  const HeaderLine header_;
  std::vector<bool> seen_;
  std::vector<bool> id_seen_;
  int depth_ = 0;
  std::int64_t inner_ = 0;
  std::int64_t leaves_ = 0;
  std::int64_t triangles_ = 0;
  std::int64_t quads_ = 0;
};

}  // namespace

Image parse_image(const Bytes& bytes) {
  constexpr std::size_t most = (std::size_t{1} << inner_field::first.width) * line_bytes;
  if (bytes.size() % line_bytes != 0 || bytes.size() < 3 * line_bytes || bytes.size() > most) {
    throw ImageError("image of " + std::to_string(bytes.size()) + " bytes: must be lines of 64 bytes, at least 3");
  }
  Image image;
  image.lines.resize(bytes.size() / line_bytes);
  for (std::size_t i = 0; i < image.lines.size(); ++i) {
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(i * line_bytes);
    std::copy(from, from + line_bytes, image.lines[i].begin());
  }
  Checker(image).check();
  return image;
}

}  // namespace cchip::bvh
