// SPDX-License-Identifier: Apache-2.0
// Several simulated chips on one memory as one device: answers, spread, counts, faults of one of them.
#include <Vcchip_chip.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/blocks/refit.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/internal/tree/tree.hpp>
#include <cchip/internal/wire/chip_registers.hpp>
#include <cchip/machines/chips_machine.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <random>
#include <set>

using namespace cchip;

namespace {

using Chips = sim::ChipsOnMemory<Vcchip_chip, 128>;
const CollisionRequest first = {};
const CollisionRequest all = {CollisionRequest::Contacts::all};

/// Queries of small objects of triangles and of quads, hits and misses, and what the CPU device answers.
struct Scene {
  explicit Scene(std::size_t count) : random(sim::seed_from_environment()) {
    objects.emplace_back(make_torus(1, 0.4, 16, 10));
    objects.emplace_back(make_body(5, 0.3, 3));
    objects.emplace_back(make_torus(1, 0.3, 12, 8, Kind::quad));
    objects.emplace_back(make_gear(0.7, 1, 0.3, 0.4, 7, 1));
    const auto cpu = open_cpu_device({1, {}});
    poses.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      poses.push_back({turned(0.2), turned(2)});
      queries.push_back(
          {&objects[random() % objects.size()], &poses[i].a, &objects[random() % objects.size()], &poses[i].b});
      CollisionResult result;
      cpu->collide(queries[i], all, result);
      expected.push_back(result.contacts);
    }
  }
  Pose turned(double range) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Pose pose = Pose::Identity();
    pose.linear() =
        Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized().toRotationMatrix();
    pose.translation() = Vec3d(unit(random), unit(random), unit(random)) * range;
    return pose;
  }

  /// Asks all, checks the answers by their places. \returns the results
  std::vector<CollisionResult> check(Device& device, const CollisionRequest& request) const {
    const std::vector<CollisionResult> results = collide(device, queries, request);
    REQUIRE(results.size() == queries.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      CAPTURE(i);
      REQUIRE(results[i].hit == !expected[i].empty());
      if (request.contacts == CollisionRequest::Contacts::all) {
        REQUIRE(results[i].contacts == expected[i]);
      } else if (results[i].hit) {
        REQUIRE(results[i].contacts.size() == 1);
        REQUIRE(std::binary_search(expected[i].begin(), expected[i].end(), results[i].contacts[0]));
      }
    }
    return results;
  }
  std::size_t hits() const {
    return static_cast<std::size_t>(
        std::count_if(expected.begin(), expected.end(), [](const auto& x) { return !x.empty(); }));
  }

  std::mt19937_64 random;
  std::vector<Object> objects;
  std::vector<PosePair> poses;
  std::vector<CollisionQuery> queries;
  std::vector<std::vector<Contact>> expected;
};

CollisionStats sum_of(const std::vector<CollisionResult>& results) {
  CollisionStats sum;
  for (const CollisionResult& x : results) sum += x.stats;
  return sum;
}

constexpr std::uint64_t ring_lines = 8 + 8;  // of a chip: 8 queries, 32 records

ChipDriverOptions small_rings() {
  ChipDriverOptions options;
  options.memory_bytes = std::uint64_t{1} << 24U;
  options.query_log2 = 3;
  options.record_log2 = 5;
  options.patience = 60000;
  options.reset_patience = 10000;
  return options;
}

/// Chips whose memory the test sees.
struct Bench {
  explicit Bench(std::size_t count)
      : chips(std::make_shared<Chips>(count, sim::without_timeout(sim::seed_from_environment()))),
        device(make_chip_device(open_chips(sim::machines_of(chips), small_rings()))) {}
  std::shared_ptr<Chips> chips;
  std::unique_ptr<Device> device;
};

/// Refuses registers once it is told to.
class Breakable final : public Machine {
 public:
  Breakable(std::unique_ptr<Machine> machine, const bool& broken) : machine_(std::move(machine)), broken_(broken) {}
  std::uint32_t read_register(std::uint32_t offset) override { return check(), machine_->read_register(offset); }
  void write_register(std::uint32_t offset, std::uint32_t value) override {
    check();
    machine_->write_register(offset, value);
  }
  void write_memory(std::uint64_t address, const Bytes& bytes) override { machine_->write_memory(address, bytes); }
  Bytes read_memory(std::uint64_t address, std::size_t size) override { return machine_->read_memory(address, size); }
  bool interrupt() override { return machine_->interrupt(); }
  void proceed() override { machine_->proceed(); }

