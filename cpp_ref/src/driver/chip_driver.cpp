// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/internal/wire/chip_registers.hpp>
#include <cchip/internal/wire/query.hpp>
#include <deque>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

namespace cchip {
namespace {

namespace regs = chip_registers;

constexpr std::uint64_t line_bytes = 64;
constexpr std::uint64_t record_bytes = 16;
constexpr std::uint64_t memory_end = std::uint64_t{1} << 38U;
constexpr std::uint32_t map_major = 2;
// proceed() from one look at the status to the next
constexpr std::uint64_t status_every = 4096;
// and to the next attempt at a swap
constexpr std::uint64_t swaps_every = 64;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("chip driver: " + what); }

class ChipDriver final : public QueryPort {
 public:
  ChipDriver(std::unique_ptr<Machine> machine, const ChipDriverOptions& options)
      : machine_(std::move(machine)), options_(options) {
    if (!machine_) refuse("no machine");
    place();
    identify();
    place_bitstreams();
    load_bitstreams();
    if (!restart()) throw std::runtime_error("chip driver: the chip's reset does not end; reset chip and bus");
  }

  const char* name() const override { return "chip"; }
  ChipCapabilities capabilities() const override { return capabilities_; }

  void store(std::uint32_t first_line, const std::vector<Line>& lines) override {
    Bytes bytes;
    bytes.reserve(lines.size() * line_bytes);
    for (const Line& line : lines) bytes.insert(bytes.end(), line.begin(), line.end());
    machine_->write_memory(first_line * line_bytes, bytes);
    if (!lines.empty()) invalidate(first_line, static_cast<std::uint32_t>(lines.size()));
  }

  bool refit(std::uint32_t first_line, std::uint32_t lines, std::uint32_t root) override {
    ring_doorbell();  // the chip answers what it has meanwhile
    const RefitEnd end = machine_->refit(first_line, lines, root);
    // Parts of a write could overwrite what the host stores there next.
    if (end.outstanding)
      throw std::runtime_error("chip driver: memory owes the refit engine an answer; reset engine, chip and bus");
    invalidate(first_line, lines);
    return end.code == RefitCode::ok;
  }

  void lock(unsigned range, std::uint32_t first, std::uint32_t last) override {
    if (range >= capabilities_.lock_ranges) refuse("no lock range " + std::to_string(range));
    // empty in between: never a range that was not requested
    machine_->write_register(regs::lock_last::offset(range), 0);
    machine_->write_register(regs::lock_first::offset(range), std::max(first, 1U));
    machine_->write_register(regs::lock_last::offset(range), first > last ? 0 : last);
  }

  bool submit(const Query& query) override {
    const std::uint32_t size = 1U << options_.query_log2;
    if (written_ - taken_ == size) {
      ring_doorbell();
      const std::uint32_t consumer = machine_->read_register(regs::query_consumer::offset);
      taken_ += static_cast<std::uint16_t>(consumer - taken_);
      if (written_ - taken_ == size) return false;
    }
    if (in_flight_ == 0) quiet_ = 0;
    ++in_flight_;
    const Line line = encode(query);
    machine_->write_memory(query_base_ + line_bytes * (written_ & (size - 1)), Bytes(line.begin(), line.end()));
    ++written_;
    doorbell_ = true;
    return true;
  }

  std::optional<QueryOutcome> collect() override {
    ring_doorbell();
    while (const std::optional<RecordBytes> record = next_record()) {
      if (!is_done(*record)) {
        const PairRecord pair = decode_pair(*record);
        open_[pair.tag].push_back(pair);
        continue;
      }
      if (in_flight_ > 0) --in_flight_;
      QueryOutcome outcome;
      outcome.done = decode_done(*record);
      if (const auto found = open_.find(outcome.done.tag); found != open_.end()) {
        outcome.pairs = std::move(found->second);
        open_.erase(found);
      }
      return outcome;
    }
    give_back();
    return std::nullopt;
  }

  bool proceed() override {
    machine_->proceed();
    ++quiet_;
    if (!wanted_.empty() && quiet_ % swaps_every == 0) ask_for_modules();
    if (quiet_ % status_every != 0) return true;
    if (capabilities_.swap_slots != 0) note_swaps();
    const std::uint32_t status = machine_->read_register(regs::status::offset);
    const bool failed = (status & (regs::status::query_failed_mask | regs::status::record_failed_mask)) != 0;
    return !failed && quiet_ < options_.patience;
  }

