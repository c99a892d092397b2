// SPDX-License-Identifier: Apache-2.0
// The host of a chip over a port that may complete queries in any order, run out of room, answer nonsense, stop or die.
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cchip/device.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/program/seed.hpp>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "bvh_meshes.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip::testing;
using cchip_test::PoseClass;
using cchip_test::random_pose;

namespace {

const CollisionRequest all = {CollisionRequest::Contacts::all};

/// What a test tells its port, and what the port has seen. Outlives the device.
struct Bench {
  ChipCapabilities chip;
  std::size_t slots = 4;                       ///< submit() returns false beyond
  std::function<void(QueryOutcome&)> corrupt;  ///< changes outcomes
  std::set<std::uint64_t> hang;                ///< numbers of submissions that never end
  std::uint64_t full = 0;                      ///< number of proceed() before a slot is free
  std::string dies_in;                         ///< name of a call that throws ...
  std::uint64_t dies_at = 0;                   ///< ... when it comes for the time of this number, from 1 on
  bool recovers = true;
  std::function<bool(std::vector<Line>&)> refit;  ///< what the engine makes of the lines of an image

  std::map<std::string, std::uint64_t> calls;
  std::uint64_t submitted = 0;
  std::uint64_t refused = 0;
  std::uint64_t collected = 0;
  std::uint64_t out_of_order = 0;
  std::uint64_t dropped = 0;  ///< by recover()
  std::size_t most_in_flight = 0;
  std::uint64_t clock = 0;
  std::uint64_t first_submission = 0;  ///< clock
  std::uint64_t last_collection = 0;   ///< clock
  std::map<unsigned, std::pair<std::uint32_t, std::uint32_t>> locks;
  std::vector<std::string> violations;  ///< what a host may not do
};

class FakePort final : public QueryPort {
 public:
  explicit FakePort(Bench& bench) : bench_(bench), memory_(bench.chip.image_lines) {}

  const char* name() const override { return "fake"; }
  ChipCapabilities capabilities() const override { return bench_.chip; }

  void store(std::uint32_t first_line, const std::vector<Line>& lines) override {
    called("store");
    check(first_line >= bench_.chip.image_first, "store: before the memory");
    const std::size_t at = first_line - bench_.chip.image_first;
    check(at + lines.size() <= memory_.size(), "store: behind the memory");
    for (const Flight& flight : flights_) {
      for (const auto& [first, end] : {flight.a, flight.b}) {
        check(at >= end || at + lines.size() <= first, "store: lines of a query in flight");
      }
    }
    for (const auto& [range, lock] : bench_.locks) {
      check(lock.first > lock.second || first_line > lock.second || first_line + lines.size() <= lock.first,
            "store: locked lines");
    }
    std::copy(lines.begin(), lines.end(), memory_.begin() + static_cast<std::ptrdiff_t>(at));
  }

  bool refit(std::uint32_t first_line, std::uint32_t lines, std::uint32_t root) override {
    called("refit");
    check(bench_.chip.refits, "refit: no engine");
    const auto at = memory_.begin() + (first_line - bench_.chip.image_first);
    check(bvh::decode_header(*at).lines == lines && bvh::decode_header(*at).root == root, "refit: no image");
    std::vector<Line> image(at, at + lines);
    const bool good = bench_.refit(image);
    std::copy(image.begin(), image.end(), at);
    return good;
  }

  void lock(unsigned range, std::uint32_t first, std::uint32_t last) override {
    called("lock");
    check(range < bench_.chip.lock_ranges, "lock: range");
    bench_.locks[range] = {first, last};
  }

  bool submit(const Query& query) override {
    called("submit");
    if (bench_.full > 0 || flights_.size() >= bench_.slots) {
      ++bench_.refused;
      return false;
    }
    for (const Flight& flight : flights_) check(flight.query.tag != query.tag, "submit: tag");
    if (bench_.submitted == 0) bench_.first_submission = bench_.clock;
    flights_.push_back({query, bench_.submitted++, range_of(query.base_a), range_of(query.base_b)});
    bench_.most_in_flight = std::max(bench_.most_in_flight, flights_.size());
    return true;
  }

