// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/collide.hpp>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "exact/float_mode.hpp"

namespace cchip {
namespace {

std::vector<CollisionResult> gather(Device& device, std::size_t count, const Device::QuerySource& query,
                                    const CollisionRequest& request) {
  std::vector<CollisionResult> results(count);
  device.collide(count, query, request,
                 [&results](std::size_t i, const CollisionResult& result) { results[i] = result; });
  return results;
}

/// The numbers of the queries, those about the same two objects behind each other: what one of them has read into the
/// caches serves the next. Pairs of objects come in the order of their first queries. Empty: the queries are in this
/// order already.
std::vector<std::size_t> by_objects(const std::vector<CollisionQuery>& queries) {
  const auto same = [&queries](std::size_t i, std::size_t k) {
    return queries[i].a == queries[k].a && queries[i].b == queries[k].b;
  };
  // The first query of each pair of objects, by a hash of the objects or in the next empty place. A standard map takes
  // memory for each pair, which costs as much as a query whose objects are far apart.
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::size_t places = 1;
  while (places < 2 * queries.size()) places *= 2;
  std::vector<std::size_t> table(places, none);
  const auto place_of = [&](std::size_t i) {
    const auto number = [](const Object* object) { return reinterpret_cast<std::uintptr_t>(object); };  // NOLINT
    const std::uint64_t mixed = (number(queries[i].a) * 31 + number(queries[i].b)) * 0x9e3779b97f4a7c15U;
    std::size_t place = static_cast<std::size_t>(mixed >> 32U) & (places - 1);
    while (table[place] != none && !same(table[place], i)) place = (place + 1) & (places - 1);
    return place;
  };
  std::vector<std::size_t> pair_of(queries.size());
  std::vector<std::size_t> starts;  // of each pair, first the number of its queries
  bool in_order = true;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (i > 0 && same(i, i - 1)) {
      pair_of[i] = pair_of[i - 1];
    } else if (std::size_t& first = table[place_of(i)]; first == none) {
      first = i;
      pair_of[i] = starts.size();
      starts.push_back(0);
    } else {
      pair_of[i] = pair_of[first];
      in_order = false;
    }
    ++starts[pair_of[i]];
  }
  if (in_order) return {};
  std::size_t start = 0;
  for (std::size_t& of_pair : starts) start += std::exchange(of_pair, start);
  std::vector<std::size_t> order(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) order[starts[pair_of[i]]++] = i;
  return order;
}

Device::QuerySource in_poses(const Object& a, const Object& b, const std::vector<PosePair>& poses) {
  return [&a, &b, &poses](std::size_t i) { return CollisionQuery{&a, &poses[i].a, &b, &poses[i].b}; };
}

/// Ends a batch whose sink has returned false.
struct Enough {};

}  // namespace

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
  if (result.certificate) result.certificate.reset();  // of another answer
  answer(query, request, result);
}

void Device::collide(std::size_t count, const QuerySource& query, const CollisionRequest& request,
                     const ResultSink& take) {
  const Use use(*this);
  check_float_mode();
  // Checked where it is fetched: a pass of its own before the batch would cost as much as a pair that is far apart.
  const QuerySource checked = [&query, &request](std::size_t i) {
    const CollisionQuery asked = query(i);
    check_query(asked, request);
    return asked;
  };
  // Every device must end a batch when its sink throws, so this stops all of them alike.
  const ResultSink stop_or_go_on = [&take](std::size_t i, const CollisionResult& result) {
    if (!take(i, result)) throw Enough();
  };
  try {
    answer_all(count, checked, request, stop_or_go_on);
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
  const std::vector<std::size_t> order = by_objects(queries);
  if (order.empty()) {
    return gather(
        device, queries.size(), [&queries](std::size_t i) { return queries[i]; }, request);
  }
  std::vector<CollisionResult> results(queries.size());
  device.collide(
      queries.size(), [&](std::size_t i) { return queries[order[i]]; }, request,
      [&](std::size_t i, const CollisionResult& result) { results[order[i]] = result; });
  return results;
}

}  // namespace cchip
