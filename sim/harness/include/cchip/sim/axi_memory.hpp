// SPDX-License-Identifier: Apache-2.0
/// \file
/// Memory behind an AXI4 read master with pins m_axi_*, 32-bit data; with delays and faults.
#ifndef CCHIP_SIM_AXI_MEMORY_HPP
#define CCHIP_SIM_AXI_MEMORY_HPP

#include <verilated.h>

#include <algorithm>
#include <cchip/sim/agent.hpp>
#include <cchip/sim/errors.hpp>
#include <cchip/sim/pattern.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cchip::sim {

enum class AxiResponse : std::uint8_t { okay = 0, exclusive_okay = 1, slave_error = 2, decode_error = 3 };

/// One beat of a read.
struct AxiBeat {
  std::uint32_t address = 0;
  std::uint32_t data = 0;
  AxiResponse response = AxiResponse::okay;
  bool last = false;
};

struct AxiMemoryOptions {
  /// Clocks from the handshake of an address to the first clock with m_axi_rvalid = 1, >= 1.
  std::uint64_t latency = 4;
  /// Clocks with m_axi_arready = 1.
  Pattern address_ready = Pattern::always();
  /// Clocks on which a new beat is offered.
  Pattern beat_valid = Pattern::always();
};

/// Answers reads in order and checks the master: a stalled address does not change, bursts are INCR of 4-byte beats,
/// aligned, within 4 KiB. Addresses that were never written are answered with decode_error. Reset drops the bursts in
/// flight.
template <class Model>
class AxiMemory : public Agent {
 public:
  /// Changes the beats of a burst before they are sent, to inject faults.
  using Fault = std::function<void(std::vector<AxiBeat>&)>;

  explicit AxiMemory(Model& model, AxiMemoryOptions options = {}) : model_(model), options_(std::move(options)) {}

