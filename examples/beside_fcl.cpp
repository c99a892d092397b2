// SPDX-License-Identifier: Apache-2.0
// The same queries through FCL and through this library, side by side: docs/cpp/from_fcl.md.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>

#include <cchip/device.hpp>
#include <cchip/shapes.hpp>
#include <iostream>
#include <set>
#include <utility>

namespace {

using FclModel = fcl::BVHModel<fcl::OBBRSS<double>>;

FclModel fcl_model(const cchip::Mesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  for (const auto& face : mesh.faces) triangles.emplace_back(face.vertex[0], face.vertex[1], face.vertex[2]);
  FclModel model;
  model.beginModel();
  model.addSubModel(mesh.vertices, triangles);
  model.endModel();
  return model;
}

}  // namespace

int main() {
  const cchip::Mesh torus = cchip::make_torus(1, 0.25, 64, 32);
  const cchip::Mesh gear = cchip::make_gear(1.25, 1.5, 0.5, 0.5, 36, 6);

  const FclModel fcl_torus = fcl_model(torus);
  const FclModel fcl_gear = fcl_model(gear);

  const cchip::Object our_torus(torus);
  const cchip::Object our_gear(gear);
  const auto device = cchip::open_device("cpu");

  for (const double height : {0.9, 0.45, 0.3}) {
    const Eigen::Isometry3d pose_torus = cchip::make_pose({0, 0, 0}, {5, 10, 15});
    const Eigen::Isometry3d pose_gear = cchip::make_pose({0, 0.1, height}, {7, 0, 0});

    fcl::CollisionRequest<double> fcl_request;
    fcl_request.num_max_contacts = 100000;
    fcl::CollisionResult<double> fcl_result;
    fcl::collide(&fcl_torus, pose_torus, &fcl_gear, pose_gear, fcl_request, fcl_result);
    std::set<std::pair<int, int>> fcl_pairs;  // FCL may name a pair twice
    for (std::size_t i = 0; i < fcl_result.numContacts(); ++i) {
      fcl_pairs.emplace(fcl_result.getContact(i).b1, fcl_result.getContact(i).b2);
    }

    cchip::CollisionRequest request;
    request.contacts = cchip::CollisionRequest::Contacts::all;
    request.max_contacts = 100000;
    const cchip::CollisionResult result =
        cchip::collide(*device, our_torus, cchip::Pose(pose_torus), our_gear, cchip::Pose(pose_gear), request);

    std::cout << "FCL: touch " << fcl_result.isCollision() << ", pairs of faces " << fcl_pairs.size()
              << "; this library: touch " << result.hit << ", pairs of faces " << result.contacts.size() << '\n';
  }
}
