// SPDX-License-Identifier: Apache-2.0
// Long runs of cchip_chip behind its driver: poses of many meshes against the CPU device, faults, soft resets.
#include <Vcchip_chip.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cchip/device/chip_host.hpp>
#include <cchip/device/cpu_device.hpp>
#include <cchip/exact/posed_pairs.hpp>
#include <cchip/mesh/shapes.hpp>
#include <cchip/rtl/simulated_chip.hpp>
#include <cchip/sim/seed.hpp>
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
    return compare_answer(e.query, answer, model::run_query(e.query, a, b, options), open_limit_);
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
  fmt::print("\nqueries={} rounds={} wrong={} hangs={} lost={} unreported={} resets={} bus_resets={} bins={}/{}\n",
             totals.queries, totals.rounds, totals.wrong, totals.hangs, totals.lost, totals.unreported, totals.resets,
             totals.bus_resets, bins, all_bins);
  const bool clean = totals.wrong == 0 && totals.hangs == 0 && totals.lost == 0 && totals.unreported == 0;
  return clean && (!settings.all_bins || bins == all_bins) ? 0 : 3;
}

// ---- soft resets

int run_resets(std::size_t resets, std::uint64_t seed) {
  Random random(seed);
  fmt::print("seed={}\n", seed);
  Bench bench(sim::without_timeout(seed), {}, small_rings(), 1);
  Objects objects(Kind::quad);
  objects.place(bench);
  std::size_t wrong = 0, hangs = 0, checked = 0;
  for (std::size_t i = 0; i < resets; ++i) {
    bench.machine().memory().options = any_memory(random);
    for (const Query& query : queries_of(objects, random, 12)) bench.submit(query);
    const std::uint64_t clocks = i % 2 == 0 ? random() % 3000 : random() % 100;
    for (std::uint64_t k = 0; k < clocks; ++k) bench.step();
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
      wrong += compare_answer(query, bench.answers()[k], objects.expected(query), 16).empty() ? 0 : 1;
      ++checked;
    }
  }
  wrong += bench.wrong().size();
  fmt::print("resets={} wrong={} hangs={} checked={}\n", resets, wrong, hangs, checked);
  return resets != 0 && wrong == 0 && hangs == 0 ? 0 : 3;
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
  app.footer("Exit codes: 0 nothing wrong, 3 a wrong or lost answer, others: wrong arguments.");
  CLI11_PARSE(app, argc, argv);
  try {
    if (*poses_command) return PosesCampaign(poses).run();
    if (*faults_command) return run_faults(faults);
    return run_resets(resets, seed);
  } catch (const std::exception& error) {
    fmt::print(stderr, "cchip_chip_campaign: {}\n", error.what());
    return 2;
  }
}
