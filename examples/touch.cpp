// SPDX-License-Identifier: Apache-2.0
// Do these two triangles touch?
#include <cchip/exact/oracle.hpp>
#include <iostream>

int main() {
  cchip::Primitive a, b;
  a.v = {cchip::Vec3d(0, 0, 0), {1, 0, 0}, {0, 1, 0}};
  b.v = {cchip::Vec3d(0.25, 0.25, 0), {1, 1, 2}, {0, 0, 2}};  // one vertex lies in A
  std::cout << "touch: " << cchip::exact_intersects(a, b);
  b.v[0].z() += 0x1p-40;
  std::cout << ", lifted by 2^-40: " << cchip::exact_intersects(a, b) << '\n';
}