 private:
  void check() const {
    if (broken_) throw std::runtime_error("the bus of this chip is gone");
  }
  std::unique_ptr<Machine> machine_;
  const bool& broken_;
};

}  // namespace

TEST_CASE("chips: the same answers as the CPU device, for any number of chips", "[system][chips]") {
  const Scene scene(60);
  REQUIRE(scene.hits() > 10);
  REQUIRE(scene.hits() < 50);
  for (const unsigned chips : {1U, 2U, 3U, 8U}) {
    CAPTURE(chips);
    SimulatedChipOptions options;
    options.chips = chips;
    const auto device = open_simulated_chip(options);
    CHECK(device->name() == std::string("chip"));
    CHECK(sum_of(scene.check(*device, first)).fallbacks == 0);
    CHECK(sum_of(scene.check(*device, all)).fallbacks == 0);
  }
}

TEST_CASE("chips: with slots whose modules are exchanged", "[system][chips]") {
  const Scene scene(24);
  SimulatedChipOptions options;
  options.chips = 2;
  options.slots = 1;
  const auto device = open_simulated_chip(options);
  const CollisionStats counts = sum_of(scene.check(*device, all));
  CHECK(counts.fallbacks == 0);
  CHECK(counts.swaps >= 2);  // each chip begins with the triangle test, and there are quads
}

TEST_CASE("chips: no query, one, and fewer than chips", "[system][chips]") {
  SimulatedChipOptions options;
  options.chips = 4;
  const auto device = open_simulated_chip(options);
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{4}, std::size_t{5}}) {
    CAPTURE(count);
    const Scene scene(count);
    CHECK(sum_of(scene.check(*device, all)).fallbacks == 0);
    if (count == 0) continue;
    CollisionResult single;
    device->collide(scene.queries[0], all, single);
    CHECK(single.contacts == scene.expected[0]);
  }
}

TEST_CASE("chips: queries are spread, and memory holds images once", "[system][chips]") {
  const Scene scene(64);
  constexpr std::size_t count = 4;
  Bench bench(count);
  std::set<std::uint64_t> lines;
  std::vector<std::set<std::uint64_t>> rings(count);
  bench.chips->memory().read_fault = [&](std::uint64_t line) {
    if (line < count * ring_lines) {
      rings[line / ring_lines].insert(line);
    } else {
      lines.insert(line);
    }
    return sim::AxiFault::none;
  };
  scene.check(*bench.device, first);
  for (std::size_t i = 0; i < count; ++i) {
    CAPTURE(i);
    CHECK(rings[i].size() == 8);  // each line of a ring was used, so each chip got 8 queries or more
    CHECK(*rings[i].begin() == i * ring_lines);
  }
  std::size_t of_images = 0;
  for (const Object& object : scene.objects)
    of_images += bvh::make_image(object.mesh(), bvh::build_tree(object.mesh())).lines.size();
  REQUIRE_FALSE(lines.empty());
  CHECK(lines.size() <= of_images);
  CHECK(*lines.begin() >= count * ring_lines);
}

TEST_CASE("chips: counts of clocks repeat", "[system][chips]") {
  const Scene scene(40);
  std::vector<std::vector<std::uint64_t>> clocks;
  for (int run = 0; run < 2; ++run) {
    SimulatedChipOptions options;
    options.chips = 3;
    options.memory.jitter = 50;
    const auto device = open_simulated_chip(options);
    std::vector<std::uint64_t> each;
    for (const CollisionResult& x : scene.check(*device, first)) each.push_back(x.stats.clocks);
    clocks.push_back(each);
  }
  CHECK(clocks[0] == clocks[1]);
  CHECK(std::any_of(clocks[0].begin(), clocks[0].end(), [](std::uint64_t x) { return x != 0; }));
}

