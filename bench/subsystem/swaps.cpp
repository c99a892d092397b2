// SPDX-License-Identifier: Apache-2.0
// Campaign: swaps under random traffic with random back-pressure and faults: in bitstreams, memory, configuration port,
// commands, by abort and reset. Every pair must be answered once, and right unless it was reported as given up;
// nothing may hang; a good bitstream must not lose its valid bit.
//
// Beside faults at random there are encounters: a fault, the phase of a swap on which it falls, a latency of the memory
// and an extreme value of a register that hold at that moment and for a while after it. Each pair of two of these four
// is a bin; a run that leaves a bin empty fails and names it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/sim/wave_on_failure.hpp>
#include <cchip/stimulus/campaign.hpp>
#include <cstdio>
#include <set>
#include <utility>

#include "subsystem_bench.hpp"

namespace cchip::subsystem {
namespace {

constexpr int wrong_result = 3;
constexpr std::uint64_t drain_bound = 400000;

// ---- encounters
constexpr std::array<const char*, 10> fault_names = {"abort",        "reset",        "bus error", "wrong bit",
                                                     "memory stops", "no address",   "clear",     "device",
                                                     "busy command", "receiver away"};
enum class Fault { abort, reset, bus_error, wrong_bit, stop, refuse, clear, device, command, receiver };
constexpr std::array<const char*, 8> phase_names = {"HEADER",   "SHUTDOWN", "DECOUPLE", "RESET",
                                                    "TRANSFER", "CHECK",    "ROC",      "RECOUPLE"};
constexpr std::array<const char*, 4> latency_names = {"1 clock", "30 clocks", "300 clocks", "beyond the limit"};
constexpr std::uint32_t memory_limit = 1000;
constexpr std::array<std::uint64_t, 4> latencies = {1, 30, 300, memory_limit + 200};
struct Extreme {
  const char* name;
  std::uint32_t offset;  ///< 0: none
  std::uint32_t value;
};
constexpr std::uint32_t top_value = 0xFFFFFFFF;
const std::array<Extreme, 11> extremes = {{{"usual registers", 0, 0},
                                           {"shutdown_limit 0", regs::shutdown_limit::offset, 0},
                                           {"shutdown_limit 1", regs::shutdown_limit::offset, 1},
                                           {"shutdown_limit 2^32-1", regs::shutdown_limit::offset, top_value},
                                           {"memory_limit 0", regs::memory_limit::offset, 0},
                                           {"memory_limit 1", regs::memory_limit::offset, 1},
                                           {"memory_limit 2^32-1", regs::memory_limit::offset, top_value},
                                           {"minimum_batch 0", regs::minimum_batch::offset, 0},
                                           {"minimum_batch 2^32-1", regs::minimum_batch::offset, top_value},
                                           {"maximum_age 0", regs::maximum_age::offset, 0},
                                           {"maximum_age 2^32-1", regs::maximum_age::offset, top_value}}};

/// Fault, phase, latency, register: numbers in the tables above.
using Encounter = std::array<std::size_t, 4>;
constexpr Encounter kinds = {fault_names.size(), phase_names.size(), latency_names.size(), extremes.size()};
std::string name_of(std::size_t dimension, std::size_t value) {
  switch (dimension) {
    case 0:
      return fault_names.at(value);
    case 1:
      return phase_names.at(value);
    case 2:
      return latency_names.at(value);
    default:
      return extremes.at(value).name;
  }
}

/// How often each pair has met.
class Coverage {
 public:
  void count(const Encounter& e) {
    for_pairs([&](std::size_t a, std::size_t b) { ++bins_[{a, b, e[a], e[b]}]; });
  }
  /// Pairs of an encounter that have not met yet.
  int gain(const Encounter& e) const {
    int n = 0;
    for_pairs([&](std::size_t a, std::size_t b) { n += bins_.count({a, b, e[a], e[b]}) == 0 ? 1 : 0; });
    return n;
  }
  Coverage& operator+=(const Coverage& x) {
    for (const auto& [bin, n] : x.bins_) bins_[bin] += n;
    return *this;
  }
  std::size_t hit() const { return bins_.size(); }
  static std::size_t all() {
    std::size_t n = 0;
    for_pairs([&](std::size_t a, std::size_t b) { n += kinds[a] * kinds[b]; });
    return n;
  }
  std::uint64_t least() const {
    std::uint64_t n = hit() == all() ? ~std::uint64_t{0} : 0;
    for (const auto& [bin, hits] : bins_) n = std::min(n, hits);
    return n;
  }
  std::vector<std::string> empty() const {
    std::vector<std::string> names;
    for_pairs([&](std::size_t a, std::size_t b) {
      for (std::size_t i = 0; i < kinds[a]; ++i) {
        for (std::size_t j = 0; j < kinds[b]; ++j) {
          if (bins_.count({a, b, i, j}) == 0) names.push_back(name_of(a, i) + " x " + name_of(b, j));
        }
      }
    });
    return names;
  }

