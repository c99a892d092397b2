// SPDX-License-Identifier: Apache-2.0
/// \file
/// 26-DOPs of two objects under two poses, made comparable.
#ifndef CCHIP_SEARCH_DOP_PAIRS_HPP
#define CCHIP_SEARCH_DOP_PAIRS_HPP

#include <array>
#include <cchip/internal/tree/dop26.hpp>
#include <cchip/object.hpp>
#include <cchip/pose.hpp>
#include <cstdint>
#include <optional>

namespace cchip {

/// Bounds of a 26-DOP on the directions of another one.
class Realignment {
 public:
  using Directions = Eigen::Matrix<double, 3, bvh::directions.size()>;
  using Row = Eigen::Matrix<double, 1, bvh::directions.size()>;

  /// Column d of `directions`, in the coordinates of the object, is direction d of the bounds. `offset` is added to
  /// both, `slack` moves them outward.
  Realignment(const Directions& directions, const Row& offset, const Row& slack);

  /// Bounds of the set along the directions, up to the rounding that the slack has to cover.
  bvh::Dop26 operator()(const bvh::Dop26& dop) const;

 private:
  /// support(direction) <= sum of factor * support(direction `at` of the 26), by at most three of them.
  struct Part {
    double factor = 0;
    std::uint8_t at = 0;        ///< along which the direction points
    std::uint8_t opposite = 0;  ///< against it
  };
  std::array<std::array<Part, 3>, bvh::directions.size()> parts_;
  std::array<double, bvh::directions.size()> low_ = {};
  std::array<double, bvh::directions.size()> high_ = {};
};

/// Compares volumes of A with volumes of B on 13 directions of the world. Which ones is free, so they are chosen such
/// that B, whose pose maps them to the directions of its own volumes, needs no work. If B's pose has no good inverse
/// they are the 13 directions themselves. Bounds are outward of the exact ones in spite of rounding, see
/// docs/cpp/exactness.md.
class DopPairs {
 public:
  /// \param within by so much the volumes of A grow to all sides
  DopPairs(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b, double within = 0);
  bvh::Dop26 volume_a(const bvh::Dop26& dop) const { return (*a_)(dop); }
  bvh::Dop26 volume_b(const bvh::Dop26& dop) const { return b_ ? (*b_)(dop) : dop; }

  /// The directions: a column for each, in the world. Bounds of volumes are of the products with these, those of A and
  /// of B relative to the translation of B's pose.
  const Realignment::Directions& world() const { return world_; }

  /// How deep the two overlap on the direction where they do so least, in a unit common to all; negative: disjoint.
  static double overlap(const bvh::Dop26& volume_a, const bvh::Dop26& volume_b);
  /// At most the distance in the world of what the two contain; at least 0.
  double gap(const bvh::Dop26& volume_a, const bvh::Dop26& volume_b) const;

 private:
  Realignment::Directions world_;
  std::optional<Realignment> a_;
  std::optional<Realignment> b_;  ///< none: the volumes of B stay as they are
  Realignment::Row length_;       ///< of the directions, at least
};

}  // namespace cchip

#endif
