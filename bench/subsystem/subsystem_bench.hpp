// SPDX-License-Identifier: Apache-2.0
/// \file
/// cchip_primtest_subsystem with its surroundings: pairs of every kind, a sink, memory with bitstreams, registers.
/// Tests, campaign and command share the account of the pairs: every tag once, with the right answer, or as open where
/// a report says so.
#ifndef CCHIP_BENCH_SUBSYSTEM_BENCH_HPP
#define CCHIP_BENCH_SUBSYSTEM_BENCH_HPP

#include <verilated.h>

#include <array>
#include <cchip/internal/driver/primtest_engine.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/model/point_tri.hpp>
#include <cchip/internal/model/programme.hpp>
#include <cchip/internal/wire/bitstream.hpp>
#include <cchip/internal/wire/registers.hpp>
#include <cchip/internal/wire/swap.hpp>
#include <cchip/machines/pair_port.hpp>
#include <cchip/machines/probes.hpp>
#include <cchip/machines/swap_port.hpp>
#include <cchip/sim/axi_lite.hpp>
#include <cchip/sim/axi_memory.hpp>
#include <cchip/sim/simulation.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>

#include "point_pair.hpp"  // of tests/ref
#include "subsystem_models.hpp"

namespace cchip::subsystem {

namespace regs = cchip::registers;
using Random = std::mt19937_64;
inline bool chance(Random& random, int percent) { return static_cast<int>(random() % 100) < percent; }

constexpr int points_kind = static_cast<int>(ModuleId::point_tri);
constexpr std::array<Kind, 4> kind_a = {Kind::tri, Kind::tri, Kind::tri, Kind::quad};
constexpr std::array<Kind, 4> kind_b = {Kind::tri, Kind::tri, Kind::quad, Kind::quad};

/// The expected answer for a pair that no module tests.
inline KindResult refused_answer(const KindRequest& r) {
  return {{r.request.tag, true, true, false, {AxisClass::illegal, 0, 0}, 0}, r.kind};
}

/// The expected answer of a module that serves its kind: a test of quads takes a triangle as the quad V3 = V2. The grid
/// answer is the exact oracle's.
inline KindResult tested_answer(const KindRequest& r, int coord_w, int module_id) {
  if (r.kind == 0 || r.request.mode > PairMode::directed) return refused_answer(r);
  if (r.kind == points_kind) return {cchip_test::confirmed_point_answer(r.request, coord_w), r.kind};
  const auto m = static_cast<std::size_t>(module_id);
  GridPair pair = r.request.pair;
  const auto widen = [](GridPrimitive& p, Kind kind) {
    if (kind == Kind::quad && p.kind == Kind::tri) p.v[3] = p.v[2];
    p.kind = kind;
  };
  widen(pair.a, kind_a[m]);
  widen(pair.b, kind_b[m]);
  const model::Options options{{static_cast<std::size_t>(kind_a[m]), static_cast<std::size_t>(kind_b[m])}, true};
  const model::Outcome o = model::run_programme(options, pair, r.request.mode, coord_w);
  const bool exact = exact_intersects(r.request.pair);
  sim::require(o.grid == exact, "the model is wrong");
  return {{r.request.tag, o.hit(), exact, o.definite, o.witness, o.beats}, r.kind};
}

/// Pairs of every kind and class.
class KindSource {
 public:
  KindSource(int coord_w, std::uint64_t seed) : coord_w_(coord_w), random_(seed), points_(coord_w, seed) {
    for (std::size_t kind = 1; kind < 4; ++kind) {
      sources_.emplace_back(coord_w, seed + kind, kind_a[kind], kind_b[kind]);
    }
  }
  /// \param kind 0: illegal, the content of the payload does not matter
  KindRequest draw(int kind) {
    KindRequest r;
    r.kind = kind;
    if (kind == points_kind) {
      r.request.pair = cchip_test::grid_pair(points_.draw(), coord_w_);
    } else {
      const std::size_t shape = kind == 0 ? 1 : static_cast<std::size_t>(kind);
      stimulus::PairSource& source = sources_[shape - 1];
      r.request.pair = source.draw(stimulus::classes_of(kind_a[shape], kind_b[shape])[source.draw_class()].value);
    }
    const int half = 1 << (coord_w_ - 1);
    for (GridPrimitive* p : {&r.request.pair.a, &r.request.pair.b}) {  // slot 3 of a triangle must not matter
      if (p->kind == Kind::tri) p->v[3].setConstant(static_cast<int>(random_() % static_cast<unsigned>(half)));
    }
    r.request.pair.eta = static_cast<int>(random_() % 16);
    r.request.mode = static_cast<PairMode>(chance(random_, 5) ? 2 + random_() % 2 : chance(random_, 25) ? 0 : 1);
    return r;
  }

