// SPDX-License-Identifier: Apache-2.0
#include <cchip/cchip.hpp>
#include <iostream>

int main() {
  const cchip::Object cube(cchip::make_mesh(
      Eigen::MatrixXd{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      Eigen::MatrixXi{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}));
  const cchip::Pose here = cchip::Pose::Identity();
  const cchip::Pose crossing(Eigen::Translation3d(0.75, 0.5, 0)), beside(Eigen::Translation3d(3, 0.5, 0));
  const cchip::Vec3d right(1, 0, 0), up(0, 1, 0);
  std::cout << "clear after " << cchip::clear_along(cube, here, cube, crossing, right).factor << " to the right, "
            << cchip::clear_along(cube, here, cube, crossing, up).factor << " upwards\n";
  std::cout << "touches after " << cchip::first_contact(cube, here, cube, beside, -right).factor << " to the left\n";
  const cchip::AlongResult third = cchip::first_contact(cube, here, cube, beside, -3 * right);
  std::cout << "2/3 of (3, 0, 0) is " << (third.lower < third.upper ? "between two doubles\n" : "a double\n");
  std::cout << (cchip::first_contact(cube, here, cube, beside, up).touches ? "touches" : "never touches")
            << " upwards\n";
}