  std::optional<QueryOutcome> collect() override {
    called("collect");
    if (random_() % 2 == 0) return std::nullopt;
    std::vector<std::size_t> ready;
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      if (bench_.hang.count(flights_[i].number) == 0) ready.push_back(i);
    }
    if (ready.empty()) return std::nullopt;
    const std::size_t i = ready[random_() % ready.size()];
    const Flight flight = flights_[i];
    flights_.erase(flights_.begin() + static_cast<std::ptrdiff_t>(i));
    if (i != 0) ++bench_.out_of_order;
    ++bench_.collected;
    bench_.last_collection = bench_.clock;
    // Memory is read now: lines that were overwritten in the meantime change the answer.
    const model::BroadPhaseResult result = model::run_query(flight.query, image(flight.a), image(flight.b));
    QueryOutcome outcome{result.done, result.pairs, result.counts.box_tests, result.counts.primitive_pairs};
    if (bench_.corrupt) bench_.corrupt(outcome);
    return outcome;
  }

  bool proceed() override {
    called("proceed");
    bench_.clock += 7;
    if (bench_.full > 0) --bench_.full;
    const bool hangs = !flights_.empty() && std::all_of(flights_.begin(), flights_.end(), [this](const Flight& x) {
      return bench_.hang.count(x.number) != 0;
    });
    const bool overdue = std::any_of(flights_.begin(), flights_.end(), [this](const Flight& x) {
      return bench_.hang.count(x.number) != 0 && bench_.submitted > x.number + bench_.slots - 2;
    });
    return !hangs && !overdue && (!flights_.empty() || bench_.full > 0);
  }

  bool recover() override {
    called("recover");
    bench_.dropped += flights_.size();
    flights_.clear();
    std::fill(memory_.begin(), memory_.end(), Line{});
    bench_.locks.clear();
    if (!bench_.recovers) dead_ = true;
    return bench_.recovers;
  }

  std::uint64_t clocks() const override {
    const_cast<FakePort*>(this)->called("clocks");
    return bench_.clock;
  }

 private:
  using Range = std::pair<std::size_t, std::size_t>;  // in memory_: first, end

  struct Flight {
    Query query;
    std::uint64_t number;
    Range a;
    Range b;
  };

  void check(bool condition, const char* rule) {
    if (!condition) bench_.violations.emplace_back(rule);
  }

  void called(const std::string& call) {
    check(!dead_, "a call of a dead chip");
    if (++bench_.calls[call] != bench_.dies_at || call != bench_.dies_in) return;
    dead_ = true;
    throw std::runtime_error("the board is gone");
  }

  Range range_of(std::uint32_t base) {
    const std::size_t at = base - bench_.chip.image_first;
    if (base < bench_.chip.image_first || at >= memory_.size()) {
      check(false, "submit: base");
      return {0, 0};
    }
    const bvh::HeaderLine header = bvh::decode_header(memory_[at]);
    if (header.magic != bvh::image_magic || header.lines > memory_.size() - at ||
        bvh::image_crc(image({at, at + header.lines})) != header.crc) {
      check(false, "submit: no image at a base");
      return {0, 0};
    }
    return {at, at + header.lines};
  }

  bvh::Image image(const Range& range) const {
    if (range.first == range.second) return {{Line{}}};
    return {{memory_.begin() + static_cast<std::ptrdiff_t>(range.first),
             memory_.begin() + static_cast<std::ptrdiff_t>(range.second)}};
  }

  Bench& bench_;
  std::vector<Line> memory_;
  std::vector<Flight> flights_;
  std::mt19937_64 random_{sim::seed_from_environment()};
  bool dead_ = false;
};

