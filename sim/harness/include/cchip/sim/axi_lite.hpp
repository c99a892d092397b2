// SPDX-License-Identifier: Apache-2.0
/// \file
/// AXI4-Lite master on pins s_axil_*, 32-bit data.
#ifndef CCHIP_SIM_AXI_LITE_HPP
#define CCHIP_SIM_AXI_LITE_HPP

#include <verilated.h>

#include <cchip/sim/agent.hpp>
#include <cchip/sim/errors.hpp>
#include <cchip/sim/pattern.hpp>
#include <cchip/sim/printing.hpp>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

namespace cchip::sim {

/// On which clocks the channels are active.
struct AxiLitePatterns {
  Pattern write_address = Pattern::always();
  Pattern write_data = Pattern::always();
  Pattern write_response = Pattern::always();
  Pattern read_address = Pattern::always();
  Pattern read_data = Pattern::always();
};

/// The result of a read.
struct AxiLiteWord {
  std::uint32_t data = 0;
  bool ok = false;  ///< answered OKAY
};

/// Sends queues of writes and of reads, each in order, the two side by side. Checks that a stalled response does not
/// change.
template <class Model>
class AxiLiteMaster : public Agent {
 public:
  explicit AxiLiteMaster(Model& model, AxiLitePatterns patterns = {}) : model_(model), patterns_(std::move(patterns)) {
    model_.s_axil_awvalid = 0;
    model_.s_axil_wvalid = 0;
    model_.s_axil_bready = 0;
    model_.s_axil_arvalid = 0;
    model_.s_axil_rready = 0;
    model_.s_axil_awprot = 0;
    model_.s_axil_arprot = 0;
  }

  void push_write(std::uint32_t address, std::uint32_t data, unsigned byte_lanes = 15) {
    addresses_.items.push_back(address);
    data_.items.push_back({data, byte_lanes});
    ++writes_;
  }
  void push_read(std::uint32_t address) {
    reads_.items.push_back(address);
    ++reads_open_;
  }
  /// Answers not yet fetched with next_*.
  bool done() const { return written_.size() == writes_ && read_.size() == reads_open_; }

  /// Answer of the oldest write: was it OKAY?
  bool next_write() {
    const bool ok = written_.front();
    written_.pop_front();
    --writes_;
    return ok;
  }
  AxiLiteWord next_read() {
    const AxiLiteWord word = read_.front();
    read_.pop_front();
    --reads_open_;
    return word;
  }

  /// One write or one read from beginning to end, for a master with nothing in flight.
  template <class Simulation>
  bool write(Simulation& simulation, std::uint32_t address, std::uint32_t data, unsigned byte_lanes = 15) {
    push_write(address, data, byte_lanes);
    simulation.run_until([&] { return done(); }, 1000, "the answer of a write");
    return next_write();
  }
  template <class Simulation>
  AxiLiteWord read(Simulation& simulation, std::uint32_t address) {
    push_read(address);
    simulation.run_until([&] { return done(); }, 1000, "the answer of a read");
    return next_read();
  }

  void drive(const ClockInfo& now) override {
    const bool run = !now.in_reset;
    addresses_.offer(run, patterns_.write_address);
    data_.offer(run, patterns_.write_data);
    reads_.offer(run, patterns_.read_address);
    model_.s_axil_awvalid = addresses_.offering;
    model_.s_axil_wvalid = data_.offering;
    model_.s_axil_arvalid = reads_.offering;
    if (addresses_.offering) model_.s_axil_awaddr = static_cast<SData>(addresses_.items.front());
    if (data_.offering) {
      model_.s_axil_wdata = data_.items.front().first;
      model_.s_axil_wstrb = static_cast<CData>(data_.items.front().second);
    }
    if (reads_.offering) model_.s_axil_araddr = static_cast<SData>(reads_.items.front());
    model_.s_axil_bready = run && patterns_.write_response.next();
    model_.s_axil_rready = run && patterns_.read_data.next();
  }

  /// \throws StreamError a response changed or was withdrawn before it was accepted
  void sample(const ClockInfo& now) override {
    if (now.in_reset) {
      stalled_b_.reset();
      stalled_r_.reset();
      return;
    }
    addresses_.accept(model_.s_axil_awready != 0);
    data_.accept(model_.s_axil_wready != 0);
    reads_.accept(model_.s_axil_arready != 0);
    const std::uint64_t b = model_.s_axil_bresp;
    if (follow("s_axil_b", model_.s_axil_bvalid != 0, model_.s_axil_bready != 0, b, stalled_b_)) {
      written_.push_back(b == 0);
    }
    const std::uint64_t r = std::uint64_t{model_.s_axil_rresp} << 32 | model_.s_axil_rdata;
    if (follow("s_axil_r", model_.s_axil_rvalid != 0, model_.s_axil_rready != 0, r, stalled_r_)) {
      read_.push_back({model_.s_axil_rdata, model_.s_axil_rresp == 0});
    }
  }

  std::string waits_for() const override { return done() ? "" : "the AXI4-Lite master waits for an answer"; }

 private:
  template <class Item>
  struct Channel {
    std::deque<Item> items;
    bool offering = false;
    void offer(bool run, Pattern& pattern) { offering = run && (offering || (!items.empty() && pattern.next())); }
    void accept(bool ready) {
      if (!offering || !ready) return;
      offering = false;
      items.pop_front();
    }
  };

  /// True if a response is handed over.
  static bool follow(const char* name, bool valid, bool ready, std::uint64_t payload,
                     std::optional<std::uint64_t>& stalled) {
    if (stalled && (!valid || payload != *stalled)) {
      throw StreamError(std::string(name) + ": response changed before it was accepted");
    }
    stalled.reset();
    if (valid && !ready) stalled = payload;
    return valid && ready;
  }

  Model& model_;
  AxiLitePatterns patterns_;
  Channel<std::uint32_t> addresses_;
  Channel<std::pair<std::uint32_t, unsigned>> data_;
  Channel<std::uint32_t> reads_;
  std::deque<bool> written_;
  std::deque<AxiLiteWord> read_;
  std::size_t writes_ = 0;
  std::size_t reads_open_ = 0;
  std::optional<std::uint64_t> stalled_b_;
  std::optional<std::uint64_t> stalled_r_;
};

}  // namespace cchip::sim

#endif