TEST_CASE("chips: a chip that stops loses its own queries alone, and comes back", "[system][chips]") {
  const Scene scene(30);
  Bench bench(3);
  bool fails = true;
  bench.chips->memory().read_fault = [&](std::uint64_t line) {
    const bool is_ring = line >= ring_lines && line < ring_lines + 8;  // of chip 1
    return fails && is_ring ? sim::AxiFault::slave_error : sim::AxiFault::none;
  };
  const CollisionStats counts = sum_of(scene.check(*bench.device, all));
  CHECK(counts.fallbacks > 0);
  CHECK(counts.fallbacks < 30);
  fails = false;
  CHECK(sum_of(scene.check(*bench.device, all)).fallbacks == 0);
  const std::vector<std::uint64_t> before = bench.chips->bus().lines_of();
  CHECK(sum_of(scene.check(*bench.device, all)).fallbacks == 0);
  CHECK(bench.chips->bus().lines_of()[1] > before[1]);
}

TEST_CASE("chips: errors of the bus in an image, for any chip", "[system][chips]") {
  const Scene scene(30);
  Bench bench(2);
  std::uint64_t reads = 0;
  bench.chips->memory().read_fault = [&](std::uint64_t line) {
    const bool fails = line >= 2 * ring_lines && ++reads % 97 == 0;
    return fails ? sim::AxiFault::slave_error : sim::AxiFault::none;
  };
  const CollisionStats counts = sum_of(scene.check(*bench.device, all));
  CHECK(counts.fallbacks > 0);
  bench.chips->memory().read_fault = [](std::uint64_t) { return sim::AxiFault::none; };
  CHECK(sum_of(scene.check(*bench.device, all)).fallbacks == 0);
}

TEST_CASE("chips: a dead chip is left out, and after the last one the CPU answers", "[system][chips]") {
  const Scene scene(24);
  const auto chips = std::make_shared<Chips>(2, sim::without_timeout(sim::seed_from_environment()));
  std::array<bool, 2> broken = {};
  std::vector<std::unique_ptr<Machine>> machines;
  for (std::size_t i = 0; i < 2; ++i)
    machines.push_back(
        std::make_unique<Breakable>(std::make_unique<sim::ChipOfSeveral<Vcchip_chip, 128>>(chips, i), broken[i]));
  const auto device = make_chip_device(open_chips(std::move(machines), small_rings()));
  CHECK(sum_of(scene.check(*device, all)).fallbacks == 0);
  broken[0] = true;
  CHECK(sum_of(scene.check(*device, all)).fallbacks < 24);
  const std::vector<std::uint64_t> before = chips->bus().lines_of();
  CHECK(sum_of(scene.check(*device, all)).fallbacks == 0);
  CHECK(chips->bus().lines_of()[0] == before[0]);
  CHECK(chips->bus().lines_of()[1] > before[1]);
  broken[1] = true;
  scene.check(*device, all);
  CHECK(sum_of(scene.check(*device, all)).fallbacks == 24);
}

TEST_CASE("chips: numbers of chips that cannot be", "[system][chips]") {
  SimulatedChipOptions options;
  options.chips = 0;
  CHECK_THROWS_WITH(open_simulated_chip(options), "simulated chip: 0 chips; 1 to 8 share a memory");
  options.chips = 9;
  CHECK_THROWS_WITH(open_simulated_chip(options), "simulated chip: 9 chips; 1 to 8 share a memory");
  options.chips = 2;
  CHECK_THROWS_WITH(make_simulated_chip(options),
                    "make_simulated_chip: 2 chips; it makes 1, make_simulated_chips() makes more");
  options.slots = 3;
  CHECK_THROWS_WITH(open_simulated_chip(options), "simulated chip: 3 slots with swaps; 1 or 2, or 0 for a static chip");
  CHECK_THROWS_WITH(open_chips({}), "open_chips: no machines; give one for each chip");
}

namespace {

struct RefitCounts {
  std::size_t lines = 0;    ///< of refitted images
  std::size_t queries = 0;  ///< that ended while the engine worked
};

/// The simulated chip, whose refits are compared with the functional model line by line.
class WithRefitChecked final : public Machine {
 public:
  explicit WithRefitChecked(RefitCounts& counts)
      : machine_(make_simulated_chip({sim::seed_from_environment(), "", 0, {}, 0, 0, 1})), counts_(counts) {}

