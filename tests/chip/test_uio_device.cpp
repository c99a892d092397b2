// SPDX-License-Identifier: Apache-2.0
// The chip through the mappings that a board would have: files instead of devices, behind them the simulated chip.
#include <Vcchip_chip.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/device.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/driver/uio_device.hpp>
#include <cchip/internal/wire/chip_registers.hpp>
#include <cchip/machines/chip_answer.hpp>
#include <cchip/machines/chip_machine.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "chip_objects.hpp"
#include "chip_poll.h"
#include "register_trap.hpp"

using namespace cchip;
using cchip::testing::RegisterTrap;
namespace regs = cchip::chip_registers;

namespace {

using Contacts = CollisionRequest::Contacts;
using Chip = sim::ChipMachine<Vcchip_chip, 128>;

constexpr std::uint64_t memory_base = std::uint64_t{1}
                                      << 36U;  // not where the file begins: the driver must subtract it
constexpr std::uint64_t memory_offset = 8192;  // in the file
constexpr std::uint64_t memory_bytes = 1 << 21;

/// A new file of zeros that lives as long as this.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::uint64_t bytes) {
    std::string name = (std::filesystem::temp_directory_path() / "cchip_uio_XXXXXX").string();
    number_ = mkstemp(name.data());
    path_ = std::filesystem::canonical(name).string();  // as /proc/self/maps names it
    REQUIRE(number_ >= 0);
    REQUIRE(ftruncate(number_, static_cast<off_t>(bytes)) == 0);
  }
  ~TemporaryFile() {
    close(number_);
    unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }
  int number() const { return number_; }
  void put(std::uint32_t offset, std::uint32_t word) const {
    REQUIRE(pwrite(number_, &word, sizeof word, static_cast<off_t>(offset)) == sizeof word);
  }
  std::uint32_t get(std::uint32_t offset) const {
    std::uint32_t word = 0;
    REQUIRE(pread(number_, &word, sizeof word, static_cast<off_t>(offset)) == sizeof word);
    return word;
  }

 private:
  std::string path_;
  int number_ = -1;
};

/// Files and the chip behind them. Outlives machine and device.
class Board {
 public:
  Board() : registers_(4096), memory_(memory_offset + memory_bytes), chip_(options()) {
    mapping_ = mmap(nullptr, memory_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory_.number(), memory_offset);
    REQUIRE(mapping_ != MAP_FAILED);
    chip_.memory().backing = {static_cast<Chip::Memory::Line*>(mapping_), memory_base / 64, memory_bytes / 64};
  }
  ~Board() { munmap(mapping_, memory_bytes); }
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  Chip& chip() { return chip_; }
  void* mapping() const { return mapping_; }
  const TemporaryFile& registers() const { return registers_; }
  UioOptions uio() {
    UioOptions options;
    options.registers = registers_.path();
    options.memory = memory_.path();
    options.memory_file_offset = memory_offset;
    options.memory_base = memory_base;
    options.memory_bytes = memory_bytes;
    options.wait = [this] { chip_.simulation().steps(16); };
    return options;
  }
  static ChipDriverOptions driver() {
    ChipDriverOptions options;
    options.query_log2 = 3;
    options.record_log2 = 6;  // goes round often
    return options;
  }
  /// Serves the registers of the one machine that is open. The trap goes before the machine.
  std::unique_ptr<RegisterTrap> serve() {
    return std::make_unique<RegisterTrap>(
        registers_.path(), [this](std::uint32_t offset) { return chip_.read_register(offset); },
        [this](std::uint32_t offset, std::uint32_t value) { chip_.write_register(offset, value); });
  }

 private:
  static sim::SimulationOptions options() { return sim::without_timeout(sim::seed_from_environment()); }

  TemporaryFile registers_, memory_;
  Chip chip_;
  void* mapping_ = MAP_FAILED;
};

