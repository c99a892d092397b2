// SPDX-License-Identifier: Apache-2.0
// Once a device has seen its queries, answering them again takes no memory from the heap.
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <cstdlib>
#include <new>
#include <thread>

#include "random_poses.hpp"

using namespace cchip;
using cchip_test::PoseClass;
using cchip_test::random_pose;

namespace {

std::atomic<std::size_t> allocations = 0;
std::atomic<std::size_t> bytes = 0;  // in use

/// Whose requests for 1000 bytes and more are refused.
enum class Refused { none, caller, helpers };
std::atomic<Refused> refused = Refused::none;
std::atomic<std::size_t> refusals = 0;
const std::thread::id caller = std::this_thread::get_id();

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  if (refused != Refused::none && size >= 1000 &&
      (refused == Refused::caller) == (std::this_thread::get_id() == caller)) {
    ++refusals;
    throw std::bad_alloc();
  }
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded)) {
    bytes += malloc_usable_size(memory);
    return memory;
  }
  throw std::bad_alloc();
}

void give_back(void* memory) {
  bytes -= malloc_usable_size(memory);
  std::free(memory);
}

constexpr std::size_t plain = alignof(std::max_align_t);

}  // namespace

// The other forms of new and delete call these.
void* operator new(std::size_t size) { return counted(size, plain); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { give_back(memory); }
void operator delete(void* memory, std::size_t) noexcept { give_back(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { give_back(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { give_back(memory); }

namespace {

/// Queries of two pairs of objects in turn, in which doubles can tell every answer.
struct Queries {
  Queries() {
    std::mt19937_64 random(sim::seed_from_environment());
    for (int i = 0; i < 200; ++i) {
      poses.push_back({random_pose(PoseClass::rigid, 1, random), random_pose(PoseClass::rigid, 1, random)});
    }
  }
  CollisionQuery at(std::size_t i) const { return {&body, &poses[i].a, i % 2 == 0 ? &torus : &quads, &poses[i].b}; }
  Object body = Object(make_body(20, 0.5));
  Object torus = Object(make_torus(1, 0.4, 48, 24));
  Object quads = Object(make_torus(1, 0.4, 48, 24, Kind::quad));
  std::vector<PosePair> poses;
};

std::size_t allocations_of(const std::function<void()>& work) {
  const std::size_t before = allocations;
  work();
  return allocations - before;
}

}  // namespace

TEST_CASE("memory: the counter counts", "[lib][collide]") {
  CHECK(allocations_of([] {
          const std::vector<int> some(100);
          CHECK(some.size() == 100);
        }) >= 1);
}

TEST_CASE("memory: a query into a result that is used again allocates nothing", "[lib][collide]") {
  const Queries queries;
  for (const std::string& target : cpu_targets()) {
    const auto device = open_cpu_device({1, target});
    for (const CollisionRequest& request : {CollisionRequest{}, CollisionRequest{CollisionRequest::Contacts::all}}) {
      CollisionResult result;
      std::size_t hits = 0;
      std::uint64_t open = 0;
      const std::function<void()> all = [&] {
        for (std::size_t i = 0; i < queries.poses.size(); ++i) {
          device->collide(queries.at(i), request, result);
          hits += result.hit;
          open += result.stats.open;
        }
      };
      all();
      CAPTURE(target, static_cast<int>(request.contacts));
      CHECK(hits > queries.poses.size() / 4);
      CHECK(open == 0);
      CHECK(allocations_of(all) == 0);
    }
  }
}

TEST_CASE("memory: a batch allocates nothing for its queries", "[lib][collide]") {
  const Queries queries;
  for (const std::string& target : cpu_targets()) {
    for (const unsigned threads : {1U, 2U}) {
      const auto device = open_cpu_device({threads, target});
      for (const CollisionRequest& request : {CollisionRequest{}, CollisionRequest{CollisionRequest::Contacts::all}}) {
        std::size_t hits = 0;
        const std::function<CollisionQuery(std::size_t)> query = [&](std::size_t i) { return queries.at(i); };
        const std::function<void(std::size_t, const CollisionResult&)> take =
            [&hits](std::size_t, const CollisionResult& result) { hits += result.hit; };
        const std::function<void()> all = [&] { device->collide(queries.poses.size(), query, request, take); };
        for (int i = 0; i < 8; ++i) all();
        // With several threads it is chance when each of them comes, and which of them meets the largest query. So one
        // call of many must do.
        const std::size_t few = threads == 1 ? 0 : 16;  // for a call with threads, none for a query
        std::size_t fewest = allocations_of(all);
        for (int i = 0; i < 50 && threads > 1 && fewest > few; ++i) fewest = std::min(fewest, allocations_of(all));
        CAPTURE(target, threads, static_cast<int>(request.contacts));
        CHECK(hits > 2 * queries.poses.size());
        CHECK(fewest <= few);
      }
    }
  }
}

TEST_CASE("memory: a batch for which there is none in one of its threads ends with bad_alloc", "[lib][collide]") {
  const Queries queries;
  constexpr std::size_t count = 20000;
  for (const Refused who : {Refused::caller, Refused::helpers}) {
    const auto device = open_cpu_device({2, {}});
    std::size_t taken = 0;
    const Device::QuerySource query = [&](std::size_t i) {
      // The caller's thread waits until the other one has come.
      const bool working = std::this_thread::get_id() == caller;
      while (working && refused == Refused::helpers && refusals == 0) std::this_thread::yield();
      return queries.at(i % queries.poses.size());
    };
    const Device::ResultSink take = [&taken](std::size_t, const CollisionResult&) { ++taken; };
    bool out_of_memory = false;
    refusals = 0;
    refused = who;
    try {
      device->collide(count, query, {}, take);
    } catch (const std::bad_alloc&) {
      out_of_memory = true;
    }
    refused = Refused::none;
    CAPTURE(static_cast<int>(who));
    CHECK(refusals > 0);
    CHECK(out_of_memory);
    taken = 0;
    device->collide(count, query, {}, take);
    CHECK(taken == count);
  }
}

TEST_CASE("memory: a device does not keep that of large results", "[lib][collide]") {
  const Object torus(make_torus(1, 0.25, 24, 10));
  const Pose here = Pose::Identity();
  const auto query = [&](std::size_t) { return CollisionQuery{&torus, &here, &torus, &here}; };
  const auto device = open_cpu_device({2, {}});
  std::size_t contacts = 0;
  const std::size_t before = bytes;
  device->collide(64, query, {CollisionRequest::Contacts::all},
                  [&contacts](std::size_t, const CollisionResult& result) { contacts = result.contacts.size(); });
  CHECK(contacts > 4096);
  CHECK(bytes < before + (std::size_t{1} << 20U));
}