  bool recover() override { return restart(); }

  void load(ModuleId module_id) override {
    if (capabilities_.swap_slots == 0) return;
    wanted_.push_back(module_id);
    ask_for_modules();
  }

  SwapCounts swaps() override {
    if (capabilities_.swap_slots != 0) note_swaps();
    return swaps_;
  }

  std::uint64_t clocks() const override {
    const std::uint64_t low = machine_->read_register(regs::counter_clocks::offset);
    const std::uint64_t high = machine_->read_register(regs::counter_clocks::offset + 4);
    return high << 32U | low;
  }

 private:
  void invalidate(std::uint32_t first_line, std::uint32_t lines) {
    machine_->write_register(regs::invalidate_first::offset, first_line);
    machine_->write_register(regs::invalidate_last::offset, first_line + lines - 1);
    machine_->write_register(regs::invalidate::offset, regs::invalidate::go_mask);
    if (!wait(regs::status::invalidating_mask)) throw std::runtime_error("chip driver: an invalidation does not end");
  }

  /// Rings first, both at multiples of their lines, then images.
  void place() {
    const ChipDriverOptions& o = options_;
    if (o.query_log2 > 15) refuse("query_log2 is " + std::to_string(o.query_log2) + ", 0..15 are legal");
    if (o.record_log2 > 28) refuse("record_log2 is " + std::to_string(o.record_log2) + ", 0..28 are legal");
    if (o.memory_base % line_bytes != 0) refuse("memory_base is no multiple of 64");
    if (o.memory_base >= memory_end || o.memory_bytes > memory_end - o.memory_base)
      refuse("the memory does not end below 2^38");
    query_base_ = o.memory_base;
    record_base_ = query_base_ + (line_bytes << o.query_log2);
    const std::uint64_t records = ((record_bytes << o.record_log2) + line_bytes - 1) / line_bytes * line_bytes;
    // line 0 belongs to no image: a lock range may be empty
    place_images(std::max(record_base_ + records, line_bytes), "rings take ");
  }

  /// Images begin at this byte.
  void place_images(std::uint64_t images, const char* before_them) {
    const std::uint64_t end = options_.memory_base + options_.memory_bytes;
    if (images + line_bytes > end)
      refuse("memory of " + std::to_string(options_.memory_bytes) + " bytes is too small: the " + before_them +
             std::to_string(images - options_.memory_base));
    capabilities_.image_first = static_cast<std::uint32_t>(images / line_bytes);
    capabilities_.image_lines = static_cast<std::uint32_t>(end / line_bytes - images / line_bytes);
  }

  /// Of a chip with swaps, between rings and images.
  void place_bitstreams() {
    if (capabilities_.swap_slots == 0) return;
    std::uint64_t at = capabilities_.image_first * line_bytes;
    for (unsigned slot = 0; slot < capabilities_.swap_slots; ++slot) {
      for (const ModuleId id : {ModuleId::tri_tri, ModuleId::tri_quad, ModuleId::quad_quad}) {
        const auto place = static_cast<std::uint8_t>(slot);
        const Bytes bytes = options_.bitstream
                                ? options_.bitstream(place, id)
                                : make_bitstream(place, id, make_payload(place, id, options_.payload_bytes, 1));
        constexpr std::uint64_t align = std::max<std::uint64_t>(defs::bitstream_align, line_bytes);
        at = (at + align - 1) / align * align;
        bitstreams_.push_back({unsigned{defs::table_modules} * slot + static_cast<unsigned>(id), at, bytes});
        at = (at + bytes.size() + align - 1) / align * align;
      }
    }
    if (at > std::uint64_t{1} << 32U) refuse("bitstreams do not end below 2^32; choose a lower memory_base");
    place_images(at, "rings and bitstreams take ");
  }

