// SPDX-License-Identifier: Apache-2.0
/// \file
/// Several AXI4 masters with pins m_axi_* on one memory: the arbiter between them and AxiLines.
#ifndef CCHIP_SIM_AXI_SHARE_HPP
#define CCHIP_SIM_AXI_SHARE_HPP

#include <verilated.h>

#include <cchip/sim/agent.hpp>
#include <cchip/sim/axi_lines.hpp>
#include <cchip/sim/errors.hpp>
#include <cstdint>
#include <deque>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace cchip::sim {

/// The pins of a master as AxiLines expects them, wide enough for IDs that name the master, too.
template <int DATA_W>
struct SharedPins {
  CData m_axi_arvalid = 0, m_axi_arready = 0;
  std::uint64_t m_axi_araddr = 0;
  std::uint32_t m_axi_arid = 0;
  CData m_axi_arlen = 0, m_axi_arsize = 0, m_axi_arburst = 0;
  CData m_axi_rvalid = 0, m_axi_rready = 0;
  std::uint32_t m_axi_rid = 0;
  VlWide<DATA_W / 32> m_axi_rdata = {};
  CData m_axi_rresp = 0, m_axi_rlast = 0;
  CData m_axi_awvalid = 0, m_axi_awready = 0;
  std::uint64_t m_axi_awaddr = 0;
  std::uint32_t m_axi_awid = 0;
  CData m_axi_awlen = 0, m_axi_awsize = 0, m_axi_awburst = 0;
  CData m_axi_wvalid = 0, m_axi_wready = 0;
  VlWide<DATA_W / 32> m_axi_wdata = {};
  std::uint64_t m_axi_wstrb = 0;
  CData m_axi_wlast = 0;
  CData m_axi_bvalid = 0, m_axi_bready = 0;
  std::uint32_t m_axi_bid = 0;
  CData m_axi_bresp = 0;
};

/// The pins of any model's master m_axi_*, for a bus that models of several kinds share.
template <int DATA_W>
struct MasterPins {
  template <class Model>
  explicit MasterPins(Model& m)
      : m_axi_arvalid(m.m_axi_arvalid),
        m_axi_arready(m.m_axi_arready),
        m_axi_arid(m.m_axi_arid),
        m_axi_arlen(m.m_axi_arlen),
        m_axi_arsize(m.m_axi_arsize),
        m_axi_arburst(m.m_axi_arburst),
        m_axi_araddr(m.m_axi_araddr),
        m_axi_rvalid(m.m_axi_rvalid),
        m_axi_rready(m.m_axi_rready),
        m_axi_rid(m.m_axi_rid),
        m_axi_rresp(m.m_axi_rresp),
        m_axi_rlast(m.m_axi_rlast),
        m_axi_rdata(m.m_axi_rdata),
        m_axi_awvalid(m.m_axi_awvalid),
        m_axi_awready(m.m_axi_awready),
        m_axi_awid(m.m_axi_awid),
        m_axi_awlen(m.m_axi_awlen),
        m_axi_awsize(m.m_axi_awsize),
        m_axi_awburst(m.m_axi_awburst),
        m_axi_awaddr(m.m_axi_awaddr),
        m_axi_wvalid(m.m_axi_wvalid),
        m_axi_wready(m.m_axi_wready),
        m_axi_wlast(m.m_axi_wlast),
        m_axi_wstrb(m.m_axi_wstrb),
        m_axi_wdata(m.m_axi_wdata),
        m_axi_bvalid(m.m_axi_bvalid),
        m_axi_bready(m.m_axi_bready),
        m_axi_bid(m.m_axi_bid),
        m_axi_bresp(m.m_axi_bresp) {}
  CData &m_axi_arvalid, &m_axi_arready, &m_axi_arid, &m_axi_arlen, &m_axi_arsize, &m_axi_arburst;
  QData& m_axi_araddr;
  CData &m_axi_rvalid, &m_axi_rready, &m_axi_rid, &m_axi_rresp, &m_axi_rlast;
  VlWide<DATA_W / 32>& m_axi_rdata;
  CData &m_axi_awvalid, &m_axi_awready, &m_axi_awid, &m_axi_awlen, &m_axi_awsize, &m_axi_awburst;
  QData& m_axi_awaddr;
  CData &m_axi_wvalid, &m_axi_wready, &m_axi_wlast;
  SData& m_axi_wstrb;
  VlWide<DATA_W / 32>& m_axi_wdata;
  CData &m_axi_bvalid, &m_axi_bready, &m_axi_bid, &m_axi_bresp;
  static_assert(DATA_W == 128, "the type of m_axi_wstrb");
};

