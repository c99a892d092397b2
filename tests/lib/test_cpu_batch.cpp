// SPDX-License-Identifier: Apache-2.0
// How the threads of the CPU device divide a batch.
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/shapes.hpp>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "search/search.hpp"

using namespace cchip;

namespace {

/// A thread that comes waits until all have come.
class Meeting {
 public:
  explicit Meeting(std::size_t threads) : threads_(threads) {}
  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    present_.insert(std::this_thread::get_id());
    changed_.notify_all();
    timed_out_ = timed_out_ || !changed_.wait_for(lock, std::chrono::seconds(20),
                                                  [this] { return timed_out_ || present_.size() == threads_; });
    if (timed_out_) changed_.notify_all();
  }
  /// Those that have come. \pre none is about to
  const std::set<std::thread::id>& present() const { return present_; }

 private:
  const std::size_t threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<std::thread::id> present_;
  bool timed_out_ = false;
};

}  // namespace

TEST_CASE("CPU device: a batch has a part for every thread", "[lib][collide]") {
  for (const std::size_t threads : {1U, 2U, 3U, 4U, 16U, 64U}) {
    for (std::size_t count = threads; count < 300 * threads; ++count) {
      const Partition p = partition_of(count, threads);
      // The others' shares are left when all threads but one hold as many queries as they may.
      const std::size_t held = p.at_once * (threads - 1);
      if (held >= count || p.share < 1 || p.share > 32 || p.at_once < p.share || p.at_once % p.share != 0) {
        CAPTURE(threads, count, p.share, p.at_once);
        FAIL("a thread finds nothing to do");
      }
      if (count >= 128 * threads) CHECK(p.share == 32);
    }
  }
  CHECK(partition_of(8, 4).share == 1);
  CHECK(partition_of(64, 4).share == 4);
}

TEST_CASE("CPU device: a search begins no more queries at once than it may", "[lib][collide]") {
  class Feed final : public QueryFeed {
   public:
    Feed(const Device::QuerySource& source, std::size_t most) : QueryFeed(source), most_(most) {}
    std::size_t at_once() const override { return most_; }
    bool next_share(std::size_t& first, std::size_t& end) override {
      if (begun == 40) return false;
      first = begun++;
      end = begun;
      greatest = std::max(greatest, begun - ended);
      return true;
    }
    void done(std::size_t, CollisionResult& result) override {
      ++ended;
      hits += result.hit;
    }
    std::size_t begun = 0;
    std::size_t ended = 0;
    std::size_t greatest = 0;
    std::size_t hits = 0;

   private:
    std::size_t most_;
  };
  const Object torus(make_torus(1, 0.25, 24, 12));
  const Pose here = Pose::Identity();
  const Pose there = make_pose({0.3, 0.1, 0.05}, {20, 10, 0});
  for (const std::string& target : simd_targets()) {
    const auto search = make_simd_search(target);
    for (const std::size_t most : {std::size_t{1}, std::size_t{3}, std::size_t{1000}}) {
      const Device::QuerySource source = [&](std::size_t) { return CollisionQuery{&torus, &here, &torus, &there}; };
      Feed feed(source, most);
      search->run(feed, {});
      CAPTURE(target, most);
      CHECK(feed.ended == 40);
      CHECK(feed.hits == 40);
      CHECK(feed.greatest <= most);
      CHECK(feed.greatest >= std::min<std::size_t>(most, 2));  // otherwise nothing was in step
    }
  }
}

TEST_CASE("CPU device: all threads answer a batch of few queries", "[lib][collide]") {
  constexpr std::size_t threads = 4;
  const Object torus(make_torus(1, 0.25, 24, 12));
  const Pose here = Pose::Identity();
  const Pose there = make_pose({0.3, 0.1, 0.05}, {20, 10, 0});
  for (const CollisionRequest& request : {CollisionRequest{}, CollisionRequest{CollisionRequest::Contacts::all}}) {
    for (const std::size_t count : {4U, 8U, 32U, 64U}) {
      const auto device = open_cpu_device({threads, {}});
      Meeting meeting(threads);
      const auto query = [&](std::size_t) {
        meeting.wait();
        return CollisionQuery{&torus, &here, &torus, &there};
      };
      device->collide(count, query, request, [](std::size_t, const CollisionResult&) {});
      CAPTURE(count, static_cast<int>(request.contacts));
      CHECK(meeting.present().size() == threads);
    }
  }
}

