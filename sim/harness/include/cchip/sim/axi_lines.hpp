// SPDX-License-Identifier: Apache-2.0
/// \file
/// Memory of 64-byte lines behind an AXI4 master with pins m_axi_*, with delays and faults: reads, and writes if the
/// master has their pins.
#ifndef CCHIP_SIM_AXI_LINES_HPP
#define CCHIP_SIM_AXI_LINES_HPP

#include <verilated.h>

#include <algorithm>
#include <array>
#include <cchip/sim/agent.hpp>
#include <cchip/sim/bits.hpp>
#include <cchip/sim/errors.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <random>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace cchip::sim {

enum class AxiFault : std::uint8_t { none, slave_error, silence };

struct AxiLinesOptions {
  std::uint64_t latency = 60;        ///< clocks from an address to its first beat, at least
  std::uint64_t write_latency = 40;  ///< clocks from the last beat of a write to its response, at least
  std::uint64_t jitter = 0;          ///< up to this many more, at random, of both
  bool reorder = false;              ///< reads that are due are answered in any order
  unsigned ready_percent = 100;      ///< clocks on which an address or a beat is taken
  unsigned valid_percent = 100;      ///< clocks on which a new beat or response is offered
  std::uint64_t beat_every = 1;      ///< clocks from one beat of a read to the next, at least
};

namespace detail {

template <class Model, class = void>
struct HasWrites : std::false_type {};
template <class Model>
struct HasWrites<Model, std::void_t<decltype(std::declval<Model&>().m_axi_awvalid)>> : std::true_type {};

}  // namespace detail

/// Reads: one burst of a whole line each, as cchip_axi_read sends them; a line's beats stay together, lines are
/// answered in the order of their addresses unless reorder is set. Writes: bursts of one beat or more within a line,
/// answered in order. Lines that were never written read as an error. Reset drops what is in flight. \tparam DATA_W
/// width of the data bus, bit
template <class Model, int DATA_W>
class AxiLines : public Agent {
 public:
  using Line = std::array<std::uint8_t, 64>;
  static constexpr std::size_t beat_bytes = DATA_W / 8;
  static constexpr std::size_t beats = 64 / beat_bytes;

  AxiLines(Model& model, std::uint64_t seed) : model_(model), random_(seed) {}

  /// As a bus with a memory behind it.
  using Memory = AxiLines;
  Memory& memory() { return *this; }
  const Memory& memory() const { return *this; }

  AxiLinesOptions options;
  /// Of each read and of each write, by its line; by default none.
  std::function<AxiFault(std::uint64_t line)> read_fault = [](std::uint64_t) { return AxiFault::none; };
  std::function<AxiFault(std::uint64_t line)> write_fault = [](std::uint64_t) { return AxiFault::none; };

  /// Lines in memory of the caller, which outlives the last clock: line first + i is at lines[i]. Those count as
  /// written; other lines are kept here. By default none.
  struct Backing {
    Line* lines = nullptr;
    std::uint64_t first = 0, count = 0;
    bool holds(std::uint64_t number) const { return number >= first && number - first < count; }
  };
  Backing backing;

  Line& line(std::uint64_t number) {
    return backing.holds(number) ? backing.lines[number - backing.first] : lines_[number];
  }
  /// Null if it was never written.
  const Line* find(std::uint64_t number) const {
    if (backing.holds(number)) return &backing.lines[number - backing.first];
    const auto found = lines_.find(number);
    return found == lines_.end() ? nullptr : &found->second;
  }
  void write(std::uint64_t number, const std::vector<Line>& lines) {
    for (const Line& x : lines) line(number++) = x;
  }
  std::uint64_t read_beats() const { return read_beats_; }
  /// Reads that memory has taken and will never answer.
  std::size_t silent() const { return silent_; }

