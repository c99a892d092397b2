// SPDX-License-Identifier: Apache-2.0
#include <cchip/collide/collide.hpp>
#include <cchip/collide/face_pairs.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "float_mode.hpp"

namespace cchip {
namespace {

std::vector<CollisionResult> gather(Device& device, std::size_t count, const Device::QuerySource& query,
                                    const CollisionRequest& request) {
  std::vector<CollisionResult> results(count);
  device.collide(count, query, request,
                 [&results](std::size_t i, const CollisionResult& result) { results[i] = result; });
  return results;
}

Device::QuerySource in_poses(const Object& a, const Object& b, const std::vector<PosePair>& poses) {
  return [&a, &b, &poses](std::size_t i) { return CollisionQuery{&a, &poses[i].a, &b, &poses[i].b}; };
}

/// Ends a batch whose sink has returned false.
struct Enough {};

}  // namespace

Object::Object(Mesh mesh) {
  check_float_mode();
  bvh::SupportTree tree(mesh, bvh::build_tree(mesh));
  data_ = std::make_shared<const Data>(Data{std::move(mesh), std::move(tree)});
}

Device::Device() { check_float_mode(); }

/// Keeps other calls off a device.
class Device::Use {
 public:
  explicit Use(Device& device) : device_(device) {
    if (!device_.in_use_.exchange(true, std::memory_order_acquire)) return;
    throw std::logic_error(std::string("device ") + device_.name() +
                           " is in use: open one device per thread, and do not call it from its result function");
  }
  ~Use() { device_.in_use_.store(false, std::memory_order_release); }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  Device& device_;
};

void Device::collide(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) {
  const Use use(*this);
  check_float_mode();
  check_query(query, request);
  answer(query, request, result);
}

void Device::collide(std::size_t count, const QuerySource& query, const CollisionRequest& request,
                     const ResultSink& take) {
  const Use use(*this);
  check_float_mode();
  for (std::size_t i = 0; i < count; ++i) check_query(query(i), request);
  // Every device must end a batch when its sink throws, so this stops all of them alike.
  const ResultSink stop_or_go_on = [&take](std::size_t i, const CollisionResult& result) {
    if (!take(i, result)) throw Enough();
  };
  try {
    answer_all(count, query, request, stop_or_go_on);
  } catch (const Enough&) {  // NOLINT: it is no error
  }
}

void Device::answer_all(std::size_t count, const QuerySource& query, const CollisionRequest& request,
                        const ResultSink& take) {
  CollisionResult result;
  for (std::size_t i = 0; i < count; ++i) {
    answer(query(i), request, result);
    take(i, result);
  }
}

void collide(Device& device, const Object& a, const Object& b, const std::vector<PosePair>& poses,
             const CollisionRequest& request, const Device::ResultSink& take) {
  device.collide(poses.size(), in_poses(a, b, poses), request, take);
}

std::vector<CollisionResult> collide(Device& device, const Object& a, const Object& b,
                                     const std::vector<PosePair>& poses, const CollisionRequest& request) {
  return gather(device, poses.size(), in_poses(a, b, poses), request);
}

std::vector<CollisionResult> collide(Device& device, const std::vector<CollisionQuery>& queries,
                                     const CollisionRequest& request) {
  return gather(
      device, queries.size(), [&queries](std::size_t i) { return queries[i]; }, request);
}

}  // namespace cchip
