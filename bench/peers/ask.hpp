// SPDX-License-Identifier: Apache-2.0
/// \file
/// Our CPU device and FCL asked the same, and exact integers where they differ.
#ifndef CCHIP_BENCH_ASK_HPP
#define CCHIP_BENCH_ASK_HPP

#include <algorithm>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "mesh_pairs.hpp"
#include "peer_library.hpp"

namespace cchip::testing {

inline constexpr CollisionRequest all_contacts = {CollisionRequest::Contacts::all};

/// What is left of two answers to the same query once exact integers have decided about every pair of faces that only
/// one of them names.
struct Difference {
  std::size_t asked = 0;        ///< pairs of faces that were decided
  std::size_t unexplained = 0;  ///< those of them, or queries, in which our answer is not the exact one
  Difference& operator+=(const Difference& x) {
    asked += x.asked;
    unexplained += x.unexplained;
    return *this;
  }
};

/// One pair of meshes for both libraries.
struct Bodies {
  Bodies(MeshPair meshes, const PeerLibrary& debian)
      : name(meshes.name),
        counts(meshes.counts),
        a(std::move(meshes.a)),
        b(std::move(meshes.b)),
        fcl_a(debian.mesh(a.mesh())),
        fcl_b(debian.mesh(b.mesh())) {}

  bool exact(const Contact& faces, const PosePair& poses) const {
    return exact_intersects(a.mesh().primitive(faces.face_a), poses.a, b.mesh().primitive(faces.face_b), poses.b);
  }

  /// Judges our yes or no where it is not FCL's. `witness`: a contact that we name, if our answer is yes.
  Difference judge(const PosePair& poses, bool our_hit, const Contact& witness) const {
    if (our_hit) return {1, exact(witness, poses) ? 0U : 1U};
    // Every contact of FCL's must be none. It may name none now, if it said otherwise before.
    return judge(poses, {}, fcl_a.contacts(poses.a, fcl_b, poses.b));
  }

  /// Judges our contacts where they are not FCL's. Both are in ascending order.
  Difference judge(const PosePair& poses, const std::vector<Contact>& ours, const std::vector<Contact>& theirs) const {
    std::vector<Contact> only_ours;
    std::vector<Contact> only_theirs;
    std::set_difference(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(only_ours));
    std::set_difference(theirs.begin(), theirs.end(), ours.begin(), ours.end(), std::back_inserter(only_theirs));
    Difference result;
    result.asked = only_ours.size() + only_theirs.size();
    for (const Contact& faces : only_ours) result.unexplained += exact(faces, poses) ? 0U : 1U;
    for (const Contact& faces : only_theirs) result.unexplained += exact(faces, poses) ? 1U : 0U;
    return result;
  }

  std::string name;
  bool counts;
  Object a;
  Object b;
  PeerMesh fcl_a;
  PeerMesh fcl_b;
};

}  // namespace cchip::testing

#endif