 private:
  int coord_w_;
  Random random_;
  std::vector<stimulus::PairSource> sources_;
  cchip_test::PointTriangleSource points_;
};

/// Ways to corrupt a bitstream.
enum class Spoilt {
  no,
  magic,         ///< not a bitstream
  slot,          ///< for another slot
  module_id,     ///< of another module
  length,        ///< header and size of the file differ
  crc,           ///< a bit of the payload is wrong
  truncated,     ///< the end is missing, header and size agree: complete to the controller
  too_long,      ///< surplus bytes at the end, header and size agree
  content,       ///< the device's own check fails
  other_module,  ///< the payload is another module's
  last
};

/// The payload's words before this byte, synchronisation and name of the slot, are not corrupted: a device that is told
/// to rewrite another slot does so, and that cannot be seen from outside.
constexpr std::size_t name_end = 8;

/// Bytes of a bitstream for this slot and module, corrupted in this way.
/// \param kinds of the subsystem: its modules are 0..kinds
inline Bytes spoilt_bitstream(Spoilt how, int slot, int module_id, std::size_t payload_bytes, Random& random,
                              int kinds = 3) {
  const auto id = static_cast<ModuleId>(module_id);
  const int step = 1 + static_cast<int>(random() % static_cast<unsigned>(kinds));
  const auto other = static_cast<ModuleId>((module_id + step) % (kinds + 1));
  const auto place = static_cast<std::uint8_t>(slot);
  const auto seed = static_cast<std::uint32_t>(random());
  Bytes payload = make_payload(place, how == Spoilt::other_module ? other : id, payload_bytes, seed);
  BitstreamHeader header{defs::bitstream_magic, place, id, static_cast<std::uint32_t>(payload.size()), crc32(payload)};
  if (how == Spoilt::magic) header.magic ^= 1U << random() % 32;
  if (how == Spoilt::slot) header.slot = static_cast<std::uint8_t>(place + 1 + random() % 254);
  if (how == Spoilt::module_id) header.module_id = other;
  if (how == Spoilt::length) header.length += 4;
  if (how == Spoilt::crc)
    payload[name_end + random() % (payload.size() - name_end)] ^= static_cast<std::uint8_t>(1U << random() % 8);
  if (how == Spoilt::content) payload[name_end + random() % (payload.size() - name_end)] ^= 0x10;
  if (how == Spoilt::truncated) payload.resize(payload.size() - 4);
  if (how == Spoilt::too_long) payload.insert(payload.end(), 4, std::uint8_t{0});
  if (how == Spoilt::truncated || how == Spoilt::too_long || how == Spoilt::content)
    return make_bitstream(place, id, payload);
  return join_bitstream(header, payload);
}

/// Signals of the subsystem that the account needs.
template <class Model>
SwapReport report_of(const Model& top) {
  return sim::get_swap_report(probes::report_data(top));
}
/// Module of slot n in bits [4n +: 4].
template <int slots, class Model>
unsigned modules_of(const Model& top) {
  unsigned modules = probes::slot0_module_id(top) & 7U;
  if constexpr (slots > 1) modules |= (probes::slot1_module_id(top) & 7U) << 4;
  if constexpr (slots > 2) modules |= (probes::slot2_module_id(top) & 7U) << 8;
  if constexpr (slots > 3) modules |= (probes::slot3_module_id(top) & 7U) << 12;
  return modules;
}
/// Bit e: the table of bitstreams has a valid entry e, numbered as its registers.
template <class Config, class Model>
unsigned announced_of(const Model& top) {
  const auto valid = static_cast<unsigned>(probes::bitstreams_valid(top));
  unsigned announced = 0;
  for (int slot = 0; slot < Config::SLOTS; ++slot) {
    for (int m = 0; m <= Config::KINDS; ++m) {
      const unsigned bit = valid >> ((slot << defs::kind_bits(Config::KINDS)) + m) & 1U;
      announced |= bit << (defs::table_modules * slot + m);
    }
  }
  return announced;
}
/// Bit n: slot n is decoupled.
template <int slots, class Model>
unsigned decoupled_of(const Model& top) {
  unsigned decoupled = probes::slot0_decoupled(top) & 1U;
  if constexpr (slots > 1) decoupled |= (probes::slot1_decoupled(top) & 1U) << 1;
  if constexpr (slots > 2) decoupled |= (probes::slot2_decoupled(top) & 1U) << 2;
  if constexpr (slots > 3) decoupled |= (probes::slot3_decoupled(top) & 1U) << 3;
  return decoupled;
}

/// What went wrong; the first failure in words.
struct Account {
  std::uint64_t pairs = 0;     ///< answered
  std::uint64_t refused = 0;   ///< of them left open because no slot serves their kind
  std::uint64_t open = 0;      ///< of them left open because a swap by force gave them up
  std::uint64_t given_up = 0;  ///< by swaps with force, reported
  std::uint64_t lost = 0;      ///< not answered
  std::uint64_t duplicated = 0;
  std::uint64_t wrong = 0;
  std::string first;
  bool clean() const { return lost + duplicated + wrong == 0; }
};

template <class Config>
class SubsystemBench {
 public:
  using Model = typename Config::Model;
  static constexpr int slots = Config::SLOTS;
  static constexpr int kinds = Config::KINDS;
  static constexpr std::uint32_t stride = 0x1000;  ///< of the bitstreams in memory