 private:
  template <class Body>
  static void for_pairs(Body&& body) {
    for (std::size_t a = 0; a < kinds.size(); ++a) {
      for (std::size_t b = a + 1; b < kinds.size(); ++b) body(a, b);
    }
  }
  std::map<std::array<std::size_t, 4>, std::uint64_t> bins_;  // two dimensions, their values
};

constexpr std::uint64_t every_part = ~std::uint64_t{0};
struct Options {
  std::uint64_t swaps = 10000;
  std::uint64_t seed = sim::seed_from_environment();
  unsigned threads = 2;
  std::uint64_t per_part = 50;
  int slots = 0;
  bool points = false;
  std::uint64_t part = every_part;
};

struct Totals {
  std::uint64_t swaps = 0, hangs = 0, faults = 0, clocks = 0, resets = 0;
  std::array<std::uint64_t, 16> codes{};
  Coverage coverage;
  std::set<std::pair<int, int>> exchanges;  // module before, after
  Account account;
  std::map<std::uint64_t, std::string> first;  // part, what
  Totals& operator+=(const Totals& x) {
    swaps += x.swaps;
    hangs += x.hangs;
    faults += x.faults;
    clocks += x.clocks;
    resets += x.resets;
    for (std::size_t i = 0; i < codes.size(); ++i) codes[i] += x.codes[i];
    coverage += x.coverage;
    exchanges.insert(x.exchanges.begin(), x.exchanges.end());
    account.pairs += x.account.pairs;
    account.refused += x.account.refused;
    account.open += x.account.open;
    account.given_up += x.account.given_up;
    account.lost += x.account.lost;
    account.duplicated += x.account.duplicated;
    account.wrong += x.account.wrong;
    first.insert(x.first.begin(), x.first.end());
    return *this;
  }
};

/// One system under attack, until it has made its number of swaps.
template <class Config>
class Part {
 public:
  explicit Part(const sim::SimulationOptions& options) : random_(options.seed), bench_(options) {}

  Totals run(std::uint64_t swaps) {
    bench_.reset();
    set_up();
    const std::uint64_t most = 40000 * swaps + 100000;
    std::uint64_t clocks = 0;
    while (bench_.count(SwapCode::ok) < swaps && clocks < most && total_.hangs == 0) {
      act();
      step();
      check_entries();
      ++clocks;
      if (chance_in(300000)) {
        drain();
        set_up();
      }
    }
    if (clocks == most) hang("too few swaps");
    drain();
    total_.swaps = bench_.count(SwapCode::ok);
    for (const SwapReport& r : bench_.reports) ++total_.codes[static_cast<std::size_t>(r.code)];
    total_.account = bench_.account;
    total_.exchanges = bench_.exchanges;
    total_.clocks = bench_.simulation.total_clocks();
    return total_;
  }
  const std::string& first() const { return bench_.account.first.empty() ? hang_ : bench_.account.first; }

 private:
  bool chance_in(std::uint64_t n) { return random_() % n == 0; }
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  void hang(const std::string& what) {
    ++total_.hangs;
    if (hang_.empty()) hang_ = "hang: " + what;
  }
  void fault() { ++total_.faults; }

