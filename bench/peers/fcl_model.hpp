// SPDX-License-Identifier: Apache-2.0
/// \file
/// A mesh of triangles as FCL takes it.
#ifndef CCHIP_BENCH_FCL_MODEL_HPP
#define CCHIP_BENCH_FCL_MODEL_HPP

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>

#include <cchip/mesh.hpp>
#include <memory>
#include <vector>

namespace cchip::testing {

using FclModel = fcl::BVHModel<fcl::OBBRSS<double>>;

inline std::shared_ptr<FclModel> fcl_model(const Mesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  for (const Mesh::Face& face : mesh.faces) triangles.emplace_back(face.vertex[0], face.vertex[1], face.vertex[2]);
  auto model = std::make_shared<FclModel>();
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

inline fcl::CollisionResult<double> fcl_collide(const FclModel& a, const Eigen::Isometry3d& pose_a, const FclModel& b,
                                                const Eigen::Isometry3d& pose_b) {
  fcl::CollisionRequest<double> request;
  request.num_max_contacts = 1;
  fcl::CollisionResult<double> result;
  fcl::collide(&a, pose_a, &b, pose_b, request, result);
  return result;
}

}  // namespace cchip::testing

#endif