std::unique_ptr<Device> open_fake(Bench& bench, const ChipHostOptions& options = {}) {
  return make_chip_device(std::make_unique<FakePort>(bench), options);
}

std::uint32_t lines_of(const Object& object) {
  return static_cast<std::uint32_t>(bvh::make_image(object.mesh(), bvh::build_tree(object.mesh())).lines.size());
}

/// Objects of triangles, queries between them, and the CPU's answers.
class Scene {
 public:
  explicit Scene(std::size_t count) : random_(sim::seed_from_environment()) {
    for (int i = 0; i < 3; ++i) {
      objects.emplace_back(noisy(make_torus(2, 0.7, 14 + 3 * i, 8), 0.02, random_));
      objects.emplace_back(make_gear(1.4, 2, 0.6, 0.8, 6 + i, 1));
    }
    for (const Object& object : objects) most_lines = std::max(most_lines, lines_of(object));
    for (std::size_t i = 0; i < count; ++i) {
      add(objects[random_() % objects.size()], objects[random_() % objects.size()]);
    }
  }

  void add(const Object& a, const Object& b) {
    poses_.push_back(std::make_unique<PosePair>(
        PosePair{random_pose(PoseClass::rigid, 0.5, random_), random_pose(PoseClass::rigid, 2, random_)}));
    queries.push_back({&a, &poses_.back()->a, &b, &poses_.back()->b});
    CollisionResult result;
    cpu_->collide(queries.back(), all, result);
    expected.push_back(result.contacts);
  }

  /// The contacts of query i must be the CPU's.
  bool is_right(std::size_t i, const CollisionRequest& request, const CollisionResult& result) const {
    if (result.hit != !expected[i].empty()) return false;
    if (request.contacts == CollisionRequest::Contacts::all) return result.contacts == expected[i];
    return result.contacts.size() == (result.hit ? 1 : 0) &&
           (!result.hit || std::binary_search(expected[i].begin(), expected[i].end(), result.contacts[0]));
  }

  /// Asks all queries, in one batch or one by one. \returns the results, which are right
  std::vector<CollisionResult> ask(Device& device, const CollisionRequest& request, bool batch) const {
    std::vector<CollisionResult> results(queries.size());
    if (batch) {
      results = collide(device, queries, request);
    } else {
      for (std::size_t i = 0; i < queries.size(); ++i) device.collide(queries[i], request, results[i]);
    }
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (is_right(i, request, results[i]) || ++wrong > 1) continue;
      FAIL_CHECK("query " << i << (request.contacts == CollisionRequest::Contacts::all ? ", all: " : ", first: ")
                          << results[i].contacts.size() << " contacts of " << expected[i].size());
    }
    CHECK(wrong == 0);
    return results;
  }

  std::vector<Object> objects;
  std::uint32_t most_lines = 0;  ///< of an image
  std::vector<CollisionQuery> queries;
  std::vector<std::vector<Contact>> expected;

 private:
  std::mt19937_64 random_;
  std::vector<std::unique_ptr<PosePair>> poses_;
  std::unique_ptr<Device> cpu_ = open_device("cpu");
};

std::uint64_t fallbacks(const std::vector<CollisionResult>& results) {
  CollisionStats sum;
  for (const CollisionResult& result : results) sum += result.stats;
  return sum.fallbacks;
}

/// Four slots, memory for all images of a scene.
Bench roomy(const Scene& scene) {
  Bench bench;
  bench.chip.queries_in_flight = 4;
  bench.chip.image_first = 1000;
  bench.chip.image_lines = static_cast<std::uint32_t>(scene.objects.size()) * scene.most_lines;
  bench.chip.lock_ranges = 2;
  return bench;
}

void check_obeyed(const Bench& bench) { CHECK(bench.violations == std::vector<std::string>{}); }

}  // namespace

