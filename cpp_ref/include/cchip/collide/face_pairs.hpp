// SPDX-License-Identifier: Apache-2.0
/// \file
/// From candidate pairs of faces to the result of a query: what every device does with the leaves that it reaches.
#ifndef CCHIP_COLLIDE_FACE_PAIRS_HPP
#define CCHIP_COLLIDE_FACE_PAIRS_HPP

#include <cchip/collide/collide.hpp>
#include <cchip/exact/posed_pairs.hpp>
#include <cstddef>
#include <set>
#include <vector>

namespace cchip {

/// Tests pairs of faces of one query exactly and gathers its result. The objects must outlive it.
class FacePairs {
 public:
  /// \throws std::invalid_argument as check_query()
  FacePairs(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b, const CollisionRequest& request);

  /// Tests a face of A against a face of B, by their numbers in the meshes.
  void test(std::uint32_t face_a, std::uint32_t face_b);
  /// Records a face of A and a face of B that are known to touch; counts nothing.
  void add(std::uint32_t face_a, std::uint32_t face_b);
  /// True once the request is fulfilled: no pair needs to be tested any more.
  bool done() const { return done_; }

  /// What the search cost; test() counts `pairs` and `open`.
  CollisionCounts& counts() { return result_.counts; }
  /// The result of what was tested. Call it once, at the end.
  CollisionResult take();

 private:
  const Mesh& mesh_a_;
  const Mesh& mesh_b_;
  PosedPairs pairs_;
  CollisionRequest request_;
  CollisionResult result_;
  bool cut_;                    ///< some faces of a file are several faces of a mesh, so contacts may repeat
  std::set<Contact> contacts_;  ///< in use if cut_
  bool done_ = false;
};

/// \throws std::invalid_argument an entry of a pose is not finite or beyond 2^500 in magnitude, or the request wants
///         all contacts but at most 0 of them; one line
void check_query(const Pose& pose_a, const Pose& pose_b, const CollisionRequest& request);

}  // namespace cchip

#endif
