// SPDX-License-Identifier: Apache-2.0
#include <cchip/device/device.hpp>
#include <cchip/mesh/shapes.hpp>
#include <iostream>

int main() {  // a gear comes down on a torus
  const cchip::Object torus(cchip::make_torus(1, 0.25, 64, 32)), gear(cchip::make_gear(1.25, 1.5, 0.5, 0.5, 36, 6));
  const auto device = cchip::open_device("cpu");
  const cchip::CollisionRequest all = {cchip::CollisionRequest::Contacts::all};
  for (const double height : {0.5 + 0x1p-50, 0.5, 0.4}) {  // at 0.5 the torus' highest ring lies in the gear's face
    const auto pose = cchip::make_pose({0, 0, height}, {0, 0, 0});
    const auto result = cchip::collide(*device, torus, cchip::Pose::Identity(), gear, pose, all);
    std::cout << "touch: " << result.hit << ", pairs of faces: " << result.contacts.size() << '\n';
  }
}
