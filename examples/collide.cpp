// SPDX-License-Identifier: Apache-2.0
#include <cchip/device.hpp>
#include <cchip/shapes.hpp>
#include <iostream>

int main() {  // a gear comes down on a torus
  const cchip::Object torus(cchip::make_torus(1, 0.25, 64, 32));
  const cchip::Object gear(cchip::make_gear(1.25, 1.5, 0.5, 0.5, 36, 6));
  const cchip::Pose origin = cchip::Pose::Identity();
  const auto device = cchip::open_device("cpu");
  cchip::CollisionRequest all;
  all.contacts = cchip::CollisionRequest::Contacts::all;
  // At 0.5 the torus' highest ring lies in the gear's face.
  for (const double height : {0.5 + 0x1p-50, 0.5, 0.4}) {
    const auto pose = cchip::make_pose({0, 0, height}, {0, 0, 0});
    const auto found = cchip::collide(*device, torus, origin, gear, pose, all);
    std::cout << "touch: " << found.hit;
    std::cout << ", pairs of faces: " << found.contacts.size() << '\n';
  }
}
