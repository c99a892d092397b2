// SPDX-License-Identifier: Apache-2.0
#include <cchip/cchip.hpp>
#include <iostream>

int main() {
  // A wall as a depth camera sees it: 101 x 101 points, 0.02 apart, each a sphere with a radius of 0.02.
  std::vector<cchip::Vec3d> points;
  for (int i = -50; i <= 50; ++i) {
    for (int k = -50; k <= 50; ++k) points.emplace_back(1.5, 0.02 * i, 0.02 * k);
  }
  const cchip::PointCloud wall(points, 0.02);
  const cchip::Object ball(cchip::make_sphere(0.25, 6));
  const cchip::Pose here = cchip::Pose::Identity();
  cchip::Pose there = here;
  for (const double x : {1.0, 1.25}) {
    there.translation().x() = x;
    std::cout << "ball at " << x << ": " << (cchip::collide(wall, here, ball, there).hit ? "contact\n" : "clear\n");
  }
  // Links of a robot, or any objects in their places.
  const std::vector<cchip::PlacedObject> links = {{&ball, here}, {&ball, there}};
  std::cout << "link " << cchip::first_met(wall, here, links) << " is the first in contact\n";
}