TEST_CASE("CPU device: a batch fetches each query once", "[lib][collide]") {
  constexpr std::size_t count = 500;
  const Object torus(make_torus(1, 0.25, 24, 12));
  const Pose here = Pose::Identity();
  const Pose far = make_pose({5, 0, 0}, {20, 10, 0});
  const Pose there = make_pose({0.3, 0.1, 0.05}, {20, 10, 0});
  for (const CollisionRequest& request : {CollisionRequest{}, CollisionRequest{CollisionRequest::Contacts::all}}) {
    for (const std::string& target : cpu_targets()) {
      for (const unsigned threads : {1U, 3U}) {
        const auto device = open_cpu_device({threads, target});
        std::vector<std::atomic<int>> fetched(count);
        std::vector<int> taken(count, 0);
        std::size_t wrong = 0;
        const auto query = [&](std::size_t i) {
          ++fetched[i];
          return CollisionQuery{&torus, &here, &torus, i % 3 == 0 ? &there : &far};
        };
        device->collide(count, query, request, [&](std::size_t i, const CollisionResult& result) {
          ++taken[i];
          const bool touches = i % 3 == 0;
          wrong += result.hit != touches || result.contacts.empty() == touches || result.stats.box_tests == 0 ||
                   (!touches && result.stats.pairs != 0);
        });
        CAPTURE(target, threads, static_cast<int>(request.contacts));
        CHECK(wrong == 0);
        CHECK(std::all_of(fetched.begin(), fetched.end(), [](const std::atomic<int>& n) { return n == 1; }));
        CHECK(std::all_of(taken.begin(), taken.end(), [](int n) { return n == 1; }));
      }
    }
  }
}

TEST_CASE("CPU device: every answer of a batch has its proof", "[lib][collide]") {
  constexpr std::size_t count = 12;
  const Object face([] {
    Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.faces = {{Kind::tri, {0, 1, 2, 0}}};
    return mesh;
  }());
  const Pose here = Pose::Identity();
  const Pose far = make_pose({5, 0, 0}, {20, 10, 0});
  const Pose there = make_pose({0.1, 0.1, 0}, {20, 10, 0});
  for (const unsigned threads : {1U, 2U, 3U}) {
    const auto device = open_cpu_device({threads, {}});
    const auto query = [&](std::size_t i) { return CollisionQuery{&face, &here, &face, i % 4 == 0 ? &there : &far}; };
    // The second time without, so that nothing of the first is left.
    for (const bool wanted : {true, false}) {
      CollisionRequest request;
      request.certificate = wanted;
      std::size_t proofs = 0;
      device->collide(count, query, request, [&proofs](std::size_t, const CollisionResult& result) {
        proofs += result.certificate ? 1U : 0U;
      });
      CAPTURE(threads, wanted);
      CHECK(proofs == (wanted ? count : 0));
    }
  }
}

TEST_CASE("CPU device: keeps its threads from batch to batch", "[lib][collide]") {
  constexpr std::size_t threads = 3;
  const Object torus(make_torus(1, 0.25, 24, 12));
  const Pose here = Pose::Identity();
  const Pose there = make_pose({0.3, 0.1, 0.05}, {20, 10, 0});
  const auto device = open_cpu_device({threads, {}});
  std::set<std::thread::id> seen;
  for (int batch = 0; batch < 4; ++batch) {
    Meeting meeting(threads);
    const auto query = [&](std::size_t) {
      meeting.wait();
      return CollisionQuery{&torus, &here, &torus, &there};
    };
    device->collide(threads, query, {}, [](std::size_t, const CollisionResult&) {});
    CHECK(meeting.present().size() == threads);
    seen.insert(meeting.present().begin(), meeting.present().end());
  }
  CHECK(seen.size() == threads);
}

namespace {

/// Three objects and a few places, of which some touch; queries about their pairs in any order, some of them twice.
struct Mixed {
  Mixed(const Mixed&) = delete;  // queries refer to its own objects
  Mixed& operator=(const Mixed&) = delete;
  Mixed() {
    std::mt19937_64 random(5);
    std::uniform_int_distribution<std::size_t> any(0, 2);
    std::uniform_real_distribution<double> move(-1.5, 1.5);
    for (int i = 0; i < 40; ++i) poses.push_back(make_pose({move(random), move(random), move(random)}, {20, 10, 0}));
    for (std::size_t i = 0; i < 300; ++i) {
      if (i % 7 == 6) {
        queries.push_back(queries[i / 2]);
      } else {
        queries.push_back({&objects[any(random)], &here, &objects[any(random)], &poses[i % poses.size()]});
      }
    }
  }
  std::array<Object, 3> objects = {Object(make_torus(1, 0.25, 24, 12)), Object(make_sphere(0.7, 6)),
                                   Object(make_torus(0.8, 0.3, 20, 10))};
  Pose here = Pose::Identity();
  std::vector<Pose> poses;
  std::vector<CollisionQuery> queries;
};

}  // namespace

