// SPDX-License-Identifier: Apache-2.0
// Long runs of cchip_chip behind its driver: poses of many meshes against the CPU device, faults, soft resets.
#include <Vcchip_chip.h>
#include <Vcchip_chip_swaps1.h>
#include <Vcchip_chip_swaps1___024root.h>
#include <Vcchip_chip_swaps2.h>
#include <Vcchip_chip_swaps2___024root.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cchip/cpu/cpu_device.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/exact/posed_pairs.hpp>
#include <cchip/machines/probes.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/mesh/shapes.hpp>
#include <cchip/sim/seed.hpp>
#include <cchip/wire/bitstream.hpp>
#include <cchip/wire/swap.hpp>
#include <limits>
#include <set>

#include "chip_objects.hpp"
#include "mesh_pairs.hpp"
#include "port_bench.hpp"

namespace cchip::testing {
namespace {

using Bench = PortBench<Vcchip_chip, 128>;
using Random = std::mt19937_64;
namespace regs = chip_registers;

bool percent(Random& random, unsigned p) { return random() % 100 < p; }

/// Any memory that AXI allows, from an idle one to a crowded one.
sim::AxiLinesOptions any_memory(Random& random) {
  sim::AxiLinesOptions options;
  options.latency = random() % 150;
  options.write_latency = random() % 150;
  options.jitter = random() % 2 == 0 ? 0 : random() % 150;
  options.reorder = random() % 2 == 0;
  options.ready_percent = random() % 2 == 0 ? 100 : static_cast<unsigned>(40 + random() % 60);
  options.valid_percent = random() % 2 == 0 ? 100 : static_cast<unsigned>(40 + random() % 60);
  return options;
}

// ---- poses

struct PosesSettings {
  std::vector<std::string> meshes;
  std::size_t first = 100000;  ///< FIRST queries in all
  std::size_t all = 10000;     ///< ALL queries in all
  std::uint64_t seed = sim::seed_from_environment();
};

std::vector<std::string> campaign_meshes() {
  std::vector<std::string> names = mesh_pair_names();
  names.insert(names.end(), {"torus-gear", "quads-quads", "sphere-quads"});
  return names;
}

MeshPair campaign_pair(const std::string& name) {
  if (name == "torus-gear") return {name, make_torus(1, 0.25, 64, 32), make_gear(1.25, 1.5, 0.5, 0.5, 36, 6)};
  if (name == "quads-quads") {
    return {name, make_torus(1, 0.25, 96, 48, Kind::quad), make_torus(0.7, 0.3, 64, 48, Kind::quad)};
  }
  if (name == "sphere-quads") return {name, make_body(24, 0.3, 5), make_torus(1, 0.4, 64, 32, Kind::quad)};
  return mesh_pair(name);
}

struct PosesTotals {
  std::size_t queries = 0, hits = 0, differences = 0;
  std::uint64_t contacts = 0, open = 0, fallbacks = 0, clocks = 0;
};

class PosesCampaign {
 public:
  explicit PosesCampaign(const PosesSettings& settings) : settings_(settings), cpu_(open_cpu_device({1, ""})) {}

  int run() {
    if (settings_.meshes.empty()) settings_.meshes = campaign_meshes();
    fmt::print("seed={}\n{:<14} {:<5} {:>8} {:>8} {:>10} {:>8} {:>9} {:>10} {:>11}\n", settings_.seed, "meshes", "mode",
               "queries", "hits", "contacts", "open", "fallbacks", "clocks", "differences");
    for (const std::string& name : settings_.meshes) run_pair(name);
    fmt::print("queries={} hits={} differences={} contacts={} open={} fallbacks={} clocks_mean={:.1f}\n",
               total_.queries, total_.hits, total_.differences, total_.contacts, total_.open, total_.fallbacks,
               static_cast<double>(total_.clocks) / std::max(1.0, static_cast<double>(total_.queries)));
    return total_.queries != 0 && total_.differences == 0 ? 0 : 3;
  }

 private:
  void run_pair(const std::string& name) {
    const MeshPair meshes = campaign_pair(name);
    const Object a(meshes.a);
    const Object b(meshes.b);
    PoseMaker maker(*cpu_, a, b, settings_.seed);
    Random random(settings_.seed);
    SimulatedChipOptions chip;
    chip.seed = settings_.seed;
    chip.memory = any_memory(random);
    const std::unique_ptr<Device> device = open_simulated_chip(chip);
    const std::size_t pairs = settings_.meshes.size();
    for (const bool all : {false, true}) {
      PosesTotals now;
      const std::size_t poses = ((all ? settings_.all : settings_.first) + pairs - 1) / pairs;
      for (std::size_t done = 0; done < poses;) {
        const std::size_t batch = std::min<std::size_t>(poses - done, 1 + random() % 200);
        answer(maker, random, a, b, *device, batch, all, now);
        done += batch;
      }
      fmt::print("{:<14} {:<5} {:>8} {:>8} {:>10} {:>8} {:>9} {:>10.1f} {:>11}\n", name, all ? "all" : "first",
                 now.queries, now.hits, now.contacts, now.open, now.fallbacks,
                 static_cast<double>(now.clocks) / std::max(1.0, static_cast<double>(now.queries)), now.differences);
      std::fflush(stdout);
      total_.queries += now.queries;
      total_.hits += now.hits;
      total_.differences += now.differences;
      total_.contacts += now.contacts;
      total_.open += now.open;
      total_.fallbacks += now.fallbacks;
      total_.clocks += now.clocks;
    }
  }

  void answer(PoseMaker& maker, Random& random, const Object& a, const Object& b, Device& device, std::size_t count,
              bool all, PosesTotals& now) {
    std::vector<PosePair> poses;
    const Approach approach = maker.approach();
    for (std::size_t i = 0; i < count; ++i) {
      poses.push_back(maker.pose(approach, pose_classes[random() % std::size(pose_classes)]));
    }
    CollisionRequest request;
    if (all) request.contacts = CollisionRequest::Contacts::all;
    const std::vector<CollisionResult> right = collide(*cpu_, a, b, poses, request);
    const std::vector<CollisionResult> got = collide(device, a, b, poses, request);
    for (std::size_t i = 0; i < count; ++i) {
      const CollisionResult& x = got[i];
      ++now.queries;
      now.hits += x.hit ? 1 : 0;
      now.contacts += x.contacts.size();
      now.open += x.counts.open;
      now.fallbacks += x.counts.fallbacks;
      now.clocks += x.counts.clocks;
      const bool same = all ? x.hit == right[i].hit && x.contacts == right[i].contacts
                            : x.hit == right[i].hit && named_contact_holds(a, b, poses[i], x);
      if (same) continue;
      ++now.differences;
      fmt::print("a query differs: hit {} {}, contacts {} {}\n", x.hit, right[i].hit, x.contacts.size(),
                 right[i].contacts.size());
    }
  }

