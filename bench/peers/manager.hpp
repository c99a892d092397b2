// SPDX-License-Identifier: Apache-2.0
/// \file
/// DynamicAABBTreeCollisionManager of FCL and of Coal, which are alike, as the broad phase and the scene of peer.hpp.
#ifndef CCHIP_BENCH_MANAGER_HPP
#define CCHIP_BENCH_MANAGER_HPP

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "peer.hpp"

namespace {

/// Objects of a manager, by numbers from 0.
/// \tparam Library names the types Manager, Object, Geometry and Sphere; visit(manager, f) calls f(x, y) for each pair
/// of objects that the manager finds
/// \tparam Object made of a Geometry
template <class Library, class Object>
class Managed {
 public:
  template <class Make>
  Managed(size_t count, const Make& make) {
    std::vector<typename Library::Object*> all;
    for (size_t i = 0; i < count; ++i) {
      objects.push_back(make(i));
      all.push_back(objects.back().get());
    }
    manager.registerObjects(all);
    manager.setup();
  }
  typename Library::Manager manager;
  std::vector<std::unique_ptr<Object>> objects;
};

template <class Library>
struct Boxed : Library::Object {
  Boxed(const std::shared_ptr<typename Library::Geometry>& shape, const double* given) : Library::Object(shape) {
    set(given);
  }
  void set(const double* given) {
    std::copy(given, given + 6, box);
    this->aabb.min_ = Eigen::Map<const Eigen::Vector3d>(given);
    this->aabb.max_ = Eigen::Map<const Eigen::Vector3d>(given + 3);
  }
  double box[6];
};

template <class Library>
struct Numbered : Library::Object {
  Numbered(const std::shared_ptr<typename Library::Geometry>& mesh, const double* pose, size_t i)
      : Library::Object(mesh, Library::transform(pose)), number(static_cast<std::uint32_t>(i)) {}
  std::uint32_t number;
};

template <class Library>
CchipBroadPeer broad_functions() {
  using Broad = Managed<Library, Boxed<Library>>;
  CchipBroadPeer functions;
  functions.make = [](const double* boxes, size_t count) -> void* {
    const auto shape = std::make_shared<typename Library::Sphere>(1);
    return new Broad(count, [&](size_t i) { return std::make_unique<Boxed<Library>>(shape, boxes + 6 * i); });
  };
  functions.destroy = [](void* broad) { delete static_cast<Broad*>(broad); };
  functions.move = [](void* to, const size_t* numbers, const double* boxes, size_t count) {
    auto& broad = *static_cast<Broad*>(to);
    std::vector<typename Library::Object*> moved;
    for (size_t i = 0; i < count; ++i) {
      broad.objects[numbers[i]]->set(boxes + 6 * i);
      moved.push_back(broad.objects[numbers[i]].get());
    }
    if (count == broad.objects.size()) {
      broad.manager.update();
    } else {
      broad.manager.update(moved);
    }
  };
  functions.replace = [](void* to, const size_t* numbers, const double* boxes, size_t count) {
    auto& broad = *static_cast<Broad*>(to);
    for (size_t i = 0; i < count; ++i) broad.manager.unregisterObject(broad.objects[numbers[i]].get());
    for (size_t i = 0; i < count; ++i) {
      broad.objects[numbers[i]]->set(boxes + 6 * i);
      broad.manager.registerObject(broad.objects[numbers[i]].get());
    }
    broad.manager.setup();
  };
  functions.count = [](void* of) {
    size_t found = 0;
    Library::visit(static_cast<Broad*>(of)->manager, [&found](const auto* x, const auto* y) {
      const auto* const p = static_cast<const Boxed<Library>*>(x);
      const auto* const q = static_cast<const Boxed<Library>*>(y);
      found += cchip_boxes_meet(p->box, q->box) ? 1 : 0;
    });
    return found;
  };
  return functions;
}

template <class Library>
CchipScenePeer scene_functions() {
  using Scene = Managed<Library, Numbered<Library>>;
  CchipScenePeer functions;
  functions.make = [](void* const* meshes, const double* poses, size_t count) -> void* {
    return new Scene(count, [&](size_t i) {
      auto* const mesh = static_cast<typename Library::Geometry*>(static_cast<typename Library::Model*>(meshes[i]));
      const std::shared_ptr<typename Library::Geometry> shared(mesh, [](auto*) {});  // the caller keeps it
      return std::make_unique<Numbered<Library>>(shared, poses + 16 * i, i);
    });
  };
  functions.destroy = [](void* scene) { delete static_cast<Scene*>(scene); };
  functions.move = [](void* to, const double* poses) {
    auto& scene = *static_cast<Scene*>(to);
    for (size_t i = 0; i < scene.objects.size(); ++i) {
      scene.objects[i]->setTransform(Library::transform(poses + 16 * i));
      scene.objects[i]->computeAABB();
    }
    scene.manager.update();
  };
  functions.contacts = [](void* of, std::uint32_t* pairs, size_t room) {
    size_t count = 0;
    Library::visit(static_cast<Scene*>(of)->manager, [&](const auto* x, const auto* y) {
      if (!Library::hit(x, y)) return;
      if (count < room) {
        const std::uint32_t p = static_cast<const Numbered<Library>*>(x)->number;
        const std::uint32_t q = static_cast<const Numbered<Library>*>(y)->number;
        pairs[2 * count] = std::min(p, q);
        pairs[2 * count + 1] = std::max(p, q);
      }
      ++count;
    });
    return count;
  };
  functions.candidates = [](void* of) {
    size_t count = 0;
    Library::visit(static_cast<Scene*>(of)->manager, [&count](const auto*, const auto*) { ++count; });
    return count;
  };
  return functions;
}

}  // namespace

#endif