TEST_CASE("collide: a batch of several pairs of objects gives what single queries give", "[lib][collide]") {
  std::mt19937_64 random(6);
  for (const CollisionRequest& request : {CollisionRequest{}, CollisionRequest{CollisionRequest::Contacts::all}}) {
    for (const unsigned threads : {1U, 3U}) {
      const auto device = open_cpu_device({threads, {}});
      Mixed mixed;
      CHECK(collide(*device, std::vector<CollisionQuery>(), request).empty());
      for (int round = 0; round < 4; ++round) {
        // The last rounds are short: one query, and the same one twice.
        if (round > 1) mixed.queries.resize(round == 2 ? 1 : 2, mixed.queries.front());
        const std::vector<CollisionResult> results = collide(*device, mixed.queries, request);
        REQUIRE(results.size() == mixed.queries.size());
        std::size_t hits = 0;
        for (std::size_t i = 0; i < results.size(); ++i) {
          CollisionResult single;
          device->collide(mixed.queries[i], request, single);
          CAPTURE(round, threads, i);
          CHECK(results[i].hit == single.hit);
          CHECK(results[i].contacts == single.contacts);
          CHECK(results[i].stats.box_tests == single.stats.box_tests);
          hits += single.hit;
        }
        if (round < 2) CHECK((hits > 30 && hits < 270));  // otherwise the order of the results is not tested
        std::shuffle(mixed.queries.begin(), mixed.queries.end(), random);
      }
    }
  }
}

TEST_CASE("collide: a batch asks about the same two objects one query behind the other", "[lib][collide]") {
  class Recorder final : public Device {
   public:
    const char* name() const override { return "recorder"; }
    std::vector<CollisionQuery> asked;

   private:
    void answer(const CollisionQuery& query, const CollisionRequest&, CollisionResult&) override {
      asked.push_back(query);
    }
  };
  const Mixed mixed;
  Recorder recorder;
  CHECK(collide(recorder, mixed.queries).size() == mixed.queries.size());
  REQUIRE(recorder.asked.size() == mixed.queries.size());
  std::set<std::pair<const Object*, const Object*>> seen;
  std::size_t changes = 0;
  for (std::size_t i = 0; i < recorder.asked.size(); ++i) {
    const CollisionQuery& query = recorder.asked[i];
    seen.emplace(query.a, query.b);
    changes += i == 0 || query.a != recorder.asked[i - 1].a || query.b != recorder.asked[i - 1].b;
  }
  CHECK(seen.size() == 9);
  CHECK(changes == 9);
}

TEST_CASE("CPU device: the first query of a batch that is refused ends it", "[lib][collide]") {
  const Object torus(make_torus(1, 0.25, 24, 12));
  const Pose here = Pose::Identity();
  const Pose far = make_pose({5, 0, 0}, {20, 10, 0});
  Pose bad = Pose::Identity();
  bad(1, 2) = std::numeric_limits<double>::quiet_NaN();
  for (const std::string& target : cpu_targets()) {
    const auto device = open_cpu_device({1, target});
    std::size_t taken = 0;
    const auto query = [&](std::size_t i) { return CollisionQuery{&torus, &here, &torus, i == 7 ? &bad : &far}; };
    const auto take = [&taken](std::size_t i, const CollisionResult&) { taken += i < 7 ? 1 : 100; };
    CAPTURE(target);
    CHECK_THROWS_WITH(device->collide(20, query, {}, take),
                      "pose of B: row 1, column 2 is not finite or beyond 2^500; check it or scale it");
    CHECK(taken <= 7);
    taken = 0;
    device->collide(7, query, {}, take);
    CHECK(taken == 7);
  }
}

namespace {

void ask_all_targets() {
  const Object torus(make_torus(1, 0.25, 24, 12));
  const Pose here = Pose::Identity();
  for (const std::string& target : cpu_targets()) {
    CHECK(collide(*open_cpu_device({1, target}), torus, here, torus, here).hit);
  }
}

}  // namespace

// What is looked up once for a process happens in the first of these: ctest runs each in a process of its own.
TEST_CASE("CPU device: another user's choice of Highway's target stays", "[lib][collide]") {
  hwy::ChosenTarget& chosen = hwy::GetChosenTarget();
  std::int64_t targets = hwy::SupportedTargets();
  chosen.Update(targets);
  const std::size_t best = chosen.GetIndex();
  for (; targets != 0 && chosen.GetIndex() == best; chosen.Update(targets)) targets &= targets - 1;
  const std::size_t mine = chosen.GetIndex();
  REQUIRE(mine != best);  // not the best one, which any call of Highway's chooses
  ask_all_targets();
  CHECK(chosen.GetIndex() == mine);
}

TEST_CASE("CPU device: makes no choice of Highway's target for others", "[lib][collide]") {
  hwy::GetChosenTarget().DeInit();
  ask_all_targets();
  CHECK_FALSE(hwy::GetChosenTarget().IsInitialized());
}