  /// The device may name any contact.
  static bool named_contact_holds(const Object& a, const Object& b, const PosePair& pose, const CollisionResult& x) {
    if (!x.hit) return x.contacts.empty();
    if (x.contacts.size() != 1) return false;
    if (!a.mesh().file_face.empty() || !b.mesh().file_face.empty()) return true;  // numbers of cut polygons
    return PosedPairs(pose.a, pose.b)
        .decide(a.mesh().primitive(x.contacts[0].face_a), b.mesh().primitive(x.contacts[0].face_b))
        .hit;
  }

  PosesSettings settings_;
  std::unique_ptr<Device> cpu_;
  PosesTotals total_;
};

// ---- faults

enum class Fault : std::uint8_t {
  read_error,     ///< some lines of images are answered with an error
  read_silence,   ///< some are never answered
  read_late,      ///< all of them so late that the chip gives up
  query_error,    ///< a line of the ring of queries is answered with an error
  query_silence,  ///< or never
  write_error,    ///< a record is not written
  write_silence,  ///< or never answered
  full_ring,      ///< the host reads no record for long
  slow_consumer,  ///< the host stops again and again
  descriptor,     ///< a field of queries is another
  garbage,        ///< lines of images are others
  open_limit,     ///< the register
  step_limit,     ///< the register
  soft_reset,     ///< at any clock
};
constexpr std::size_t fault_count = 14;
constexpr const char* fault_names[fault_count] = {
    "read_error", "read_silence",  "read_late",  "query_error", "query_silence", "write_error", "write_silence",
    "full_ring",  "slow_consumer", "descriptor", "garbage",     "open_limit",    "step_limit",  "soft_reset"};
/// When a fault begins: before the first query, when some queries are answered, when all are given to the chip.
constexpr std::size_t phase_count = 3;
constexpr const char* phase_names[phase_count] = {"begin", "traffic", "end"};

struct FaultTotals {
  std::size_t queries = 0, rounds = 0, wrong = 0, hangs = 0, lost = 0, unreported = 0, resets = 0, bus_resets = 0;
  /// Answers on damaged images that are not the model's: boxes that no driver makes go beyond the formats of the box
  /// test, where the model is not exact. The chip must end such queries, not more.
  std::size_t damaged = 0;
  std::array<std::size_t, 8> codes{};
  std::array<std::array<std::array<std::size_t, 2>, phase_count>, fault_count> bins{};
};

/// One batch of queries under one or two faults, then some right ones.
class FaultRound {
 public:
  static constexpr std::size_t batch = 24;
  static constexpr std::uint64_t most_clocks = 6000000;
  static constexpr std::uint32_t slow_limit = 4000;  // of memory, clocks

  FaultRound(Bench& bench, Objects& objects, Random& random, FaultTotals& totals, std::set<Fault> faults,
             std::uint64_t stop_clocks)
      : bench_(bench),
        objects_(objects),
        random_(random),
        totals_(totals),
        stop_clocks_(stop_clocks),
        all_(random() % 2 != 0) {
    for (const Fault fault : faults) pending_.push_back({fault, static_cast<std::size_t>(random() % phase_count)});
    clean_a_ = objects_.a;
    clean_b_ = objects_.b;
  }

  void run() {
    from_ = bench_.queries().size();
    bench_.machine().memory().options = any_memory(random_);
    set(regs::memory_limit::offset, slow_limit);
    bench_.edit = [this](std::size_t number, Line& line) { maybe_corrupt(number, line); };
    add(batch);
    const std::uint64_t end = bench_.clocks() + most_clocks;
    bool stopped = false;
    while (!stopped && !reset_ && (bench_.unanswered() > 0 || !pending_.empty()) && bench_.clocks() < end) {
      begin_faults();
      stopped = !bench_.step();
      act();
    }
    judge(stopped, bench_.clocks() >= end);
    restore(stopped);
  }

 private:
  struct Pending {
    Fault fault;
    std::size_t phase;
  };
  /// What may become of a query.
  struct Expectation {
    Query query;                ///< as the chip reads it
    bool ends = false;          ///< with an error code, whichever of `codes`
    std::set<QueryCode> codes;  ///< allowed besides a right answer
  };

  void set(std::uint32_t offset, std::uint32_t value) { bench_.machine().write_register(offset, value); }

  void add(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      Query query = objects_.query(random_);
      query.mode = all_ ? QueryMode::all : QueryMode::first;
      bench_.submit(query);
      Expectation e;
      e.query = query;
      expected_.push_back(e);
      ++totals_.queries;
    }
  }

  bool active(Fault fault) const { return active_.count(fault) != 0; }
  void hit(Fault fault) { ++totals_.bins[static_cast<std::size_t>(fault)][phase_of_[fault]][all_ ? 1 : 0]; }

  void begin_faults() {
    const std::size_t answered = batch - std::min<std::size_t>(batch, bench_.unanswered());
    for (auto p = pending_.begin(); p != pending_.end();) {
      const bool now = p->phase == 0 || (p->phase == 1 && answered >= batch / 4) ||
                       (p->phase == 2 && bench_.unanswered() <= batch / 4);
      if (!now) {
        ++p;
        continue;
      }
      phase_of_[p->fault] = p->phase;
      active_.insert(p->fault);
      begin(p->fault);
      p = pending_.erase(p);
    }
  }

  void begin(Fault fault) {
    // what needs queries that have not been read yet gets some
    const bool needs_more = fault == Fault::query_error || fault == Fault::query_silence ||
                            fault == Fault::descriptor || fault == Fault::garbage || fault == Fault::read_error ||
                            fault == Fault::read_silence || fault == Fault::read_late || fault == Fault::open_limit ||
                            fault == Fault::step_limit;
    if (needs_more && phase_of_[fault] == 2) add(6);
    if (phase_of_[fault] == 2 && bench_.unanswered() == 0) add(6);
    switch (fault) {
      case Fault::read_silence:
        silent_ = 1 + random_() % 3;
        break;
      case Fault::read_late:
        late_ = 1 + random_() % 4;
        break;
      case Fault::full_ring:
      case Fault::slow_consumer:
        stops_ = fault == Fault::full_ring ? 1 : 6;
        stop_for_ = fault == Fault::full_ring ? stop_clocks_ : 200 + random_() % 5000;
        break;
      case Fault::descriptor:
        corrupt_ = 1 + random_() % 4;
        break;
      case Fault::garbage:
        bench_.hold = true;
        break;
      case Fault::open_limit:
        open_limit_ = static_cast<std::uint32_t>(random_() % 3);
        set(regs::open_limit::offset, open_limit_);
        open_limit_ = std::max(open_limit_, 1U);
        hit(fault);
        break;
      case Fault::step_limit:
        set(regs::step_limit::offset, static_cast<std::uint32_t>(random_() % 150));
        hit(fault);
        break;
      case Fault::soft_reset:
        reset_in_ = random_() % 2 == 0 ? random_() % 40 : random_() % 3000;
        break;
      default:
        break;
    }
    auto& memory = bench_.machine().memory();
    const std::uint64_t images = std::min(objects_.line_a, objects_.line_b);
    memory.read_fault = [this, images](std::uint64_t line) {
      const bool image = line >= images;
      if (image && active(Fault::read_error) && percent(random_, 3)) {
        hit(Fault::read_error);
        return sim::AxiFault::slave_error;
      }
      if (image && active(Fault::read_silence) && silent_ > 0 && percent(random_, 20)) {
        --silent_;
        lost_response_ = true;
        hit(Fault::read_silence);
        return sim::AxiFault::silence;
      }
      if (!image && active(Fault::query_error) && !ring_hit_) {
        ring_hit_ = true;
        hit(Fault::query_error);
        return sim::AxiFault::slave_error;
      }
      if (!image && active(Fault::query_silence) && !ring_hit_) {
        ring_hit_ = lost_response_ = true;
        hit(Fault::query_silence);
        return sim::AxiFault::silence;
      }
      return sim::AxiFault::none;
    };
    memory.write_fault = [this](std::uint64_t) {
      if (active(Fault::write_error) && !write_hit_) {
        write_hit_ = true;
        hit(Fault::write_error);
        return sim::AxiFault::slave_error;
      }
      if (active(Fault::write_silence) && !write_hit_) {
        write_hit_ = lost_response_ = true;
        hit(Fault::write_silence);
        return sim::AxiFault::silence;
      }
      return sim::AxiFault::none;
    };
  }

