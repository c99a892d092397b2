// SPDX-License-Identifier: Apache-2.0
#include <cchip/cchip.hpp>
#include <iostream>

int main() {
  const cchip::Object ring(cchip::make_torus(1, 0.25, 48, 24)), ball(cchip::make_sphere(0.25, 6));
  const cchip::Pose here = cchip::Pose::Identity();
  cchip::Pose there = here;
  there.translation().x() = 1.9;
  // A clearance of 0.5 is wanted.
  std::cout << (cchip::within(ring, here, ball, there, 0.5).hit ? "closer than 0.5\n" : "clear by more than 0.5\n");
  there.translation().x() = 2.25;
  std::cout << (cchip::within(ring, here, ball, there, 0.5).hit ? "closer than 0.5\n" : "clear by more than 0.5\n");
  const cchip::DistanceResult far = cchip::distance(ring, here, ball, there);
  std::cout << far.upper << " apart\n";
}
