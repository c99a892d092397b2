// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/internal/judge/near_parts.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "exact/filter.hpp"

namespace cchip {
namespace {

void check_placed(const Object* object, const Pose* pose, const char* name) {
  const auto refuse = [name](const char* what) { throw std::invalid_argument(std::string("query: ") + name + what); };
  if (object == nullptr) refuse(" is a null pointer; point it to an Object");
  if (object->id() == nullptr) refuse(" is an Object that was moved from; use the one that it was moved to");
  if (pose == nullptr) refuse("'s pose is a null pointer; point it to a Pose");
}

/// Empties a result and keeps its memory.
void clear(CollisionResult& result) {
  result.hit = false;
  result.relation.reset();
  result.contacts.clear();
  result.stats = {};
}

}  // namespace

void check_pose(const Pose& pose, const char* name) {
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      if (std::abs(pose(row, column)) <= 0x1p500) continue;
      throw std::invalid_argument(std::string("pose of ") + name + ": row " + std::to_string(row) + ", column " +
                                  std::to_string(column) + " is not finite or beyond 2^500; check it or scale it");
    }
  }
}

void check_query(const Pose& pose_a, const Pose& pose_b, const CollisionRequest& request) {
  check_pose(pose_a, "A");
  check_pose(pose_b, "B");
  if (request.max_contacts == 0) {
    throw std::invalid_argument("max_contacts is 0: ask for at least one contact");
  }
  if (request.least != Relation::touching && request.least != Relation::crossing) {
    throw std::invalid_argument("least is apart, and faces that are apart are no contact: give touching or crossing");
  }
  if (!(request.within >= 0 && request.within <= std::numeric_limits<double>::max())) {
    throw std::invalid_argument("within is " + decimal_text(request.within) +
                                ": ask for a distance that is finite and at least 0");
  }
  if (request.within > 0 && request.tells_relation()) {
    throw std::invalid_argument(
        "within: faces at a distance neither touch nor cross; leave out relation and least, or within");
  }
}

void check_query(const CollisionQuery& query, const CollisionRequest& request) {
  check_placed(query.a, query.pose_a, "A");
  check_placed(query.b, query.pose_b, "B");
  check_query(*query.pose_a, *query.pose_b, request);
}

void FacePairs::start(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) {
  query_ = query;
  result_ = &result;
  request_ = request;
  clear(result);
  done_ = false;
  seen_ = Relation::apart;
  most_ = request.contacts == CollisionRequest::Contacts::first ? 1 : request.max_contacts;
  cut_ = !query.a->mesh().file_face.empty() || !query.b->mesh().file_face.empty();
  if (cut_) table_.clear();
  pairs_.reset();
  distances_.reset();
}

void FacePairs::answer_apart(const CollisionRequest& request, CollisionResult& result) {
  clear(result);
  if (request.tells_relation()) result.relation = Relation::apart;
}

Relation FacePairs::relate(std::uint32_t face_a, std::uint32_t face_b) {
  const Primitive a = query_.a->mesh().primitive(face_a);
  const Primitive b = query_.b->mesh().primitive(face_b);
  if (request_.within > 0) {
    if (!distances_) distances_.emplace(*query_.pose_a, *query_.pose_b);
    const PosedDistances::Answer answer = distances_->within(a, b, request_.within);
    ++result_->stats.pairs;
    result_->stats.open += answer.open;
    return answer.hit ? Relation::touching : Relation::apart;
  }
  if (!pairs_) pairs_.emplace(*query_.pose_a, *query_.pose_b);
  const PosedPairs::Answer answer = pairs_->decide(a, b, request_.tells_relation());
  ++result_->stats.pairs;
  result_->stats.open += answer.open;
  return answer.crosses ? Relation::crossing : answer.hit ? Relation::touching : Relation::apart;
}

void FacePairs::test(std::uint32_t face_a, std::uint32_t face_b) {
  const Relation relation = relate(face_a, face_b);
  if (relation != Relation::apart) add(face_a, face_b, relation);
}

