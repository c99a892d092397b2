// SPDX-License-Identifier: Apache-2.0
// Two meshes of real size through cchip_broad_phase_axi: leaf pairs and answers against the functional model, and
// what it costs.
#include <Vbroad_phase.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/machines/simulated_broad_phase.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <set>

#include "mesh_pairs.hpp"

namespace cchip::testing {
namespace {

struct BroadPhase {
  using Model = Vbroad_phase;
  static constexpr int DATA_W = 128;
  static constexpr int LOCKS = 2;
};
constexpr std::uint64_t line_of_a = 0x10000;

struct Settings {
  std::vector<std::string> meshes = {mesh_pair_names().begin(), mesh_pair_names().begin() + 5};
  std::size_t poses = 100;
  std::size_t warm = 20;
  std::uint64_t seed = sim::seed_from_environment();
  sim::AxiLinesOptions memory;
  std::size_t at_once = 0;
  unsigned pairs_each = 3;
  std::uint32_t lock = 512;  ///< lines of each image, from its first one
  std::vector<std::string> modes = {"first", "all"};
  std::string wave;
};

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// An object's image in memory, and which leaf has which face.
struct Placed {
  bvh::Image image;
  std::uint64_t line = 0;
  std::map<std::uint32_t, std::uint32_t> first_face;  ///< line of a leaf: number of its first face
  explicit Placed(const Mesh& mesh, std::uint64_t at) : image(bvh::make_image(mesh, bvh::build_tree(mesh))), line(at) {
    for (std::uint32_t i = image.header().root; i < image.lines.size(); ++i) {
      // lines below the root are visited by their parents: only inner ones tell what their children are
      if (leaf_.count(i) != 0) continue;
      const bvh::InnerLine node = bvh::decode_inner(image.lines[i]);
      for (int c = 0; c < node.children; ++c) {
        const auto kind = node.kind[static_cast<std::size_t>(c)];
        if (kind == bvh::NodeKind::inner) continue;
        const std::uint32_t number = node.first + static_cast<std::uint32_t>(c);
        leaf_.insert(number);
        first_face[number] = bvh::decode_leaf(image.lines[number], kind).id[0];
      }
    }
  }

 private:
  std::set<std::uint32_t> leaf_;
};

struct Totals {
  std::size_t queries = 0;
  std::size_t mismatches = 0;
  std::size_t lost = 0;
  std::uint64_t hits = 0;
  sim::BroadPhaseCounters counters;
};

class Run {
 public:
  explicit Run(const Settings& settings) : settings_(settings), device_(open_cpu_device({1, ""})) {}

  int run() {
    fmt::print("seed={} latency={} jitter={} reorder={} beat_every={} poses={} of each class, after {} more\n",
               settings_.seed, settings_.memory.latency, settings_.memory.jitter, settings_.memory.reorder,
               settings_.memory.beat_every, settings_.poses, settings_.warm);
    fmt::print("{:<12} {:<6} {:<6} {:>7} {:>6} {:>8} {:>8} {:>9} {:>8} {:>9} {:>8} {:>9} {:>6} {:>6} {:>6}\n", "meshes",
               "class", "mode", "queries", "hits", "alone", "steps", "boxtests", "leaves", "clocks", "hitrate", "bytes",
               "box", "bus", "lane");
    for (const std::string& name : settings_.meshes) run_pair(name);
    const double n = std::max(1.0, static_cast<double>(total_.queries));
    fmt::print(
        "queries={} mismatches={} lost={} steps={} box_tests={} leaf_pairs={} clocks_mean={:.1f} hit_rate={:.3f} "
        "bytes_mean={:.0f}\n",
        total_.queries, total_.mismatches, total_.lost, total_.counters.steps, total_.counters.box_tests,
        total_.counters.leaf_pairs, static_cast<double>(total_.counters.clocks) / n, hit_rate(total_.counters),
        static_cast<double>(bytes(total_.counters)) / n);
    return total_.mismatches == 0 && total_.lost == 0 ? 0 : 3;
  }

 private:
  static std::uint64_t bytes(const sim::BroadPhaseCounters& c) { return c.beats * BroadPhase::DATA_W / 8; }
  static double hit_rate(const sim::BroadPhaseCounters& c) {
    const auto all = static_cast<double>(c.hits + c.misses + c.waits);
    return all == 0 ? 0 : static_cast<double>(c.hits) / all;
  }