  void drive(const ClockInfo& now) override {
    if (now.in_reset) drop();
    model_.m_axi_arready = !now.in_reset && chance(options.ready_percent) ? 1 : 0;
    if constexpr (detail::HasWrites<Model>::value) {
      model_.m_axi_awready = !now.in_reset && chance(options.ready_percent) ? 1 : 0;
      model_.m_axi_wready = !now.in_reset && chance(options.ready_percent) ? 1 : 0;
    }
    const bool may_offer = now.clock >= next_beat_;
    if (!bursting_ && may_offer) choose(now.clock);
    if (bursting_ && !offered_ && may_offer) offered_ = chance(options.valid_percent);
    model_.m_axi_rvalid = offered_ ? 1 : 0;
    if (offered_) {
      model_.m_axi_rid = static_cast<std::decay_t<decltype(model_.m_axi_rid)>>(burst_.id);
      model_.m_axi_rlast = beat_ + 1 == beats ? 1 : 0;
      model_.m_axi_rresp = burst_.okay ? 0 : 2;
      for (std::size_t i = 0; i < beat_bytes; ++i)
        set_bits(model_.m_axi_rdata, static_cast<int>(8 * i), 8, burst_.data[beat_ * beat_bytes + i]);
    } else {
      set_random(model_.m_axi_rdata, DATA_W, random_);
    }
    if constexpr (detail::HasWrites<Model>::value) drive_responses(now.clock);
  }

  /// \throws StreamError the master breaks a rule
  void sample(const ClockInfo& now) override {
    if (now.in_reset) return;
    if (offered_ && model_.m_axi_rready != 0) {
      offered_ = false;
      ++read_beats_;
      next_beat_ = now.clock + options.beat_every;
      if (++beat_ == beats) bursting_ = false;
    }
    const std::pair<std::uint64_t, unsigned> read(model_.m_axi_araddr, model_.m_axi_arid);
    require(!read_asked_ || (model_.m_axi_arvalid != 0 && read == read_), "m_axi_ar changed before it was accepted");
    read_asked_ = model_.m_axi_arvalid != 0 && model_.m_axi_arready == 0;
    read_ = read;
    if (model_.m_axi_arvalid != 0 && model_.m_axi_arready != 0) take_read(now, read.first, read.second);
    if constexpr (detail::HasWrites<Model>::value) sample_writes(now);
  }

  std::string waits_for() const override {
    return reads_.empty() ? "" : std::to_string(reads_.size()) + " reads outstanding";
  }

 private:
  struct Read {
    unsigned id = 0;
    std::uint64_t due = 0;
    bool okay = true;
    Line data{};
  };
  struct Address {
    std::uint64_t address = 0;
    unsigned id = 0;
    std::size_t count = 1;  ///< beats
  };
  struct Data {
    std::array<std::uint8_t, beat_bytes> bytes{};
    std::uint64_t strobe = 0;
    bool last = true;
  };
  struct Response {
    std::uint64_t due = 0;
    unsigned id = 0;
    bool okay = true;
  };

  static void require(bool condition, const std::string& message) {
    if (!condition) throw StreamError(message);
  }
  bool chance(unsigned percent) { return percent >= 100 || random_() % 100 < percent; }
  std::uint64_t random_delay() { return options.jitter == 0 ? 0 : random_() % (options.jitter + 1); }

  void drive_responses(std::uint64_t now) {
    if (!answering_ && !responses_.empty() && responses_.front().due <= now) answering_ = chance(options.valid_percent);
    model_.m_axi_bvalid = answering_ ? 1 : 0;
    model_.m_axi_bid = static_cast<std::decay_t<decltype(model_.m_axi_bid)>>(answering_ ? responses_.front().id : 0);
    model_.m_axi_bresp = answering_ && !responses_.front().okay ? 2 : 0;
  }
  void sample_writes(const ClockInfo& now) {
    if (answering_ && model_.m_axi_bready != 0) {
      answering_ = false;
      responses_.pop_front();
    }
    if (model_.m_axi_awvalid != 0 && model_.m_axi_awready != 0) take_address();
    if (model_.m_axi_wvalid != 0 && model_.m_axi_wready != 0) take_data();
    while (!addresses_.empty() && data_.size() >= addresses_.front().count) finish_write(now);
  }

  void drop() {
    reads_.clear();
    addresses_.clear();
    data_.clear();
    responses_.clear();
    bursting_ = offered_ = answering_ = read_asked_ = false;
    silent_ = 0;
    next_beat_ = 0;
  }