  explicit SubsystemBench(sim::SimulationOptions options)
      : simulation(without_end(options)),
        memory(simulation.top()),
        port_(simulation.top(), Config::COORD_W),
        source(Config::COORD_W, options.seed),
        driver("s_pair", top().s_pair_valid, top().s_pair_ready, [this](const KindRequest& r) { put(r); }),
        sink("m_result", top().m_result_valid, top().m_result_ready, [this] { return result(); }),
        random_(options.seed) {
    top().cfg_error = 0;
    driver.on_accept([this](const KindRequest& r, std::uint64_t) { accept(r); });
    driver.when_idle([this] {
      port_.scramble(random_);
      top().s_pair_kind = static_cast<CData>(random_() & 7U);
    });
    sink.on_item([this](const KindResult& r, std::uint64_t) { take(r); });
    master_ = std::make_unique<sim::AxiLiteMaster<Model>>(top());
    for (sim::Agent* agent : std::initializer_list<sim::Agent*>{&driver, &sink, &memory, &registers_, &watch_}) {
      simulation.add(*agent);
    }
  }

  Model& top() { return simulation.top(); }
  Random& random() { return random_; }
  void step() { simulation.step(); }
  void steps(std::uint64_t clocks) { simulation.steps(clocks); }

  /// Drops all pairs: none of their tags may come back.
  void reset(int clocks = 2) {
    driver.clear();
    queued_.clear();
    posted_ = 0;
    master_ = std::make_unique<sim::AxiLiteMaster<Model>>(top());
    simulation.reset(clocks);
    open_.clear();
    given_up_ = 0;
    answered_open_ = 0;
    absent_.fill(0);
  }