struct Scene {
  explicit Scene(Kind kind) : a(make_sphere(1, 3, 0.1)), b(make_torus(1, 0.4, 14, 9, kind)) {
    std::mt19937_64 random(sim::seed_from_environment());
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto pose = [&](double range) {
      Pose made = Pose::Identity();
      made.linear() =
          Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized().toRotationMatrix();
      for (int i = 0; i < 3; ++i) made.translation()[i] = range * unit(random);
      return made;
    };
    for (int i = 0; i < 12; ++i) poses.push_back({pose(0.1), pose(i < 6 ? 1.2 : 2.4)});
    poses.push_back({Pose::Identity(), Pose(Eigen::Translation3d(5, 0, 0))});
  }
  Object a, b;
  std::vector<PosePair> poses;
};

void compare(const CollisionResult& result, const CollisionResult& first_of_cpu, const CollisionResult& all_of_cpu,
             Contacts contacts) {
  CHECK(result.hit == first_of_cpu.hit);
  CHECK(result.stats.fallbacks == 0);
  if (contacts == Contacts::all) {
    CHECK(result.contacts == all_of_cpu.contacts);
  } else {
    REQUIRE(result.contacts.size() == (result.hit ? 1U : 0U));
    if (result.hit)
      CHECK(std::binary_search(all_of_cpu.contacts.begin(), all_of_cpu.contacts.end(), result.contacts[0]));
  }
}

/// Every pose singly and in a batch, FIRST and ALL, against the CPU.
void check(Device& device, const Scene& scene) {
  const std::unique_ptr<Device> cpu = open_device("cpu");
  const std::vector<CollisionResult> first = collide(*cpu, scene.a, scene.b, scene.poses);
  const std::vector<CollisionResult> all = collide(*cpu, scene.a, scene.b, scene.poses, {Contacts::all});
  std::size_t hits = 0, contacts_seen = 0;
  for (const Contacts contacts : {Contacts::first, Contacts::all}) {
    const std::vector<CollisionResult> batch = collide(device, scene.a, scene.b, scene.poses, {contacts});
    REQUIRE(batch.size() == scene.poses.size());
    for (std::size_t i = 0; i < scene.poses.size(); ++i) {
      CAPTURE(i, contacts == Contacts::all);
      const PosePair& pose = scene.poses[i];
      const CollisionResult single = collide(device, scene.a, pose.a, scene.b, pose.b, {contacts});
      compare(single, first[i], all[i], contacts);
      compare(batch[i], first[i], all[i], contacts);
      CHECK(single.stats.clocks > 0);
      hits += single.hit ? 1 : 0;
      contacts_seen += single.contacts.size();
    }
  }
  CHECK(hits > 0);
  CHECK(hits < 2 * scene.poses.size());
  CHECK(contacts_seen > 64);  // more than the ring of records holds
}

}  // namespace

TEST_CASE("uio device: answers as the CPU does", "[system][uio]") {
  for (const Kind kind : {Kind::tri, Kind::quad}) {
    CAPTURE(kind == Kind::quad);
    Board board;
    std::unique_ptr<Machine> machine = open_uio_machine(board.uio());
    const std::unique_ptr<RegisterTrap> trap = board.serve();
    ChipDriverOptions driver = Board::driver();
    driver.memory_base = memory_base;
    driver.memory_bytes = memory_bytes;
    const std::unique_ptr<Device> device = make_chip_device(open_chip(std::move(machine), driver));
    check(*device, Scene(kind));
    CHECK(trap->reads() > 0);
    CHECK(trap->writes() > 0);
  }
}

