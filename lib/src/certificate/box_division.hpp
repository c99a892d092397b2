// SPDX-License-Identifier: Apache-2.0
/// \file
/// Sets of faces by the trees that certificates cite, and directions that may part two of them.
#ifndef CCHIP_CERTIFICATE_BOX_DIVISION_HPP
#define CCHIP_CERTIFICATE_BOX_DIVISION_HPP

#include <Eigen/Core>
#include <array>
#include <cchip/certificate_tree.hpp>
#include <cchip/check.hpp>
#include <optional>
#include <vector>

namespace cchip {

/// Of two meshes in their poses. Lengths of the world are in a unit of its own, a power of two, in which none is much
/// above 1.
class BoxDivision {
 public:
  /// Boxes of a hull by their middles and halves, in coordinates of the mesh; vertices are boxes of no size.
  using Hull = std::vector<std::array<Vec3d, 2>>;
  /// A set with its box: centre in the world, halves of its sides in coordinates of the mesh.
  struct Node {
    CertificateTree::Set set;
    Vec3d centre, half;
    double size = 0;
    mutable Hull hull = {};  ///< made when it is asked for
  };
  struct Proposal {
    std::vector<Digits> direction;
    bool is_certain = false;  ///< it parts them as the claim wants; else that has to be checked
  };

  /// Keeps references.
  /// \param along of the claim, if it is of a translation
  BoxDivision(const std::array<const CertificateTree*, 2>& trees, const std::array<const Pose*, 2>& poses,
              double within, const std::optional<Vec3d>& along);

  Node root(std::size_t side) const { return node(side, trees_[side]->all()); }
  Node first_half(std::size_t side, const Node& n) const { return node(side, n.set.first_half()); }
  Node second_half(std::size_t side, const Node& n) const { return node(side, n.set.second_half()); }
  std::uint32_t split_at(std::size_t /*side*/, const Node& /*n*/) const { return 0; }  // the tree says it
  bool is_single(std::size_t /*side*/, const Node& n) const { return n.set.size() == 1; }
  std::uint32_t face(std::size_t side, const Node& n) const { return trees_[side]->order()[n.set.begin]; }
  double size(std::size_t /*side*/, const Node& n) const { return n.size; }
  certificate_check::Faces faces(std::size_t side, const Node& n) const;

  /// Calls `accept` with directions that part the sets, or may. \returns whether one was accepted
  template <class Accept>
  bool propose(const Node& a, const Node& b, const Accept& accept) const {
    const Proposal by_boxes = part_boxes(a, b);
    if (!by_boxes.direction.empty() && accept(by_boxes)) return true;
    for (const Proposal& proposal : part_hulls(a, b)) {
      if (accept(proposal)) return true;
    }
    return false;
  }

 private:
  static constexpr Eigen::Index count = 16;  ///< 3 and 3 normals of boxes, 9 products of their edges, one again
  using Lanes = Eigen::Array<double, count, 1>;
  static bool is_small(const Node& n) { return n.set.size() <= CertificateTree::most_faces_without_box; }
  CertificateTree::Box box_of(std::size_t side, const CertificateTree::Set& set) const;
  Node node(std::size_t side, const CertificateTree::Set& set) const;
  void make_directions();
  /// That of the greatest gap.
  Proposal part_boxes(const Node& a, const Node& b) const;
  std::vector<Proposal> part_hulls(const Node& a, const Node& b) const;
  const Hull& hull(std::size_t side, const Node& n) const;
  /// The point of the hull that is farthest along a direction, in the world.
  Vec3d extreme(std::size_t side, const Hull& hull, const Vec3d& direction) const;
  /// Appends a proposal if the direction, or the opposite one, parts the hulls, or may.
  void part_along(const Vec3d& direction, const Hull& a, const Hull& b, std::vector<Proposal>& found) const;
  /// Above the rounding of a gap along a direction: sums of some ten products, each off by a few 2^-53 of its size.
  double margin(const Vec3d& direction) const { return 0x1p-44 * direction.lpNorm<1>() * scale_; }
  /// The sign of the direction's value on the claim's translation.
  int rise(const Vec3d& direction) const;

  std::array<const CertificateTree*, 2> trees_;
  std::array<Eigen::Matrix3d, 2> linear_;
  std::array<Vec3d, 2> shift_;
  double within_;
  std::optional<certificate_check::Point> along_;
  double scale_ = 0;  ///< no coordinate of either side is greater, and no sum of products that makes one
  std::array<Vec3d, count> direction_;                          ///< of integers
  std::array<std::array<std::vector<Digits>, 2>, count> text_;  ///< of each and its opposite
  std::array<std::array<bool, 2>, count> may_rise_;
  std::array<Lanes, 3> components_;
  std::array<std::array<Lanes, 3>, 2> reach_;
  Lanes least_, margins_, lengths_;
};

/// The order of a tree for certificates: sets are halved at the median of the middles of their faces, along the longest
/// side of their box.
std::vector<std::uint32_t> certificate_order(const Mesh& mesh);

}  // namespace cchip

#endif