  void set_up() {
    usual_limits();
    announced_ = good_ = ~0U;
    valid_ = 0;
    changed_at_.fill(now());
    bench_.set_up(1 + static_cast<std::uint32_t>(pick(12)), 50 + static_cast<std::uint32_t>(pick(1500)));
    new_patterns();
    stage_ = Stage::waits;
    plan();
  }
  void usual_limits() {
    bench_.post_write(regs::shutdown_limit::offset, 4000);  // longer than the longest pair
    bench_.post_write(regs::memory_limit::offset, memory_limit);
  }
  std::uint64_t now() { return bench_.simulation.total_clocks(); }
  void new_patterns() {
    const auto patterns = sim::standard_patterns(random_());
    bench_.driver.set_pattern(patterns[random_() % patterns.size()]);
    bench_.sink.set_pattern(patterns[random_() % patterns.size()]);
    bench_.memory.set_options({1 + random_() % 20, patterns[2], patterns[random_() % patterns.size()]});
  }

  void step() {
    bench_.top().cfg_error = cfg_error_ ? 1 : 0;
    cfg_error_ = false;
    bench_.step();
    bench_.top().cfg_error = 0;  // one clock: what steps by itself, such as drain(), must not see it
  }

  /// Everything that happens on this clock besides the clock itself.
  void act() {
    traffic();
    encounter();
    if (bench_.idle_bus()) {
      bench_.collect();
      if (chance_in(100)) software();
    }
    if (chance_in(1500)) memory_fault();
    if (resume_at_ != 0 && bench_.simulation.total_clocks() >= resume_at_) {
      bench_.memory.resume();
      resume_at_ = 0;
    }
    if (bench_.phase() == SwapPhase::transfer && chance_in(6000)) {
      cfg_error_ = true;
      fault();
    }
    if (chance_in(3000)) new_patterns();
    if (chance_in(12000)) {  // a receiver that is absent for longer than a shut-down waits
      bench_.sink.set_pattern(sim::Pattern::never_for(4000 + random_() % 3000));
      fault();
    }
    const bool swapping = bench_.phase() != SwapPhase::idle;
    if (chance_in(swapping ? 6000 : 60000)) {
      bench_.reset(1 + pick(3));
      ++total_.resets;
      fault();
      set_up();
    }
  }

  // ---- encounters: wait for the phase, let it meet the fault, wait for the end of the swap and a while, restore
  void plan() {
    int best = -1;
    for (int i = 0; i < 24; ++i) {
      Encounter e{};
      for (std::size_t d = 0; d < e.size(); ++d) e[d] = random_() % kinds[d];
      if (total_.coverage.gain(e) > best) {
        best = total_.coverage.gain(e);
        next_ = e;
      }
    }
    stage_at_ = now();
  }
  SwapPhase wanted() const { return static_cast<SwapPhase>(1 + next_[1]); }
  static bool by_register(Fault f) { return f == Fault::abort || f == Fault::clear || f == Fault::command; }

