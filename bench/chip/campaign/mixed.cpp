// SPDX-License-Identifier: Apache-2.0
// Batches of triangle and quad objects through a chip with swaps, without and with faults of swaps. Rings are large or
// so small that they are full; meanwhile the host stops, and the cache is invalidated. In some of the batches most
// queries end early, apart or at their first hit, while the host asks for one swap after another: queries begin and
// end, and records come, in phases of a swap that take a clock.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "swap_chip.hpp"

namespace cchip::testing {
namespace {

namespace regs = chip_registers;

const std::vector<std::string>& swap_fault_names() {
  static const std::vector<std::string> names = {"silent", "bus_error", "damaged", "forced",
                                                 "abort",  "slow",      "commands"};
  return names;
}

/// Batches of mixed objects through a chip with swaps against the CPU device.
class MixedRun {
 public:
  explicit MixedRun(const MixedSettings& settings)
      : settings_(settings), random_(settings.seed), cpu_(open_cpu_device({1, ""})) {}

  int run() {
    fmt::print("seed={} slots={}\n", settings_.seed, settings_.slots);
    for (std::size_t batches = 0; queries_ < settings_.queries; ++batches) {
      if (batches % batches_each == 0) {
        end_chip();
        begin_chip();
      }
      batch();
    }
    end_chip();
    std::size_t bins = 0;
    for (const auto& [name, count] : bins_) bins += count > 0 ? 1U : 0U;
    fmt::print(
        "queries={} hits={} mismatches={} contacts={} open={} lost={} duplicated={} swaps={} clocks_mean={:.1f} "
        "fallbacks={} failed_swaps={} given_up={} bins={}\n",
        queries_, hits_, mismatches_, contacts_, stats_.open, lost_, duplicated_, stats_.swaps,
        static_cast<double>(stats_.clocks) / std::max(1.0, static_cast<double>(queries_)), stats_.fallbacks,
        failed_swaps_, given_up_, bins);
    for (const auto& [name, count] : bins_) fmt::print("  {}: {}\n", name, count);
    return mismatches_ == 0 && lost_ == 0 && duplicated_ == 0 && queries_ > 0 ? 0 : 3;
  }

 private:
  static constexpr std::size_t batches_each = 4;  // of a chip

  void set(std::uint32_t offset, std::uint32_t value) { chip_.machine->write_register(offset, value); }

  void begin_chip() {
    small_ = !small_;
    ChipDriverOptions driver;
    if (small_) {
      make_rings_small(driver);
      driver.record_log2 = static_cast<unsigned>(1 + random_() % 6);  // fewer records than queries, too
    }
    const bool patient = percent(random_, 50);
    if (patient) {  // pairs wait long for their module: other queries begin and end meanwhile
      driver.minimum_batch = 400;
      driver.maximum_age = 1000U << random_() % 5;
    }
    // Phases follow each other.
    if (patient || percent(random_, 50)) driver.payload_bytes = 16U << random_() % 4;
    driver.memory_bytes = std::uint64_t{1} << 25U;
    driver.patience = 3000000;
    driver.reset_patience = 100000;
    chip_ = make_swap_chip(settings_.slots, any_memory(random_), driver, random_());
  }
  void end_chip() {
    if (!chip_.device) return;
    failed_swaps_ += chip_.machine->read_register(regs::rejected::offset);
    given_up_ += chip_.machine->read_register(regs::swap_lost::offset);
  }

  void batch() {
    busy_ = percent(random_, settings_.busy);
    // Pairs of two quads of queries that have ended stay behind when a command takes their module, while the others go
    // through all contexts until each holds such pairs: then each start comes too early, in all phases of the swap that
    // brings the module back.
    left_behind_ = busy_ && percent(random_, 50);
    const std::size_t count = left_behind_ ? 200 : 1 + random_() % (busy_ ? 120 : 60);
    // Few that meet: the others go through all contexts while pairs of a query that has ended wait for their module.
    const int near = percent(random_, 50) ? 30 : 4;
    // Without commands for the last one, pairs of two quads wait longer, for the scheduler.
    modules_ = left_behind_ || (busy_ && percent(random_, 50)) ? 2 : 3;
    std::vector<MixedObjects::Placed> placed;
    std::vector<CollisionQuery> queries;
    for (std::size_t i = 0; i < count; ++i) {
      placed.push_back(objects_.draw(random_));
      const bool quads = left_behind_ && i < 50;
      while (quads && (placed.back().a < 2 || placed.back().b < 2)) placed.back() = objects_.draw(random_);
      if (busy_) placed.back().pose.b.translation() *= quads || (!left_behind_ && percent(random_, near)) ? 0.1 : 10;
    }
    for (const auto& x : placed)
      queries.push_back({&objects_.objects[x.a], &x.pose.a, &objects_.objects[x.b], &x.pose.b});
    CollisionRequest request;
    if (random_() % (busy_ ? 8 : 2) == 0) request.contacts = CollisionRequest::Contacts::all;
    const std::vector<CollisionResult> right = collide(*cpu_, queries, request);
    const std::string fault = begin_fault();
    std::vector<std::size_t> taken(count);
    std::size_t ended = 0;
    chip_.device->collide(
        count, [&](std::size_t i) { return queries[i]; }, request,
        [&](std::size_t i, const CollisionResult& x) {
          ++taken[i];
          ++ended;
          meddle(fault, ended);
          const bool all = request.contacts == CollisionRequest::Contacts::all;
          const bool same = x.hit == right[i].hit && (!all || x.contacts == right[i].contacts) &&
                            (all || x.contacts.size() == (x.hit ? 1U : 0U));
          if (!same) {
            ++mismatches_;
            fmt::print("batch with fault '{}': query {} differs, hit {} {}, contacts {} {}\n", fault, i, x.hit,
                       right[i].hit, x.contacts.size(), right[i].contacts.size());
          }
          hits_ += x.hit ? 1 : 0;
          contacts_ += x.contacts.size();
          stats_ += x.stats;
        });
    for (const std::size_t times : taken) {
      lost_ += times == 0 ? 1 : 0;
      duplicated_ += times > 1 ? times - 1 : 0;
    }
    queries_ += count;
    ++bins_[fmt::format("{} {} {} {}", small_ ? "small" : "large", busy_ ? "busy" : "calm",
                        fault.empty() ? "none" : fault,
                        request.contacts == CollisionRequest::Contacts::all ? "all" : "first")];
    end_fault();
  }