  void run_pair(const std::string& name) {
    const MeshPair meshes = mesh_pair(name);
    fmt::print("{}: {} against {} faces\n", name, describe_faces(meshes.a), describe_faces(meshes.b));
    const Object a(meshes.a);
    const Object b(meshes.b);
    const Placed image_a(meshes.a, line_of_a);
    // the first 512 lines of both have sets of their own, so that they can be locked together
    const Placed image_b(meshes.b, line_of_a + 512 + (image_a.image.lines.size() + 1023) / 1024 * 1024);
    PoseMaker maker(*device_, a, b, settings_.seed);
    std::vector<Approach> approaches;
    for (std::size_t i = 0; i < settings_.poses + settings_.warm; ++i) approaches.push_back(maker.approach());
    for (const PoseClass pose_class : {PoseClass::touch, PoseClass::near, PoseClass::deep, PoseClass::far}) {
      std::vector<Query> queries;
      for (const Approach& approach : approaches) {
        const PosePair pose = maker.pose(approach, pose_class);
        std::optional<Query> query = bvh::make_query(image_a.image.header(), pose.a, image_b.image.header(), pose.b);
        if (!query) throw std::runtime_error("a pose that the chip does not take");
        const Placed& moved = query->swapped ? image_b : image_a;
        const Placed& fixed = query->swapped ? image_a : image_b;
        query->base_a = static_cast<std::uint32_t>(moved.line);
        query->base_b = static_cast<std::uint32_t>(fixed.line);
        queries.push_back(*query);
      }
      for (const std::string& mode : settings_.modes) {
        for (Query& query : queries) query.mode = mode == "all" ? QueryMode::all : QueryMode::first;
        measure(name, name_of(pose_class), mode, queries, image_a, image_b);
      }
    }
  }

  void measure(const std::string& meshes, const std::string& pose_class, const std::string& mode,
               const std::vector<Query>& queries, const Placed& image_a, const Placed& image_b) {
    sim::SimulationOptions options = sim::without_timeout(settings_.seed);
    if (!settings_.wave.empty()) {
      options.trace_path = settings_.wave;
      options.trace_clocks = 7000;
      write_broad_phase_gtkw(settings_.wave, 10000, 30000);  // the cache is clear after 1024 clocks
      fmt::print("waveform {}, its layout beside it\n", settings_.wave);
    }
    settings_.wave.clear();
    sim::SimulatedBroadPhase<BroadPhase> bench(options);
    bench.memory().options = settings_.memory;
    bench.at_once = settings_.at_once;
    bench.top().pairs_each = static_cast<CData>(settings_.pairs_each);
    bench.place(image_a.line, image_a.image.lines);
    bench.place(image_b.line, image_b.image.lines);
    if (settings_.lock != 0) {
      const auto last = [this](const Placed& x) {
        return static_cast<std::uint32_t>(x.line + std::min<std::size_t>(settings_.lock, x.image.lines.size()) - 1);
      };
      bench.set_lock(0, static_cast<std::uint32_t>(image_a.line), last(image_a));
      bench.set_lock(1, static_cast<std::uint32_t>(image_b.line), last(image_b));
    }
    std::size_t lost = 0;
    const auto run = [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) bench.submit(queries[i]);
      try {
        bench.run(20000 + 2000000 * (to - from));
      } catch (const sim::SimulationTimeout& error) {
        fmt::print("{}\n", error.what());
        lost += bench.unanswered();
      }
    };
    run(0, settings_.warm);
    bench.clear_counters();
    if (lost == 0) run(settings_.warm, queries.size());
    const sim::BroadPhaseCounters& spent = bench.counters();
    std::size_t hits = 0;
    std::size_t mismatches = 0;
    steps_alone_ = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (i >= bench.answers().size() || !bench.answers()[i].done) continue;
      mismatches += compare(queries[i], bench.answers()[i], image_a, image_b, i >= settings_.warm);
      if (i >= settings_.warm) hits += bench.answers()[i].done->answer == QueryAnswer::yes;
    }
    const double n = std::max(1.0, static_cast<double>(settings_.poses));
    const auto mean = [n](std::uint64_t x) { return static_cast<double>(x) / n; };
    const double clocks = std::max(1.0, static_cast<double>(spent.clocks));
    fmt::print(
        "{:<12} {:<6} {:<6} {:>7} {:>6} {:>8.2f} {:>8.2f} {:>9.1f} {:>8.2f} {:>9.1f} {:>8.3f} {:>9.0f} {:>6.2f} "
        "{:>6.2f} {:>6.2f}\n",
        meshes, pose_class, mode, settings_.poses, hits, mean(steps_alone_), mean(spent.steps), mean(spent.box_tests),
        mean(spent.leaf_pairs), mean(spent.clocks), hit_rate(spent), mean(bytes(spent)),
        static_cast<double>(spent.box_busy) / clocks, static_cast<double>(spent.beats) / clocks,
        static_cast<double>(spent.lane_busy) / clocks);
    std::fflush(stdout);
    total_.queries += settings_.poses;
    total_.mismatches += mismatches;
    total_.lost += lost;
    total_.counters += spent;
  }

