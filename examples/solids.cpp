// SPDX-License-Identifier: Apache-2.0
#include <cchip/cchip.hpp>
#include <iostream>

int main() {
  const cchip::Object cube(cchip::make_mesh(
      Eigen::MatrixXd{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      Eigen::MatrixXi{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}));
  const cchip::Pose here = cchip::Pose::Identity();
  for (const double x : {1.5, 1.0, 0.5, 0.0}) {
    const cchip::Pose there(Eigen::Translation3d(x, 0, 0));
    std::cout << x << ": " << cchip::name_of(cchip::solids(cube, here, cube, there)) << '\n';
  }
  const cchip::Pose half(Eigen::UniformScaling<double>(0.5));
  std::cout << "half as large: " << cchip::name_of(cchip::solids(cube, here, cube, half)) << '\n';
}
