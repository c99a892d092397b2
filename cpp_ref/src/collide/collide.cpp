// SPDX-License-Identifier: Apache-2.0
#include <cchip/collide/collide.hpp>
#include <cchip/collide/face_pairs.hpp>
#include <utility>

namespace cchip {

Object::Object(Mesh mesh) {
  bvh::Tree tree = bvh::build_tree(mesh);
  data_ = std::make_shared<const Data>(Data{std::move(mesh), std::move(tree)});
}

void Device::collide(const Object& a, const Object& b, const std::vector<PosePair>& poses,
                     const CollisionRequest& request, const std::function<void(std::size_t, CollisionResult&&)>& take) {
  for (const PosePair& pose : poses) check_query(pose.a, pose.b, request);
  for (std::size_t i = 0; i < poses.size(); ++i) take(i, collide(a, poses[i].a, b, poses[i].b, request));
}

std::vector<CollisionResult> collide(Device& device, const Object& a, const Object& b,
                                     const std::vector<PosePair>& poses, const CollisionRequest& request) {
  std::vector<CollisionResult> results(poses.size());
  device.collide(a, b, poses, request,
                 [&results](std::size_t i, CollisionResult&& result) { results[i] = std::move(result); });
  return results;
}

}  // namespace cchip