/// One bus for all masters. Each of its five channels carries at most one beat a clock for all of them together,
/// because the memory behind it is that of a single master; that is where the bandwidth is counted: DATA_W bits a clock
/// of reads in read_beats(), and as many of writes in write_beats(), out of clocks().
///
/// Addresses of reads and of writes are each granted round robin; a grant stays until the address is accepted. The
/// beats of a line stay together, and data of writes follow in the order of their addresses. The arbiter adds no clock
/// to a read; data of a write that come with their address wait for one. Responses find their master by the upper bits
/// of the ID. A master that does not accept a response blocks those behind it.
///
/// The masters' valids and addresses must come from registers: the arbiter grants before inputs of this clock settle.
template <class Model, int DATA_W>
class AxiShare : public Agent {
 public:
  using Memory = AxiLines<SharedPins<DATA_W>, DATA_W>;

  /// \param masters outlive the last clock
  AxiShare(std::vector<Model*> masters, std::uint64_t seed)
      : masters_(std::move(masters)), lines_of_(masters_.size()), memory_(pins_, seed) {}

  Memory& memory() { return memory_; }
  const Memory& memory() const { return memory_; }
  /// Clocks, those in reset left out, and on how many of them a beat was handed over.
  std::uint64_t clocks() const { return clocks_; }
  std::uint64_t read_beats() const { return read_beats_; }
  std::uint64_t write_beats() const { return write_beats_; }
  /// Reads of each master that the memory has accepted.
  const std::vector<std::uint64_t>& lines_of() const { return lines_of_; }

  void drive(const ClockInfo& now) override {
    if (now.in_reset) {
      reads_ = writes_ = Grant{};
      order_.clear();
    }
    choose(reads_, now, [](const Model& x) { return x.m_axi_arvalid != 0; });
    choose(writes_, now, [](const Model& x) { return x.m_axi_awvalid != 0; });
    join_requests();
    memory_.drive(now);
    for (std::size_t i = 0; i < masters_.size(); ++i) answer(i);
  }

  /// \throws StreamError a master breaks a rule
  void sample(const ClockInfo& now) override {
    pins_.m_axi_rready = pins_.m_axi_rvalid != 0 ? masters_[master_of(pins_.m_axi_rid)]->m_axi_rready : CData{0};
    pins_.m_axi_bready = pins_.m_axi_bvalid != 0 ? masters_[master_of(pins_.m_axi_bid)]->m_axi_bready : CData{0};
    if (now.in_reset) return memory_.sample(now);
    if (reads_.valid) require_unchanged(masters_[reads_.master]->m_axi_arvalid != 0, "m_axi_arvalid");
    if (writes_.valid) require_unchanged(masters_[writes_.master]->m_axi_awvalid != 0, "m_axi_awvalid");
    ++clocks_;
    if (pins_.m_axi_rvalid != 0 && pins_.m_axi_rready != 0) ++read_beats_;
    if (reads_.valid && pins_.m_axi_arready != 0) {
      ++lines_of_[reads_.master];
      reads_.valid = false;
    }
    // before the address that this clock accepts, whose data may not come before the next one
    if (pins_.m_axi_wvalid != 0 && pins_.m_axi_wready != 0) {
      ++write_beats_;
      if (pins_.m_axi_wlast != 0) order_.pop_front();
    }
    if (writes_.valid && pins_.m_axi_awready != 0) {
      order_.push_back(writes_.master);
      writes_.valid = false;
    }
    memory_.sample(now);
  }

  std::string waits_for() const override { return memory_.waits_for(); }

