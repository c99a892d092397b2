// SPDX-License-Identifier: Apache-2.0
/// \file
/// Broad phases of other libraries, which are given the boxes of our scene.
#ifndef CCHIP_BENCH_BROAD_PEERS_HPP
#define CCHIP_BENCH_BROAD_PEERS_HPP

#include <cchip/scene.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "peer_library.hpp"
#ifdef CCHIP_HAS_BULLET
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <cmath>
#endif

namespace cchip::testing {

/// Boxes by numbers from 0.
class BroadPeer {
 public:
  BroadPeer() = default;
  BroadPeer(const BroadPeer&) = delete;
  BroadPeer& operator=(const BroadPeer&) = delete;
  virtual ~BroadPeer() = default;
  virtual void begin(const std::vector<WorldBox>& boxes) = 0;
  virtual void move(const std::vector<std::size_t>& numbers, const std::vector<WorldBox>& boxes) = 0;
  /// Takes boxes out and puts others with the same numbers in.
  virtual void replace(const std::vector<std::size_t>& numbers, const std::vector<WorldBox>& boxes) = 0;
  /// How many pairs overlap. Whatever boxes the peer has, those that it was given decide.
  virtual std::size_t count() = 0;
};

/// That of a library behind a C interface.
class LibraryBroad : public BroadPeer {
 public:
  /// \pre library.broad() is not null
  explicit LibraryBroad(const PeerLibrary& library) : peer_(*library.broad()), broad_(nullptr, peer_.destroy) {}
  void begin(const std::vector<WorldBox>& boxes) override { broad_.reset(peer_.make(numbers_of(boxes), boxes.size())); }
  void move(const std::vector<std::size_t>& numbers, const std::vector<WorldBox>& boxes) override {
    peer_.move(broad_.get(), numbers.data(), numbers_of(boxes), numbers.size());
  }
  void replace(const std::vector<std::size_t>& numbers, const std::vector<WorldBox>& boxes) override {
    peer_.replace(broad_.get(), numbers.data(), numbers_of(boxes), numbers.size());
  }
  std::size_t count() override { return peer_.count(broad_.get()); }

 private:
  static const double* numbers_of(const std::vector<WorldBox>& boxes) {
    static_assert(sizeof(WorldBox) == 6 * sizeof(double));
    return boxes.front().least.data();
  }
  const CchipBroadPeer& peer_;
  std::unique_ptr<void, void (*)(void*)> broad_;
};

#ifdef CCHIP_HAS_BULLET
/// btDbvtBroadphase, with its cache of pairs. Its floats are rounded outwards.
class BulletBroad : public BroadPeer {
 public:
  void begin(const std::vector<WorldBox>& boxes) override {
    boxes_ = boxes;
    for (std::size_t i = 0; i < boxes.size(); ++i) proxies_.push_back(proxy(i));
  }
  void move(const std::vector<std::size_t>& numbers, const std::vector<WorldBox>& boxes) override {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      WorldBox& box = boxes_[numbers[i]];
      box = boxes[i];
      broad_.setAabb(proxies_[numbers[i]], least(box), greatest(box), nullptr);
    }
  }
  void replace(const std::vector<std::size_t>& numbers, const std::vector<WorldBox>& boxes) override {
    for (const std::size_t number : numbers) broad_.destroyProxy(proxies_[number], nullptr);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      boxes_[numbers[i]] = boxes[i];
      proxies_[numbers[i]] = proxy(numbers[i]);
    }
  }
  std::size_t count() override {
    broad_.calculateOverlappingPairs(nullptr);
    const btBroadphasePairArray& pairs = broad_.getOverlappingPairCache()->getOverlappingPairArray();
    std::size_t count = 0;
    for (int i = 0; i < pairs.size(); ++i) {
      const WorldBox& p = box(pairs[i].m_pProxy0);
      const WorldBox& q = box(pairs[i].m_pProxy1);
      count += cchip_boxes_meet(p.least.data(), q.least.data()) ? 1 : 0;
    }
    return count;
  }

 private:
  static btVector3 least(const WorldBox& box) {
    const auto down = [](double x) {
      return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
    };
    return {down(box.least[0]), down(box.least[1]), down(box.least[2])};
  }
  static btVector3 greatest(const WorldBox& box) {
    const auto up = [](double x) {
      return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
    };
    return {up(box.greatest[0]), up(box.greatest[1]), up(box.greatest[2])};
  }
  btBroadphaseProxy* proxy(std::size_t number) {
    WorldBox& box = boxes_[number];
    return broad_.createProxy(least(box), greatest(box), 0, &box, 1, 1, nullptr);
  }
  static const WorldBox& box(const btBroadphaseProxy* proxy) {
    return *static_cast<const WorldBox*>(proxy->m_clientObject);
  }
  std::vector<WorldBox> boxes_;
  btDbvtBroadphase broad_;
  std::vector<btBroadphaseProxy*> proxies_;
};
#endif

}  // namespace cchip::testing

#endif
