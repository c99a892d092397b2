// SPDX-License-Identifier: Apache-2.0
// Two meshes through cchip_chip, by its registers and rings: every record against the functional model, and what a
// query costs.
#include <Vcchip_chip.h>
#include <Vchip_tri.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/waves/wave_layout.hpp>
#include <random>

#include "mesh_pairs.hpp"
#include "port_bench.hpp"

namespace cchip::testing {
namespace {

constexpr int data_w = 128;

struct Settings {
  std::vector<std::string> meshes = {"limbs-limbs"};
  std::vector<std::string> classes = {"touch", "near", "deep", "far"};
  std::size_t poses = 25;
  std::size_t warm = 10;
  std::string modes = "mixed";
  int module = 3;
  sim::AxiLinesOptions memory;
  ChipDriverOptions driver;
  std::uint64_t host_every = 1;
  std::uint64_t seed = sim::seed_from_environment();
  std::string wave;
};

struct Totals {
  std::size_t queries = 0, hits = 0, mismatches = 0, contacts = 0, open = 0, lost = 0, duplicated = 0;
  std::uint64_t clocks = 0;
};

template <class Model>
class Run {
 public:
  using Bench = PortBench<Model, data_w>;

  explicit Run(const Settings& settings) : settings_(settings), device_(open_cpu_device({1, ""})) {}

  int run() {
    fmt::print(
        "seed={} module={} latency={} jitter={} reorder={} ready={}% valid={}% query ring={} record ring={} host every "
        "{}\n",
        settings_.seed, settings_.module, settings_.memory.latency, settings_.memory.jitter, settings_.memory.reorder,
        settings_.memory.ready_percent, settings_.memory.valid_percent, 1U << settings_.driver.query_log2,
        1U << settings_.driver.record_log2, settings_.host_every);
    all_ = settings_.meshes.size() * settings_.classes.size() * (settings_.poses + settings_.warm);
    for (const std::string& name : settings_.meshes) run_pair(name);
    progress_.clear();
    fmt::print("queries={} hits={} mismatches={} contacts={} open={} lost={} duplicated={} clocks_mean={:.1f}\n",
               total_.queries, total_.hits, total_.mismatches, total_.contacts, total_.open, total_.lost,
               total_.duplicated,
               static_cast<double>(total_.clocks) / std::max(1.0, static_cast<double>(total_.queries)));
    return total_.queries != 0 && total_.mismatches == 0 && total_.lost == 0 && total_.duplicated == 0 ? 0 : 3;
  }

 private:
  static_assert(sim::detail::HasTrace<Model>::value, "--wave of this model would write nothing: make it with WAVES");
  static constexpr std::uint64_t traced = 30000;    // clocks of the waveform
  static constexpr std::uint64_t viewed = 5000;     // of these at first sight
  static constexpr std::uint64_t nanoseconds = 10;  // of a clock