  // ---- registers
  bool idle_bus() const { return master_->done(); }
  /// Steps until all posted writes are answered.
  void settle_bus() {
    simulation.run_until([&] { return master_->done(); }, 4000, "the registers");
    collect();
  }
  void write(std::uint32_t offset, std::uint32_t value) {
    settle_bus();
    sim::require(master_->write(simulation, offset, value), "a register refuses a write");
  }
  std::uint32_t read(std::uint32_t offset) {
    settle_bus();
    const sim::AxiLiteWord word = master_->read(simulation, offset);
    sim::require(word.ok, "a register refuses a read");
    return word.data;
  }
  /// Collects the answers to the posted writes.
  void collect() {
    while (posted_ > 0) {
      master_->next_write();
      --posted_;
    }
  }
  void post_write(std::uint32_t offset, std::uint32_t value) {
    master_->push_write(offset, value);
    ++posted_;
  }
  static std::uint32_t entry(int slot, int module_id) {
    return static_cast<std::uint32_t>(defs::table_modules * slot + module_id);
  }
  /// Is this address below name_end of a payload?
  static bool in_name(std::uint32_t byte) { return byte % stride < defs::bitstream_header + name_end; }
  static std::uint32_t address(int slot, int module_id) { return stride * (1 + entry(slot, module_id)); }

  /// Puts a bitstream into memory and, by posted writes, into the table.
  void provide(int slot, int module_id, const Bytes& file) {
    const std::uint32_t e = entry(slot, module_id);
    memory.write(address(slot, module_id), file);
    post_write(regs::bitstream_address::offset(e), address(slot, module_id));
    post_write(regs::bitstream_size::offset(e), static_cast<std::uint32_t>(file.size()));
    post_write(regs::bitstream_valid::offset(e), 1);
  }
  Bytes good(int slot, int module_id, std::size_t payload_bytes = 32) {
    return spoilt_bitstream(Spoilt::no, slot, module_id, payload_bytes, random_, kinds);
  }
  /// Registers of a working system: good bitstreams for all slots and modules, scheduler on.
  void set_up(std::uint32_t batch = 4, std::uint32_t age = 500) {
    for (int slot = 0; slot < slots; ++slot) {
      for (int m = 0; m <= kinds; ++m) provide(slot, m, good(slot, m));
    }
    post_write(regs::minimum_batch::offset, batch);
    post_write(regs::maximum_age::offset, age);
    post_write(regs::interrupt_enable::offset, 0x1F);
    post_write(regs::control::offset, regs::control::scheduler_enable_mask);
    settle_bus();
  }
  void command(int slot, int module_id, bool force) {
    post_write(regs::command::offset, regs::command::go_mask | (force ? regs::command::force_mask : 0) |
                                          static_cast<std::uint32_t>(module_id) << regs::command::module_id_shift |
                                          static_cast<std::uint32_t>(slot));
  }

  // ---- pairs
  void push(int kind) {
    KindRequest r = source.draw(kind);
    push(r);
  }
  void push(KindRequest r) {
    while (open_.count(next_tag_) != 0 || queued_.count(next_tag_) != 0) ++next_tag_;
    r.request.tag = next_tag_++;
    queued_.insert(r.request.tag);
    driver.push(r);
  }
  std::size_t in_flight() const { return open_.size(); }
  /// Steps until every pair is answered and no swap is in progress; then every remaining one is an error, and no more
  /// pairs may be left open than were reported as given up.
  /// \returns false if that does not happen: a hang
  bool drain(std::uint64_t most_clocks) {
    std::uint64_t clocks = 0;
    while (driver.waiting() != 0 || !open_.empty() || phase() != SwapPhase::idle) {
      if (clocks++ == most_clocks) return false;
      simulation.step();
    }
    simulation.steps(300);  // nothing may come after the last answer
    if (answered_open_ > given_up_)
      fail(account.wrong, "more pairs were left open than the reports of lost ones allow");
    account.lost += open_.size();
    open_.clear();
    given_up_ = 0;
    answered_open_ = 0;
    return true;
  }
  /// \throws SimulationError
  void finish(std::uint64_t most_clocks = 200000) {
    if (!drain(most_clocks)) {
      throw sim::SimulationTimeout("hang: " + std::to_string(open_.size()) + " pairs without an answer after " +
                                   std::to_string(most_clocks) + " clocks");
    }
    sim::require(account.clean(), account.first.empty() ? "pairs were lost" : account.first);
  }