  /// What the host does beside its rings.
  void act() {
    if (stops_ > 0 && bench_.in_flight() > 0) {
      --stops_;
      hit(active(Fault::full_ring) ? Fault::full_ring : Fault::slow_consumer);
      for (std::uint64_t i = 0; i < stop_for_; ++i) bench_.machine().proceed();
    }
    if (late_ > 0 && bench_.in_flight() > 0) {
      // addresses of this time are answered after the limit; those before and after it are not touched
      auto& options = bench_.machine().memory().options;
      const std::uint64_t usual = options.latency;
      options.latency = 3 * slow_limit;
      hit(Fault::read_late);
      late_hit_ = true;
      --late_;
      for (int i = 0; i < 20; ++i) bench_.machine().proceed();
      options.latency = usual;
    }
    if (active(Fault::garbage) && bench_.hold && bench_.in_flight() == 0) spoil_images();
    if (active(Fault::soft_reset)) {
      if (reset_in_ > 0) {
        --reset_in_;
      } else {
        hit(Fault::soft_reset);
        reset_ = true;
      }
    }
  }

  void spoil_images() {
    for (int i = 0; i < 6; ++i) {
      bvh::Image& image = random_() % 2 == 0 ? objects_.a : objects_.b;
      Line& line = image.lines[1 + random_() % (image.lines.size() - 1)];
      if (random_() % 2 == 0) {
        for (std::uint8_t& byte : line) byte = static_cast<std::uint8_t>(random_());
      } else {
        line[random_() % line.size()] ^= static_cast<std::uint8_t>(1U << random_() % 8);
      }
    }
    bench_.port().store(static_cast<std::uint32_t>(objects_.line_a), objects_.a.lines);
    bench_.port().store(static_cast<std::uint32_t>(objects_.line_b), objects_.b.lines);
    spoiled_from_ = expected_.size() - bench_.unanswered();
    if (bench_.unanswered() > 0) hit(Fault::garbage);
    bench_.hold = false;
    active_.erase(Fault::garbage);
    garbage_ = true;
  }

  /// Changes one field of a descriptor in the ring.
  void maybe_corrupt(std::size_t number, Line& line) {
    if (!active(Fault::descriptor) || corrupt_ == 0) return;
    --corrupt_;
    hit(Fault::descriptor);
    Expectation& e = expected_[number - from_];
    const std::size_t fields = query_field::all.size();
    const std::size_t which = random_() % (fields + 1);
    if (which == fields) {  // bits that must be 0
      line[478 / 8] ^= static_cast<std::uint8_t>(0x40U << random_() % 2);
      e.ends = true;
      e.codes = {QueryCode::bad_descriptor};
      return;
    }
    const Field& field = query_field::all[which];
    const std::size_t index = random_() % field.count;
    const std::int64_t old = get(line, field, index);
    auto value = static_cast<std::int64_t>(random_() >> (64 - field.width));
    const std::string name = field.name;
    if (name == "m") {
      // a map that is far from any legal one, or near the given one: between them the driver is the gate
      value = random_() % 2 == 0 ? ((std::int64_t{1} << 30) + 1 + static_cast<std::int64_t>(random_() % 1000)) *
                                       (random_() % 2 == 0 ? 1 : -1)
                                 : old + static_cast<std::int64_t>(random_() % 200) - 100;
    }
    if (name == "tag") {
      value |= std::int64_t{1} << 31;  // of no other query
      bench_.rename(static_cast<std::uint32_t>(value), number);
    }
    put(line, field, value, index);
    e.query = decode_query(line);
    if ((name == "base_a" || name == "base_b") && get(line, field, index) != old) {
      e.ends = true;
      e.codes = {QueryCode::bad_descriptor, QueryCode::memory, QueryCode::corrupt, QueryCode::outside};
    }
  }

  /// The answer of the model for what the chip reads.
  std::string compare(const Expectation& e, const Query& sent, const ChipAnswer& answer, bool clean) const {
    const bvh::Image& a = clean ? (sent.swapped ? clean_b_ : clean_a_) : (sent.swapped ? objects_.b : objects_.a);
    const bvh::Image& b = clean ? (sent.swapped ? clean_a_ : clean_b_) : (sent.swapped ? objects_.a : objects_.b);
    model::BroadPhaseOptions options;
    options.step_limit = 20000;
    const QueryCode code = answer.done->code;
    if (!clean) {
      Query whole = e.query;
      whole.mode = QueryMode::all;
      if (model::run_query(whole, a, b, options).done.code != QueryCode::ok) {
        return e.query.mode == QueryMode::all && code == QueryCode::ok ? "ok on garbage" : "";
      }
    }
    if (code == QueryCode::steps && ever(Fault::step_limit)) return "";
    if (code == QueryCode::memory && (ever(Fault::read_error) || ever(Fault::read_silence) || ever(Fault::read_late)))
      return "";
    const model::BroadPhaseResult expected = model::run_query(e.query, a, b, options);
    const std::string wrong = compare_answer(e.query, answer, expected, open_limit_);
    if (wrong.empty()) return wrong;
    using Key = std::pair<std::uint32_t, std::uint32_t>;
    std::set<Key> got, wanted;
    for (const PairRecord& x : answer.pairs) got.emplace(x.id_a, x.id_b);
    for (const PairRecord& x : expected.pairs) wanted.emplace(x.id_a, x.id_b);
    std::string text = wrong;
    for (const Key& x : got) text += wanted.count(x) == 0 ? fmt::format(" +{}/{}", x.first, x.second) : "";
    for (const Key& x : wanted) text += got.count(x) == 0 ? fmt::format(" -{}/{}", x.first, x.second) : "";
    return text + fmt::format(", expected {} steps and {} records", expected.done.steps, expected.pairs.size());
  }

  bool ever(Fault fault) const { return phase_of_.count(fault) != 0; }