  void run_pair(const std::string& name) {
    const MeshPair meshes = mesh_pair(name);
    fmt::print("{}: {} against {} faces\n", name, describe_faces(meshes.a), describe_faces(meshes.b));
    const Object a(meshes.a);
    const Object b(meshes.b);
    const bvh::Image image_a = bvh::make_image(meshes.a, bvh::build_tree(meshes.a));
    const bvh::Image image_b = bvh::make_image(meshes.b, bvh::build_tree(meshes.b));
    PoseMaker maker(*device_, a, b, settings_.seed);
    std::mt19937_64 random(settings_.seed);
    bool has_head = false;
    for (const PoseClass pose_class : {PoseClass::touch, PoseClass::near, PoseClass::deep, PoseClass::far}) {
      const std::string class_name = name_of(pose_class);
      if (std::find(settings_.classes.begin(), settings_.classes.end(), class_name) == settings_.classes.end())
        continue;
      sim::SimulationOptions options = sim::without_timeout(settings_.seed);
      if (!settings_.wave.empty()) {
        options.trace_path = settings_.wave;
        options.trace_clocks = traced;
      }
      Bench bench(options, settings_.memory, settings_.driver, settings_.host_every);
      const std::uint32_t line_a = bench.place(image_a);
      const std::uint32_t line_b = bench.place(image_b);
      if (!settings_.wave.empty()) {
        // The view begins with the first query: before it the cache is cleared and invalidates the lines of both
        // images.
        const std::uint64_t first = bench.clocks();
        if (first + viewed > traced)
          throw std::runtime_error("the waveform ends before the first queries; trace more clocks");
        write_chip_gtkw(settings_.wave, nanoseconds * first, nanoseconds * (first + viewed));
        fmt::print("waveform {}, its layout beside it\n", settings_.wave);
        settings_.wave.clear();
      }
      std::vector<Query> queries;
      for (std::size_t i = 0; i < settings_.poses + settings_.warm; ++i) {
        const PosePair pose = maker.pose(maker.approach(), pose_class);
        std::optional<Query> query = bvh::make_query(image_a.header(), pose.a, image_b.header(), pose.b);
        if (!query) throw std::runtime_error("a pose that the chip does not take");
        query->base_a = query->swapped ? line_b : line_a;
        query->base_b = query->swapped ? line_a : line_b;
        query->mode = settings_.modes == "all" || (settings_.modes == "mixed" && random() % 2 != 0) ? QueryMode::all
                                                                                                    : QueryMode::first;
        queries.push_back(*query);
      }
      if (!has_head) print_head();  // below what is said about the meshes and the waveform
      has_head = true;
      measure(name, class_name, bench, queries, image_a, image_b);
    }
  }

  static void print_head() {
    fmt::print("{:<12} {:<6} {:>7} {:>6} {:>9} {:>6} {:>9} {:>9} {:>9}\n", "meshes", "class", "queries", "hits",
               "contacts", "open", "steps", "pairs", "clocks");
  }

  bool run_to_end(Bench& bench, std::uint64_t most) {
    std::uint64_t steps = 0;
    return bench.run(most, [&] {
      if (++steps % 1024 == 0) progress_.update_of(done_ + bench.answers().size() - bench.unanswered(), all_);
    });
  }

  void measure(const std::string& meshes, const std::string& pose_class, Bench& bench,
               const std::vector<Query>& queries, const bvh::Image& image_a, const bvh::Image& image_b) {
    const std::uint64_t most = 20000 + 4000000 * queries.size();
    for (std::size_t i = 0; i < settings_.warm; ++i) bench.submit(queries[i]);
    bool ends = run_to_end(bench, most);
    namespace regs = chip_registers;
    const std::uint64_t steps = bench.counter(regs::counter_node_pairs::offset);
    const std::uint64_t pairs = bench.counter(regs::counter_primitive_pairs::offset);
    const std::uint64_t clocks = bench.clocks();
    for (std::size_t i = settings_.warm; i < queries.size(); ++i) bench.submit(queries[i]);
    ends = ends && run_to_end(bench, most);
    done_ += queries.size();
    progress_.clear();
    Totals now;
    now.clocks = bench.clocks() - clocks;
    for (std::uint64_t i = 0; i < 2000; i += settings_.host_every) bench.step();  // nothing may follow
    now.queries = queries.size();
    now.lost = bench.unanswered();
    now.duplicated = bench.duplicated();
    if (!ends) fmt::print("{} queries without an answer\n", bench.unanswered());
    for (const std::string& text : bench.wrong()) fmt::print("{}\n", text);
    now.mismatches = bench.wrong().size();
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const ChipAnswer& answer = bench.answers()[i];
      if (!answer.done) continue;
      const Query& query = queries[i];
      const model::BroadPhaseResult expected =
          model::run_query(query, query.swapped ? image_b : image_a, query.swapped ? image_a : image_b);
      const std::string wrong = compare_answer(query, answer, expected, settings_.driver.open_limit);
      now.hits += answer.done->answer == QueryAnswer::yes ? 1 : 0;
      now.contacts += answer.pairs.size();
      for (const PairRecord& x : answer.pairs) now.open += x.definite ? 0 : 1;
      if (wrong.empty()) continue;
      ++now.mismatches;
      fmt::print("query {}: {}: code {} {}, answer {} {}, steps {} {}, records {} {}\n", i, wrong,
                 static_cast<int>(answer.done->code), static_cast<int>(expected.done.code),
                 static_cast<int>(answer.done->answer), static_cast<int>(expected.done.answer), answer.done->steps,
                 expected.done.steps, answer.pairs.size(), expected.pairs.size());
    }
    const double n = std::max(1.0, static_cast<double>(settings_.poses));
    fmt::print("{:<12} {:<6} {:>7} {:>6} {:>9} {:>6} {:>9.2f} {:>9.1f} {:>9.1f}\n", meshes, pose_class, now.queries,
               now.hits, now.contacts, now.open,
               static_cast<double>(bench.counter(regs::counter_node_pairs::offset) - steps) / n,
               static_cast<double>(bench.counter(regs::counter_primitive_pairs::offset) - pairs) / n,
               static_cast<double>(now.clocks) / n);
    std::fflush(stdout);
    total_.queries += now.queries;
    total_.hits += now.hits;
    total_.mismatches += now.mismatches;
    total_.contacts += now.contacts;
    total_.open += now.open;
    total_.lost += now.lost;
    total_.duplicated += now.duplicated;
    total_.clocks += now.clocks * queries.size() / std::max<std::size_t>(1, settings_.poses);
  }