  // ---- swaps
  std::vector<SwapReport> reports;          ///< since construction
  std::set<std::pair<int, int>> exchanges;  ///< module before, after a swap that ended well
  std::size_t count(SwapCode code) const {
    return static_cast<std::size_t>(
        std::count_if(reports.begin(), reports.end(), [&](const SwapReport& r) { return r.code == code; }));
  }
  /// Steps until one more report has arrived. \throws SimulationTimeout
  SwapReport next_report(std::uint64_t most_clocks = 20000) {
    const std::size_t before = reports.size();
    simulation.run_until([&] { return reports.size() > before; }, most_clocks, "a report");
    return reports.back();
  }
  SwapPhase phase() { return static_cast<SwapPhase>(probes::swap_phase(top())); }
  int module_in(int slot) { return static_cast<int>(modules_of<Config::SLOTS>(top()) >> (4 * slot) & 7U); }
  bool decoupled(int slot) { return (decoupled_of<Config::SLOTS>(top()) >> slot & 1U) != 0; }
  std::uint64_t last_progress() const { return progress_; }

  sim::Simulation<Model> simulation;
  sim::AxiMemory<Model> memory;

 private:
  sim::PairPort<Model> port_;

 public:
  KindSource source;
  sim::StreamDriver<KindRequest> driver;
  sim::StreamSink<KindResult> sink;
  Account account;

 private:
  struct Open {
    KindRequest request;
    std::uint64_t clock;
  };
  /// Forwards to the current master.
  class Registers : public sim::Agent {
   public:
    explicit Registers(std::unique_ptr<sim::AxiLiteMaster<Model>>& master) : master_(master) {}
    void drive(const sim::ClockInfo& now) override { master_->drive(now); }
    void sample(const sim::ClockInfo& now) override { master_->sample(now); }

   private:
    std::unique_ptr<sim::AxiLiteMaster<Model>>& master_;
  };
  class Watch : public sim::Agent {
   public:
    explicit Watch(SubsystemBench& bench) : bench_(bench) {}
    void sample(const sim::ClockInfo& now) override { bench_.watch(now); }

   private:
    SubsystemBench& bench_;
  };

  static sim::SimulationOptions without_end(sim::SimulationOptions options) {
    options.timeout_clocks = 0;
    return options;
  }
  void put(const KindRequest& r) {
    port_.put(r.request);
    top().s_pair_kind = static_cast<CData>(r.kind);
  }
  KindResult result() { return {port_.result(), top().m_result_kind}; }

