// SPDX-License-Identifier: Apache-2.0
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>
#include <fcl/narrowphase/distance.h>
#include <fcl/narrowphase/distance_request.h>
#include <fcl/narrowphase/distance_result.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "manager.hpp"
#include "peer.hpp"

namespace {

using Model = fcl::BVHModel<fcl::OBBRSS<double>>;

fcl::Transform3<double> transform(const double* pose) {
  fcl::Transform3<double> result;
  result.matrix() = Eigen::Map<const Eigen::Matrix4d>(pose);
  return result;
}

void* make(const double* vertices, size_t vertex_count, const uint32_t* triangles, size_t triangle_count) {
  std::vector<fcl::Vector3<double>> points(vertex_count);
  for (size_t i = 0; i < vertex_count; ++i) points[i] = Eigen::Map<const Eigen::Vector3d>(vertices + 3 * i);
  std::vector<fcl::Triangle> faces(triangle_count);
  for (size_t i = 0; i < triangle_count; ++i) {
    faces[i].set(triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]);
  }
  auto* model = new Model;
  model->beginModel();
  model->addSubModel(points, faces);
  model->endModel();
  return model;
}

void destroy(void* mesh) { delete static_cast<Model*>(mesh); }

int hit(void* a, const double* pose_a, void* b, const double* pose_b) {
  const fcl::CollisionRequest<double> request(1, false);
  fcl::CollisionResult<double> result;
  return fcl::collide(static_cast<const Model*>(a), transform(pose_a), static_cast<const Model*>(b), transform(pose_b),
                      request, result) > 0;
}

size_t contacts(void* a, const double* pose_a, void* b, const double* pose_b, size_t most, uint32_t* pairs,
                size_t room) {
  const fcl::CollisionRequest<double> request(most, false);
  fcl::CollisionResult<double> result;
  fcl::collide(static_cast<const Model*>(a), transform(pose_a), static_cast<const Model*>(b), transform(pose_b),
               request, result);
  const size_t count = result.numContacts();
  for (size_t i = 0; i < std::min(count, room); ++i) {
    const fcl::Contact<double>& contact = result.getContact(i);
    pairs[2 * i] = static_cast<uint32_t>(contact.b1);
    pairs[2 * i + 1] = static_cast<uint32_t>(contact.b2);
  }
  return count;
}

double distance(void* a, const double* pose_a, void* b, const double* pose_b, double rel_error, double* points) {
  const fcl::DistanceRequest<double> request(true, false, rel_error);
  fcl::DistanceResult<double> result;
  fcl::distance(static_cast<const Model*>(a), transform(pose_a), static_cast<const Model*>(b), transform(pose_b),
                request, result);
  Eigen::Map<Eigen::Vector3d>(points + 0) = result.nearest_points[0];
  Eigen::Map<Eigen::Vector3d>(points + 3) = result.nearest_points[1];
  return result.min_distance;
}

/// The search begins with a result just above d, so that it opens nothing farther away. FCL cannot end it at the first
/// pair that is near enough.
int within(void* a, const double* pose_a, void* b, const double* pose_b, double d) {
  const fcl::DistanceRequest<double> request;
  fcl::DistanceResult<double> result(std::nextafter(d, std::numeric_limits<double>::infinity()));
  fcl::distance(static_cast<const Model*>(a), transform(pose_a), static_cast<const Model*>(b), transform(pose_b),
                request, result);
  return result.min_distance <= d;
}

struct Fcl {
  using Manager = fcl::DynamicAABBTreeCollisionManager<double>;
  using Object = fcl::CollisionObject<double>;
  using Geometry = fcl::CollisionGeometry<double>;
  using Model = ::Model;
  using Sphere = fcl::Sphere<double>;
  static fcl::Transform3<double> transform(const double* pose) { return ::transform(pose); }
  static bool hit(const Object* x, const Object* y) {
    const fcl::CollisionRequest<double> request(1, false);
    fcl::CollisionResult<double> result;
    return fcl::collide(x, y, request, result) > 0;
  }
  template <class Visit>
  static void visit(Manager& manager, Visit f) {
    manager.collide(&f, [](Object* x, Object* y, void* to) {
      (*static_cast<Visit*>(to))(x, y);
      return false;
    });
  }
};

const CchipBroadPeer broad = broad_functions<Fcl>();
const CchipScenePeer scene = scene_functions<Fcl>();

constexpr CchipPeer peer = {
#if defined(__AVX512F__)
    FCL_VERSION ", compiled with AVX-512",
#elif defined(__AVX2__)
    FCL_VERSION ", compiled with AVX2",
#else
    FCL_VERSION ", compiled for any x86-64 or other processor",
#endif
    make,
    destroy,
    hit,
    contacts,
    distance,
    within,
    1e-6,  // DistanceRequest::distance_tolerance
    &broad,
    &scene};

}  // namespace

extern "C" __attribute__((visibility("default"))) const CchipPeer* cchip_peer() { return &peer; }