TEST_CASE("chip host: any order of completion, few slots, little memory", "[ref][chip_host]") {
  const Scene scene(120);
  const bool batch = GENERATE(true, false);
  const CollisionRequest request = GENERATE(true, false) ? all : CollisionRequest{};
  const unsigned ranges = GENERATE(0U, 1U, 2U);
  Bench bench = roomy(scene);
  bench.chip.queries_in_flight = 9;
  bench.chip.lock_ranges = ranges;
  const bool little = GENERATE(true, false);
  bench.slots = 3;
  bench.chip.image_lines = (little ? 2 : 4) * scene.most_lines + scene.most_lines / 2;
  const auto device = open_fake(bench);
  CHECK(device->name() == std::string("fake"));
  const std::vector<CollisionResult> results = scene.ask(*device, request, batch);
  CHECK(fallbacks(results) == 0);
  CHECK(bench.submitted == scene.queries.size());
  CHECK(bench.calls["store"] > scene.objects.size());  // some had to leave and came again
  CHECK((bench.calls["lock"] > 0) == (ranges > 0));
  if (batch && !little) {
    CHECK(bench.most_in_flight == bench.slots);
    CHECK(bench.refused > 0);
    CHECK(bench.out_of_order > 0);
  }
  check_obeyed(bench);
}

TEST_CASE("chip host: images stay in memory while there is room", "[ref][chip_host]") {
  const Scene scene(60);
  Bench bench = roomy(scene);
  const auto device = open_fake(bench);
  scene.ask(*device, all, true);
  scene.ask(*device, {}, false);
  CHECK(bench.calls["store"] == scene.objects.size());
  check_obeyed(bench);
  SECTION("at most as many as the options say") {
    Bench other = roomy(scene);
    ChipHostOptions options;
    options.kept_images = 3;
    const auto forgetful = open_fake(other, options);
    scene.ask(*forgetful, all, GENERATE(true, false));
    CHECK(other.calls["store"] > scene.objects.size());
    check_obeyed(other);
  }
  SECTION("at most as many lines as the options say, but the two of a query") {
    Bench other = roomy(scene);
    ChipHostOptions options;
    options.kept_lines = 1;
    const auto forgetful = open_fake(other, options);
    CHECK(fallbacks(scene.ask(*forgetful, all, GENERATE(true, false))) == 0);
    CHECK(other.calls["store"] > scene.objects.size());
    check_obeyed(other);
  }
}

TEST_CASE("chip host: two images that fill the memory take the places of others", "[ref][chip_host]") {
  // In any order of sizes, what is free may lie on both sides of an image that is to stay.
  Scene scene(0);
  std::uint32_t memory = 0;
  for (const auto& [x, y] : {std::pair(5, 4), std::pair(4, 5), std::pair(4, 2), std::pair(5, 4), std::pair(2, 3),
                             std::pair(2, 4), std::pair(4, 4), std::pair(1, 2), std::pair(2, 4)}) {
    const Object& a = scene.objects[static_cast<std::size_t>(x)];
    const Object& b = scene.objects[static_cast<std::size_t>(y)];
    scene.add(a, b);
    if (x != y) memory = std::max(memory, lines_of(a) + lines_of(b));
  }
  Bench bench = roomy(scene);
  bench.chip.image_lines = memory;
  const auto device = open_fake(bench);
  CHECK(fallbacks(scene.ask(*device, all, GENERATE(true, false))) == 0);
  check_obeyed(bench);
}