  std::string begin_fault() {
    if (settings_.faults.empty() || random_() % 4 == 0) return "";
    const std::vector<std::string>& names = swap_fault_names();
    const std::string fault = settings_.faults == "all" ? names[random_() % names.size()] : settings_.faults;
    // too short for the pairs inside: a forced swap gives them up
    if (fault == "forced") set(regs::swap_shutdown_limit::offset, static_cast<std::uint32_t>(1 + random_() % 40));
    if (fault == "silent") chip_.set_silent(true);
    if (fault == "bus_error") {
      chip_.set_fault([](std::vector<sim::AxiBeat>& burst) { burst.back().response = sim::AxiResponse::slave_error; });
    }
    if (fault == "damaged") {
      chip_.set_fault([this](std::vector<sim::AxiBeat>& burst) {
        if (random_() % 4 == 0) burst[random_() % burst.size()].data ^= 1U << random_() % 32;
      });
    }
    if (fault == "slow") {
      sim::AxiMemoryOptions slow;
      slow.latency = 2000;
      chip_.set_port(slow);
    }
    return fault;
  }

  /// While results come.
  void meddle(const std::string& fault, std::size_t ended) {
    // Of lines that stay as they are: the answers must, too.
    if (percent(random_, 20)) {
      auto first = static_cast<std::uint32_t>(random_());
      auto last = static_cast<std::uint32_t>(random_());
      if (last < first || percent(random_, 50)) first = 0;
      set(regs::invalidate_first::offset, first);
      set(regs::invalidate_last::offset, last);
      set(regs::invalidate::offset, regs::invalidate::go_mask);
    }
    // Records wait for the host, which may have asked for a swap, one that does not wait for them, too.
    if (percent(random_, left_behind_ ? 20 : busy_ ? 3 : 10)) {
      if (percent(random_, 50)) command(fault == "forced");
      proceed(random_() % 3000);
    }
    if (busy_) command(fault == "forced" && percent(random_, 10));
    if (fault == "forced" && random_() % 4 == 0) command(true);
    if (fault == "commands" && random_() % 4 == 0) command(false);
    if (fault == "abort" && random_() % 3 == 0) {
      command(false);
      proceed(random_() % 3000);
      chip_.machine->write_register(regs::swap_control::offset,
                                    regs::swap_control::abort_mask | regs::swap_control::scheduler_enable_mask);
    }
    if ((fault == "silent" || fault == "bus_error") && ended > 4 && random_() % 40 == 0) end_fault();
  }

  void proceed(std::uint64_t times) {
    for (; times > 0; --times) chip_.machine->proceed();
  }

  void command(bool force) {
    const auto slot = static_cast<std::uint32_t>(random_() % settings_.slots);
    const auto module_id = static_cast<std::uint32_t>(1 + random_() % modules_);
    chip_.machine->write_register(regs::swap_command::offset, regs::swap_command::go_mask |
                                                                  (force ? regs::swap_command::force_mask : 0U) |
                                                                  module_id << regs::swap_command::module_id_shift |
                                                                  slot << regs::swap_command::slot_shift);
  }

  /// The port works again; what was rejected is announced again, as software does after it has written it anew.
  void end_fault() {
    chip_.set_silent(false);
    chip_.set_fault({});
    chip_.set_port({});
    set(regs::swap_shutdown_limit::offset, 0);
    for (std::uint32_t entry = 0; entry < 4 * settings_.slots; ++entry) {
      if (entry % 4 != 0) chip_.machine->write_register(regs::bitstream_valid::offset(entry), 1);
    }
  }

  MixedSettings settings_;
  Random random_;
  std::unique_ptr<Device> cpu_;
  SwapChip chip_;
  MixedObjects objects_;
  std::size_t queries_ = 0, hits_ = 0, mismatches_ = 0, lost_ = 0, duplicated_ = 0;
  std::uint64_t contacts_ = 0, failed_swaps_ = 0, given_up_ = 0;
  bool small_ = false;        ///< rings of the present chip
  unsigned modules_ = 3;      ///< that commands ask for, from 1 on
  bool left_behind_ = false;  ///< pairs of queries of the present batch that have ended wait for their module
  bool busy_ = false;         ///< queries of the present batch end early, and swaps follow each other
  CollisionStats stats_;
  std::map<std::string, std::size_t> bins_;
};

}  // namespace

int run_mixed(const MixedSettings& settings) { return MixedRun(settings).run(); }

}  // namespace cchip::testing