  void judge(bool stopped, bool late) {
    const std::uint32_t failed = regs::status::query_failed_mask | regs::status::record_failed_mask;
    const std::uint32_t status = bench_.machine().read_register(regs::status::offset);
    const std::uint32_t events = bench_.machine().read_register(regs::interrupt_status::offset);
    const bool ring_stopped = (status & failed) != 0;
    if (stopped || late || reset_) {
      const bool fault_stops = ring_hit_ || write_hit_ || late_hit_;  // a line of the ring may be late, too
      if (late || (stopped && !ring_stopped)) {
        ++totals_.hangs;
        report("hang");
      }
      if (stopped && ring_stopped && !fault_stops) {
        ++totals_.wrong;
        report("a ring stopped without a fault");
      }
      const bool query_event = (events & regs::interrupt_status::query_failed_mask) != 0;
      const bool record_event = (events & regs::interrupt_status::record_failed_mask) != 0;
      if (((status & regs::status::query_failed_mask) != 0) != query_event ||
          ((status & regs::status::record_failed_mask) != 0) != record_event) {
        ++totals_.unreported;
        report("a ring stopped without its event");
      }
    } else if (bench_.unanswered() > 0) {
      totals_.lost += bench_.unanswered();
      report("lost");
    }
    for (std::size_t i = 0; i < expected_.size(); ++i) {
      const ChipAnswer& answer = bench_.answers()[from_ + i];
      if (!answer.done) continue;
      const Expectation& e = expected_[i];
      const QueryCode code = answer.done->code;
      ++totals_.codes[static_cast<std::size_t>(code)];
      const bool clean = !garbage_ || i < spoiled_from_;
      std::string wrong;
      if (e.ends) {
        const bool memory = code == QueryCode::memory &&
                            (ever(Fault::read_error) || ever(Fault::read_silence) || ever(Fault::read_late));
        if (e.codes.count(code) == 0 && !memory) wrong = "code of a bad descriptor";
      } else {
        wrong = compare(e, bench_.queries()[from_ + i], answer, clean);
      }
      if (wrong.empty()) continue;
      if (!clean) {
        ++totals_.damaged;
        continue;
      }
      ++(code == QueryCode::ok || code == QueryCode::host ? totals_.wrong : totals_.unreported);
      report(fmt::format("query {}: {}, code {}, answer {}, steps {}, records {}", i, wrong, static_cast<int>(code),
                         static_cast<int>(answer.done->answer), answer.done->steps, answer.pairs.size()));
    }
    if (!bench_.wrong().empty() && bench_.wrong().size() > seen_wrong()) {
      totals_.wrong += bench_.wrong().size() - seen_wrong();
      report(bench_.wrong().back());
      seen_wrong() = bench_.wrong().size();
    }
  }

  std::size_t& seen_wrong() {
    static std::size_t seen = 0;
    return seen;
  }

  void report(const std::string& what) const {
    std::string names;
    for (const auto& [fault, phase] : phase_of_)
      names += fmt::format(" {}/{}", fault_names[static_cast<std::size_t>(fault)], phase_names[phase]);
    fmt::print("round {}:{} {}: {}\n", totals_.rounds, names, all_ ? "all" : "first", what);
  }

  /// Everything as it was, and right queries.
  void restore(bool stopped) {
    auto& memory = bench_.machine().memory();
    memory.read_fault = memory.write_fault = [](std::uint64_t) { return sim::AxiFault::none; };
    bench_.edit = nullptr;
    bench_.hold = false;
    active_.clear();
    // late responses are still to come: they hold up others, and their slots are out of use
    for (int i = 0; late_hit_ && i < 20; ++i) {
      const std::uint32_t status = bench_.machine().read_register(regs::status::offset);
      if (lost_response_ || (status & regs::status::read_outstanding_mask) == 0) break;
      bench_.machine().simulation().steps(slow_limit);
    }
    if (stopped || reset_ || lost_response_ || bench_.unanswered() > 0) {
      ++totals_.resets;
      if (!bench_.recover()) {
        // memory that has lost a response: the chip says so, and only a reset of chip and bus helps
        const std::uint32_t status = bench_.machine().read_register(regs::status::offset);
        const std::uint32_t owed = regs::status::read_outstanding_mask | regs::status::write_outstanding_mask;
        if (!lost_response_ || (status & owed) == 0 || (status & regs::status::resetting_mask) == 0) {
          ++totals_.unreported;
          report("a reset does not end");
        }
        ++totals_.bus_resets;
        bench_.machine().reset();
        if (!bench_.recover()) throw std::runtime_error("a reset of chip and bus does not help");
      }
    }
    set(regs::step_limit::offset, 0xFFFFFFFF);
    set(regs::open_limit::offset, 16);
    set(regs::interrupt_status::offset, 0x1F);
    if (garbage_) {
      objects_.a = clean_a_;
      objects_.b = clean_b_;
      bench_.port().store(static_cast<std::uint32_t>(objects_.line_a), objects_.a.lines);
      bench_.port().store(static_cast<std::uint32_t>(objects_.line_b), objects_.b.lines);
    }
    check_after();
  }

  void check_after() {
    const std::size_t from = bench_.queries().size();
    for (int i = 0; i < 3; ++i) bench_.submit(objects_.query(random_));
    totals_.queries += 3;
    if (!bench_.run(most_clocks)) {
      ++totals_.hangs;
      report("no answer afterwards");
      bench_.machine().reset();
      if (!bench_.recover()) throw std::runtime_error("a reset of chip and bus does not help");
      return;
    }
    for (std::size_t i = from; i < bench_.queries().size(); ++i) {
      const Query& query = bench_.queries()[i];
      const std::string wrong = compare_answer(query, bench_.answers()[i], objects_.expected(query), 16);
      if (wrong.empty()) continue;
      ++totals_.wrong;
      report("afterwards: " + wrong);
    }
  }

