// SPDX-License-Identifier: Apache-2.0
// What the driver of a chip makes of registers that no chip has, and of records that memory shows in halves.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/internal/wire/chip_registers.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

using namespace cchip;
namespace regs = cchip::chip_registers;

namespace {

/// Registers of a chip with swaps and this number of slots; the others are 0.
class Registers final : public Machine {
 public:
  explicit Registers(std::uint32_t slots) : slots_(slots) {}
  std::uint32_t read_register(std::uint32_t offset) override {
    if (offset == regs::id::offset) return regs::id::value_reset;
    if (offset == regs::version::offset) return 2U << regs::version::major_number_shift;
    if (offset != regs::capabilities::offset) return 0;
    return regs::capabilities::swaps_mask | 7U << regs::capabilities::kinds_shift |
           slots_ << regs::capabilities::slots_shift;
  }
  void write_register(std::uint32_t, std::uint32_t) override {}
  void write_memory(std::uint64_t, const Bytes&) override {}
  Bytes read_memory(std::uint64_t, std::size_t count) override { return Bytes(count); }
  bool has_refit() const override { return true; }
  RefitEnd refit(std::uint32_t, std::uint32_t, std::uint32_t) override { return end; }
  bool interrupt() override { return false; }
  void proceed() override {}

  RefitEnd end;

 private:
  std::uint32_t slots_;
};

}  // namespace

TEST_CASE("chip driver: more slots than a chip can have are refused", "[ref][chip_driver]") {
  for (std::uint32_t slots = 1; slots <= regs::slot_status::count; ++slots) {
    const auto port = open_chip(std::make_unique<Registers>(slots));
    CHECK(port->capabilities().swap_slots == slots);
    for (std::uint32_t i = 0; i < 2 * slots; ++i) port->load(ModuleId::tri_tri);
  }
  for (std::uint32_t slots = regs::slot_status::count + 1; slots <= 7; ++slots) {
    CHECK_THROWS_WITH(open_chip(std::make_unique<Registers>(slots)),
                      "chip driver: the register capabilities says " + std::to_string(slots) +
                          " slots, a chip has at most 4; check the bus and the chip's release");
  }
}

TEST_CASE("chip driver: a refit whose writes may still arrive is no refit that gave up", "[ref][chip_driver]") {
  auto machine = std::make_unique<Registers>(1);
  RefitEnd& end = machine->end;
  const auto port = open_chip(std::move(machine));
  CHECK(port->refit(100, 3, 1));
  end.code = RefitCode::timeout;
  CHECK_FALSE(port->refit(100, 3, 1));  // the host makes the nodes and stores them at once
  end.outstanding = true;
  CHECK_THROWS_AS(port->refit(100, 3, 1), std::runtime_error);
}

namespace {

ChipDriverOptions small() {
  ChipDriverOptions options;
  options.query_log2 = 2;
  options.record_log2 = 3;
  options.memory_bytes = 4096;
  return options;
}
constexpr std::uint64_t record_base = 64 << 2U;
constexpr std::uint32_t pairs_each = 2;

/// A chip behind a port of 64 bits. It answers a query with two pair records and the done record. Each fourth of the
/// host's calls lets one beat through: a half of a record, then the other one, then the chip counts the record.
class Halves final : public Machine {
 public:
  std::uint32_t read_register(std::uint32_t offset) override {
    step();
    if (offset == regs::id::offset) return regs::id::value_reset;
    if (offset == regs::version::offset) return 2U << regs::version::major_number_shift;
    if (offset == regs::capabilities::offset) return 7U << regs::capabilities::kinds_shift;
    if (offset == regs::query_consumer::offset) return queries_;
    return offset == regs::record_producer::offset ? producer_ : 0;
  }
  void write_register(std::uint32_t offset, std::uint32_t value) override {
    step();
    if (offset == regs::control::offset && value == regs::control::soft_reset_mask) {
      written_ = producer_ = queries_ = 0;
      steps_.clear();
    }
    if (offset != regs::query_producer::offset) return;
    for (; queries_ != value; ++queries_) {
      Line query;
      std::copy_n(memory_.begin() + 64 * static_cast<std::ptrdiff_t>(queries_ % 4), 64, query.begin());
      const std::uint32_t tag = decode_query(query).tag;
      for (std::uint32_t i = 0; i < pairs_each; ++i) write(encode(PairRecord{tag, tag + 10 + i, tag + 20 + i, true}));
      write(encode(DoneRecord{tag, QueryCode::ok, QueryAnswer::yes, tag, pairs_each}));
    }
  }
  void write_memory(std::uint64_t address, const Bytes& bytes) override {
    step();
    std::copy(bytes.begin(), bytes.end(), memory_.begin() + static_cast<std::ptrdiff_t>(address));
  }
  Bytes read_memory(std::uint64_t address, std::size_t count) override {
    step();
    const auto from = memory_.begin() + static_cast<std::ptrdiff_t>(address);
    return {from, from + static_cast<std::ptrdiff_t>(count)};
  }
  bool interrupt() override { return false; }
  void proceed() override { step(); }

 private:
  void step() {
    if (++calls_ % 4 != 0 || steps_.empty()) return;
    steps_.front()();
    steps_.pop_front();
  }
  void write(RecordBytes record) {
    const std::uint32_t place = written_ % 8;
    if (written_ / 8 % 2 == 0) record[7] |= 0x80U;  // phase
    ++written_;
    for (const std::ptrdiff_t half : {0, 8}) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(record_base + 16 * place) + half;
      steps_.emplace_back([=] { std::copy_n(record.begin() + half, 8, memory_.begin() + at); });
    }
    steps_.emplace_back([this] { ++producer_; });
  }

  Bytes memory_ = Bytes(4096);
  std::deque<std::function<void()>> steps_;
  std::uint32_t calls_ = 0, queries_ = 0, written_ = 0, producer_ = 0;
};

/// Of 40 queries, in five rings of records or so, those whose records are not what the chip has written.
int wrong_answers(bool confirm) {
  ChipDriverOptions options = small();
  options.confirm_records = confirm;
  const auto port = open_chip(std::make_unique<Halves>(), options);
  int wrong = 0;
  for (std::uint32_t i = 0; i < 40; ++i) {
    Query query;
    query.tag = 100 * (i + 1);
    REQUIRE(port->submit(query));
    std::optional<QueryOutcome> outcome;
    for (int looks = 0; !outcome && looks < 1000; ++looks) {
      outcome = port->collect();
      if (!outcome) REQUIRE(port->proceed());
    }
    REQUIRE(outcome.has_value());
    bool right = outcome->done.tag == query.tag && outcome->done.pairs == pairs_each &&
                 outcome->done.steps == query.tag && outcome->pairs.size() == pairs_each;
    for (std::uint32_t k = 0; right && k < pairs_each; ++k)
      right = outcome->pairs[k].id_a == query.tag + 10 + k && outcome->pairs[k].id_b == query.tag + 20 + k;
    wrong += right ? 0 : 1;
  }
  return wrong;
}

}  // namespace

TEST_CASE("chip driver: half a record is not accepted with confirm_records", "[ref][chip_driver]") {
  CHECK(wrong_answers(true) == 0);
  CHECK(wrong_answers(false) > 0);  // the machine does show halves
}