// The registers are a file at first, which takes the driver's setup and never answers a query. With the chip behind it
// the first query times out, and the driver sets the chip up that it finds.
TEST_CASE("uio device: a chip that lost its setup is set up again", "[system][uio]") {
  Board board;
  for (const std::uint32_t offset : {regs::id::offset, regs::version::offset, regs::capabilities::offset})
    board.registers().put(offset, board.chip().read_register(offset));
  ChipDriverOptions driver = Board::driver();
  driver.patience = 4096;
  const std::unique_ptr<Device> device = open_uio_device(board.uio(), driver);
  CHECK(board.registers().get(regs::query_base_low::offset) == (memory_base & 0xFFFFFFFFU));
  CHECK(board.registers().get(regs::query_base_high::offset) == memory_base >> 32U);
  CHECK(board.registers().get(regs::control::offset) == regs::control::enable_mask);
  const std::unique_ptr<RegisterTrap> trap = board.serve();
  const Scene scene(Kind::tri);
  const CollisionResult lost = collide(*device, scene.a, scene.poses[0].a, scene.b, scene.poses[0].b);
  CHECK(lost.stats.fallbacks == 1);
  check(*device, scene);
}

TEST_CASE("uio machine: registers, memory and interrupt of a chip", "[system][uio]") {
  Board board;
  const std::unique_ptr<Machine> machine = open_uio_machine(board.uio());
  const std::unique_ptr<RegisterTrap> trap = board.serve();
  CHECK(machine->read_register(regs::id::offset) == regs::id::value_reset);
  machine->write_register(regs::step_limit::offset, 0x12345678);
  CHECK(board.chip().read_register(regs::step_limit::offset) == 0x12345678);
  CHECK(trap->reads() == 1);
  CHECK(trap->writes() == 1);

  const Bytes bytes = {1, 2, 3, 4, 5, 6, 7, 8};
  machine->write_memory(memory_base + 60, bytes);
  CHECK(board.chip().read_memory(memory_base + 60, 8) == bytes);
  board.chip().write_memory(memory_base + memory_bytes - 8, bytes);
  CHECK(machine->read_memory(memory_base + memory_bytes - 8, 8) == bytes);

  CHECK_FALSE(machine->interrupt());
  machine->write_register(regs::interrupt_enable::offset, regs::interrupt_enable::invalidated_mask);
  CHECK_FALSE(machine->interrupt());
  machine->write_register(regs::invalidate::offset, regs::invalidate::go_mask);
  for (int i = 0; !machine->interrupt(); ++i) {
    REQUIRE(i < 10000);
    machine->proceed();
  }
  CHECK(board.chip().interrupt());
  machine->write_register(regs::interrupt_status::offset, regs::interrupt_status::invalidated_mask);
  CHECK_FALSE(machine->interrupt());
}

namespace {

/// The registers of a board, mapped and served.
class MappedRegisters {
 public:
  explicit MappedRegisters(Board& board) {
    mapping_ = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, board.registers().number(), 0);
    REQUIRE(mapping_ != MAP_FAILED);
    trap_ = std::make_unique<RegisterTrap>(
        board.registers().path(),
        [&board](std::uint32_t offset) {
          board.chip().simulation().steps(200);  // time passes while the driver polls
          return board.chip().read_register(offset);
        },
        [&board](std::uint32_t offset, std::uint32_t value) { board.chip().write_register(offset, value); });
  }
  ~MappedRegisters() {
    trap_.reset();
    munmap(mapping_, 4096);
  }
  MappedRegisters(const MappedRegisters&) = delete;
  MappedRegisters& operator=(const MappedRegisters&) = delete;
  volatile std::uint32_t* words() const { return static_cast<volatile std::uint32_t*>(mapping_); }

 private:
  void* mapping_ = MAP_FAILED;
  std::unique_ptr<RegisterTrap> trap_;
};

chip driver_of(Board& board, MappedRegisters& registers) {
  chip driver = {};
  driver.registers = registers.words();
  driver.memory = static_cast<volatile std::uint32_t*>(board.mapping());
  driver.address = memory_base;
  driver.patience = 10000000;
  return driver;
}

std::string print(const char* format, std::uint32_t a, std::uint32_t b, const char* c = "") {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), format, a, b, c);
  return text.data();
}

}  // namespace

