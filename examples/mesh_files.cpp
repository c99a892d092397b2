// SPDX-License-Identifier: Apache-2.0
// Two meshes from files, the second one in three places: mesh_files A B
#include <cchip/cchip.hpp>
#include <exception>
#include <iostream>

int main(int count, char** arguments) try {
  if (count != 3) {
    std::cerr << "usage: mesh_files A B, as in: mesh_files meshes/bracket.obj meshes/peg.stl\n";
    return 2;
  }
  const cchip::Object a(cchip::load_mesh(arguments[1])), b(cchip::load_mesh(arguments[2]));  // build once, ask often
  cchip::CollisionRequest request;
  request.relation = true;  // tell touching from crossing
  for (const Eigen::Vector3d place :
       {Eigen::Vector3d(0.5, 0, 0), Eigen::Vector3d(1.25, 2, 0), Eigen::Vector3d(2, 2, 0)}) {
    const cchip::Pose pose_b(Eigen::Translation3d{place});
    const auto result = cchip::collide(a, cchip::Pose::Identity(), b, pose_b, request);
    const bool cross = result.relation == cchip::Relation::crossing;
    std::cout << place.transpose() << ": " << (cross ? "crossing" : result.hit ? "touching" : "apart") << '\n';
  }
} catch (const std::exception& error) {  // a file that cannot be read, or is no mesh
  std::cerr << error.what() << '\n';
  return 1;
}
