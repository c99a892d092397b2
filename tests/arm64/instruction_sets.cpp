// SPDX-License-Identifier: Apache-2.0
// The CPU device's best instruction set on 64-bit ARM, and whether each one gives the same contacts as no instruction
// set.
#include <cchip/cpu_device.hpp>
#include <cchip/device.hpp>
#include <cchip/shapes.hpp>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

int main() {
  const cchip::Object torus(cchip::make_torus(1, 0.25, 64, 32)), gear(cchip::make_gear(1.25, 1.5, 0.5, 0.5, 36, 6));
  cchip::CollisionRequest all;
  all.contacts = cchip::CollisionRequest::Contacts::all;
  const auto pairs = [](const cchip::CollisionResult& result) {
    std::vector<std::pair<int, int>> faces;
    for (const cchip::Contact& contact : result.contacts) faces.emplace_back(contact.face_a, contact.face_b);
    return faces;
  };
  bool same = true;
  for (const std::string& name : cchip::cpu_targets()) {
    std::size_t contacts = 0;
    const auto device = cchip::open_cpu_device({1, name}), plain = cchip::open_cpu_device({1, "plain"});
    for (int step = 0; step < 50; ++step) {
      const auto pose = cchip::make_pose({0.044 * step, 0, 0.5}, {4.0 * step, 8.0 * step, 0});
      const auto found = pairs(cchip::collide(*device, torus, cchip::Pose::Identity(), gear, pose, all));
      same = same && found == pairs(cchip::collide(*plain, torus, cchip::Pose::Identity(), gear, pose, all));
      contacts += found.size();
    }
    std::cout << name << ": " << contacts << " pairs of faces in 50 poses\n";
  }
  std::cout << (same ? "all alike\n" : "not alike\n");
  return same ? 0 : 1;
}