 private:
  static constexpr unsigned id_bits = 16;  // of a master's own ID

  /// Of a channel of addresses: the master that has it, or had it last.
  struct Grant {
    std::size_t master = 0;
    bool valid = false;
  };

  static std::size_t master_of(std::uint32_t id) { return id >> id_bits; }
  static std::uint32_t id_of(std::size_t master, unsigned id) {
    return static_cast<std::uint32_t>(master) << id_bits | id;
  }
  static void require_unchanged(bool condition, const char* pin) {
    if (!condition) throw StreamError(std::string(pin) + " was withdrawn, or is not from a register");
  }

  template <class Asks>
  void choose(Grant& grant, const ClockInfo& now, const Asks& asks) {
    if (now.in_reset || grant.valid) return;
    for (std::size_t i = 1; i <= masters_.size() && !grant.valid; ++i) {
      const std::size_t master = (grant.master + i) % masters_.size();
      if (asks(*masters_[master])) grant = {master, true};
    }
  }

  void join_requests() {
    const Model& r = *masters_[reads_.master];
    pins_.m_axi_arvalid = reads_.valid ? 1 : 0;
    pins_.m_axi_araddr = r.m_axi_araddr;
    pins_.m_axi_arid = id_of(reads_.master, r.m_axi_arid);
    pins_.m_axi_arlen = r.m_axi_arlen;
    pins_.m_axi_arsize = r.m_axi_arsize;
    pins_.m_axi_arburst = r.m_axi_arburst;
    const Model& w = *masters_[writes_.master];
    pins_.m_axi_awvalid = writes_.valid ? 1 : 0;
    pins_.m_axi_awaddr = w.m_axi_awaddr;
    pins_.m_axi_awid = id_of(writes_.master, w.m_axi_awid);
    pins_.m_axi_awlen = w.m_axi_awlen;
    pins_.m_axi_awsize = w.m_axi_awsize;
    pins_.m_axi_awburst = w.m_axi_awburst;
    pins_.m_axi_wvalid = 0;
    if (order_.empty()) return;
    const Model& d = *masters_[order_.front()];
    pins_.m_axi_wvalid = d.m_axi_wvalid;
    pins_.m_axi_wdata = d.m_axi_wdata;
    pins_.m_axi_wstrb = d.m_axi_wstrb;
    pins_.m_axi_wlast = d.m_axi_wlast;
  }

  void answer(std::size_t master) {
    Model& x = *masters_[master];
    x.m_axi_arready = reads_.valid && reads_.master == master ? pins_.m_axi_arready : CData{0};
    x.m_axi_awready = writes_.valid && writes_.master == master ? pins_.m_axi_awready : CData{0};
    x.m_axi_wready = !order_.empty() && order_.front() == master ? pins_.m_axi_wready : CData{0};
    x.m_axi_rvalid = pins_.m_axi_rvalid != 0 && master_of(pins_.m_axi_rid) == master ? 1 : 0;
    x.m_axi_rid = static_cast<std::decay_t<decltype(x.m_axi_rid)>>(pins_.m_axi_rid & ((1U << id_bits) - 1));
    x.m_axi_rdata = pins_.m_axi_rdata;
    x.m_axi_rresp = pins_.m_axi_rresp;
    x.m_axi_rlast = pins_.m_axi_rlast;
    x.m_axi_bvalid = pins_.m_axi_bvalid != 0 && master_of(pins_.m_axi_bid) == master ? 1 : 0;
    x.m_axi_bid = static_cast<std::decay_t<decltype(x.m_axi_bid)>>(pins_.m_axi_bid & ((1U << id_bits) - 1));
    x.m_axi_bresp = pins_.m_axi_bresp;
  }

  std::vector<Model*> masters_;
  std::vector<std::uint64_t> lines_of_;
  SharedPins<DATA_W> pins_;
  Memory memory_;
  Grant reads_, writes_;
  std::deque<std::size_t> order_;  // masters of the writes whose data have not come
  std::uint64_t clocks_ = 0, read_beats_ = 0, write_beats_ = 0;
};

}  // namespace cchip::sim

#endif