FacePairs::Parts FacePairs::parts_of(const Object& object, std::uint32_t face) {
  Parts parts = {};
  if (object.mesh().file_face.empty()) {
    parts.face[0] = face;
    parts.count = face < object.mesh().faces.size() ? 1 : 0;
    return parts;
  }
  const std::vector<std::uint32_t> all = object.parts(face);
  parts.count = std::min(parts.face.size(), all.size());
  std::copy_n(all.begin(), parts.count, parts.face.begin());
  return parts;
}

void FacePairs::add(std::uint32_t face_a, std::uint32_t face_b, Relation relation) {
  const bool crosses = relation == Relation::crossing;
  seen_ = std::max(seen_, relation);
  if (!crosses && request_.least == Relation::crossing) return;
  Contact contact = {query_.a->mesh().number_in_file(face_a), query_.b->mesh().number_in_file(face_b), std::nullopt};
  if (request_.tells_relation()) contact.relation = relation;
  std::vector<Contact>& contacts = result_->contacts;
  if (request_.contacts == CollisionRequest::Contacts::first) {
    if (contacts.empty() || crosses) contacts.assign(1, contact);  // one that touches is kept until one crosses
    done_ = crosses || !request_.tells_relation();
    return;
  }
  if (cut_ && !table_.empty()) {
    if (const std::uint32_t place = entry_of(contact); place != 0) {
      if (crosses && request_.tells_relation()) contacts[place - 1].relation = relation;
      return;
    }
  }
  // Only one contact more than are wanted ends the search: until then it may find that it has met all of them.
  if (contacts.size() == most_) {
    done_ = true;
    return;
  }
  contacts.push_back(contact);
  if (!cut_) return;
  if (2 * contacts.size() > table_.size()) {
    grow_table();
  } else {
    entry_of(contact) = static_cast<std::uint32_t>(contacts.size());
  }
}

std::uint32_t& FacePairs::entry_of(const Contact& contact) {
  const std::vector<Contact>& contacts = result_->contacts;
  const std::uint64_t mixed = (std::uint64_t{contact.face_a} << 32U | contact.face_b) * 0x9e3779b97f4a7c15U;
  std::size_t at = static_cast<std::size_t>(mixed >> 16U) & (table_.size() - 1);
  while (table_[at] != 0 && !same_faces(contacts[table_[at] - 1], contact)) at = (at + 1) & (table_.size() - 1);
  return table_[at];
}

/// To at least twice as many entries as contacts, each of four bytes.
void FacePairs::grow_table() {
  const std::vector<Contact>& contacts = result_->contacts;
  if (contacts.size() >= std::numeric_limits<std::uint32_t>::max() / 2) {
    throw std::runtime_error("collide: more than 2^31 contacts of polygons; ask for fewer by max_contacts");
  }
  std::size_t size = std::max<std::size_t>(64, 2 * table_.size());
  while (size < 2 * contacts.size()) size *= 2;
  std::vector<std::uint32_t>().swap(table_);
  table_.resize(size);
  for (std::size_t i = 0; i < contacts.size(); ++i) entry_of(contacts[i]) = static_cast<std::uint32_t>(i + 1);
}

/// The search ended before it met all parts of two faces that were cut, and those that it met only touch.
void FacePairs::relate_all_parts(Contact& contact) {
  const bool crosses = any_near_parts(query_, contact, [this](std::uint32_t face_a, std::uint32_t face_b) {
    return relate(face_a, face_b) == Relation::crossing;
  });
  if (crosses) contact.relation = seen_ = Relation::crossing;
}

void FacePairs::finish() {
  std::vector<Contact>& contacts = result_->contacts;
  result_->hit = !contacts.empty();
  if (cut_ && done_ && request_.contacts == CollisionRequest::Contacts::all && request_.tells_relation()) {
    for (Contact& contact : contacts) {
      if (contact.relation == Relation::touching) relate_all_parts(contact);
    }
  }
  if (request_.tells_relation() && (seen_ == Relation::crossing || !done_)) result_->relation = seen_;
  if (result_->contacts.size() > 1) std::sort(result_->contacts.begin(), result_->contacts.end());
}

}  // namespace cchip