  void identify() {
    const std::uint32_t id = machine_->read_register(regs::id::offset);
    if (id != regs::id::value_reset)
      throw std::runtime_error("chip driver: no chip, its register id is " + std::to_string(id));
    const std::uint32_t version = machine_->read_register(regs::version::offset);
    const std::uint32_t major = (version & regs::version::major_number_mask) >> regs::version::major_number_shift;
    if (major != map_major) {
      throw std::runtime_error("chip driver: register map " + std::to_string(major) + " is not known, " +
                               std::to_string(map_major) + " is; use a driver of the chip's release");
    }
    const std::uint32_t has = machine_->read_register(regs::capabilities::offset);
    const std::uint32_t kinds = (has & regs::capabilities::kinds_mask) >> regs::capabilities::kinds_shift;
    capabilities_.quads = kinds == 7;
    capabilities_.refits = machine_->has_refit();
    if ((has & regs::capabilities::swaps_mask) != 0)
      capabilities_.swap_slots = (has & regs::capabilities::slots_mask) >> regs::capabilities::slots_shift;
    if (capabilities_.swap_slots > regs::slot_status::count) {
      throw std::runtime_error("chip driver: the register capabilities says " +
                               std::to_string(capabilities_.swap_slots) + " slots, a chip has at most " +
                               std::to_string(regs::slot_status::count) + "; check the bus and the chip's release");
    }
    capabilities_.lock_ranges = (has & regs::capabilities::locks_mask) >> regs::capabilities::locks_shift;
    capabilities_.queries_in_flight = std::size_t{1} << options_.query_log2;
  }

  void load_bitstreams() {
    for (const Loaded& x : bitstreams_) {
      machine_->write_memory(x.address, x.bytes);
      machine_->write_register(regs::bitstream_address::offset(x.index), static_cast<std::uint32_t>(x.address));
      machine_->write_register(regs::bitstream_size::offset(x.index), static_cast<std::uint32_t>(x.bytes.size()));
      machine_->write_register(regs::bitstream_valid::offset(x.index), 1);
    }
    if (bitstreams_.empty()) return;
    machine_->write_register(regs::swap_minimum_batch::offset, options_.minimum_batch);
    machine_->write_register(regs::swap_maximum_age::offset, options_.maximum_age);
    machine_->write_register(regs::interrupt_status::offset, regs::interrupt_status::swap_done_mask);
    machine_->write_register(regs::swap_control::offset, regs::swap_control::scheduler_enable_mask);
  }

  /// Asks for modules that are wanted, one swap at a time: a command during a swap is refused.
  void ask_for_modules() {
    note_swaps();
    while (!wanted_.empty()) {
      const auto m = static_cast<std::uint32_t>(wanted_.front());
      bool loaded = false;
      for (unsigned slot = 0; slot < capabilities_.swap_slots; ++slot) {
        const std::uint32_t status = machine_->read_register(regs::slot_status::offset(slot));
        if ((status & regs::slot_status::phase_mask) != 0) return;  // a swap is in flight
        const bool works = (status & regs::slot_status::decoupled_mask) == 0;
        const bool has = (status & regs::slot_status::module_id_mask) >> regs::slot_status::module_id_shift == m;
        if (!works || !has) continue;
        asked_[slot] = ++asks_;
        loaded = true;
        break;
      }
      wanted_.pop_front();
      if (loaded) continue;
      const auto end = asked_.begin() + capabilities_.swap_slots;
      const auto slot = static_cast<std::uint32_t>(std::min_element(asked_.begin(), end) - asked_.begin());
      asked_[slot] = ++asks_;
      machine_->write_register(regs::swap_command::offset, regs::swap_command::go_mask |
                                                               m << regs::swap_command::module_id_shift |
                                                               slot << regs::swap_command::slot_shift);
      return;
    }
  }

  /// Counts a swap that has ended well since this was called last.
  void note_swaps() {
    const std::uint32_t done = regs::interrupt_status::swap_done_mask;
    if ((machine_->read_register(regs::interrupt_status::offset) & done) == 0) return;
    machine_->write_register(regs::interrupt_status::offset, done);
    ++swaps_.swaps;
    for (std::uint32_t phase = 0; phase < regs::phase_clocks::count; ++phase)
      swaps_.clocks += machine_->read_register(regs::phase_clocks::offset(phase));
  }