  void encounter() {
    const SwapPhase phase = bench_.phase();
    const auto fault = static_cast<Fault>(next_[0]);
    switch (stage_) {
      case Stage::waits: {
        if (now() - stage_at_ > 3000) plan();  // no swap of that kind comes
        // a write needs some clocks to arrive: it may set out a phase earlier
        const bool early = by_register(fault) && wanted() > SwapPhase::header &&
                           static_cast<int>(phase) + 1 == static_cast<int>(wanted());
        if (phase != wanted() && !early) return;
        stage_ = Stage::meets;
        // RECOUPLE lasts 3 clocks and ROC before it 36; RESET 2 and DECOUPLE before it 20
        meets_at_ = now() + (early && wanted() == SwapPhase::recouple              ? 20 + random_() % 20
                             : early && wanted() == SwapPhase::reset               ? 14 + random_() % 6
                             : phase == SwapPhase::transfer && !by_register(fault) ? random_() % 40
                                                                                   : random_() % 5);
        bench_.memory.set_options(
            {latencies.at(next_[2]), sim::standard_patterns(random_())[2], sim::Pattern::always()});
        return;
      }
      case Stage::meets:
        if (now() < meets_at_ || (by_register(fault) && !bench_.idle_bus())) return;
        attack(fault);
        if (extremes.at(next_[3]).offset != 0)
          bench_.post_write(extremes.at(next_[3]).offset, extremes.at(next_[3]).value);
        reports_ = bench_.reports.size();
        stage_ = by_register(fault) ? Stage::arrives : Stage::lasts;
        if (stage_ == Stage::lasts) met();
        stage_at_ = now();
        return;
      case Stage::arrives:
        if (!arrives() && now() - stage_at_ < 40) return;
        met();
        stage_ = Stage::lasts;
        return;
      case Stage::lasts:
        if (bench_.reports.size() == reports_ && now() - stage_at_ < 3000) return;
        stage_ = Stage::lingers;
        stage_at_ = now() + random_() % 1500;
        return;
      case Stage::lingers:
        if (now() < stage_at_ || !bench_.idle_bus()) return;
        usual_limits();
        bench_.post_write(regs::minimum_batch::offset, 1 + static_cast<std::uint32_t>(pick(12)));
        bench_.post_write(regs::maximum_age::offset, 50 + static_cast<std::uint32_t>(pick(1500)));
        bench_.memory.resume();
        resume_at_ = 0;
        new_patterns();
        stage_ = Stage::waits;
        plan();
    }
  }
  bool arrives() {
    const auto& top = bench_.top();
    return probes::abort_arrives(top) != 0 || probes::clear_arrives(top) != 0 || probes::command_arrives(top) != 0;
  }
  /// Counts the encounter, in the phase in which it happened.
  void met() {
    const SwapPhase phase = bench_.phase();
    if (phase == SwapPhase::idle || phase == SwapPhase::report) return;
    Encounter e = next_;
    e[1] = static_cast<std::size_t>(phase) - 1;
    total_.coverage.count(e);
    fault();
  }
  void attack(Fault f) {
    switch (f) {
      case Fault::abort:
        bench_.post_write(regs::control::offset, regs::control::abort_mask | regs::control::scheduler_enable_mask);
        break;
      case Fault::clear:
        bench_.post_write(regs::control::offset, regs::control::clear_mask | regs::control::scheduler_enable_mask);
        break;
      case Fault::command:
        bench_.command(pick(Config::SLOTS), pick(Config::KINDS + 1), chance(random_, 40));
        break;
      case Fault::bus_error:
      case Fault::wrong_bit:
        spoil_burst(f == Fault::bus_error);
        break;
      case Fault::stop:
        bench_.memory.stop_after(random_() % 8);
        break;
      case Fault::refuse:
        bench_.memory.refuse_addresses();
        break;
      case Fault::device:
        cfg_error_ = true;
        break;
      case Fault::receiver:
        bench_.sink.set_pattern(sim::Pattern::never_for(4000 + random_() % 3000));
        break;
      case Fault::reset:
        met();
        bench_.reset(1 + pick(3));
        ++total_.resets;
        set_up();
        break;
    }
  }
  /// The next burst of the memory has an error or a wrong bit.
  void spoil_burst(bool error) {
    spoilt_at_ = error ? spoilt_at_ : never;
    bench_.memory.set_fault([this, beat = random_(), error](std::vector<sim::AxiBeat>& burst) {
      sim::AxiBeat& b = burst[beat % burst.size()];
      if (error) b.response = sim::AxiResponse::slave_error;
      if (!error && !SubsystemBench<Config>::in_name(b.address)) b.data ^= 1U << beat % 32;
      if (!error) spoilt_at_ = now();
      bench_.memory.set_fault({});
    });
  }

