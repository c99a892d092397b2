// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/collide/face_pairs.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace cchip {
namespace {

void check_pose(const Pose& pose, const char* name) {
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      if (std::abs(pose(row, column)) <= 0x1p500) continue;
      throw std::invalid_argument(std::string("pose of ") + name + ": row " + std::to_string(row) + ", column " +
                                  std::to_string(column) + " is not finite or beyond 2^500; check it or scale it");
    }
  }
}

std::uint32_t file_face(const Mesh& mesh, std::uint32_t face) {
  return mesh.file_face.empty() ? face : mesh.file_face[face];
}

}  // namespace

void check_query(const Pose& pose_a, const Pose& pose_b, const CollisionRequest& request) {
  check_pose(pose_a, "A");
  check_pose(pose_b, "B");
  if (request.contacts == CollisionRequest::Contacts::all && request.most_contacts == 0) {
    throw std::invalid_argument("most_contacts is 0: ask for at least one contact");
  }
}

FacePairs::FacePairs(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                     const CollisionRequest& request)
    : mesh_a_(a.mesh()),
      mesh_b_(b.mesh()),
      pairs_((check_query(pose_a, pose_b, request), pose_a), pose_b),
      request_(request),
      cut_(!a.mesh().file_face.empty() || !b.mesh().file_face.empty()) {
  if (request_.contacts == CollisionRequest::Contacts::first) request_.most_contacts = 1;
}

void FacePairs::test(std::uint32_t face_a, std::uint32_t face_b) {
  const PosedPairs::Answer answer = pairs_.decide(mesh_a_.primitive(face_a), mesh_b_.primitive(face_b));
  ++result_.counts.pairs;
  result_.counts.open += answer.open;
  if (answer.hit) add(face_a, face_b);
}

void FacePairs::add(std::uint32_t face_a, std::uint32_t face_b) {
  const Contact contact = {file_face(mesh_a_, face_a), file_face(mesh_b_, face_b)};
  if (cut_ && !contacts_.insert(contact).second) return;
  result_.contacts.push_back(contact);
  done_ = result_.contacts.size() == request_.most_contacts;
}

CollisionResult FacePairs::take() {
  result_.hit = !result_.contacts.empty();
  std::sort(result_.contacts.begin(), result_.contacts.end());
  return std::move(result_);
}

}  // namespace cchip
