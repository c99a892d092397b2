// SPDX-License-Identifier: Apache-2.0
// Parts that are apart, touch or cross: docs/cpp/touching.md.
#include <cchip/device.hpp>
#include <cmath>
#include <iostream>

#include "parts.hpp"

namespace {

using cchip::Relation;

void tell(const char* name, const cchip::Object& a, const cchip::Object& b,
          const cchip::Pose& pose_b = cchip::Pose::Identity()) {
  static const auto device = cchip::open_device("cpu");
  const cchip::Pose pose_a = cchip::Pose::Identity();
  cchip::CollisionRequest request;
  request.contacts = cchip::CollisionRequest::Contacts::all;
  request.relation = true;  // tell touching from crossing
  const cchip::CollisionResult result = cchip::collide(*device, a, pose_a, b, pose_b, request);
  int cross = 0;
  int touch = 0;
  for (const cchip::Contact& contact : result.contacts) ++(contact.relation == Relation::crossing ? cross : touch);
  const bool clash = result.relation == Relation::crossing;
  const char* answer = clash ? "crossing" : result.hit ? "touching" : "apart";
  std::cout << name << ": " << answer << ", pairs of faces that cross " << cross << ", that touch " << touch << '\n';
}

cchip::Pose moved(double x, double y, double z) { return cchip::Pose(Eigen::Translation3d(x, y, z)); }

}  // namespace

int main() {
  const cchip::Object cube(parts::box({0, 0, 0}, {1, 1, 1})), brick(parts::box({1, 0.25, 0.25}, {2, 0.75, 0.75}));
  tell("flush boxes", cube, brick);
  tell("pressed in by 2^-53", cube, brick, moved(-0x1p-53, 0, 0));
  tell("pulled off by 2^-52", cube, brick, moved(0x1p-52, 0, 0));

  const auto peg_with = [](double radius) { return cchip::Object(parts::prism(parts::circle(radius, 24), -1, 2)); };
  const cchip::Object plate(parts::prism(parts::circle(2, 24), 0, 1, parts::circle(1, 24)));
  tell("peg in its hole", plate, peg_with(1));
  tell("thicker by 2^-52", plate, peg_with(1 + 0x1p-52));
  tell("thinner by 2^-53", plate, peg_with(1 - 0x1p-53));

  const parts::Outline outline = parts::gear(9000, 11000, 16);
  const cchip::Object wheel(parts::prism(outline, -2000, 2000)), pinion(parts::prism(outline, -1000, 1000));
  const cchip::Pose in_mesh = parts::in_mesh(outline);
  tell("gear pair", wheel, pinion, in_mesh);
  tell("moved on by 2^-30", wheel, pinion, moved(0, -0x1p-30, 0) * in_mesh);
  tell("moved back by 2^-30", wheel, pinion, moved(0, 0x1p-30, 0) * in_mesh);
}
