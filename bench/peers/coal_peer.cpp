// SPDX-License-Identifier: Apache-2.0
// Coal, formerly hpp-fcl: the same tree as FCL's, contact points switched off.
#include <coal/BVH/BVH_model.h>
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/shape/geometric_shapes.h>

#include <algorithm>
#include <vector>

#include "manager.hpp"
#include "peer.hpp"

namespace {

using Model = coal::BVHModel<coal::OBBRSS>;

coal::Transform3s transform(const double* pose) {
  const Eigen::Map<const Eigen::Matrix4d> matrix(pose);
  return coal::Transform3s(matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>());
}

void* make(const double* vertices, size_t vertex_count, const uint32_t* triangles, size_t triangle_count) {
  std::vector<coal::Vec3s> points(vertex_count);
  for (size_t i = 0; i < vertex_count; ++i) points[i] = Eigen::Map<const Eigen::Vector3d>(vertices + 3 * i);
  std::vector<coal::Triangle> faces(triangle_count);
  for (size_t i = 0; i < triangle_count; ++i) {
    faces[i].set(triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]);
  }
  auto* model = new Model;
  model->beginModel(static_cast<unsigned>(triangle_count), static_cast<unsigned>(vertex_count));
  model->addSubModel(points, faces);
  model->endModel();
  return model;
}

void destroy(void* mesh) { delete static_cast<Model*>(mesh); }

size_t collide(void* a, const double* pose_a, void* b, const double* pose_b, size_t most,
               coal::CollisionResult& result) {
  coal::CollisionRequest request;
  request.num_max_contacts = most;
  request.enable_contact = false;  // Coal's default is true, FCL's false
  request.break_distance = 0;      // by default boxes apart by up to 0.001 are opened, for a bound of the distance
  return coal::collide(static_cast<const Model*>(a), transform(pose_a), static_cast<const Model*>(b), transform(pose_b),
                       request, result);
}

int hit(void* a, const double* pose_a, void* b, const double* pose_b) {
  coal::CollisionResult result;
  return collide(a, pose_a, b, pose_b, 1, result) > 0;
}

size_t contacts(void* a, const double* pose_a, void* b, const double* pose_b, size_t most, uint32_t* pairs,
                size_t room) {
  coal::CollisionResult result;
  collide(a, pose_a, b, pose_b, most, result);
  const size_t count = result.numContacts();
  for (size_t i = 0; i < std::min(count, room); ++i) {
    const coal::Contact& contact = result.getContact(i);
    pairs[2 * i] = static_cast<uint32_t>(contact.b1);
    pairs[2 * i + 1] = static_cast<uint32_t>(contact.b2);
  }
  return count;
}

double distance(void* a, const double* pose_a, void* b, const double* pose_b, double rel_error, double* points) {
  const coal::DistanceRequest request(true, false, rel_error, 0);  // no depth of penetration
  coal::DistanceResult result;
  coal::distance(static_cast<const Model*>(a), transform(pose_a), static_cast<const Model*>(b), transform(pose_b),
                 request, result);
  Eigen::Map<Eigen::Vector3d>(points + 0) = result.nearest_points[0];
  Eigen::Map<Eigen::Vector3d>(points + 3) = result.nearest_points[1];
  return result.min_distance;
}

int within(void* a, const double* pose_a, void* b, const double* pose_b, double d) {
  coal::CollisionRequest request;
  request.num_max_contacts = 1;
  request.enable_contact = false;
  request.break_distance = 0;
  request.security_margin = d;
  coal::CollisionResult result;
  return coal::collide(static_cast<const Model*>(a), transform(pose_a), static_cast<const Model*>(b), transform(pose_b),
                       request, result) > 0;
}

struct Coal {
  using Manager = coal::DynamicAABBTreeCollisionManager;
  using Object = coal::CollisionObject;
  using Geometry = coal::CollisionGeometry;
  using Model = ::Model;
  using Sphere = coal::Sphere;
  static coal::Transform3s transform(const double* pose) { return ::transform(pose); }
  static bool hit(const Object* x, const Object* y) {
    coal::CollisionRequest request;
    request.num_max_contacts = 1;
    request.enable_contact = false;
    request.break_distance = 0;
    coal::CollisionResult result;
    return coal::collide(x, y, request, result) > 0;
  }
  template <class Visit>
  static void visit(Manager& manager, Visit f) {
    struct Callback : coal::CollisionCallBackBase {
      explicit Callback(Visit& g) : visit(g) {}
      bool collide(Object* x, Object* y) override {
        visit(x, y);
        return false;
      }
      Visit& visit;
    };
    Callback callback(f);
    manager.collide(&callback);
  }
};

const CchipBroadPeer broad = broad_functions<Coal>();
const CchipScenePeer scene = scene_functions<Coal>();

constexpr CchipPeer peer = {COAL_VERSION ", compiled for any x86-64 or other processor",
                            make,
                            destroy,
                            hit,
                            contacts,
                            distance,
                            within,
                            1e-6,  // QueryRequest::gjk_tolerance
                            &broad,
                            &scene};

}  // namespace

extern "C" __attribute__((visibility("default"))) const CchipPeer* cchip_peer() { return &peer; }