TEST_CASE("driver in C: the example of the programmer's guide", "[system][chip_poll]") {
  Board board;
  MappedRegisters registers(board);
  chip chip = driver_of(board, registers);
  // a roof of two triangles, and one that pierces both of them
  Mesh roof, blade;
  roof.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 1, 1}, {2, 1, 1}};
  roof.faces = {{Kind::tri, {0, 1, 2}}, {Kind::tri, {1, 3, 2}}};
  blade.vertices = {{1, -1, 0.25}, {1, 2, 0.5}, {1, 0.5, 2}};
  blade.faces = {{Kind::tri, {0, 1, 2}}};
  const bvh::Image a = testing::image_of(roof), b = testing::image_of(blade);
  const auto bytes_a = static_cast<std::uint32_t>(64 * a.lines.size());
  const auto bytes_b = static_cast<std::uint32_t>(64 * b.lines.size());
  std::optional<Query> made = bvh::make_query(a.header(), Pose::Identity(), b.header(), Pose::Identity());
  REQUIRE(made.has_value());
  const auto line_a = static_cast<std::uint32_t>((memory_base + CHIP_IMAGES) / 64);
  const std::uint32_t line_b = line_a + bytes_a / 64;
  made->base_a = made->swapped ? line_b : line_a;
  made->base_b = made->swapped ? line_a : line_b;
  made->mode = QueryMode::all;
  const Line query = encode(*made);

  std::string text;
  REQUIRE(chip_start(&chip) == CHIP_OK);
  REQUIRE(chip_store(&chip, CHIP_IMAGES, a.lines.data(), bytes_a) == CHIP_OK);
  REQUIRE(chip_store(&chip, CHIP_IMAGES + bytes_a, b.lines.data(), bytes_b) == CHIP_OK);
  REQUIRE(chip_submit(&chip, query.data()) == CHIP_OK);
  chip_record record;
  while (chip_next(&chip, &record) == CHIP_OK && chip_is_done(&record) == 0) {
    text += print("faces %u and %u%s\n", record.first, record.second, chip_is_definite(&record) != 0 ? "" : ", open");
  }
  text += print("answer %u, code %u%s\n", chip_answer(&record), chip_code(&record));
  INFO(text);
  CHECK(text == "faces 0 and 0\nfaces 1 and 0\nanswer 1, code 0\n");
  int looks = 0;  // the event of a record follows it
  while (chip_event(&chip) == 0 && looks < 1000) ++looks;
  CHECK(looks < 1000);
  while (chip_event(&chip) != 0) REQUIRE(++looks < 1000);
  REQUIRE(chip_submit(&chip, query.data()) == CHIP_OK);
  int dones = 0;
  for (looks = 0; dones == 0 && looks < 10000; ++looks) {
    while (chip_event(&chip) != 0) {
      while (dones == 0 && chip_next(&chip, &record) == CHIP_OK) dones += chip_is_done(&record);
    }
  }
  REQUIRE(dones == 1);
  CHECK(chip_code(&record) == 0);
}