  // ---- what the valid bits must be: from what the campaign did, not from what the hardware says of itself
  void provide(int slot, int module_id, Spoilt how) {
    const std::uint32_t e = SubsystemBench<Config>::entry(slot, module_id);
    bench_.provide(slot, module_id, spoilt_bitstream(how, slot, module_id, payload_bytes(), random_, Config::KINDS));
    announced_ |= 1U << e;
    good_ = how == Spoilt::no ? good_ | 1U << e : good_ & ~(1U << e);
    changed_at_.at(e) = now();
  }
  void withdraw(std::uint32_t entry) {
    bench_.post_write(regs::bitstream_valid::offset(entry), 0);
    announced_ &= ~(1U << entry);
  }
  /// An entry may lose its valid bit only by a report about it that says so, and only if it is bad, was changed during
  /// the swap, or a bit was wrong on the way.
  void check_entries() {
    const unsigned valid = announced_of<Config>(bench_.top());
    const unsigned fallen = valid_ & ~valid & announced_;
    valid_ = valid;
    const bool swaps = bench_.phase() != SwapPhase::idle;
    if (swaps && !swapped_) swap_at_ = now();
    swapped_ = swaps;
    if (fallen == 0) return;
    for (std::size_t i = bench_.reports.size(); i > 0 && i + 3 > bench_.reports.size(); --i) {
      const SwapReport& r = bench_.reports[i - 1];
      const auto entry = static_cast<std::size_t>(defs::table_modules * r.slot + r.module_id);
      if (entry >= changed_at_.size() || fallen != 1U << entry) continue;
      const bool bad = (good_ & fallen) == 0 || changed_at_.at(entry) + 100 >= swap_at_ || spoilt_at_ >= swap_at_;
      if (bad && defs::swap_spoilt(static_cast<int>(r.code)) != 0) return;
    }
    ++bench_.account.wrong;
    if (!bench_.account.first.empty()) return;
    const SwapReport r = bench_.reports.empty() ? SwapReport{} : bench_.reports.back();
    bench_.account.first = fmt::format(
        "clock {}: entries {:#x} lost their valid bits without reason, last report: code {} of slot {}, module {}",
        bench_.simulation.clock(), fallen, static_cast<int>(r.code), r.slot, r.module_id);
  }

  void traffic() {
    if (bench_.driver.waiting() > 3) return;
    if (burst_ == 0) {
      burst_ = 1 + pick(30);
      kind_ = 1 + pick(Config::KINDS);
      pause_ = chance_in(4) ? pick(400) : 0;
    }
    if (pause_ > 0) {
      --pause_;
      return;
    }
    --burst_;
    bench_.push(chance_in(60) ? 0 : chance_in(5) ? 1 + pick(Config::KINDS) : kind_);
  }

  void software() {
    const int slot = pick(Config::SLOTS);
    const int module_id = pick(Config::KINDS + 1);
    const std::uint32_t entry = SubsystemBench<Config>::entry(slot, module_id);
    switch (pick(40)) {
      case 0:  // a corrupt bitstream
        provide(slot, module_id, static_cast<Spoilt>(1 + pick(static_cast<int>(Spoilt::last) - 1)));
        fault();
        break;
      case 1:  // no bitstream, or a wrong address or size
        if (chance(random_, 50)) {
          withdraw(entry);
        } else {
          good_ &= ~(1U << entry);
          if (chance(random_, 50)) {
            bench_.post_write(regs::bitstream_address::offset(entry), static_cast<std::uint32_t>(random_()));
          } else {
            bench_.post_write(regs::bitstream_size::offset(entry), static_cast<std::uint32_t>(random_() % 300));
          }
        }
        fault();
        break;
      case 2:  // a kind that no slot provides
        if (chance(random_, 20)) {
          for (int s = 0; s < Config::SLOTS; ++s) {
            withdraw(SubsystemBench<Config>::entry(s, module_id));
          }
          fault();
        }
        break;
      case 3:
        bench_.command(pick(Config::SLOTS + 1), pick(6), chance(random_, 40));
        fault();
        break;
      case 4:
        bench_.post_write(regs::control::offset, regs::control::abort_mask | regs::control::scheduler_enable_mask);
        fault();
        break;
      case 5:
        bench_.post_write(regs::shutdown_limit::offset, chance_in(8) ? 100 : 4000);
        bench_.post_write(regs::minimum_batch::offset, static_cast<std::uint32_t>(pick(20)));
        bench_.post_write(regs::maximum_age::offset, static_cast<std::uint32_t>(pick(2000)));
        break;
      case 6:
        bench_.post_write(regs::interrupt_status::offset, 0x1F);
        break;
      case 7:  // a swap, as a host asks for it that sorts its work by kind
      case 8:
      case 9:
      case 10:
      case 11:
        if (bench_.phase() == SwapPhase::idle) bench_.command(slot, module_id, chance(random_, 20));
        break;
      default:
        provide(slot, module_id, Spoilt::no);
    }
  }
  /// Whole words: the 32-bit port accepts nothing else.
  std::size_t payload_bytes() { return 16 + 4 * (random_() % (chance_in(10) ? 200 : 12)); }