  /// A soft reset, empty rings, registers. \returns false: the reset does not end
  bool restart() {
    machine_->write_register(regs::control::offset, regs::control::soft_reset_mask);
    if (!wait(regs::status::resetting_mask)) return false;
    written_ = taken_ = 0;
    read_ = told_ = confirmed_ = 0;
    doorbell_ = false;
    quiet_ = 0;
    in_flight_ = 0;
    open_.clear();
    machine_->write_memory(record_base_, Bytes(record_bytes << options_.record_log2));
    const auto set = [this](std::uint32_t offset, std::uint64_t value) {
      machine_->write_register(offset, static_cast<std::uint32_t>(value));
    };
    set(regs::step_limit::offset, options_.step_limit);
    set(regs::memory_limit::offset, options_.memory_limit);
    set(regs::open_limit::offset, options_.open_limit);
    set(regs::pairs_each::offset, options_.pairs_each);
    set(regs::query_base_low::offset, query_base_);
    set(regs::query_base_high::offset, query_base_ >> 32U);
    set(regs::query_size::offset, options_.query_log2);
    set(regs::record_base_low::offset, record_base_);
    set(regs::record_base_high::offset, record_base_ >> 32U);
    set(regs::record_size::offset, options_.record_log2);
    set(regs::control::offset, regs::control::enable_mask);
    return true;
  }

  /// Until the bits of the status are 0. \returns false: not in time
  bool wait(std::uint32_t mask) {
    for (std::uint64_t i = 0; (machine_->read_register(regs::status::offset) & mask) != 0; ++i) {
      if (i == options_.reset_patience) return false;
      machine_->proceed();
    }
    return true;
  }

  void ring_doorbell() {
    if (!doorbell_) return;
    doorbell_ = false;
    machine_->write_register(regs::query_producer::offset, written_ & 0xFFFFU);
  }

  /// The next record if its phase bit says that it is there.
  std::optional<RecordBytes> next_record() {
    const std::uint32_t size = 1U << options_.record_log2;
    const std::uint64_t at = record_base_ + record_bytes * (read_ & (size - 1));
    // The word of the phase bit alone, then the record: memory may read the words of one call in any order.
    const bool phase = (machine_->read_memory(at + 4, 4)[3] & 0x80U) != 0;
    const bool expected = (read_ >> options_.record_log2 & 1U) == 0;
    if (phase != expected) return std::nullopt;
    if (options_.confirm_records && confirmed_ == read_) {
      confirmed_ = machine_->read_register(regs::record_producer::offset);
      if (confirmed_ == read_) return std::nullopt;
    }
    const Bytes bytes = machine_->read_memory(at, static_cast<std::size_t>(record_bytes));
    RecordBytes record;
    std::copy(bytes.begin(), bytes.end(), record.begin());
    record[7] &= 0x7FU;
    ++read_;
    quiet_ = 0;
    if (read_ - told_ >= std::max(size / 4, 1U)) give_back();
    return record;
  }

  /// Room in the ring of records.
  void give_back() {
    if (read_ == told_) return;
    told_ = read_;
    machine_->write_register(regs::record_consumer::offset, read_);
  }

  struct Loaded {
    unsigned index;  ///< in the table of bitstreams
    std::uint64_t address;
    Bytes bytes;
  };

  std::unique_ptr<Machine> machine_;
  ChipDriverOptions options_;
  std::vector<Loaded> bitstreams_;
  std::array<std::uint64_t, regs::slot_status::count> asked_ = {};  // when a module was asked for in this slot last
  std::uint64_t asks_ = 0;
  std::deque<ModuleId> wanted_;  // that were not asked for yet
  SwapCounts swaps_;
  ChipCapabilities capabilities_;
  std::uint64_t query_base_ = 0, record_base_ = 0;  // bytes
  std::uint32_t written_ = 0, taken_ = 0;           // queries written by the host, known to be taken by the chip
  std::uint32_t read_ = 0, told_ = 0;               // records read, given back
  std::uint32_t confirmed_ = 0;                     // records that are whole in memory, with confirm_records
  bool doorbell_ = false;                           // queries were written that the chip does not know of
  std::uint64_t in_flight_ = 0;                     // queries
  std::uint64_t quiet_ = 0;                         // proceed() since the last record, or since there was a query
  std::unordered_map<std::uint32_t, std::vector<PairRecord>> open_;  // by tag, of queries that have not ended
};

}  // namespace

std::unique_ptr<QueryPort> open_chip(std::unique_ptr<Machine> machine, const ChipDriverOptions& options) {
  return std::make_unique<ChipDriver>(std::move(machine), options);
}

}  // namespace cchip