TEST_CASE("driver in C: every record is the model's, round after round of its rings", "[system][chip_poll]") {
  Board board;
  MappedRegisters registers(board);
  chip chip = driver_of(board, registers);
  std::mt19937_64 random(sim::seed_from_environment());
  testing::Objects objects(Kind::quad);
  REQUIRE(chip_start(&chip) == CHIP_OK);
  const auto bytes_a = static_cast<std::uint32_t>(64 * objects.a.lines.size());
  const auto bytes_b = static_cast<std::uint32_t>(64 * objects.b.lines.size());
  REQUIRE(chip_store(&chip, CHIP_IMAGES, objects.a.lines.data(), bytes_a) == CHIP_OK);
  REQUIRE(chip_store(&chip, CHIP_IMAGES + bytes_a, objects.b.lines.data(), bytes_b) == CHIP_OK);
  objects.line_a = (memory_base + CHIP_IMAGES) / 64;
  objects.line_b = objects.line_a + objects.a.lines.size();
  for (int round = 0; round < 30; ++round) {
    std::vector<Query> queries = testing::queries_of(objects, random, 4);
    std::vector<sim::ChipAnswer> answers(queries.size());
    for (std::size_t i = 0; i < queries.size(); ++i) {
      queries[i].tag = static_cast<std::uint32_t>(i);
      const Line line = encode(queries[i]);
      REQUIRE(chip_submit(&chip, line.data()) == CHIP_OK);
    }
    for (std::size_t left = queries.size(); left > 0;) {
      chip_record record;
      REQUIRE(chip_next(&chip, &record) == CHIP_OK);
      REQUIRE(record.tag < answers.size());
      sim::ChipAnswer& answer = answers[record.tag];
      REQUIRE_FALSE(answer.done.has_value());
      if (chip_is_done(&record) == 0) {
        answer.pairs.push_back({record.tag, record.first, record.second, chip_is_definite(&record) != 0});
        continue;
      }
      REQUIRE(record.second == answer.pairs.size());
      answer.done = DoneRecord{record.tag, static_cast<QueryCode>(chip_code(&record)),
                               static_cast<QueryAnswer>(chip_answer(&record)), record.first, record.second};
      --left;
    }
    for (std::size_t i = 0; i < queries.size(); ++i) {
      CAPTURE(round, i);
      CHECK(sim::compare_answer(queries[i], answers[i], objects.expected(queries[i]), 16).empty());
    }
    if (round % 10 == 9) REQUIRE(chip_start(&chip) == CHIP_OK);
  }
}

TEST_CASE("driver in C: offsets and bits are those of the register map", "[system][chip_poll]") {
  CHECK(CHIP_ID == regs::id::offset);
  CHECK(CHIP_ID_VALUE == regs::id::value_reset);
  CHECK(CHIP_VERSION == regs::version::offset);
  CHECK(CHIP_CAPABILITIES == regs::capabilities::offset);
  CHECK(CHIP_CONTROL == regs::control::offset);
  CHECK(CHIP_CONTROL_ENABLE == regs::control::enable_mask);
  CHECK(CHIP_CONTROL_SOFT_RESET == regs::control::soft_reset_mask);
  CHECK(CHIP_STATUS == regs::status::offset);
  CHECK(CHIP_INTERRUPT_STATUS == regs::interrupt_status::offset);
  CHECK(CHIP_INTERRUPT_ENABLE == regs::interrupt_enable::offset);
  CHECK(CHIP_INTERRUPT_RECORD == regs::interrupt_status::record_mask);
  CHECK(CHIP_STATUS_RESETTING == regs::status::resetting_mask);
  CHECK(CHIP_STATUS_QUERY_FAILED == regs::status::query_failed_mask);
  CHECK(CHIP_STATUS_RECORD_FAILED == regs::status::record_failed_mask);
  CHECK(CHIP_STATUS_INVALIDATING == regs::status::invalidating_mask);
  CHECK(CHIP_MEMORY_LIMIT == regs::memory_limit::offset);
  CHECK(CHIP_QUERY_BASE_LOW == regs::query_base_low::offset);
  CHECK(CHIP_QUERY_BASE_HIGH == regs::query_base_high::offset);
  CHECK(CHIP_QUERY_SIZE == regs::query_size::offset);
  CHECK(CHIP_QUERY_PRODUCER == regs::query_producer::offset);
  CHECK(CHIP_QUERY_CONSUMER == regs::query_consumer::offset);
  CHECK(CHIP_RECORD_BASE_LOW == regs::record_base_low::offset);
  CHECK(CHIP_RECORD_BASE_HIGH == regs::record_base_high::offset);
  CHECK(CHIP_RECORD_SIZE == regs::record_size::offset);
  CHECK(CHIP_RECORD_CONSUMER == regs::record_consumer::offset);
  CHECK(CHIP_RECORD_PRODUCER == regs::record_producer::offset);
  CHECK(CHIP_INVALIDATE_FIRST == regs::invalidate_first::offset);
  CHECK(CHIP_INVALIDATE_LAST == regs::invalidate_last::offset);
  CHECK(CHIP_INVALIDATE == regs::invalidate::offset);
}
