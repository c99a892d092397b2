// SPDX-License-Identifier: Apache-2.0
// Campaign: swaps under random traffic with random back-pressure and faults: in bitstreams, memory, configuration port,
// commands, by abort and reset. Every pair must be answered once, and right unless it was reported as given up;
// nothing may hang.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/sim/wave_on_failure.hpp>
#include <cchip/stimulus/campaign.hpp>
#include <cstdio>

#include "bench.hpp"

namespace cchip::subsystem {
namespace {

constexpr int wrong_result = 3;
constexpr std::uint64_t drain_bound = 400000;

struct Options {
  std::uint64_t swaps = 10000;
  std::uint64_t seed = sim::seed_from_environment();
  unsigned threads = 2;
  std::uint64_t per_part = 50;
  int slots = 0;
};

struct Totals {
  std::uint64_t swaps = 0, hangs = 0, faults = 0, clocks = 0, resets = 0;
  std::array<std::uint64_t, 16> codes{};
  Account account;
  std::map<std::uint64_t, std::string> first;  // part, what
  Totals& operator+=(const Totals& x) {
    swaps += x.swaps;
    hangs += x.hangs;
    faults += x.faults;
    clocks += x.clocks;
    resets += x.resets;
    for (std::size_t i = 0; i < codes.size(); ++i) codes[i] += x.codes[i];
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
    const std::uint64_t most = 20000 * swaps + 100000;
    std::uint64_t clocks = 0;
    while (bench_.count(SwapCode::ok) < swaps && clocks < most && total_.hangs == 0) {
      act();
      step();
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
    bench_.post_write(regs::shutdown_limit::offset, 4000);  // longer than the longest pair
    bench_.post_write(regs::memory_limit::offset, 300);
    bench_.set_up(1 + static_cast<std::uint32_t>(pick(12)), 50 + static_cast<std::uint32_t>(pick(1500)));
    new_patterns();
  }
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
  }

  /// Everything that happens on this clock besides the clock itself.
  void act() {
    traffic();
    if (bench_.idle_bus()) {
      bench_.collect();
      if (chance_in(30)) software();
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

  void traffic() {
    if (bench_.driver.waiting() > 3) return;
    if (burst_ == 0) {
      burst_ = 1 + pick(30);
      kind_ = 1 + pick(3);
      pause_ = chance_in(4) ? pick(400) : 0;
    }
    if (pause_ > 0) {
      --pause_;
      return;
    }
    --burst_;
    bench_.push(chance_in(60) ? 0 : chance_in(5) ? 1 + pick(3) : kind_);
  }

  void software() {
    const int slot = pick(Config::SLOTS);
    const int module_id = pick(4);
    const std::uint32_t entry = SubsystemBench<Config>::entry(slot, module_id);
    switch (pick(40)) {
      case 0:  // a corrupt bitstream
        bench_.provide(slot, module_id,
                       spoilt_bitstream(static_cast<Spoilt>(1 + pick(static_cast<int>(Spoilt::last) - 1)), slot,
                                        module_id, payload_bytes(), random_));
        fault();
        break;
      case 1:  // no bitstream, or a wrong address or size
        if (chance(random_, 50)) {
          bench_.post_write(regs::bitstream_valid::offset(entry), 0);
        } else if (chance(random_, 50)) {
          bench_.post_write(regs::bitstream_address::offset(entry), static_cast<std::uint32_t>(random_()));
        } else {
          bench_.post_write(regs::bitstream_size::offset(entry), static_cast<std::uint32_t>(random_() % 300));
        }
        fault();
        break;
      case 2:  // a kind that no slot provides
        if (chance(random_, 20)) {
          for (int s = 0; s < Config::SLOTS; ++s) {
            bench_.post_write(regs::bitstream_valid::offset(SubsystemBench<Config>::entry(s, module_id)), 0);
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
      default:
        bench_.provide(slot, module_id, bench_.good(slot, module_id, payload_bytes()));
    }
  }
  /// Whole words: the 32-bit port accepts nothing else.
  std::size_t payload_bytes() { return 16 + 4 * (random_() % (chance_in(10) ? 200 : 12)); }

  void memory_fault() {
    if (bench_.phase() == SwapPhase::idle || resume_at_ != 0) return;
    switch (pick(4)) {
      case 0: {  // an error in one beat, a wrong bit in another
        bench_.memory.set_fault([this, beat = random_(), kind = pick(2)](std::vector<sim::AxiBeat>& burst) {
          sim::AxiBeat& b = burst[beat % burst.size()];
          if (kind == 0) b.response = sim::AxiResponse::slave_error;
          if (kind == 1 && !SubsystemBench<Config>::in_name(b.address)) b.data ^= 1U << beat % 32;
          bench_.memory.set_fault({});
        });
        break;
      }
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
    resume_at_ = 0;
    bench_.driver.set_pattern(sim::Pattern::always());
    bench_.sink.set_pattern(sim::Pattern::always());
    for (int i = 0; i < 3; ++i) {  // a swap in progress may still reject a repaired bitstream
      bench_.settle_bus();
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
    const std::uint64_t seed = o.seed * 0x9e3779b97f4a7c15U + part;
    const bool one = o.slots == 1 || (o.slots == 0 && part % 2 == 1);
    return one ? run_part<OneSlot>(part, seed, o.per_part) : run_part<TwoSlots>(part, seed, o.per_part);
  });
  constexpr std::array<const char*, 15> names = {"OK",           "SAME",   "BUSY",   "REQUEST",  "MAGIC",
                                                 "SLOT",         "MODULE", "LENGTH", "CRC",      "DEVICE",
                                                 "WRONG_MODULE", "BUS",    "MEMORY", "SHUTDOWN", "ABORTED"};
  fmt::print("reports:");
  for (std::size_t i = 0; i < names.size(); ++i) fmt::print(" {} {}", names[i], t.codes[i]);
  fmt::print("\nclocks {}, resets {}, pairs answered without a test {}, given up by force and reported {}\n", t.clocks,
             t.resets, t.account.refused, t.account.given_up);
  fmt::print("{:.1f} s\n", watch.seconds());
  int shown = 0;
  for (const auto& [part, what] : t.first) {
    if (++shown <= 10) fmt::print("part {}: {}\n", part, what);
  }
  fmt::print("swaps={} pairs={} lost={} duplicated={} wrong={} hangs={} faults={}\n", t.swaps, t.account.pairs,
             t.account.lost, t.account.duplicated, t.account.wrong, t.hangs, t.faults);
  return t.account.clean() && t.hangs == 0 ? 0 : wrong_result;
}

}  // namespace
}  // namespace cchip::subsystem

int main(int argc, char** argv) try {
  CLI::App app{
      "Swaps of the reconfigurable subsystem under random traffic with faults.\n"
      "Exit codes: 0 nothing wrong, 3 lost, duplicated or wrong answers or a hang, 2 the run could not be made."};
  cchip::subsystem::Options o;
  app.add_option("--swaps", o.swaps, "swaps that end well, in all")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--seed", o.seed, "repeats a run (or CCHIP_SEED)")->capture_default_str();
  app.add_option("--threads", o.threads, "threads; the outcome does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--per-part", o.per_part, "swaps of one simulation")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--slots", o.slots, "slots; 0: systems with one and with two in turn")
      ->check(CLI::Range(0, 2))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return cchip::subsystem::run(o);
} catch (const std::exception& error) {
  std::fprintf(stderr, "cchip_swaps: %s\n", error.what());
  return 2;
}
