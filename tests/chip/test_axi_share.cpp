// SPDX-License-Identifier: Apache-2.0
// The arbiter of several masters on one memory, with masters that are made for it.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/sim/axi_share.hpp>
#include <deque>
#include <memory>
#include <random>

using namespace cchip::sim;

namespace {

constexpr int data_w = 128;
constexpr std::size_t beats = 4;
using Line = std::array<std::uint8_t, 64>;

/// What memory holds in line `number` at the beginning.
Line line_of(std::uint64_t number) {
  Line line;
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = static_cast<std::uint8_t>(number * 7 + number / 256 + i * 3);
  return line;
}

/// Pins of a master, and what is behind them: outputs change in rise() alone.
struct Master {
  CData m_axi_arvalid = 0, m_axi_arready = 0, m_axi_arid = 0;
  QData m_axi_araddr = 0;
  CData m_axi_arlen = beats - 1, m_axi_arsize = 4, m_axi_arburst = 1;
  CData m_axi_rvalid = 0, m_axi_rready = 0, m_axi_rid = 0, m_axi_rresp = 0, m_axi_rlast = 0;
  VlWide<data_w / 32> m_axi_rdata = {};
  CData m_axi_awvalid = 0, m_axi_awready = 0, m_axi_awid = 0;
  QData m_axi_awaddr = 0;
  CData m_axi_awlen = 0, m_axi_awsize = 4, m_axi_awburst = 1;
  CData m_axi_wvalid = 0, m_axi_wready = 0, m_axi_wlast = 1;
  VlWide<data_w / 32> m_axi_wdata = {};
  SData m_axi_wstrb = 0xFFFF;
  CData m_axi_bvalid = 0, m_axi_bready = 0, m_axi_bid = 0, m_axi_bresp = 0;

  std::mt19937_64 random;
  unsigned active_percent = 100;  ///< clocks on which it offers something new, and on which it is ready
  std::deque<std::uint64_t> reads, addresses, data;       ///< to do: lines; beats to write, by their number
  std::array<std::deque<std::uint64_t>, 64> outstanding;  ///< by ID: line, of which `got` beats have come
  std::array<std::size_t, 64> got = {};
  std::size_t read_lines = 0, responses = 0, wrong = 0;
  std::uint64_t next_id = 0;

  bool chance() { return random() % 100 < active_percent; }

  /// The rising edge: what was handed over is over, and the next is offered.
  void rise() {
    if (m_axi_arvalid != 0 && m_axi_arready != 0) m_axi_arvalid = 0;
    if (m_axi_awvalid != 0 && m_axi_awready != 0) m_axi_awvalid = 0;
    if (m_axi_wvalid != 0 && m_axi_wready != 0) m_axi_wvalid = 0;
    if (m_axi_rvalid != 0 && m_axi_rready != 0) take_beat();
    if (m_axi_bvalid != 0 && m_axi_bready != 0) {
      ++responses;
      wrong += m_axi_bresp != 0 || m_axi_bid != 1 ? 1 : 0;
    }
    const std::size_t id = next_id % outstanding.size();
    if (m_axi_arvalid == 0 && !reads.empty() && outstanding[id].empty() && chance()) {
      m_axi_arvalid = 1;
      m_axi_arid = static_cast<CData>(id);
      m_axi_araddr = 64 * reads.front();
      outstanding[id].push_back(reads.front());
      reads.pop_front();
      ++next_id;
    }
    if (m_axi_awvalid == 0 && !addresses.empty() && chance()) {
      m_axi_awvalid = 1;
      m_axi_awid = 1;
      m_axi_awaddr = 16 * addresses.front();
      addresses.pop_front();
    }
    if (m_axi_wvalid == 0 && !data.empty() && chance()) {
      m_axi_wvalid = 1;
      for (std::size_t i = 0; i < 16; ++i) set_bits(m_axi_wdata, static_cast<int>(8 * i), 8, line_of(data.front())[i]);
      data.pop_front();
    }
    m_axi_rready = chance() ? 1 : 0;
    m_axi_bready = chance() ? 1 : 0;
  }

  void take_beat() {
    const std::size_t id = m_axi_rid;
    if (id >= outstanding.size() || outstanding[id].empty()) {
      ++wrong;
      return;
    }
    const Line expected = line_of(outstanding[id].front());
    for (std::size_t i = 0; i < 16; ++i)
      wrong += get_bits(m_axi_rdata, static_cast<int>(8 * i), 8) != expected[16 * got[id] + i] ? 1 : 0;
    wrong += m_axi_rresp != 0 ? 1 : 0;
    wrong += (m_axi_rlast != 0) != (got[id] + 1 == beats) ? 1 : 0;
    if (++got[id] < beats) return;
    got[id] = 0;
    outstanding[id].pop_front();
    ++read_lines;
  }
};

struct Bench {
  explicit Bench(std::size_t count) {
    std::vector<Master*> pointers;
    for (std::size_t i = 0; i < count; ++i) {
      masters.push_back(std::make_unique<Master>());
      masters.back()->random.seed(seed_from_environment() + i);
      pointers.push_back(masters.back().get());
    }
    bus = std::make_unique<AxiShare<Master, data_w>>(pointers, seed_from_environment());
    for (int i = 0; i < 2; ++i) step(true);
    clock = 0;
  }