  void choose(std::uint64_t now) {
    std::vector<std::size_t> due;
    for (std::size_t i = 0; i < reads_.size() && (options.reorder || i == 0); ++i) {
      if (reads_[i].due <= now) due.push_back(i);
    }
    if (due.empty()) return;
    const auto at = reads_.begin() + static_cast<std::ptrdiff_t>(due[random_() % due.size()]);
    burst_ = *at;
    reads_.erase(at);
    bursting_ = true;
    beat_ = 0;
  }

  void take_read(const ClockInfo& now, std::uint64_t address, unsigned id) {
    require(model_.m_axi_arlen + 1U == beats, "m_axi_ar: not a burst of one line");
    if constexpr (detail::HasSize<Model>::value)
      require(model_.m_axi_arburst == 1 && (1U << model_.m_axi_arsize) == beat_bytes,
              "m_axi_ar: not an INCR burst of whole beats");
    require(address % 64 == 0, "m_axi_araddr is not a multiple of 64");
    for (const Read& x : reads_) require(x.id != id, "m_axi_arid is used twice");
    const std::uint64_t number = address / 64;
    const Line* found = find(number);
    const AxiFault fault = read_fault(number);
    if (fault == AxiFault::silence) {
      ++silent_;
      return;
    }
    Read read{id, now.clock + options.latency + random_delay(), fault == AxiFault::none && found != nullptr, {}};
    if (found != nullptr) read.data = *found;
    reads_.push_back(read);
  }

  void take_address() {
    const std::uint64_t address = model_.m_axi_awaddr;
    const std::size_t count = model_.m_axi_awlen + std::size_t{1};
    if constexpr (detail::HasSize<Model>::value)
      require(model_.m_axi_awburst == 1 && (1U << model_.m_axi_awsize) == beat_bytes,
              "m_axi_aw: not an INCR burst of whole beats");
    require(address % beat_bytes == 0, "m_axi_awaddr is not a multiple of the beat");
    require(address % 64 + count * beat_bytes <= 64, "m_axi_aw: a burst beyond its line");
    addresses_.push_back({address, model_.m_axi_awid, count});
  }

  void take_data() {
    Data data;
    for (std::size_t i = 0; i < beat_bytes; ++i)
      data.bytes[i] = static_cast<std::uint8_t>(get_bits(model_.m_axi_wdata, static_cast<int>(8 * i), 8));
    data.strobe = get_bits(model_.m_axi_wstrb, 0, static_cast<int>(beat_bytes));
    data.last = model_.m_axi_wlast != 0;
    data_.push_back(data);
  }

  void finish_write(const ClockInfo& now) {
    const Address address = addresses_.front();
    addresses_.pop_front();
    const AxiFault fault = write_fault(address.address / 64);
    for (std::size_t beat = 0; beat < address.count; ++beat) {
      const Data data = data_.front();
      data_.pop_front();
      require(data.last == (beat + 1 == address.count), "m_axi_wlast is not that of its burst");
      if (fault != AxiFault::none) continue;
      Line& to = line(address.address / 64);
      for (std::size_t i = 0; i < beat_bytes; ++i) {
        if ((data.strobe >> i & 1) != 0) to[address.address % 64 + beat * beat_bytes + i] = data.bytes[i];
      }
    }
    if (fault == AxiFault::silence) return;
    const std::uint64_t due = now.clock + options.write_latency + random_delay();
    responses_.push_back(
        {responses_.empty() ? due : std::max(due, responses_.back().due), address.id, fault == AxiFault::none});
  }

  Model& model_;
  std::mt19937_64 random_;
  std::unordered_map<std::uint64_t, Line> lines_;
  std::deque<Read> reads_;
  Read burst_;
  std::size_t beat_ = 0;
  bool bursting_ = false, offered_ = false, answering_ = false, read_asked_ = false;
  std::pair<std::uint64_t, unsigned> read_;
  std::deque<Address> addresses_;
  std::deque<Data> data_;
  std::deque<Response> responses_;
  std::uint64_t read_beats_ = 0, next_beat_ = 0;
  std::size_t silent_ = 0;
};

}  // namespace cchip::sim

#endif
