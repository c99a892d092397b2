// SPDX-License-Identifier: Apache-2.0
/// \file
/// Answers of a device against the expected contacts.
#ifndef CCHIP_TESTS_LIB_ANSWERS_HPP
#define CCHIP_TESTS_LIB_ANSWERS_HPP

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cchip/collide.hpp>
#include <cstdint>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace cchip::testing {

inline const CollisionRequest all = {CollisionRequest::Contacts::all};

inline std::string describe(const PosePair& poses) {
  std::ostringstream text;
  text.precision(17);
  text << poses.a.affine() << '\n' << poses.b.affine();
  return text.str();
}

/// The questions to a device and its answers.
struct Tally {
  std::uint64_t queries = 0;
  std::uint64_t hits = 0;
  CollisionStats stats;           ///< of the queries for all contacts
  std::uint64_t first_pairs = 0;  ///< tested by the queries for the first one
  std::array<std::uint64_t, 3> relations = {};

  void print(const Device& device) const {
    std::cout << device.name() << ": queries=" << queries << " hits=" << hits << " pairs=" << stats.pairs
              << " open=" << stats.open << '\n';
  }
};

/// What requests that tell touching from crossing must be answered with.
inline void check_relations(Device& device, const Object& a, const Object& b, const PosePair& poses,
                            const std::vector<Contact>& expected, Tally& tally) {
  std::vector<Contact> crossing;
  for (const Contact& x : expected) {
    if (x.relation == Relation::crossing) crossing.push_back(x);
  }
  const Relation relation = !crossing.empty()   ? Relation::crossing
                            : !expected.empty() ? Relation::touching
                                                : Relation::apart;
  ++tally.relations[static_cast<std::size_t>(relation)];
  for (const Relation least : {Relation::touching, Relation::crossing}) {
    CollisionRequest request;
    request.least = least;
    request.relation = least == Relation::touching;
    const std::vector<Contact>& wanted = request.relation ? expected : crossing;
    const CollisionResult first = collide(device, a, poses.a, b, poses.b, request);
    request.contacts = CollisionRequest::Contacts::all;
    const CollisionResult found = collide(device, a, poses.a, b, poses.b, request);
    const bool all_right = found.hit == !wanted.empty() && found.relation == relation && found.contacts == wanted;
    // One that crosses if there is one.
    const bool first_right = first.hit == found.hit && first.relation == relation &&
                             first.contacts.size() == (found.hit ? 1 : 0) &&
                             (!found.hit || (first.contacts[0].relation == relation &&
                                             std::binary_search(wanted.begin(), wanted.end(), first.contacts[0])));
    if (all_right && first_right) continue;
    FAIL(device.name() << ": relation " << static_cast<int>(found.relation.value_or(Relation::apart)) << " and "
                       << static_cast<int>(first.relation.value_or(Relation::apart)) << " instead of "
                       << static_cast<int>(relation) << ", " << found.contacts.size() << " contacts instead of "
                       << wanted.size() << ", least " << static_cast<int>(least) << '\n'
                       << describe(poses));
  }
}

/// First and all contacts of a query must be the expected ones.
inline void check_answers(Device& device, const Object& a, const Object& b, const PosePair& poses,
                          const std::vector<Contact>& expected, Tally& tally) {
  const CollisionResult found = collide(device, a, poses.a, b, poses.b, all);
  const CollisionResult first = collide(device, a, poses.a, b, poses.b);
  ++tally.queries;
  tally.hits += found.hit;
  tally.stats += found.stats;
  tally.first_pairs += first.stats.pairs;
  if (!same_faces(found.contacts, expected) || found.hit != !expected.empty() || first.hit != found.hit ||
      first.contacts.size() != (found.hit ? 1 : 0) ||
      (found.hit && !std::binary_search(expected.begin(), expected.end(), first.contacts[0]))) {
    FAIL(device.name() << ": " << found.contacts.size() << " contacts instead of " << expected.size() << ", first "
                       << first.hit << '\n'
                       << describe(poses));
  }
  const auto told = [](const Contact& x) { return x.relation.has_value(); };
  REQUIRE((!found.relation && std::none_of(found.contacts.begin(), found.contacts.end(), told)));
  check_relations(device, a, b, poses, expected, tally);
}

}  // namespace cchip::testing

#endif
