// SPDX-License-Identifier: Apache-2.0
/// \file
/// The CPU device with its options, before and after it has any.
#ifndef CCHIP_TESTS_PEERS_CPU_API_HPP
#define CCHIP_TESTS_PEERS_CPU_API_HPP

#include <cchip/device/device.hpp>

#if __has_include(<cchip/device/cpu_device.hpp>)
#include <cchip/device/cpu_device.hpp>
#else
namespace cchip {

struct CollisionQuery {
  const Object* a;
  const Pose* pose_a;
  const Object* b;
  const Pose* pose_b;
};
struct CpuOptions {
  unsigned threads = 0;
  std::string target = {};
};
inline std::vector<std::string> cpu_targets() { return {"plain"}; }
inline std::unique_ptr<Device> open_cpu_device(const CpuOptions& = {}) { return open_device("cpu"); }

}  // namespace cchip
#endif

namespace cchip::testing {

#if __has_include(<cchip/device/cpu_device.hpp>)
inline void ask(Device& device, const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) {
  device.collide(query, request, result);
}
inline void ask(Device& device, std::size_t count, const std::function<CollisionQuery(std::size_t)>& query,
                const CollisionRequest& request, const std::function<void(std::size_t, const CollisionResult&)>& take) {
  device.collide(count, query, request, take);
}
#else
inline void ask(Device& device, const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) {
  result = device.collide(*query.a, *query.pose_a, *query.b, *query.pose_b, request);
}
inline void ask(Device& device, std::size_t count, const std::function<CollisionQuery(std::size_t)>& query,
                const CollisionRequest& request, const std::function<void(std::size_t, const CollisionResult&)>& take) {
  for (std::size_t i = 0; i < count; ++i) {
    CollisionResult result;
    ask(device, query(i), request, result);
    take(i, result);
  }
}
#endif

}  // namespace cchip::testing

#endif