TEST_CASE("chip host: images too large for the memory", "[ref][chip_host]") {
  Scene scene(0);
  const Object& big = scene.objects[4];  // the finest torus
  const Object& small = scene.objects[1];
  const std::uint32_t lines = lines_of(big);
  REQUIRE(lines == scene.most_lines);
  REQUIRE(lines_of(small) < lines);
  for (int i = 0; i < 5; ++i) {
    scene.add(big, big);
    scene.add(small, big);
    scene.add(small, small);
    scene.add(big, small);
  }
  const bool batch = GENERATE(true, false);
  const auto run = [&](std::uint32_t memory, std::uint64_t expected) {
    CAPTURE(memory);
    Bench bench = roomy(scene);
    bench.chip.image_lines = memory;
    const auto device = open_fake(bench);
    CHECK(fallbacks(scene.ask(*device, all, batch)) == expected);
    CHECK(bench.submitted == 20 - expected);
    check_obeyed(bench);
  };
  run(lines + lines_of(small), 0);
  run(lines + lines_of(small) - 1, 10);  // each fits, not both
  run(lines - 1, 15);
  run(lines_of(small) - 1, 20);
  run(0, 20);
}

TEST_CASE("chip host: queries that a chip cannot take", "[ref][chip_host]") {
  Scene scene(10);
  const Object quads(make_torus(1.5, 0.5, 12, 8, Kind::quad));
  for (int i = 0; i < 5; ++i) {
    scene.add(quads, scene.objects[0]);
    scene.add(scene.objects[1], quads);
  }
  const bool batch = GENERATE(true, false);
  SECTION("quads") {
    Bench bench = roomy(scene);
    bench.chip.quads = false;
    const auto device = open_fake(bench);
    const std::vector<CollisionResult> results = scene.ask(*device, all, batch);
    for (std::size_t i = 0; i < results.size(); ++i) CHECK(results[i].stats.fallbacks == (i < 10 ? 0 : 1));
    CHECK(bench.submitted == 10);
    check_obeyed(bench);
  }
  SECTION("a pose") {
    Pose small = Pose::Identity();
    small.linear() *= 0x1p-20;  // units too far apart
    Bench bench = roomy(scene);
    const auto device = open_fake(bench);
    const CollisionResult found = collide(*device, quads, Pose::Identity(), quads, small, all);
    const auto cpu = open_device("cpu");
    const CollisionResult expected = collide(*cpu, quads, Pose::Identity(), quads, small, all);
    CHECK(found.contacts == expected.contacts);
    CHECK(found.stats.fallbacks == 1);
    CHECK(found.stats.steps == expected.stats.steps);
    CHECK(expected.stats.fallbacks == 0);
    CHECK(bench.submitted == 0);
  }
}

TEST_CASE("chip host: error codes and records that make no sense", "[ref][chip_host]") {
  const Scene scene(24);
  const bool batch = GENERATE(true, false);
  const CollisionRequest request = GENERATE(true, false) ? all : CollisionRequest{};
  const auto run = [&](const char* what, bool only_hits, const std::function<void(QueryOutcome&)>& corrupt) {
    CAPTURE(what);
    Bench bench = roomy(scene);
    std::uint64_t changed = 0;
    bench.corrupt = [&](QueryOutcome& outcome) {  // every second one
      if (bench.collected % 2 == 0 || (only_hits && outcome.pairs.empty())) return;
      ++changed;
      corrupt(outcome);
    };
    const auto device = open_fake(bench);
    const std::vector<CollisionResult> results = scene.ask(*device, request, batch);
    CHECK(fallbacks(results) == changed);
    CHECK(changed > 0);
    for (const CollisionResult& result : results) CHECK(result.stats.steps > 0);
    check_obeyed(bench);
  };
  for (const int code : {2, 3, 4, 5, 6, 7, 200}) {
    CAPTURE(code);
    run("code", false, [code](QueryOutcome& outcome) {
      outcome.done.code = static_cast<QueryCode>(code);
      outcome.pairs.clear();
      outcome.done.pairs = 0;
    });
  }
  run("host without a pair that decides", false, [](QueryOutcome& outcome) {
    outcome.done.code = QueryCode::host;
    outcome.pairs.clear();
    outcome.done.pairs = 0;
  });
  run("a record too few", true, [](QueryOutcome& outcome) { outcome.pairs.pop_back(); });
  run("a record of another query", true, [](QueryOutcome& outcome) { ++outcome.pairs.back().tag; });
  run("no such face of A", true, [](QueryOutcome& outcome) { outcome.pairs.back().id_a = 1U << 30U; });
  run("no such face of B", true, [](QueryOutcome& outcome) { outcome.pairs.back().id_b = 1U << 30U; });
}