  std::uint32_t read_register(std::uint32_t offset) override { return machine_->read_register(offset); }
  void write_register(std::uint32_t offset, std::uint32_t value) override { machine_->write_register(offset, value); }
  void write_memory(std::uint64_t address, const Bytes& bytes) override { machine_->write_memory(address, bytes); }
  Bytes read_memory(std::uint64_t address, std::size_t size) override { return machine_->read_memory(address, size); }
  bool interrupt() override { return machine_->interrupt(); }
  void proceed() override { machine_->proceed(); }
  bool has_refit() const override { return machine_->has_refit(); }
  RefitEnd refit(std::uint32_t base, std::uint32_t lines, std::uint32_t root) override {
    std::vector<Line> expected = image(base, lines);
    CHECK(model::refit_image(expected, {lines, root}).code == RefitCode::ok);
    const std::uint32_t queries = read_register(chip_registers::counter_queries::offset);
    const RefitEnd end = machine_->refit(base, lines, root);
    counts_.queries += read_register(chip_registers::counter_queries::offset) - queries;
    CHECK(end.code == RefitCode::ok);
    CHECK(end.clocks > lines);
    CHECK(image(base, lines) == expected);
    counts_.lines += lines;
    return end;
  }

 private:
  std::vector<Line> image(std::uint32_t base, std::uint32_t lines) {
    const Bytes bytes = machine_->read_memory(std::uint64_t{base} * 64, std::size_t{lines} * 64);
    std::vector<Line> image(lines);
    for (std::size_t n = 0; n < lines; ++n)
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(64 * n), 64, image[n].begin());
    return image;
  }

  std::unique_ptr<Machine> machine_;
  RefitCounts& counts_;
};

}  // namespace

TEST_CASE("simulated chip: the refit engine makes the images of a body that bends", "[system][chips]") {
  std::mt19937_64 random(sim::seed_from_environment());
  RefitCounts counts;
  const auto chip = make_chip_device(open_chip(std::make_unique<WithRefitChecked>(counts), small_rings()));
  const auto cpu = open_cpu_device({1, {}});
  const Object ring(make_torus(1, 0.3, 12, 8, Kind::quad));
  Object body(make_body(5, 0.3, 3));
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t hits = 0;
  for (int step = 0; step < 6; ++step) {
    std::vector<Vec3d> vertices = body.mesh().vertices;
    for (Vec3d& v : vertices) v += 0.05 * Vec3d(v.y() * v.z(), std::sin(v.x()), 0.1 * unit(random));
    body = body.moved(std::move(vertices));
    const PosePair pose = {Pose::Identity(), Pose(Eigen::Translation3d(unit(random), unit(random), unit(random)))};
    const CollisionQuery query = {&body, &pose.a, &ring, &pose.b};
    CollisionResult expected, result;
    cpu->collide(query, all, expected);
    chip->collide(query, all, result);
    CHECK(result.stats.fallbacks == 0);
    CHECK(result.contacts == expected.contacts);
    hits += expected.hit ? 1 : 0;
  }
  CHECK(hits > 0);
  CHECK(counts.lines > 6 * 100);
  CHECK(counts.queries == 0);  // each was alone
}

TEST_CASE("simulated chip: queries of other objects go on while the refit engine works", "[system][chips]") {
  RefitCounts counts;
  const auto chip = make_chip_device(open_chip(std::make_unique<WithRefitChecked>(counts)));
  const auto cpu = open_cpu_device({1, {}});
  Scene scene(24);
  scene.check(*chip, all);  // their images are in memory now
  REQUIRE(counts.lines == 0);
  std::vector<Object> moved;
  moved.reserve(3);
  for (const Object& object : {scene.objects[0], scene.objects[1], scene.objects[2]}) {
    std::vector<Vec3d> vertices = object.mesh().vertices;
    for (Vec3d& v : vertices) v += 0.05 * Vec3d(v.y() * v.z(), std::sin(v.x()), 0);
    moved.push_back(object.moved(std::move(vertices)));
  }
  for (std::size_t i = 0; i < moved.size(); ++i) {  // each behind others that are in flight when it is refitted
    CollisionQuery& query = scene.queries[8 * i + 6];
    query.a = &moved[i];
    CollisionResult result;
    cpu->collide(query, all, result);
    scene.expected[8 * i + 6] = result.contacts;
  }
  scene.check(*chip, all);
  CHECK(counts.lines > 3 * 100);
  CHECK(counts.queries > 3);
}
