// SPDX-License-Identifier: Apache-2.0
#include "behind_plane.hpp"

#include "exact/ieee.hpp"

namespace cchip {

// For a point x and the plane's point p, m . (x - p) = m . (x - c) - m . (p - c) with the centre c. Every magnitude
// that is added up for it is at most |m|_1 extent. With u = 2^-53, the components of m are off by 8u of the greatest
// one, the factors of a reach, their products and sums by 8u, the product with p - c by 6u: less than 32u in all.
BehindPlane::BehindPlane(const TreeSide& side, const exact::HalfSpace& space)
    : side_(side), space_(space), reach_(space.normal(), side.tree.unit()) {
  const Vec3d normal = space.normal();
  const Vec3d& centre = side.tree.centre();
  const double extent = centre.cwiseAbs().maxCoeff() + 2 * bvh::support_most * side.tree.unit();
  const double slack = 128 * 0x1p-53 * (normal.cwiseAbs().sum() * extent);
  const bool is_moderate = extent > 0x1p-200 && extent < 0x1p200;
  limit_ = is_moderate ? normal.dot(space.through() - centre) - slack : -std::numeric_limits<double>::infinity();
}

bool BehindPlane::contains_line(const bvh::SupportLine& line) {
  return reach_.along(line) < limit_ || contains(line.ref());
}

bool BehindPlane::contains_all() {
  // Vertices that no face uses may be anywhere.
  return space_.contains(side_.mesh.vertices) || contains(side_.tree.root());
}

bool BehindPlane::contains(bvh::NodeRef node) {
  const auto known = known_.find(node.bits());
  if (known != known_.end()) return known->second;
  bool all = true;
  for (std::uint32_t i = node.first(); i < node.first() + node.count() && all; ++i) {
    all = node.is_leaf() ? space_.contains(side_.mesh.primitive(side_.tree.faces()[i]))
                         : contains_line(side_.tree.lines()[i]);
  }
  known_.emplace(node.bits(), all);
  return all;
}

}  // namespace cchip