  Bench& bench_;
  Objects& objects_;
  Random& random_;
  FaultTotals& totals_;
  std::uint64_t stop_clocks_;
  bool all_;
  std::vector<Pending> pending_;
  std::set<Fault> active_;
  std::map<Fault, std::size_t> phase_of_;
  std::vector<Expectation> expected_;
  std::size_t from_ = 0, spoiled_from_ = 0;
  bvh::Image clean_a_, clean_b_;
  bool garbage_ = false, ring_hit_ = false, write_hit_ = false, late_hit_ = false, lost_response_ = false,
       reset_ = false;
  std::size_t silent_ = 0, late_ = 0, stops_ = 0, corrupt_ = 0;
  std::uint64_t stop_for_ = 0, reset_in_ = 0;
  std::uint32_t open_limit_ = 16;
};

struct FaultSettings {
  std::size_t queries = 100000;
  std::vector<std::string> faults;  ///< only these; empty: all
  std::uint64_t stop = 1000000;     ///< clocks of the longest stop of the host
  std::uint64_t seed = sim::seed_from_environment();
  bool all_bins = false;
};

ChipDriverOptions small_rings() {
  ChipDriverOptions options;
  options.memory_base = std::uint64_t{3} << 32U;
  options.memory_bytes = std::uint64_t{1} << 24U;
  options.query_log2 = 3;
  options.record_log2 = 6;
  options.patience = 200000;
  options.reset_patience = 4000;
  return options;
}

int run_faults(const FaultSettings& settings) {
  Random random(settings.seed);
  fmt::print("seed={}\n", settings.seed);
  Bench bench(sim::without_timeout(settings.seed), {}, small_rings(), 1);
  Objects objects(Kind::quad);
  objects.place(bench);
  bench.machine().write_register(regs::interrupt_status::offset, 0x1F);
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < fault_count; ++i) {
    const bool wanted = settings.faults.empty() || std::find(settings.faults.begin(), settings.faults.end(),
                                                             fault_names[i]) != settings.faults.end();
    if (wanted) faults.push_back(static_cast<Fault>(i));
  }
  FaultTotals totals;
  while (totals.queries < settings.queries) {
    std::set<Fault> now = {faults[random() % faults.size()]};
    if (random() % 2 == 0) now.insert(faults[random() % faults.size()]);
    // the longest stop is long: one of 64
    const std::uint64_t stop = random() % 64 == 0 ? settings.stop : std::min<std::uint64_t>(settings.stop, 20000);
    FaultRound(bench, objects, random, totals, now, stop).run();
    ++totals.rounds;
  }
  std::size_t bins = 0;
  fmt::print("{:<14}", "fault");
  for (const char* phase : phase_names) fmt::print(" {:>8} first {:>8} all", phase, phase);
  fmt::print("\n");
  for (const Fault fault : faults) {
    const auto& row = totals.bins[static_cast<std::size_t>(fault)];
    fmt::print("{:<14}", fault_names[static_cast<std::size_t>(fault)]);
    for (const auto& phase : row) {
      fmt::print(" {:>14} {:>12}", phase[0], phase[1]);
      bins += (phase[0] > 0 ? 1U : 0U) + (phase[1] > 0 ? 1U : 0U);
    }
    fmt::print("\n");
  }
  fmt::print("codes:");
  for (std::size_t i = 0; i < totals.codes.size(); ++i) fmt::print(" {}={}", i, totals.codes[i]);
  const std::size_t all_bins = faults.size() * phase_count * 2;
  fmt::print(
      "\nqueries={} rounds={} wrong={} hangs={} lost={} unreported={} resets={} bus_resets={} damaged_images={} "
      "bins={}/{}\n",
      totals.queries, totals.rounds, totals.wrong, totals.hangs, totals.lost, totals.unreported, totals.resets,
      totals.bus_resets, totals.damaged, bins, all_bins);
  const bool clean = totals.wrong == 0 && totals.hangs == 0 && totals.lost == 0 && totals.unreported == 0;
  return clean && (!settings.all_bins || bins == all_bins) ? 0 : 3;
}

// ---- soft resets

/// A chip with swaps: the module that answered a pair decides how certain it is, and a pair that a swap left without a
/// module comes back open. So there may be more open pairs, never fewer contacts or more definite ones.
std::string compare_ids(const Query& query, const ChipAnswer& answer, const model::BroadPhaseResult& expected) {
  if (!answer.done) return "no answer";
  using Key = std::pair<std::uint32_t, std::uint32_t>;
  std::set<Key> wanted, got;
  for (const PairRecord& x : expected.pairs) wanted.emplace(x.id_a, x.id_b);
  bool more = false;
  for (const PairRecord& x : answer.pairs) {
    got.emplace(x.id_a, x.id_b);
    const bool is_new = wanted.count({x.id_a, x.id_b}) == 0;
    more = more || is_new;
    // the first contact may be any, so a definite one that the model does not name is no error there
    if (is_new && x.definite && query.mode == QueryMode::all) return "a definite contact that is none";
  }
  const auto some = [](QueryAnswer x) { return x != QueryAnswer::no; };
  if (some(expected.done.answer) && !some(answer.done->answer)) return "answer";
  if (!some(expected.done.answer) && some(answer.done->answer) && !more) return "answer";
  if (answer.done->answer == QueryAnswer::yes && !some(expected.done.answer)) return "yes";
  if (query.mode == QueryMode::first) return "";
  if (answer.done->code != expected.done.code) return "code";
  if (answer.done->steps != expected.done.steps) return "steps";
  return std::includes(got.begin(), got.end(), wanted.begin(), wanted.end()) ? "" : "a contact is missing";
}

/// \param slots of a chip with swaps, whose modules are exchanged meanwhile; 0: a chip without
template <class Bench>
int run_resets(std::size_t resets, std::uint64_t seed, std::uint32_t slots) {
  const bool swaps = slots > 0;
  Random random(seed);
  fmt::print("seed={}\n", seed);
  ChipDriverOptions driver = small_rings();
  if (swaps) driver.memory_base = std::uint64_t{1} << 20U;  // of bitstreams, too
  Bench bench(sim::without_timeout(seed), {}, driver, 1);
  std::size_t in_swaps = 0;
  Objects objects(Kind::quad);
  objects.place(bench);
  std::size_t wrong = 0, hangs = 0, checked = 0;
  constexpr std::uint32_t transfer = 5;     // phase of a swap
  constexpr std::uint64_t port_clocks = 2;  // of a word of the configuration port, a byte
  constexpr std::uint64_t longest_swap = 20000;
  for (std::size_t i = 0; i < resets; ++i) {
    bench.machine().memory().options = any_memory(random);
    for (const Query& query : queries_of(objects, random, 12)) bench.submit(query);
    const std::uint64_t clocks = i % 2 == 0 ? random() % 3000 : random() % 100;
    const std::uint32_t slot = slots > 1 ? static_cast<std::uint32_t>(random() % slots) : 0;
    const auto field = [&](std::uint32_t mask, int shift) {
      return (bench.machine().read_register(regs::slot_status::offset(slot)) & mask) >> shift;
    };
    const auto phase = [&] { return field(regs::slot_status::phase_mask, regs::slot_status::phase_shift); };
    if (swaps) {
      const std::uint32_t now = field(regs::slot_status::module_id_mask, regs::slot_status::module_id_shift);
      const std::uint32_t other = 1 + (now + static_cast<std::uint32_t>(random() % 2)) % 3;
      bench.machine().write_register(regs::swap_command::offset, regs::swap_command::go_mask |
                                                                     slot << regs::swap_command::slot_shift |
                                                                     other << regs::swap_command::module_id_shift);
    }
    std::uint64_t wait = clocks;
    if (swaps && i % 4 >= 2) {
      // Nearly all of a swap is its transfer: a quarter of the resets looks for one of the phases before it, another
      // begins about where it ends, and continues while the new module is reset and taken into operation.
      const std::uint32_t wanted = i % 4 == 2 ? 1 + static_cast<std::uint32_t>(random() % 4) : transfer;
      for (std::uint64_t k = 0; k < longest_swap && phase() < wanted; ++k) bench.step();
      wait = i % 4 == 2 ? clocks % 16 : driver.payload_bytes * port_clocks - 48 + clocks % 64;
    }
    for (std::uint64_t k = 0; k < wait; ++k) bench.step();
    if (swaps && phase() != 0) ++in_swaps;
    if (!bench.recover()) {
      ++hangs;
      bench.machine().reset();
      bench.recover();
      continue;
    }
    const std::size_t from = bench.queries().size();
    for (const Query& query : queries_of(objects, random, 3)) bench.submit(query);
    if (!bench.run(FaultRound::most_clocks)) ++hangs;
    for (std::size_t k = from; k < bench.queries().size(); ++k) {
      const Query& query = bench.queries()[k];
      const model::BroadPhaseResult expected = objects.expected(query);
      const ChipAnswer& answer = bench.answers()[k];
      const std::string text =
          swaps ? compare_ids(query, answer, expected) : compare_answer(query, answer, expected, 16);
      if (!text.empty()) {
        ++wrong;
        fmt::print("reset {}, query {}: {}, mode {}, code {} {}, answer {} {}, records {} {}, steps {} {}\n", i,
                   k - from, text, query.mode == QueryMode::first ? "first" : "all",
                   answer.done ? static_cast<int>(answer.done->code) : -1, static_cast<int>(expected.done.code),
                   answer.done ? static_cast<int>(answer.done->answer) : -1, static_cast<int>(expected.done.answer),
                   answer.pairs.size(), expected.pairs.size(), answer.done ? answer.done->steps : 0,
                   expected.done.steps);
      }
      ++checked;
    }
  }
  wrong += bench.wrong().size();
  fmt::print("resets={} wrong={} hangs={} checked={}", resets, wrong, hangs, checked);
  if (swaps) fmt::print(" in_swaps={}", in_swaps);
  fmt::print("\n");
  return resets != 0 && wrong == 0 && hangs == 0 ? 0 : 3;
}

