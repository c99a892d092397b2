// SPDX-License-Identifier: Apache-2.0
// An arm of three links reaches into a box of parts: docs/cpp/scenes.md.
#include <cchip/cchip.hpp>
#include <iostream>

#include "parts.hpp"

int main() {
  using cchip::make_pose;
  const cchip::Object link(parts::box({0, -0.1, -0.1}, {1, 0.1, 0.1}));
  const cchip::Object ball(cchip::make_sphere(0.25, 4));
  const cchip::Object table(parts::box({-1, -2, -0.5}, {4, 2, -0.25}));

  cchip::Scene scene;
  const auto base = scene.add(link), middle = scene.add(link), hand = scene.add(link);
  scene.set_ignored(base, middle);  // joints connect them, so they always touch
  scene.set_ignored(middle, hand);
  constexpr cchip::CollisionGroups parts = {2, 1};  // in group 2, tested against group 1 only: not against each other
  for (int i = 0; i < 5; ++i) scene.add(ball, make_pose({1.5 + 0.25 * i, 1, 0}, {0, 0, 0}), parts);
  scene.add(table, cchip::Pose::Identity(), parts);

  const auto device = cchip::open_device("cpu");
  for (const double angle : {10, 20, 30}) {  // of each joint
    Eigen::Isometry3d joint = Eigen::Isometry3d::Identity();
    for (const auto id : {base, middle, hand}) {
      joint = joint * make_pose({0, 0, 0}, {0, 0, angle});
      scene.set_pose(id, joint);
      joint = joint * Eigen::Translation3d(1, 0, 0);
    }
    std::cout << "joints at " << angle << " degrees: " << (scene.find_contact(*device) ? "touches" : "free");
    for (const auto& pair : scene.contacts(*device)) std::cout << "; " << pair.a << " and " << pair.b;
    std::cout << '\n';
  }

  // A part that is not in the scene: would it fit there?
  const auto there = make_pose({2, -1, 0}, {0, 0, 0});
  std::cout << "a ball at (2, -1, 0) touches " << scene.contacts(*device, {ball, there}).size() << " of them\n";
}