  /// 0 if the answer is the model's: all of it in mode ALL; whether they meet, and no leaf pair that the model
  /// does not have, in mode FIRST.
  std::size_t compare(const Query& query, const sim::BroadPhaseAnswer& answer, const Placed& image_a,
                      const Placed& image_b, bool counts) {
    const Placed& moved = query.swapped ? image_b : image_a;
    const Placed& fixed = query.swapped ? image_a : image_b;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> lines;
    model::BroadPhaseOptions options;
    options.leaf_pairs = &lines;
    Query all = query;
    const model::BroadPhaseResult expected = run_query(all, moved.image, fixed.image, options);
    if (counts) steps_alone_ += expected.done.steps;
    // A query for the first hit ends at a definite one or at the limit of open ones, whichever comes first: that
    // depends on the order when there are both.
    const bool limit = query.mode == QueryMode::first &&
                       (answer.done->code == QueryCode::host || expected.done.code == QueryCode::host);
    bool definite = false;
    for (const PairRecord& pair : answer.pairs) definite = definite || pair.definite;
    std::string wrong;
    if (limit) {
      const bool host = answer.done->code == QueryCode::host && answer.pairs.size() >= options.open_limit;
      if (answer.done->answer == QueryAnswer::yes ? !definite || answer.done->code != QueryCode::ok : !host) {
        wrong = "end at the limit of open pairs";
      }
    } else {
      if (answer.done->code != expected.done.code) wrong = "code";
      if (answer.done->answer != expected.done.answer) wrong = "answer";
    }
    if (answer.done->pairs != answer.pairs.size() && query.mode == QueryMode::all) wrong = "number of pairs";
    Pairs leaves;
    for (const auto& [line_a, line_b] : lines) leaves.emplace(moved.first_face.at(line_a), fixed.first_face.at(line_b));
    const Pairs seen(answer.leaf_pairs.begin(), answer.leaf_pairs.end());
    const bool whole = query.mode == QueryMode::all || expected.done.answer == QueryAnswer::no;
    if (whole) {
      if (seen != leaves || answer.leaf_pairs.size() != lines.size()) wrong = "leaf pairs";
      if (answer.done->steps != expected.done.steps) wrong = "steps";
    } else if (answer.done->answer == QueryAnswer::yes && !definite) {
      wrong = "no definite hit";
    }
    if (wrong.empty()) return 0;
    fmt::print("query {}: {}: code {} {}, answer {} {}, steps {} {}, pairs {} {}, leaf pairs {} {}\n", query.tag, wrong,
               static_cast<int>(answer.done->code), static_cast<int>(expected.done.code),
               static_cast<int>(answer.done->answer), static_cast<int>(expected.done.answer), answer.done->steps,
               expected.done.steps, answer.done->pairs, expected.done.pairs, answer.leaf_pairs.size(), lines.size());
    return 1;
  }

  Settings settings_;
  std::unique_ptr<Device> device_;
  Totals total_;
  std::uint64_t steps_alone_ = 0;  ///< of the model, which has one node pair in flight
};

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) {
  using namespace cchip::testing;
  CLI::App app("Queries of two meshes through the broad phase in RTL, against the functional model.");
  Settings settings;
  app.add_option("--meshes", settings.meshes, "pairs of meshes")->delimiter(',')->capture_default_str();
  app.add_option("--poses", settings.poses, "poses of each class")->capture_default_str();
  app.add_option("--warm", settings.warm, "poses before these, which fill the cache")->capture_default_str();
  app.add_option("--seed", settings.seed, "of the poses and of memory")->capture_default_str();
  app.add_option("--modes", settings.modes, "first, all")->delimiter(',')->capture_default_str();
  app.add_option("--latency", settings.memory.latency, "clocks from an address to its first beat")
      ->capture_default_str();
  app.add_option("--jitter", settings.memory.jitter, "up to this many more, at random")->capture_default_str();
  app.add_option("--beat-every", settings.memory.beat_every, "clocks from one beat to the next")->capture_default_str();
  app.add_flag("--reorder", settings.memory.reorder, "memory answers in any order");
  app.add_option("--at-once", settings.at_once, "queries that may be unanswered; 0: no limit")->capture_default_str();
  app.add_option("--pairs-each", settings.pairs_each, "node pairs of a query in flight")
      ->check(CLI::Range(1, 7))
      ->capture_default_str();
  app.add_option("--lock", settings.lock, "lines of each image that stay in the cache")->capture_default_str();
  app.add_option("--wave", settings.wave, "waveform of the beginning, FST");
  app.footer("Exit codes: 0 nothing wrong, 3 a wrong or a lost answer, others: wrong arguments.");
  CLI11_PARSE(app, argc, argv);
  try {
    return Run(settings).run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "cchip_traverse: {}\n", error.what());
    return 2;
  }
}