  Settings settings_;
  std::unique_ptr<Device> device_;
  Totals total_;
  Progress progress_{"queries"};  // on a terminal
  std::uint64_t done_ = 0;        // queries of the classes before
  std::uint64_t all_ = 0;
};

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) {
  using namespace cchip::testing;
  CLI::App app("Queries of two meshes through the whole chip in RTL, record by record against the functional model.");
  Settings settings;
  app.add_option("--meshes", settings.meshes, "pairs of meshes")->delimiter(',')->capture_default_str();
  app.add_option("--classes", settings.classes, "touch, near, deep, far")->delimiter(',')->capture_default_str();
  app.add_option("--poses", settings.poses, "poses of each class")->capture_default_str();
  app.add_option("--warm", settings.warm, "poses before these, which fill the cache")->capture_default_str();
  app.add_option("--modes", settings.modes, "first, all or mixed")
      ->check(CLI::IsMember({"first", "all", "mixed"}))
      ->capture_default_str();
  app.add_option("--module", settings.module, "module of the slot: 1 triangles, 3 quads")
      ->check(CLI::IsMember({1, 3}))
      ->capture_default_str();
  app.add_option("--seed", settings.seed, "of the poses and of memory")->capture_default_str();
  app.add_option("--latency", settings.memory.latency, "clocks from an address to its first beat")
      ->capture_default_str();
  app.add_option("--jitter", settings.memory.jitter, "up to this many more, at random")->capture_default_str();
  app.add_flag("--reorder", settings.memory.reorder, "memory answers reads in any order");
  unsigned stall = 0;
  app.add_option("--stall", stall, "per cent of the clocks on which a channel of memory rests")
      ->check(CLI::Range(0, 99))
      ->capture_default_str();
  app.add_option("--query-ring", settings.driver.query_log2, "lines, as a power of two")
      ->check(CLI::Range(0, 15))
      ->capture_default_str();
  app.add_option("--record-ring", settings.driver.record_log2, "records, as a power of two")
      ->check(CLI::Range(3, 16))
      ->capture_default_str();
  app.add_option("--host-every", settings.host_every, "clocks from one look of the host at its rings to the next")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--lowest-address", settings.driver.memory_base, "of the rings and images, a multiple of 64")
      ->capture_default_str();
  app.add_option("--wave", settings.wave, "waveform of the beginning, FST");
  app.footer("Exit codes: 0 nothing wrong, 3 a wrong or a lost answer, others: wrong arguments.");
  CLI11_PARSE(app, argc, argv);
  settings.memory.ready_percent = settings.memory.valid_percent = 100 - stall;
  try {
    return settings.module == 1 ? Run<Vchip_tri>(settings).run() : Run<Vcchip_chip>(settings).run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "cchip_chip_run: {}\n", error.what());
    return 2;
  }
}