TEST_CASE("chip host: open pairs are decided by the host", "[ref][chip_host]") {
  const Scene scene(24);
  const CollisionRequest request = GENERATE(true, false) ? all : CollisionRequest{};
  Bench bench = roomy(scene);
  bench.corrupt = [](QueryOutcome& outcome) {
    for (PairRecord& pair : outcome.pairs) pair.definite = false;
    if (!outcome.pairs.empty()) outcome.done.answer = QueryAnswer::open;
  };
  const auto device = open_fake(bench);
  const std::vector<CollisionResult> results = scene.ask(*device, request, true);
  CHECK(fallbacks(results) == 0);
  for (const CollisionResult& result : results) CHECK((result.stats.open > 0) == result.hit);
}

TEST_CASE("chip host: a chip that stops", "[ref][chip_host]") {
  const Scene scene(60);
  const bool batch = GENERATE(true, false);
  const CollisionRequest request = GENERATE(true, false) ? all : CollisionRequest{};
  Bench bench = roomy(scene);
  SECTION("once") {
    bench.hang = {20};
    const auto device = open_fake(bench);
    const std::uint64_t fallen = fallbacks(scene.ask(*device, request, batch));
    CHECK(fallen == bench.dropped);
    CHECK(bench.dropped >= 1);
    CHECK(bench.calls["recover"] == 1);
    CHECK(bench.collected + bench.dropped == 60);
    CHECK(fallbacks(scene.ask(*device, request, batch)) == 0);
    check_obeyed(bench);
  }
  SECTION("several times") {
    bench.hang = {0, 5, 6, 7, 8, 30, 31, 59};
    const auto device = open_fake(bench);
    const std::uint64_t fallen = fallbacks(scene.ask(*device, request, batch));
    CHECK(fallen == bench.dropped);
    CHECK(bench.collected + bench.dropped == 60);
    CHECK(bench.calls["recover"] > 2);
    check_obeyed(bench);
  }
  SECTION("and cannot be reset") {
    bench.hang = {20};
    bench.recovers = false;
    const auto device = open_fake(bench);
    const std::uint64_t fallen = fallbacks(scene.ask(*device, request, batch));
    CHECK(fallen == 60 - bench.collected);
    CHECK(fallbacks(scene.ask(*device, request, batch)) == 60);
    check_obeyed(bench);
  }
  SECTION("with no room, although nothing is in flight") {
    bench.full = 3;
    const auto device = open_fake(bench);
    CHECK(fallbacks(scene.ask(*device, request, batch)) == 1);  // the last proceed() of a full chip is a time-out
    CHECK(bench.submitted == 59);
    check_obeyed(bench);
  }
}

TEST_CASE("chip host: a chip that dies", "[ref][chip_host]") {
  const Scene scene(40);
  const bool batch = GENERATE(true, false);
  const CollisionRequest request = GENERATE(true, false) ? all : CollisionRequest{};
  for (const std::string call : {"store", "lock", "submit", "collect", "proceed", "clocks", "recover"}) {
    for (const std::uint64_t at : {1U, 4U}) {
      CAPTURE(call, at);
      Bench bench = roomy(scene);
      bench.dies_in = call;
      bench.dies_at = at;
      if (call == "recover") bench.hang = {3, 8, 13, 18};
      const auto device = open_fake(bench);
      const std::uint64_t fallen = fallbacks(scene.ask(*device, request, batch));
      if (at > 1 && bench.calls[call] < at) continue;  // a batch locks seldom
      CHECK(bench.calls[call] == at);
      CHECK(fallen == 40 - bench.collected);
      CHECK(fallen > 0);
      CHECK(fallbacks(scene.ask(*device, request, batch)) == 40);
      check_obeyed(bench);
    }
  }
}

