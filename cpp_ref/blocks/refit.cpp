// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/refit.hpp>

namespace cchip::model {
namespace {

using bvh::directions;
using bvh::first_corner;
using bvh::first_face;
using bvh::NodeKind;

constexpr int fraction = 48;

/// floor(x / 2^n)
std::int64_t floor_shift(std::int64_t x, int n) {
  const std::int64_t unit = std::int64_t{1} << n;
  return x / unit - (x % unit < 0 ? 1 : 0);
}
std::int64_t ceil_shift(std::int64_t x, int n) { return -floor_shift(-x, n); }

/// Middle of the interval in 2^-18, to nearest, ties to even, as a field of 18 bits holds it.
std::int32_t origin_of(std::int64_t least, std::int64_t greatest) {
  constexpr int shift = fraction - 18 + 1;
  const std::int64_t twice = least + greatest;
  std::int64_t origin = floor_shift(twice, shift);
  const std::int64_t rest = twice - origin * (std::int64_t{1} << shift);
  const std::int64_t half = std::int64_t{1} << (shift - 1);
  if (rest > half || (rest == half && origin % 2 != 0)) ++origin;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(origin, -(1 << 17), (1 << 17) - 1));
}

class Refit {
 public:
  Refit(std::vector<Line>& image, const RefitCommand& command, int levels)
      : image_(image), command_(command), levels_(levels) {}

  /// Children first; the bounds of what lies below `line` are valid while the code is OK.
  RefitBounds visit(std::uint32_t line, NodeKind kind, int level) {
    RefitBounds bounds;
    result_.line = line;
    if (result_.lines + 1 >= command_.lines) return fail(RefitCode::visits);
    ++result_.lines;
    if (kind != NodeKind::inner) {
      const bvh::LeafLine leaf = bvh::decode_leaf(image_[line], kind);
      if (leaf.extent > bvh::extent_max) return fail(RefitCode::leaf);
      return leaf_bounds(leaf, kind);
    }
    if (level == levels_) return fail(RefitCode::depth);
    bvh::InnerLine node = bvh::decode_inner(image_[line]);
    const auto count = static_cast<std::uint32_t>(node.children);
    if (node.first <= line || node.first + count > command_.lines) return fail(RefitCode::outside);
    std::vector<RefitBounds> children;
    for (std::uint32_t i = 0; i < count; ++i) {
      children.push_back(visit(node.first + i, node.kind[i], level + 1));
      if (result_.code != RefitCode::ok) return bounds;
    }
    result_.line = line;
    if (!set_volumes(node, children)) return fail(RefitCode::range);
    image_[line] = bvh::encode(node);
    bounds = children.front();
    for (const RefitBounds& child : children) {
      for (std::size_t d = 0; d < directions.size(); ++d) {
        bounds.least[d] = std::min(bounds.least[d], child.least[d]);
        bounds.greatest[d] = std::max(bounds.greatest[d], child.greatest[d]);
      }
    }
    return bounds;
  }

  const RefitResult& result() const { return result_; }

 private:
  RefitBounds fail(RefitCode code) {
    result_.code = code;
    return {};
  }

  std::vector<Line>& image_;
  RefitCommand command_;
  int levels_;
  RefitResult result_;
};

}  // namespace

RefitBounds leaf_bounds(const bvh::LeafLine& leaf, NodeKind kind) {
  const int step = fraction + bvh::leaf_step(kind, leaf.extent);
  RefitBounds bounds;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    std::int64_t margin = 0;
    if (leaf.rounded) {
      for (const int component : directions[d]) margin += component == 0 ? 0 : std::int64_t{1} << (step - 1);
    }
    for (std::size_t v = 0; v < bvh::vertices_in(kind); ++v) {
      std::int64_t position = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        position += directions[d][i] * (std::int64_t{leaf.origin[i]} * (1 << (fraction - 24)) +
                                        leaf.vertex[v][i] * (std::int64_t{1} << step));
      }
      if (v == 0 || position - margin < bounds.least[d]) bounds.least[d] = position - margin;
      if (v == 0 || position + margin > bounds.greatest[d]) bounds.greatest[d] = position + margin;
    }
  }
  return bounds;
}

bool set_volumes(bvh::InnerLine& node, const std::vector<RefitBounds>& children) {
  RefitBounds whole = children.front();
  for (const RefitBounds& child : children) {
    for (std::size_t i = 0; i < 3; ++i) {
      whole.least[i] = std::min(whole.least[i], child.least[i]);
      whole.greatest[i] = std::max(whole.greatest[i], child.greatest[i]);
    }
  }
  std::array<std::int64_t, 3> origin{};
  for (std::size_t i = 0; i < 3; ++i) {
    node.origin[i] = origin_of(whole.least[i], whole.greatest[i]);
    origin[i] = std::int64_t{node.origin[i]} * (std::int64_t{1} << (fraction - 18));
  }
  const auto fits = [&] {
    for (std::size_t i = 0; i < 3; ++i) {
      const int unit = fraction - 24 + node.step;
      if (floor_shift(whole.least[i] - origin[i], unit) < bvh::box_least) return false;
      if (ceil_shift(whole.greatest[i] - origin[i], unit) > bvh::box_most) return false;
    }
    return true;
  };
  node.step = 0;
  while (!fits()) {
    if (node.step == bvh::step_max) return false;
    ++node.step;
  }
  node.child = {};
  const int unit = fraction - 24 + node.step;
  for (std::size_t n = 0; n < children.size(); ++n) {
    bvh::ChildVolume& child = node.child[n];
    for (std::size_t i = 0; i < 3; ++i) {
      child.least[i] = static_cast<int>(floor_shift(children[n].least[i] - origin[i], unit));
      child.greatest[i] =
          std::max(static_cast<int>(ceil_shift(children[n].greatest[i] - origin[i], unit)), bvh::box_least + 1);
    }
    for (std::size_t d = first_face; d < directions.size(); ++d) {
      std::int64_t upper = 0;
      std::int64_t lower = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const int sign = directions[d][i];
        const std::int64_t least = origin[i] + child.least[i] * (std::int64_t{1} << unit);
        const std::int64_t greatest = origin[i] + child.greatest[i] * (std::int64_t{1} << unit);
        upper += sign * (sign > 0 ? greatest : least);
        lower += sign * (sign > 0 ? least : greatest);
      }
      const int cut_unit = unit - 1 + node.cut_exponent + (d >= first_corner ? 1 : 0);
      const auto cut = [cut_unit](std::int64_t length) {
        return static_cast<int>(std::clamp<std::int64_t>(floor_shift(length, cut_unit), 0, 7));
      };
      child.cut[d - first_face] = {cut(upper - children[n].greatest[d]), cut(children[n].least[d] - lower)};
    }
  }
  return true;
}

RefitResult refit_image(std::vector<Line>& image, const RefitCommand& command, int levels) {
  if (command.lines > (1U << 24U) || command.root == 0 || command.root >= command.lines) {
    RefitResult result;
    result.code = RefitCode::command;
    return result;
  }
  Refit refit(image, command, levels);
  refit.visit(command.root, NodeKind::inner, 0);
  return refit.result();
}

}  // namespace cchip::model