  /// \param address multiple of 4; an incomplete last word is padded with zeros
  void write(std::uint32_t address, const std::vector<std::uint8_t>& bytes) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      std::uint32_t& word = words_[address + static_cast<std::uint32_t>(i / 4 * 4)];
      const auto shift = static_cast<unsigned>(8 * (i % 4));
      word = (word & ~(0xFFU << shift)) | static_cast<std::uint32_t>(bytes[i]) << shift;
    }
  }
  /// \param address multiple of 4
  /// \returns 0 for bytes of words that were never written
  std::vector<std::uint8_t> read(std::uint32_t address, std::size_t size) const {
    std::vector<std::uint8_t> bytes(size);
    for (std::size_t i = 0; i < size; ++i) {
      const auto word = words_.find(address + static_cast<std::uint32_t>(i / 4 * 4));
      if (word != words_.end()) bytes[i] = static_cast<std::uint8_t>(word->second >> 8 * (i % 4));
    }
    return bytes;
  }
  void clear() { words_.clear(); }
  /// If set: where words are, instead of those that were written here; none: nothing wrote them.
  std::function<std::optional<std::uint32_t>(std::uint32_t address)> backing;
  /// If set: gets the bursts, which then are not answered from words here, but by answer(), in their order.
  std::function<void(std::uint32_t address, std::uint32_t beats)> elsewhere;
  /// Next beat of the bursts that went elsewhere, without further delay.
  void answer(const AxiBeat& beat) { beats_.emplace_back(0, beat); }
  void set_options(AxiMemoryOptions options) { options_ = std::move(options); }
  void set_fault(Fault fault) { fault_ = std::move(fault); }
  /// At most this many further beats are sent until resume().
  void stop_after(std::uint64_t beats) { allowed_ = beats; }
  /// No address is accepted until resume().
  void refuse_addresses() { refuses_ = true; }
  void resume() {
    allowed_ = std::numeric_limits<std::uint64_t>::max();
    refuses_ = false;
  }

  /// Beats not yet taken, of accepted addresses.
  std::size_t owed() const { return beats_.size(); }
  std::uint64_t bursts() const { return bursts_; }
  std::uint64_t beats() const { return sent_; }
  /// Most bursts in flight at a time.
  std::size_t most_outstanding() const { return most_outstanding_; }

  void drive(const ClockInfo& now) override {
    if (now.in_reset) {
      beats_.clear();
      offering_ = false;
      asked_ = false;
      outstanding_ = 0;
    }
    model_.m_axi_arready = !now.in_reset && !refuses_ && options_.address_ready.next() ? 1 : 0;
    if (!offering_ && !beats_.empty() && allowed_ != 0 && now.clock >= beats_.front().first &&
        options_.beat_valid.next()) {
      offering_ = true;
    }
    const AxiBeat beat = offering_ ? beats_.front().second : AxiBeat{0, 0xDEADBEEF, AxiResponse::decode_error, true};
    model_.m_axi_rvalid = offering_ ? 1 : 0;
    model_.m_axi_rdata = beat.data;
    model_.m_axi_rresp = static_cast<CData>(beat.response);
    model_.m_axi_rlast = beat.last ? 1 : 0;
  }

  /// \throws StreamError the master breaks a rule
  void sample(const ClockInfo& now) override {
    if (now.in_reset) return;
    if (offering_ && model_.m_axi_rready != 0) {
      if (beats_.front().second.last) --outstanding_;
      beats_.pop_front();
      offering_ = false;
      ++sent_;
      if (allowed_ != std::numeric_limits<std::uint64_t>::max()) --allowed_;
    }
    const bool asks = model_.m_axi_arvalid != 0;
    const std::pair<std::uint32_t, std::uint32_t> request(model_.m_axi_araddr, model_.m_axi_arlen);
    require(!asked_ || (asks && request == request_), "m_axi_ar changed before it was accepted");
    asked_ = asks && model_.m_axi_arready == 0;
    request_ = request;
    if (asks && model_.m_axi_arready != 0) accept(now, request.first, request.second + 1);
  }

  std::string waits_for() const override {
    return beats_.empty() ? "" : std::to_string(beats_.size()) + " beats outstanding";
  }

 private:
  static void require(bool condition, const std::string& message) {
    if (!condition) throw StreamError(message);
  }

  std::optional<std::uint32_t> at(std::uint32_t address) const {
    if (backing) return backing(address);
    const auto word = words_.find(address);
    return word == words_.end() ? std::nullopt : std::optional<std::uint32_t>(word->second);
  }

  void accept(const ClockInfo& now, std::uint32_t address, std::uint32_t count) {
    if constexpr (detail::HasSize<Model>::value)
      require(model_.m_axi_arsize == 2 && model_.m_axi_arburst == 1, "m_axi_ar: not an INCR burst of 4-byte beats");
    require(address % 4 == 0, "m_axi_araddr is not a multiple of 4");
    require(count <= 16, "m_axi_arlen: more than 16 beats");
    require(address / 4096 == (address + 4 * count - 1) / 4096, "burst crosses a boundary of 4 KiB");
    ++bursts_;
    most_outstanding_ = std::max(most_outstanding_, ++outstanding_);
    if (elsewhere) return elsewhere(address, count);
    std::vector<AxiBeat> burst;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::optional<std::uint32_t> word = at(address + 4 * i);
      burst.push_back(
          {address + 4 * i, word.value_or(0), word ? AxiResponse::okay : AxiResponse::decode_error, i + 1 == count});
    }
    if (fault_) fault_(burst);
    for (const AxiBeat& beat : burst) beats_.emplace_back(now.clock + options_.latency, beat);
  }

  Model& model_;
  AxiMemoryOptions options_;
  Fault fault_;
  std::map<std::uint32_t, std::uint32_t> words_;
  std::deque<std::pair<std::uint64_t, AxiBeat>> beats_;  // first clock, beat
  std::pair<std::uint32_t, std::uint32_t> request_;
  bool asked_ = false;
  bool offering_ = false;
  bool refuses_ = false;
  std::uint64_t allowed_ = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t bursts_ = 0;
  std::uint64_t sent_ = 0;
  std::size_t outstanding_ = 0;
  std::size_t most_outstanding_ = 0;
};

}  // namespace cchip::sim

#endif
