// SPDX-License-Identifier: Apache-2.0
/// \file
/// From candidate pairs of faces to the result of a query: what every device does with the leaves that it reaches.
#ifndef CCHIP_INTERNAL_JUDGE_FACE_PAIRS_HPP
#define CCHIP_INTERNAL_JUDGE_FACE_PAIRS_HPP

#include <array>
#include <cchip/collide.hpp>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cstddef>
#include <optional>
#include <vector>

namespace cchip {

/// Tests pairs of faces of one query exactly and gathers its result. Keeps its memory from query to query.
class FacePairs {
 public:
  /// Begins a query: empties the result, which the other calls fill. All of what is named must outlive them.
  /// \pre check_query() accepts it
  void start(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result);

  /// The result of a query whose objects are known to be apart, with counts of 0. Takes the place of the other calls.
  static void answer_apart(const CollisionRequest& request, CollisionResult& result);

  /// Tests a face of A against a face of B, by their numbers in the meshes.
  void test(std::uint32_t face_a, std::uint32_t face_b);
  /// Records a face of A and a face of B that are known to cross; counts nothing.
  void add(std::uint32_t face_a, std::uint32_t face_b) { add(face_a, face_b, Relation::crossing); }
  /// Calls `visit(face_a, face_b)` for the query's hint, with numbers in the meshes, until the request is fulfilled:
  /// for no pair if there is no hint, all contacts are wanted, or the meshes have no such faces.
  template <class Visit>
  void visit_hint(const Visit& visit) {
    if (query_.hint.face_a == CollisionHint::none || request_.contacts != CollisionRequest::Contacts::first) return;
    const Parts a = parts_of(*query_.a, query_.hint.face_a);
    const Parts b = parts_of(*query_.b, query_.hint.face_b);
    for (std::size_t i = 0; i < a.count; ++i) {
      for (std::size_t k = 0; k < b.count && !done_; ++k) visit(a.face[i], b.face[k]);
    }
  }
  /// True once the request is fulfilled: no pair needs to be tested any more.
  bool done() const { return done_; }

  /// What the search cost; test() counts `pairs` and `open`.
  CollisionStats& stats() { return result_->stats; }
  /// Completes the result. Call it once, at the end.
  void finish();

 private:
  /// Faces of a mesh that a face of the file was cut into: the first few, as a test of all those of two large polygons
  /// would cost more than a search.
  struct Parts {
    std::array<std::uint32_t, 4> face;
    std::size_t count;
  };
  static Parts parts_of(const Object& object, std::uint32_t face);

  void add(std::uint32_t face_a, std::uint32_t face_b, Relation relation);
  /// Exactly, and counts it.
  Relation relate(std::uint32_t face_a, std::uint32_t face_b);
  void relate_all_parts(Contact& contact);
  /// Where the table has the contact's place, or none yet.
  std::uint32_t& entry_of(const Contact& contact);
  void grow_table();

  CollisionQuery query_;
  CollisionRequest request_;
  CollisionResult* result_ = nullptr;
  std::size_t most_ = 1;
  bool done_ = false;
  Relation seen_ = Relation::apart;   ///< the greatest of a pair so far
  bool cut_ = false;                  ///< some faces of a file are several of a mesh, so contacts may repeat
  std::vector<std::uint32_t> table_;  ///< of contacts by their faces, open addressing: place in the result and 1, or 0
  std::optional<PosedPairs> pairs_;   ///< made when it is needed first
  std::optional<PosedDistances> distances_;  ///< the same, for requests within a distance
};

/// \param name of the object, for the message: "A"
/// \throws std::invalid_argument an entry of the pose is not finite or beyond 2^500 in magnitude; one line
void check_pose(const Pose& pose, const char* name);
/// \throws std::invalid_argument an entry of a pose is not finite or beyond 2^500 in magnitude, or the request wants
///         at most 0 contacts, or those within a distance that is negative or not finite, or their relations as well;
///         one line
void check_query(const Pose& pose_a, const Pose& pose_b, const CollisionRequest& request);
/// \throws std::invalid_argument as above, or a pointer of the query is null, or an object was moved from; one line
void check_query(const CollisionQuery& query, const CollisionRequest& request);

}  // namespace cchip

#endif