// ---- swaps

/// A simulated chip with swaps as a device, and its machine.
struct SwapChip {
  template <class Model>
  static SwapChip make(const sim::AxiLinesOptions& memory, const ChipDriverOptions& driver, std::uint64_t seed);

  std::unique_ptr<Device> device;
  Machine* machine = nullptr;                           // of the device
  std::function<void(sim::AxiMemoryOptions)> set_port;  ///< of the bitstreams' memory
  std::function<void(std::function<void(std::vector<sim::AxiBeat>&)>)> set_fault;
  std::function<void(bool)> set_silent;  ///< it takes no address
  std::function<std::uint64_t()> clocks;
  std::shared_ptr<std::array<std::uint64_t, 2>> overlap;  ///< clocks of TRANSFER, and those of them with box tests
};

/// Counts what the registers do not show.
template <class Model>
class SwapObserver : public sim::Agent {
 public:
  SwapObserver(const Model& model, std::shared_ptr<std::array<std::uint64_t, 2>> overlap)
      : model_(model), overlap_(std::move(overlap)) {}
  void drive(const sim::ClockInfo&) override {}
  void sample(const sim::ClockInfo&) override {
    if (static_cast<SwapPhase>(probes::chip_swap_phase(model_)) != SwapPhase::transfer) return;
    ++(*overlap_)[0];
    (*overlap_)[1] += probes::chip_counts(model_) >> 1 & 1U;
  }

 private:
  const Model& model_;
  std::shared_ptr<std::array<std::uint64_t, 2>> overlap_;
};

/// ChipMachine that owns its observer.
template <class Model>
class ObservedChip : public sim::ChipMachine<Model, 128> {
 public:
  ObservedChip(std::uint64_t seed, std::shared_ptr<std::array<std::uint64_t, 2>> overlap)
      : sim::ChipMachine<Model, 128>(sim::without_timeout(seed)),
        observer_(this->simulation().top(), std::move(overlap)) {
    this->simulation().add(observer_);
  }

 private:
  SwapObserver<Model> observer_;
};

template <class Model>
SwapChip SwapChip::make(const sim::AxiLinesOptions& memory, const ChipDriverOptions& driver, std::uint64_t seed) {
  SwapChip made;
  made.overlap = std::make_shared<std::array<std::uint64_t, 2>>();
  auto machine = std::make_unique<ObservedChip<Model>>(seed, made.overlap);
  auto* chip = machine.get();
  chip->memory().options = memory;
  made.machine = chip;
  made.set_port = [chip](sim::AxiMemoryOptions options) { chip->bitstreams().set_options(std::move(options)); };
  made.set_fault = [chip](std::function<void(std::vector<sim::AxiBeat>&)> fault) {
    chip->bitstreams().set_fault(std::move(fault));
  };
  made.set_silent = [chip](bool silent) {
    if (silent) {
      chip->bitstreams().refuse_addresses();
    } else {
      chip->bitstreams().resume();
    }
  };
  made.clocks = [chip] { return chip->simulation().total_clocks(); };
  made.device = make_chip_device(open_chip(std::move(machine), driver));
  return made;
}

SwapChip make_swap_chip(unsigned slots, const sim::AxiLinesOptions& memory, const ChipDriverOptions& driver,
                        std::uint64_t seed) {
  if (slots == 1) return SwapChip::make<Vcchip_chip_swaps1>(memory, driver, seed);
  return SwapChip::make<Vcchip_chip_swaps2>(memory, driver, seed);
}

/// Objects of triangles and of quads, and random pairs of them.
struct MixedObjects {
  MixedObjects() {
    objects.emplace_back(make_body(6, 0.3, 3));
    objects.emplace_back(make_torus(1, 0.4, 36, 24));
    objects.emplace_back(make_torus(1, 0.4, 36, 24, Kind::quad));
    objects.emplace_back(make_torus(0.8, 0.3, 24, 18, Kind::quad));
  }
  struct Placed {
    std::size_t a, b;
    PosePair pose;
  };
  Placed draw(Random& random) const {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto pose = [&](double range) {
      Pose made = Pose::Identity();
      made.linear() =
          Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized().toRotationMatrix();
      for (int i = 0; i < 3; ++i) made.translation()[i] = range * unit(random);
      return made;
    };
    return {random() % objects.size(), random() % objects.size(), {pose(0.2), pose(2)}};
  }
  std::vector<Object> objects;
};