  void memory_fault() {
    if (bench_.phase() == SwapPhase::idle || resume_at_ != 0) return;
    switch (pick(4)) {
      case 0:
        spoil_burst(chance(random_, 50));
        break;
      case 1:
        bench_.memory.stop_after(random_() % 8);
        resume_at_ = bench_.simulation.total_clocks() + 100 + random_() % 500;
        break;
      case 2:
        bench_.memory.refuse_addresses();
        resume_at_ = bench_.simulation.total_clocks() + 100 + random_() % 500;
        break;
      default:
        return;
    }
    fault();
  }

  /// The attack ends: everything is answered.
  void drain() {
    bench_.memory.resume();
    bench_.memory.set_fault({});
    bench_.memory.set_options({});
    resume_at_ = 0;
    bench_.driver.set_pattern(sim::Pattern::always());
    bench_.sink.set_pattern(sim::Pattern::always());
    for (int i = 0; i < 3; ++i) {  // a swap in progress may still reject a repaired bitstream
      bench_.settle_bus();
      usual_limits();
      bench_.set_up();
      bench_.steps(1500);
    }
    if (!bench_.drain(drain_bound)) hang(fmt::format("{} pairs are not answered", bench_.in_flight()));
  }

  Random random_;
  SubsystemBench<Config> bench_;
  Totals total_;
  std::string hang_;
  int burst_ = 0;
  int kind_ = 1;
  int pause_ = 0;
  bool cfg_error_ = false;
  std::uint64_t resume_at_ = 0;
  // the encounter to come, or in progress
  enum class Stage { waits, meets, arrives, lasts, lingers };
  Stage stage_ = Stage::waits;
  Encounter next_{};
  std::uint64_t stage_at_ = 0;
  std::uint64_t meets_at_ = 0;
  std::size_t reports_ = 0;
  // entries of the table: bit per entry, clocks
  static constexpr std::uint64_t never = ~std::uint64_t{0};
  unsigned announced_ = 0, good_ = 0, valid_ = 0;
  std::array<std::uint64_t, std::size_t{defs::table_modules} * Config::SLOTS> changed_at_{};
  bool swapped_ = false;
  std::uint64_t swap_at_ = 0;
  std::uint64_t spoilt_at_ = 0;  // never: a wrong bit is on its way
};

/// A part that fails leaves a waveform.
template <class Config>
Totals run_part(std::uint64_t number, std::uint64_t seed, std::uint64_t swaps) {
  Totals t;
  sim::SimulationOptions options;
  options.seed = seed;
  try {
    sim::with_wave_on_failure(
        "swaps_part_" + std::to_string(number),
        [&](const sim::SimulationOptions& o) {
          Part<Config> part(o);
          t = {};
          t = part.run(swaps);
          sim::require(t.account.clean() && t.hangs == 0, part.first());
        },
        options);
  } catch (const sim::SimulationTimeout& error) {
    t.hangs = 1;
    t.first[number] = error.what();
  } catch (const sim::SimulationError& error) {
    if (t.account.clean() && t.hangs == 0) t.account.wrong = 1;
    t.first[number] = error.what();
  }
  return t;
}

int run(const Options& o) {
  const std::uint64_t parts = (o.swaps + o.per_part - 1) / o.per_part;
  fmt::print("seed {}, {} parts of {} swaps\n", o.seed, parts, o.per_part);
  const stimulus::StopWatch watch;
  const Totals t = stimulus::sum_of_parts<Totals>(parts, o.threads, [&](std::uint64_t part) {
    if (o.part != every_part && part != o.part) return Totals{};
    const std::uint64_t seed = o.seed * 0x9e3779b97f4a7c15U + part;
    constexpr std::array<int, 4> in_turn = {2, 1, 4, 1};
    const bool in_all = o.slots == 0;
    switch (in_all ? in_turn[part % in_turn.size()] : o.slots) {
      case 1:
        return (in_all ? part % in_turn.size() == 3 : o.points) ? run_part<OneSlotPoints>(part, seed, o.per_part)
                                                                : run_part<OneSlot>(part, seed, o.per_part);
      case 2:
        return run_part<TwoSlots>(part, seed, o.per_part);
      default:
        return run_part<FourSlots>(part, seed, o.per_part);
    }
  });
  constexpr std::array<const char*, 16> names = {"OK",     "SAME",     "BUSY",    "REQUEST", "MAGIC",        "SLOT",
                                                 "MODULE", "LENGTH",   "CRC",     "DEVICE",  "WRONG_MODULE", "BUS",
                                                 "MEMORY", "SHUTDOWN", "ABORTED", "OWED"};
  fmt::print("reports:");
  for (std::size_t i = 0; i < names.size(); ++i) fmt::print(" {} {}", names[i], t.codes[i]);
  fmt::print("\nclocks {}, resets {}, pairs answered without a test {}, given up by force and reported {}\n", t.clocks,
             t.resets, t.account.refused, t.account.given_up);
  fmt::print("{:.1f} s\n", watch.seconds());
  const std::vector<std::string> empty = t.coverage.empty();
  fmt::print("bins of fault, phase, latency, register, two at a time: {} of {} hit, each {} times or more\n",
             t.coverage.hit(), Coverage::all(), t.coverage.least());
  const bool whole = o.part == every_part;  // one part alone need not fill the bins
  // every module of 0..KINDS_MAX for every other one
  constexpr std::size_t exchanges = std::size_t{defs::kinds_max} * (defs::kinds_max + 1);
  const bool exchanged = t.exchanges.size() == exchanges || !whole || o.slots != 0;
  if (whole) {
    for (const std::string& name : empty) fmt::print("never met: {}\n", name);
  }
  int shown = 0;
  for (const auto& [part, what] : t.first) {
    if (++shown <= 10) fmt::print("part {}: {}\n", part, what);
  }
  fmt::print("swaps={} pairs={} lost={} duplicated={} wrong={} hangs={} faults={} exchanges={}/{} bins={}/{}\n",
             t.swaps, t.account.pairs, t.account.lost, t.account.duplicated, t.account.wrong, t.hangs, t.faults,
             t.exchanges.size(), exchanges, t.coverage.hit(), Coverage::all());
  return t.account.clean() && t.hangs == 0 && exchanged && (empty.empty() || !whole) ? 0 : wrong_result;
}

}  // namespace
}  // namespace cchip::subsystem

int main(int argc, char** argv) try {
  CLI::App app{
      "Swaps of the reconfigurable subsystem under random traffic with faults.\n"
      "Exit codes: 0 nothing wrong, 3 lost, duplicated or wrong answers, a hang or an empty bin, 2 the run could not "
      "be made."};
  cchip::subsystem::Options o;
  app.add_option("--swaps", o.swaps, "swaps that end well, in all")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--seed", o.seed, "repeats a run (or CCHIP_SEED)")->capture_default_str();
  app.add_option("--threads", o.threads, "threads; the outcome does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--per-part", o.per_part, "swaps of one simulation")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--part", o.part, "only this one of the parts: the one that a longer run named");
  app.add_option("--slots", o.slots, "slots; 0: systems with two, one, four, and one with points, in turn")
      ->check(CLI::IsMember({0, 1, 2, 4}))
      ->capture_default_str();
  app.add_flag("--points", o.points, "with --slots 1: points, too; four slots always have them");
  CLI11_PARSE(app, argc, argv);
  return cchip::subsystem::run(o);
} catch (const std::exception& error) {
  std::fprintf(stderr, "cchip_swaps: %s\n", error.what());
  return 2;
}