TEST_CASE("chip host: exceptions of the user leave the device usable", "[ref][chip_host]") {
  const Scene scene(60);
  Bench bench = roomy(scene);
  const auto device = open_fake(bench);
  std::uint64_t given_up = 0;
  SECTION("of the function that takes results") {
    std::size_t taken = 0;
    CHECK_THROWS_WITH(device->collide(
                          60, [&](std::size_t i) { return scene.queries[i]; }, all,
                          [&](std::size_t i, const CollisionResult& result) {
                            CHECK(scene.is_right(i, all, result));
                            if (++taken == 17) throw std::runtime_error("enough");
                          }),
                      "enough");
    CHECK(taken == 17);
  }
  SECTION("of the function that gives queries") {
    std::size_t asked = 0;
    CHECK_THROWS_WITH(device->collide(
                          60,
                          [&](std::size_t i) {
                            if (++asked == 17) throw std::runtime_error("no more");
                            return scene.queries[i];
                          },
                          all, [](std::size_t, const CollisionResult&) {}),
                      "no more");
    CHECK(asked == 17);
  }
  SECTION("while one in flight never ends") {
    bench.hang = {9};
    CHECK_THROWS_AS(device->collide(
                        60, [&](std::size_t i) { return scene.queries[i]; }, all,
                        [&](std::size_t, const CollisionResult&) {
                          if (bench.submitted > 9) throw 1;
                        }),
                    int);
    given_up = 1;
  }
  CHECK(bench.calls["recover"] == given_up);
  CHECK(bench.collected + bench.dropped == bench.submitted);
  CHECK(fallbacks(scene.ask(*device, all, true)) == 0);
  CHECK(fallbacks(scene.ask(*device, {}, false)) == 0);
  check_obeyed(bench);
}

TEST_CASE("chip host: clocks are those between submission and end", "[ref][chip_host]") {
  const Scene scene(40);
  const bool batch = GENERATE(true, false);
  Bench bench = roomy(scene);
  bench.clock = 1000;
  const auto device = open_fake(bench);
  const auto sum_of = [](const std::vector<CollisionResult>& results) {
    CollisionStats sum;
    for (const CollisionResult& result : results) sum += result.stats;
    return sum.clocks;
  };
  const std::uint64_t first = sum_of(scene.ask(*device, all, batch));
  CHECK(first == bench.last_collection - bench.first_submission);
  bench.clock += 5000;  // nothing is in flight
  const std::uint64_t start = bench.clock;
  const std::uint64_t second = sum_of(scene.ask(*device, all, batch));
  CHECK(second == bench.last_collection - start);
  bench.hang = {bench.submitted + 3};
  const std::uint64_t again = bench.clock;
  const std::uint64_t third = sum_of(scene.ask(*device, all, batch));
  CHECK(third == bench.last_collection - again);
  CHECK(bench.dropped > 0);
}

TEST_CASE("chip host: the tops of the two trees are locked", "[ref][chip_host]") {
  const Scene scene(0);
  const Object& a = scene.objects[0];
  const Object& b = scene.objects[1];
  const Object& c = scene.objects[2];
  Bench bench = roomy(scene);
  ChipHostOptions options;
  options.locked_lines = lines_of(b);
  REQUIRE(lines_of(a) > lines_of(b));
  const auto device = open_fake(bench, options);
  const auto ask = [&](const Object& x, const Object& y) {
    collide(*device, x, Pose::Identity(), y, make_pose({0.5, 0, 0}, {0, 0, 0}));
  };
  const auto lines = [&bench](unsigned range) {
    const auto [first, last] = bench.locks[range];
    return std::int64_t{last} - first + 1;
  };
  ask(a, b);
  CHECK(bench.calls["lock"] == 2);
  CHECK(lines(0) == lines_of(b));  // of a, no more than the options say
  CHECK(lines(1) == lines_of(b));
  CHECK(bench.locks[0].first != bench.locks[1].first);
  ask(a, b);
  ask(b, a);
  CHECK(bench.calls["lock"] == 2);
  const auto lock_a = bench.locks[0];
  ask(c, a);
  CHECK(bench.calls["lock"] == 3);
  CHECK(bench.locks[0] == lock_a);
  ask(a, a);
  CHECK(bench.calls["lock"] == 4);
  CHECK(lines(1) <= 0);
  check_obeyed(bench);
}