struct MixedSettings {
  unsigned slots = 1;
  std::size_t queries = 2000;
  std::string faults;  ///< empty: none; all, or one of swap_faults
  std::uint64_t seed = sim::seed_from_environment();
};

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
    ChipDriverOptions driver;
    driver.memory_bytes = std::uint64_t{1} << 25U;
    driver.patience = 3000000;
    driver.reset_patience = 100000;
    chip_ = make_swap_chip(settings_.slots, any_memory(random_), driver, settings_.seed);
    while (queries_ < settings_.queries) batch();
    std::size_t bins = 0;
    for (const auto& [name, count] : bins_) bins += count > 0 ? 1U : 0U;
    fmt::print(
        "queries={} hits={} mismatches={} contacts={} open={} lost={} duplicated={} swaps={} clocks_mean={:.1f} "
        "fallbacks={} failed_swaps={} given_up={} bins={}\n",
        queries_, hits_, mismatches_, contacts_, counts_.open, lost_, duplicated_, counts_.swaps,
        static_cast<double>(counts_.clocks) / std::max(1.0, static_cast<double>(queries_)), counts_.fallbacks,
        failed_swaps(), chip_.machine->read_register(regs::swap_lost::offset), bins);
    for (const auto& [name, count] : bins_) fmt::print("  {}: {}\n", name, count);
    return mismatches_ == 0 && lost_ == 0 && duplicated_ == 0 && queries_ > 0 ? 0 : 3;
  }

 private:
  void set(std::uint32_t offset, std::uint32_t value) { chip_.machine->write_register(offset, value); }
  std::uint32_t failed_swaps() { return chip_.machine->read_register(regs::rejected::offset); }

  void batch() {
    const std::size_t count = 1 + random_() % 60;
    std::vector<MixedObjects::Placed> placed;
    std::vector<CollisionQuery> queries;
    for (std::size_t i = 0; i < count; ++i) placed.push_back(objects_.draw(random_));
    for (const auto& x : placed)
      queries.push_back({&objects_.objects[x.a], &x.pose.a, &objects_.objects[x.b], &x.pose.b});
    CollisionRequest request;
    if (random_() % 2 == 0) request.contacts = CollisionRequest::Contacts::all;
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
          counts_ += x.counts;
        });
    for (const std::size_t times : taken) {
      lost_ += times == 0 ? 1 : 0;
      duplicated_ += times > 1 ? times - 1 : 0;
    }
    queries_ += count;
    ++bins_[fmt::format("{} {}", fault.empty() ? "none" : fault,
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
    if (fault == "forced" && random_() % 4 == 0) command(true);
    if (fault == "commands" && random_() % 4 == 0) command(false);
    if (fault == "abort" && random_() % 3 == 0) {
      command(false);
      for (std::uint64_t i = random_() % 3000; i-- > 0;) chip_.machine->proceed();
      chip_.machine->write_register(regs::swap_control::offset,
                                    regs::swap_control::abort_mask | regs::swap_control::scheduler_enable_mask);
    }
    if ((fault == "silent" || fault == "bus_error") && ended > 4 && random_() % 40 == 0) end_fault();
  }

  void command(bool force) {
    const auto slot = static_cast<std::uint32_t>(random_() % settings_.slots);
    const auto module_id = static_cast<std::uint32_t>(1 + random_() % 3);
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
  std::uint64_t contacts_ = 0;
  CollisionCounts counts_;
  std::map<std::string, std::size_t> bins_;
};

// ---- the paper's experiment: triangles, then quads, in turn

struct CurveSettings {
  std::vector<std::size_t> queries = {1, 10, 100, 1000, 10000};
  std::size_t rounds = 2;
  std::size_t triangle_bytes = 688008;  ///< payload, the paper's 5,504,088 bit but for three bytes
  std::size_t quad_bytes = 676248;      ///< 5,409,976 bit
  std::uint64_t seed = sim::seed_from_environment();
};

/// Clocks of batches of `queries` of triangle objects and of quad objects in turn.
struct CurvePoint {
  double clocks = 0;  ///< of a batch, mean
  double swaps = 0;   ///< of a batch
  double swap_clocks = 0;
  double worked = 0;  ///< clocks of TRANSFER of a batch on which the box test worked
};

SwapChip make_curve_chip(unsigned slots, const CurveSettings& settings) {
  ChipDriverOptions driver;
  driver.memory_bytes = std::uint64_t{1} << 25U;
  driver.bitstream = [&](std::uint8_t slot, ModuleId id) {
    const std::size_t bytes = id == ModuleId::tri_tri     ? settings.triangle_bytes
                              : id == ModuleId::quad_quad ? settings.quad_bytes
                                                          : (settings.triangle_bytes + settings.quad_bytes) / 8 * 4;
    return make_bitstream(slot, id, make_payload(slot, id, bytes, 1));
  };
  return make_swap_chip(slots, {}, driver, settings.seed);
}

/// The swap in progress ends: it belongs to its batch, also if no query of it had to wait.
void end_swaps(SwapChip& chip, unsigned slots) {
  for (std::uint32_t slot = 0; slot < slots;) {
    const std::uint32_t status = chip.machine->read_register(regs::slot_status::offset(slot));
    if ((status & regs::slot_status::phase_mask) == 0) {
      ++slot;
    } else {
      chip.machine->proceed();
      slot = 0;
    }
  }
}

CurvePoint measure_curve(unsigned slots, std::size_t queries, const CurveSettings& settings) {
  SwapChip chip = make_curve_chip(slots, settings);
  const Object triangles_a(make_body(6, 0.3, 3)), triangles_b(make_torus(1, 0.4, 36, 24));
  const Object quads_a(make_torus(0.8, 0.3, 24, 18, Kind::quad)), quads_b(make_torus(1, 0.4, 36, 24, Kind::quad));
  Random random(settings.seed);
  const MixedObjects poses;
  CurvePoint point;
  std::size_t batches = 0;
  std::array<std::uint64_t, 2> before = {};
  for (std::size_t round = 0; round < settings.rounds + 1; ++round) {
    // the first round loads what is there from then on, and fills the cache
    for (const bool quads : {false, true}) {
      std::vector<PosePair> batch;
      for (std::size_t i = 0; i < (round == 0 ? 1 : queries); ++i) batch.push_back(poses.draw(random).pose);
      const Object& a = quads ? quads_a : triangles_a;
      const Object& b = quads ? quads_b : triangles_b;
      const std::uint64_t from = chip.clocks();
      const std::uint32_t swaps = chip.machine->read_register(regs::swaps::offset);
      collide(*chip.device, a, b, batch, {}, [](std::size_t, const CollisionResult&) {});
      end_swaps(chip, slots);
      if (round == 0) continue;
      ++batches;
      point.clocks += static_cast<double>(chip.clocks() - from);
      if (chip.machine->read_register(regs::swaps::offset) == swaps) continue;
      ++point.swaps;
      for (std::uint32_t phase = 0; phase < regs::phase_clocks::count; ++phase)
        point.swap_clocks += chip.machine->read_register(regs::phase_clocks::offset(phase));
    }
    if (round == 0) before = *chip.overlap;
  }
  const auto n = static_cast<double>(batches);
  point.worked = static_cast<double>((*chip.overlap)[1] - before[1]) / n;
  for (double* x : {&point.clocks, &point.swaps, &point.swap_clocks}) *x /= n;
  return point;
}

/// A batch of `queries` each of triangles, of triangles against quads and of quads: three modules, each for its part.
/// With two slots the host asks for the next one while the one before works. \returns clocks, swaps of a batch
CurvePoint measure_three(unsigned slots, std::size_t queries, const CurveSettings& settings) {
  SwapChip chip = make_curve_chip(slots, settings);
  const std::array<Object, 3> objects = {Object(make_body(6, 0.3, 3)), Object(make_torus(1, 0.4, 36, 24)),
                                         Object(make_torus(1, 0.4, 36, 24, Kind::quad))};
  const Object quads(make_torus(0.8, 0.3, 24, 18, Kind::quad));
  Random random(settings.seed);
  const MixedObjects poses;
  CurvePoint point;
  for (std::size_t round = 0; round < settings.rounds + 1; ++round) {
    std::vector<CollisionQuery> batch;
    std::vector<PosePair> placed;
    const std::size_t each = round == 0 ? 1 : queries;
    for (std::size_t i = 0; i < 3 * each; ++i) placed.push_back(poses.draw(random).pose);
    for (std::size_t i = 0; i < 3 * each; ++i) {
      const std::size_t part = i / each;
      const Object& first = part == 2 ? quads : objects[0];
      const Object& second = part == 1 ? objects[2] : objects[part];
      batch.push_back({&first, &placed[i].a, &second, &placed[i].b});
    }
    const std::uint64_t from = chip.clocks();
    const std::uint32_t swaps = chip.machine->read_register(regs::swaps::offset);
    collide(*chip.device, batch);
    end_swaps(chip, slots);
    if (round == 0) continue;
    point.clocks += static_cast<double>(chip.clocks() - from) / static_cast<double>(settings.rounds);
    point.swaps += static_cast<double>(chip.machine->read_register(regs::swaps::offset) - swaps) /
                   static_cast<double>(settings.rounds);
  }
  return point;
}

int run_three(const CurveSettings& settings) {
  fmt::print("{:>8} {:>14} {:>7} {:>14} {:>7}\n", "queries", "one slot", "swaps", "two slots", "swaps");
  for (const std::size_t queries : settings.queries) {
    const CurvePoint one = measure_three(1, queries, settings);
    const CurvePoint two = measure_three(2, queries, settings);
    fmt::print("{:>8} {:>14.1f} {:>7.2f} {:>14.1f} {:>7.2f}\n", queries, one.clocks, one.swaps, two.clocks, two.swaps);
    std::fflush(stdout);
  }
  return 0;
}

int run_curve(const CurveSettings& settings) {
  // eq. (4): a word of 8 bit takes 2 clocks, 100 MHz and a port of 50 MHz
  const double equation4 = static_cast<double>(settings.triangle_bytes + settings.quad_bytes);
  fmt::print("eq. (4): {:.0f} clocks a swap, mean of both bitstreams\n", equation4);
  fmt::print("{:>8} {:>14} {:>14} {:>7} {:>12} {:>11} {:>11} {:>12}\n", "queries", "both stay", "one slot", "swaps",
             "swap clocks", "overhead %", "eq. (5) %", "box tests");
  for (const std::size_t queries : settings.queries) {
    const CurvePoint both = measure_curve(2, queries, settings);
    const CurvePoint one = measure_curve(1, queries, settings);
    fmt::print("{:>8} {:>14.1f} {:>14.1f} {:>7.2f} {:>12.1f} {:>11.3f} {:>11.3f} {:>12.1f}\n", queries, both.clocks,
               one.clocks, one.swaps, one.swap_clocks, 100 * (one.clocks - both.clocks) / both.clocks,
               100 * equation4 / both.clocks, one.worked);
    if (both.swaps != 0) fmt::print("both stay, yet {:.2f} swaps a batch\n", both.swaps);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) {
  using namespace cchip::testing;
  CLI::App app("Campaigns of the whole chip in RTL behind its driver.");
  app.require_subcommand(1);
  PosesSettings poses;
  auto* poses_command = app.add_subcommand("poses", "the simulated device against the CPU device, face for face");
  poses_command->add_option("--meshes", poses.meshes, "pairs of meshes; default: ten")->delimiter(',');
  poses_command->add_option("--first", poses.first, "queries for the first contact, in all")->capture_default_str();
  poses_command->add_option("--all", poses.all, "queries for all contacts, in all")->capture_default_str();
  poses_command->add_option("--seed", poses.seed, "of poses, memory, power-up")->capture_default_str();
  FaultSettings faults;
  auto* faults_command = app.add_subcommand("faults", "queries under faults, alone and in pairs");
  faults_command->add_option("--queries", faults.queries, "in all")->capture_default_str();
  faults_command->add_option("--faults", faults.faults, "only these")->delimiter(',');
  faults_command->add_option("--stop", faults.stop, "clocks of the longest stop of the host")->capture_default_str();
  faults_command->add_option("--seed", faults.seed, "of everything")->capture_default_str();
  faults_command->add_flag("--all-bins", faults.all_bins, "every fault in each phase and mode, or exit code 3");
  std::size_t resets = 1000;
  std::uint64_t seed = cchip::sim::seed_from_environment();
  auto* resets_command = app.add_subcommand("resets", "soft resets at any clock, each followed by right queries");
  resets_command->add_option("--resets", resets, "how many")->capture_default_str();
  resets_command->add_option("--seed", seed, "of everything")->capture_default_str();
  std::uint32_t slots = 0;
  resets_command->add_option("--slots", slots, "1 or 2 slots, whose modules are exchanged meanwhile; 0: no swaps")
      ->check(CLI::Range(0, 2))
      ->capture_default_str();
  MixedSettings mixed;
  auto* mixed_command = app.add_subcommand("mixed", "batches of triangle and quad objects through a chip with swaps");
  mixed_command->add_option("--slots", mixed.slots, "1 or 2")->check(CLI::Range(1, 2))->capture_default_str();
  mixed_command->add_option("--queries", mixed.queries, "in all")->capture_default_str();
  mixed_command->add_option("--faults", mixed.faults,
                            "of bitstreams and swaps: all, or one of silent, bus_error, "
                            "damaged, forced, abort, slow, commands");
  mixed_command->add_option("--seed", mixed.seed, "of everything")->capture_default_str();
  CurveSettings curve;
  auto* curve_command = app.add_subcommand("curve", "triangles and quads in turn: overhead against queries per swap");
  curve_command->add_option("--queries", curve.queries, "per swap")->delimiter(',')->capture_default_str();
  curve_command->add_option("--rounds", curve.rounds, "swaps of each kind that are measured")->capture_default_str();
  bool three = false;
  curve_command->add_flag("--three", three, "three modules in turn, on one slot and on two");
  curve_command->add_option("--triangle-bytes", curve.triangle_bytes, "payload")->capture_default_str();
  curve_command->add_option("--quad-bytes", curve.quad_bytes, "payload")->capture_default_str();
  curve_command->add_option("--seed", curve.seed, "of poses and power-up")->capture_default_str();
  app.footer("Exit codes: 0 nothing wrong, 3 a wrong or lost answer, others: wrong arguments.");
  CLI11_PARSE(app, argc, argv);
  try {
    if (*poses_command) return PosesCampaign(poses).run();
    if (*faults_command) return run_faults(faults);
    if (*mixed_command) return MixedRun(mixed).run();
    if (*curve_command) return three ? run_three(curve) : run_curve(curve);
    if (slots == 1) return run_resets<PortBench<Vcchip_chip_swaps1, 128>>(resets, seed, slots);
    if (slots == 2) return run_resets<PortBench<Vcchip_chip_swaps2, 128>>(resets, seed, slots);
    return run_resets<Bench>(resets, seed, slots);
  } catch (const std::exception& error) {
    fmt::print(stderr, "cchip_chip_campaign: {}\n", error.what());
    return 2;
  }
}