  void accept(const KindRequest& r) {
    queued_.erase(r.request.tag);
    answered_.erase(r.request.tag);
    open_[r.request.tag] = {r, simulation.total_clocks()};
    progress_ = simulation.total_clocks();
  }
  void fail(std::uint64_t& counter, const std::string& what) {
    ++counter;
    if (account.first.empty()) account.first = "clock " + std::to_string(simulation.clock()) + ": " + what;
  }
  void take(const KindResult& got) {
    progress_ = simulation.total_clocks();
    const auto entry = open_.find(got.beat.tag);
    if (entry == open_.end()) {
      if (answered_.count(got.beat.tag) != 0) {
        fail(account.duplicated, "answered twice: " + sim::to_text(got));
      } else {
        fail(account.wrong, "an answer without a request: " + sim::to_text(got));
      }
      return;
    }
    const Open& open = entry->second;
    ++account.pairs;
    if (!is_tested(open, got)) {
      const KindRequest& r = open.request;
      if (!(got == refused_answer(r))) {
        fail(account.wrong,
             "got " + sim::to_text(got) + ", expected " + sim::to_text(tested_answer(r, Config::COORD_W, r.kind)));
      } else if (absent_[static_cast<std::size_t>(got.kind)] >= open.clock) {
        ++account.refused;
      } else {
        ++account.open;
        ++answered_open_;
      }
    }
    answered_.insert(got.beat.tag);
    open_.erase(entry);
  }
  /// The answer of a module that was in a slot since the pair was accepted.
  bool is_tested(const Open& open, const KindResult& got) const {
    for (int m = 0; m <= kinds; ++m) {
      if (open.request.kind != 0 && defs::rm_serves(m, open.request.kind) == 0) continue;
      if (m > 0 && loaded_[static_cast<std::size_t>(m)] < open.clock) continue;
      if (got == tested_answer(open.request, Config::COORD_W, m)) return true;
    }
    return false;
  }
  /// Bitstreams that have failed on their way and not ended well since, and how often any did since there were none.
  void note_failures(const SwapReport& r) {
    const unsigned bit = r.slot < slots && r.module_id <= kinds ? 1U << entry(r.slot, r.module_id) : 0U;
    if (defs::swap_put_off(static_cast<int>(r.code)) != 0) {
      failed_ |= bit;
      ++failures_;
    } else if (r.code == SwapCode::ok) {
      failed_ &= ~bit;
    }
    failed_ &= announced_of<Config>(top());
    if (failed_ == 0) failures_ = 0;
  }
  void watch(const sim::ClockInfo& now) {
    if (now.in_reset) return;
    if (probes::report_valid(top()) != 0) {
      SwapReport r = report_of(top());
      r.clock = now.clock;
      note_failures(r);
      given_up_ += r.lost;
      account.given_up += r.lost;
      if (r.code == SwapCode::ok && r.slot < slots) {
        const int before = before_[static_cast<std::size_t>(r.slot)];
        if (before != r.module_id) exchanges.insert({before, r.module_id});
      }
      reports.push_back(r);
    }
    const unsigned modules = modules_of<Config::SLOTS>(top());
    const unsigned announced = announced_of<Config>(top());
    // there is no need to wait for bitstreams that have failed on their way often enough
    const unsigned valid = failures_ >= defs::retry_doublings ? announced & ~failed_ : announced;
    std::array<bool, kinds + 1> provided{};
    for (int slot = 0; slot < slots; ++slot) {
      const unsigned has = modules >> (4 * slot) & 7U;
      loaded_[has] = simulation.total_clocks();
      if (!decoupled(slot) && phase() == SwapPhase::idle)
        before_[static_cast<std::size_t>(slot)] = static_cast<int>(has);
      for (int m = 0; m <= kinds; ++m) {
        if (static_cast<int>(has) != m && (valid >> entry(slot, m) & 1U) == 0) continue;
        for (std::size_t kind = 1; kind < provided.size(); ++kind) {
          provided[kind] = provided[kind] || defs::rm_serves(m, static_cast<int>(kind)) != 0;
        }
      }
    }
    for (std::size_t kind = 1; kind < provided.size(); ++kind) {
      if (!provided[kind]) absent_[kind] = simulation.total_clocks();
    }
  }

  std::map<std::uint16_t, Open> open_;
  std::set<std::uint16_t> queued_, answered_;
  std::uint16_t next_tag_ = 1;
  unsigned failed_ = 0;
  int failures_ = 0;
  std::uint64_t given_up_ = 0;             // reported
  std::uint64_t answered_open_ = 0;        // answered as open for that reason
  std::array<int, slots> before_{};        // module at work before the swap in progress
  std::array<std::uint64_t, 8> absent_{};  // last clock without a provider
  std::array<std::uint64_t, 8> loaded_{};  // last clock on which a slot had the module
  std::uint64_t progress_ = 0;
  std::unique_ptr<sim::AxiLiteMaster<Model>> master_;
  Registers registers_{master_};
  Watch watch_{*this};
  std::size_t posted_ = 0;
  Random random_;
};

}  // namespace cchip::subsystem

#endif