  void step(bool in_reset = false) {
    const ClockInfo now{clock++, in_reset};
    bus->drive(now);
    std::size_t on_read = 0, on_write = 0, read_address = 0, write_address = 0;
    for (const auto& x : masters) {
      on_read += x->m_axi_rvalid != 0 ? 1 : 0;
      on_write += x->m_axi_wvalid != 0 && x->m_axi_wready != 0 ? 1 : 0;
      read_address += x->m_axi_arvalid != 0 && x->m_axi_arready != 0 ? 1 : 0;
      write_address += x->m_axi_awvalid != 0 && x->m_axi_awready != 0 ? 1 : 0;
    }
    crowded = crowded || on_read > 1 || on_write > 1 || read_address > 1 || write_address > 1;
    bus->sample(now);
    if (in_reset) return;
    for (const auto& x : masters) x->rise();
  }

  std::vector<std::unique_ptr<Master>> masters;
  std::unique_ptr<AxiShare<Master, data_w>> bus;
  std::uint64_t clock = 0;
  bool crowded = false;  ///< two masters had the same channel on one clock
};

constexpr std::uint64_t readable = 1000;  // lines

void fill(Bench& bench) {
  for (std::uint64_t i = 0; i < readable; ++i) bench.bus->memory().line(i) = line_of(i);
}

}  // namespace

TEST_CASE("axi_share: every beat arrives where it belongs", "[system][axi_share]") {
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{8}}) {
    for (const bool tame : {true, false}) {
      CAPTURE(count, tame);
      Bench bench(count);
      fill(bench);
      if (!tame) bench.bus->memory().options = {20, 10, 60, true, 60, 70, 1};
      constexpr std::size_t each = 200;
      for (std::size_t m = 0; m < count; ++m) {
        Master& x = *bench.masters[m];
        x.active_percent = tame ? 100 : 55;
        for (std::size_t i = 0; i < each; ++i) {
          x.reads.push_back(x.random() % readable);
          const std::uint64_t beat = 4 * (readable + m * each) + i;  // of memory that no other master writes
          x.addresses.push_back(beat);
          x.data.push_back(beat);
        }
      }
      const auto is_done = [&] {
        return std::all_of(bench.masters.begin(), bench.masters.end(),
                           [&](const auto& x) { return x->read_lines == each && x->responses == each; });
      };
      for (int i = 0; i < 100000 && !is_done(); ++i) bench.step();
      REQUIRE(is_done());
      CHECK_FALSE(bench.crowded);
      CHECK(bench.bus->read_beats() == count * each * beats);
      CHECK(bench.bus->write_beats() == count * each);
      for (std::size_t m = 0; m < count; ++m) {
        CHECK(bench.masters[m]->wrong == 0);
        CHECK(bench.bus->lines_of()[m] == each);
        for (std::size_t i = 0; i < each; ++i) {
          const std::uint64_t beat = 4 * (readable + m * each) + i;
          const auto* line = bench.bus->memory().find(beat / 4);
          REQUIRE(line != nullptr);
          const Line expected = line_of(beat);
          REQUIRE(std::equal(expected.begin(), expected.begin() + 16, line->begin() + 16 * (beat % 4)));
        }
      }
    }
  }
}

TEST_CASE("axi_share: masters that always ask get the same share, one alone gets all", "[system][axi_share]") {
  constexpr std::size_t count = 5;
  Bench bench(count);
  fill(bench);
  constexpr std::uint64_t clocks = 4000;
  for (const auto& x : bench.masters) x->reads.assign(clocks, 1);
  for (std::uint64_t i = 0; i < clocks; ++i) {
    bench.step();
    const auto [least, most] = std::minmax_element(bench.bus->lines_of().begin(), bench.bus->lines_of().end());
    REQUIRE(*most - *least <= 1);
  }
  CHECK(bench.bus->lines_of()[0] > 100);
  // the others fall silent, and the responses of what they have asked for come
  for (std::size_t m = 1; m < count; ++m) bench.masters[m]->reads.clear();
  for (int i = 0; i < 2000; ++i) bench.step();
  const std::vector<std::uint64_t> before = bench.bus->lines_of();
  const std::uint64_t beats_before = bench.bus->read_beats();
  bench.masters[0]->reads.assign(clocks, 1);
  for (std::uint64_t i = 0; i < 1000; ++i) bench.step();
  for (std::size_t m = 1; m < count; ++m) CHECK(bench.bus->lines_of()[m] == before[m]);
  // 64 lines of 4 beats outstanding cover a latency of 60 clocks, so no clock of the data is lost
  CHECK(bench.bus->lines_of()[0] > before[0]);
  CHECK(bench.bus->read_beats() - beats_before > 1000 - 2 * 70);
}

TEST_CASE("axi_share: one beat a clock for all masters together", "[system][axi_share]") {
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{8}}) {
    CAPTURE(count);
    Bench bench(count);
    fill(bench);
    for (const auto& x : bench.masters) {
      x->reads.assign(5000, 2);
      for (std::uint64_t i = 0; i < 5000; ++i) {
        x->addresses.push_back(4 * readable);
        x->data.push_back(1);
      }
    }
    for (int i = 0; i < 200; ++i) bench.step();  // the first answers have come
    const std::uint64_t reads = bench.bus->read_beats(), writes = bench.bus->write_beats();
    for (int i = 0; i < 1000; ++i) bench.step();
    CHECK(bench.bus->read_beats() - reads == 1000);
    CHECK(bench.bus->write_beats() - writes <= 1000);
    // a master of these has every second clock, as its address is offered again one clock after it was accepted
    CHECK(bench.bus->write_beats() - writes >= (count == 1 ? 490U : 990U));
    CHECK_FALSE(bench.crowded);
  }
}

TEST_CASE("axi_share: an address that is withdrawn is an error", "[system][axi_share]") {
  Bench bench(2);
  fill(bench);
  bench.bus->memory().options.ready_percent = 0;
  bench.masters[1]->reads.push_back(3);
  bench.step();
  bench.step();
  bench.masters[1]->m_axi_arvalid = 0;
  CHECK_THROWS_AS(bench.step(), StreamError);
}