TEST_CASE("chip host: an engine makes the nodes of objects that were moved, the CPU does if it gives up",
          "[ref][chip_host]") {
  std::mt19937_64 random(sim::seed_from_environment());
  Scene scene(0);
  std::vector<Object> bent;
  std::vector<std::vector<Line>> leaves;
  std::vector<std::vector<Line>> images;
  for (const Object& object : scene.objects) {
    bent.push_back(object.moved(noisy(object.mesh(), 0.05, random).vertices));
    REQUIRE(bent.back().was_moved());
    REQUIRE(!object.was_moved());
    bvh::Tree tree = bent.back().tree().topology();
    leaves.push_back(bvh::make_leaves(bent.back().mesh(), tree).lines);
    bvh::refit(tree, bent.back().mesh());
    images.push_back(bvh::make_image(bent.back().mesh(), tree).lines);
  }
  for (std::size_t i = 0; i < 60; ++i) {
    const Object& other = i % 3 == 0 ? bent[random() % bent.size()] : scene.objects[random() % scene.objects.size()];
    scene.add(bent[i % bent.size()], other);
  }
  const bool engine = GENERATE(true, false);
  const bool works = GENERATE(true, false);
  Bench bench = roomy(scene);
  bench.chip.image_lines *= 2;
  bench.chip.refits = engine;
  bench.refit = [&](std::vector<Line>& image) {
    const auto found = std::find(leaves.begin(), leaves.end(), image);
    CHECK(found != leaves.end());
    if (found == leaves.end()) return false;
    image = works ? images[static_cast<std::size_t>(found - leaves.begin())] : std::vector<Line>(image.size());
    return works;
  };
  const auto device = open_fake(bench);
  CHECK(fallbacks(scene.ask(*device, all, GENERATE(true, false))) == 0);
  CHECK(bench.calls["refit"] == (engine ? bent.size() : 0));
  CHECK(bench.calls["store"] == scene.objects.size() + (engine && !works ? 2 : 1) * bent.size());
  check_obeyed(bench);
}

TEST_CASE("chip host: a port is needed, and it must say what the chip has", "[ref][chip_host]") {
  CHECK_THROWS_AS(make_chip_device(nullptr), std::invalid_argument);
}

TEST_CASE("devices: others are known once they are added", "[ref][chip_host]") {
  static Bench bench;  // the device stays known
  CHECK_THROWS_AS(add_device("", [] { return open_device("cpu"); }), std::invalid_argument);
  CHECK_THROWS_AS(add_device("nothing", nullptr), std::invalid_argument);
  CHECK_THROWS_WITH(add_device("model", [] { return open_device("cpu"); }),
                    "device model is known already: choose another name");
  REQUIRE_THROWS_AS(open_device("fake"), std::invalid_argument);
  std::vector<std::thread> threads;
  std::atomic<int> added = 0;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&added] {
      try {
        add_device("fake", [] { return open_fake(bench); });
        ++added;
      } catch (const std::invalid_argument&) {
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(added == 1);
  CHECK(device_names() == std::vector<std::string>{"cpu", "model", "fake"});
  CHECK(open_device("fake")->name() == std::string("fake"));
  CHECK_THROWS_WITH(open_device("gpu"), "device gpu is not known: the devices are cpu, model, fake");
}
