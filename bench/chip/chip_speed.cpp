// SPDX-License-Identifier: Apache-2.0
// Queries per second of the simulated chip, of the CPU device and of other libraries in the same poses:
// docs/hardware/chip-speed.md.
#include <Vcchip_chip.h>
#include <Vcchip_chip___024root.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/driver/chip_driver.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/internal/wire/chip_registers.hpp>
#include <cchip/machines/chip_machine.hpp>
#include <cchip/machines/probes.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/seed.hpp>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include "ask.hpp"
#include "chip_scaling.hpp"
#include "machine.hpp"
#include "measure.hpp"
#include "other_libraries.hpp"

namespace cchip::testing {
namespace {

namespace regs = cchip::chip_registers;

struct Options {
  std::size_t poses = 200;
  double chip_mhz = 0;
  std::uint64_t seed = sim::seed_from_environment();
  std::vector<std::string> pairs = mesh_pair_names();
  std::string csv = "build/bench/chip.csv";
};

/// What the chip's blocks do on each clock.
struct Use {
  std::uint64_t clocks = 0;
  std::uint64_t box = 0;        ///< a node pair is at the box test
  std::uint64_t bus = 0;        ///< a beat of a read is on the bus
  std::uint64_t transform = 0;  ///< a vertex leaves the transform
  std::uint64_t lane = 0;       ///< an axis leaves the primitive test's controller
  std::uint64_t memory = 0;     ///< none of these, while a line is outstanding
  std::uint64_t inside = 0;     ///< none of these, nothing is outstanding: results and events are on their way
  Use operator-(const Use& x) const {
    return {clocks - x.clocks, box - x.box,       bus - x.bus,      transform - x.transform,
            lane - x.lane,     memory - x.memory, inside - x.inside};
  }
  Use operator+(const Use& x) const {
    return {clocks + x.clocks, box + x.box,       bus + x.bus,      transform + x.transform,
            lane + x.lane,     memory + x.memory, inside + x.inside};
  }
};

class UseObserver : public sim::Agent {
 public:
  explicit UseObserver(const Vcchip_chip& model) : model_(model) {}
  void drive(const sim::ClockInfo&) override {}
  void sample(const sim::ClockInfo&) override {
    const bool box = probes::chip_box_test(model_) != 0;
    const bool bus = model_.m_axi_rvalid != 0 && model_.m_axi_rready != 0;
    const bool transform = (probes::chip_transform(model_) & 1U) != 0;
    const bool lane = probes::chip_lane(model_) != 0;
    const bool outstanding = probes::chip_read_outstanding(model_) != 0;
    const bool idle = !box && !bus && !transform && !lane;
    ++use_.clocks;
    use_.box += box ? 1 : 0;
    use_.bus += bus ? 1 : 0;
    use_.transform += transform ? 1 : 0;
    use_.lane += lane ? 1 : 0;
    use_.memory += idle && outstanding ? 1 : 0;
    use_.inside += idle && !outstanding ? 1 : 0;
  }
  const Use& use() const { return use_; }

 private:
  const Vcchip_chip& model_;
  Use use_;
};

class Machine : public sim::ChipMachine<Vcchip_chip, 128> {
 public:
  explicit Machine(std::uint64_t seed) : ChipMachine(sim::without_timeout(seed)), observer_(simulation().top()) {
    simulation().add(observer_);
  }
  const Use& use() const { return observer_.use(); }

 private:
  UseObserver observer_;
};

/// The chip behind one memory.
struct Chip {
  std::string name;  ///< of the memory
  Machine* machine = nullptr;
  std::unique_ptr<Device> device;

  Chip(std::string memory_name, const sim::AxiLinesOptions& memory, std::uint64_t seed) : name(std::move(memory_name)) {
    auto made = std::make_unique<Machine>(seed);
    machine = made.get();
    machine->memory().options = memory;
    ChipDriverOptions driver;
    driver.memory_bytes = std::uint64_t{1} << 28U;
    device = make_chip_device(open_chip(std::move(made), driver));
  }

  /// The cache invalidates every line.
  void invalidate() const {
    machine->write_register(regs::invalidate_first::offset, 0);
    machine->write_register(regs::invalidate_last::offset, 0xFFFFFFFF);
    machine->write_register(regs::invalidate::offset, regs::invalidate::go_mask);
    while ((machine->read_register(regs::status::offset) & regs::status::invalidating_mask) != 0) machine->proceed();
  }
};

std::vector<Chip> chips(std::uint64_t seed) {
  sim::AxiLinesOptions fast;
  fast.latency = 60;
  sim::AxiLinesOptions slow;
  slow.latency = 100;
  slow.valid_percent = 50;  // every second clock has a beat: what a bus of 64 bit carries
  std::vector<Chip> result;
  result.emplace_back("128 bit, 60 clocks", fast, seed);
  result.emplace_back("64 bit, 100 clocks", slow, seed);
  return result;
}

class Benchmark {
 public:
  explicit Benchmark(const Options& options)
      : options_(options), libraries_(open_libraries()), cpu_(open_cpu_device({1, ""})) {}

  int run() {
    text_ << fmt::format("# machine: {}\n# compiler: {}\n# load before the run: {}\n", machine_description(), compiler,
                         load_description());
    text_ << fmt::format("# chip: {:g} MHz\n# run: seed {}, {} poses of each class\n", options_.chip_mhz, options_.seed,
                         options_.poses);
    for (const NamedLibrary& x : libraries_) text_ << fmt::format("# {}: {}\n", x.name, x.library.description());
    for (const OtherLibrary& other : other_libraries) {
      if (*other.module == 0) text_ << fmt::format("# {}: not in this run; {} brings it\n", other.name, other.remedy);
    }
    fmt::print("{}", text_.str());
    fmt::print(
        "\nqueries/s; chip: clocks a query, and queries/s at {:g} MHz; shares of the chip's clocks in "
        "%\n{:<14}{:<11}{:<20}",
        options_.chip_mhz, "meshes", "class", "memory");
    text_ << "meshes,class,memory,queries,hits";
    for (const std::string& name : ways()) {
      fmt::print("{:>11}", name);
      text_ << ',' << name;
    }
    fmt::print("{:>10}{:>11} {:>5}{:>5}{:>6}{:>6}{:>8}{:>7}\n", "clocks", "chip", "box", "bus", "trans", "lane",
               "memory", "inside");
    text_ << ",clocks,chip,box,bus,transform,lane,memory_wait,inside\n";
    for (const std::string& name : options_.pairs) run_pair(name);
    fmt::print("\ngeometric means, times {}:\n", reference());
    for (const auto& [key, means] : means_) {
      fmt::print("  {:<34} chip {:>7.2f}", key, means.at("chip").value());
      for (const std::string& name : ways()) {
        const auto mean = means.find(name);
        if (mean != means.end() && name != reference()) fmt::print("  {} {:.2f}", name, mean->second.value());
      }
      fmt::print("\n");
    }
    if (!options_.csv.empty()) {
      std::filesystem::create_directories(std::filesystem::path(options_.csv).parent_path());
      sim::OutputFile file(options_.csv);
      file.stream() << text_.str();
      file.commit();
    }
    fmt::print("queries={} differences={} fcl_errs={}\n", queries_, differences_, fcl_errs_);
    return queries_ != 0 && differences_ == 0 ? 0 : 3;
  }

 private:
  /// All that answer beside the chip: "single" and "batch" are the CPU device.
  std::vector<std::string> ways() const {
    std::vector<std::string> result;
    for (const NamedLibrary& x : libraries_) result.push_back(x.name);
    result.insert(result.end(), {"single", "batch"});
    return result;
  }
  /// FCL built natively if there is one, else Debian's.
  const std::string& reference() const {
    return libraries_.size() > 1 && libraries_[1].name == "FCL native" ? libraries_[1].name : libraries_[0].name;
  }

  void run_pair(const std::string& name) {
    const Bodies bodies(mesh_pair(name), libraries_.front().library);
    peers_ = peer_pairs(libraries_, bodies.a.mesh(), bodies.b.mesh());
    PoseMaker maker(*cpu_, bodies.a, bodies.b, options_.seed);
    std::vector<Approach> approaches;
    for (std::size_t i = 0; i < options_.poses; ++i) approaches.push_back(maker.approach());
    const std::vector<Chip> made = chips(options_.seed);
    const auto poses = [&](PoseClass c, std::size_t count) {
      std::vector<PosePair> result;
      for (std::size_t i = 0; i < count; ++i) result.push_back(maker.pose(approaches[i], c));
      return result;
    };
    for (const PoseClass c : pose_classes) run_class(bodies, name_of(c), {}, poses(c, options_.poses), made, false);
    const std::size_t few = std::max<std::size_t>(4, options_.poses / 20);
    for (const PoseClass c : {PoseClass::touch, PoseClass::deep})
      run_class(bodies, std::string(name_of(c)) + " all", all_contacts, poses(c, few), made, false);
    run_class(bodies, "lone", {}, poses(PoseClass::touch, few), made, true);
  }

  /// \param lone one query at a time, after the caches forgot everything
  void run_class(const Bodies& bodies, const std::string& class_name, const CollisionRequest& request,
                 const std::vector<PosePair>& poses, const std::vector<Chip>& made, bool lone) {
    std::vector<CollisionResult> right(poses.size());
    std::vector<std::vector<char>> theirs(peers_.size(), std::vector<char>(poses.size()));
    const std::map<std::string, double> seconds_each = time_peers(bodies, request, poses, right, theirs, lone);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      hits += right[i].hit ? 1 : 0;
      // FCL's yes or no; the others' wrong answers are counted by collide_speed
      if ((theirs.front()[i] != 0) == right[i].hit) continue;
      const Difference x = bodies.judge(poses[i], right[i].hit, right[i].hit ? right[i].contacts.front() : Contact{});
      fcl_errs_ += x.unexplained == 0 ? 1 : 0;
      differences_ += x.unexplained;
    }
    for (const Chip& chip : made) {
      const Use use = answer(chip, bodies, request, poses, right, lone);
      const double n = static_cast<double>(poses.size());
      const double clocks = static_cast<double>(use.clocks) / n;
      report(bodies, class_name, chip.name, poses.size(), hits, seconds_each, clocks, use);
    }
  }

  /// Seconds a query of the CPU device and of each library; their answers.
  std::map<std::string, double> time_peers(const Bodies& bodies, const CollisionRequest& request,
                                           const std::vector<PosePair>& poses, std::vector<CollisionResult>& right,
                                           std::vector<std::vector<char>>& theirs, bool lone) {
    const bool all = request.contacts == CollisionRequest::Contacts::all;
    CollisionResult result;
    std::vector<Variant> ways;
    const auto ask = [&, all](std::size_t k) {
      const PeerPair& peer = peers_[k];
      if (all && !peer.has_contacts) return;
      ways.push_back({peer.name, Clock::cpu, [&, all, k](std::size_t first, std::size_t count) {
                        for (std::size_t i = first; i < first + count; ++i) {
                          const bool hit = all ? peer.a.count_contacts(poses[i].a, peer.b, poses[i].b) != 0
                                               : peer.a.hit(poses[i].a, peer.b, poses[i].b);
                          theirs[k][i] = static_cast<char>(hit);
                        }
                      }});
    };
    ways.push_back({"single", Clock::cpu, [&](std::size_t first, std::size_t count) {
                      for (std::size_t i = first; i < first + count; ++i)
                        cpu_->collide({&bodies.a, &poses[i].a, &bodies.b, &poses[i].b}, request, right[i]);
                    }});
    ask(0);
    if (!lone) {
      ways.push_back({"batch", Clock::cpu, [&](std::size_t first, std::size_t count) {
                        cpu_->collide(
                            count,
                            [&](std::size_t i) {
                              const PosePair& pose = poses[first + i];
                              return CollisionQuery{&bodies.a, &pose.a, &bodies.b, &pose.b};
                            },
                            request, [&](std::size_t, const CollisionResult&) {});
                      }});
    }
    for (std::size_t k = 1; k < peers_.size(); ++k) ask(k);
    std::map<std::string, double> seconds_each;
    if (lone) {
      std::vector<unsigned char> unrelated(std::size_t{96} << 20U);
      std::map<std::string, std::vector<double>> times;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        for (Variant& way : ways) {
          for (std::size_t byte = 0; byte < unrelated.size(); byte += 64) ++unrelated[byte];
          const double start = seconds(Clock::wall);
          way.answer(i, 1);
          times[way.name].push_back(seconds(Clock::wall) - start);
        }
      }
      for (const auto& [name, values] : times) seconds_each[name] = median(values);
      return seconds_each;
    }
    for (int pass = 0; pass < 3; ++pass) measure_pass(ways, poses.size(), 4, [](std::size_t) {});
    for (const Variant& way : ways) seconds_each[way.name] = way.seconds_each();
    return seconds_each;
  }

  /// The chip's answers, which must be the CPU device's. \returns what it did meanwhile
  Use answer(const Chip& chip, const Bodies& bodies, const CollisionRequest& request,
             const std::vector<PosePair>& poses, const std::vector<CollisionResult>& right, bool lone) {
    const bool all = request.contacts == CollisionRequest::Contacts::all;
    const auto check = [&](std::size_t i, const CollisionResult& x) {
      ++queries_;
      const bool same = x.hit == right[i].hit && (!all || x.contacts == right[i].contacts);
      differences_ += same ? 0 : 1;
    };
    CollisionResult result;
    // images are written, and the cache knows the top of the trees
    chip.device->collide({&bodies.a, &poses[0].a, &bodies.b, &poses[0].b}, request, result);
    const Use before = chip.machine->use();
    if (!lone) {
      const std::vector<CollisionResult> got = collide(*chip.device, bodies.a, bodies.b, poses, request);
      const Use use = chip.machine->use() - before;
      for (std::size_t i = 0; i < poses.size(); ++i) check(i, got[i]);
      return use;
    }
    Use sum;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      chip.invalidate();
      const Use start = chip.machine->use();
      chip.device->collide({&bodies.a, &poses[i].a, &bodies.b, &poses[i].b}, request, result);
      sum = sum + (chip.machine->use() - start);
      check(i, result);
    }
    return sum;
  }

  void report(const Bodies& bodies, const std::string& class_name, const std::string& memory, std::size_t queries,
              std::size_t hits, const std::map<std::string, double>& seconds_each, double clocks, const Use& use) {
    const double chip = options_.chip_mhz * 1e6 / clocks;
    const auto share = [&](std::uint64_t part) {
      return 100 * static_cast<double>(part) / static_cast<double>(use.clocks);
    };
    fmt::print("{:<14}{:<11}{:<20}", bodies.name, class_name, memory);
    text_ << fmt::format("{},{},\"{}\",{},{}", bodies.name, class_name, memory, queries, hits);
    const double reference_seconds = seconds_each.at(reference());
    std::map<std::string, GeometricMean>& means = means_[class_name + ", " + memory];
    for (const std::string& name : ways()) {
      const auto found = seconds_each.find(name);
      if (found == seconds_each.end()) {
        fmt::print("{:>11}", "-");
        text_ << ',';
        continue;
      }
      fmt::print("{:>11.0f}", 1 / found->second);
      text_ << fmt::format(",{:.5g}", 1 / found->second);
      if (bodies.counts) means[name].add(reference_seconds / found->second);
    }
    if (bodies.counts) means["chip"].add(chip * reference_seconds);
    fmt::print("{:>10.1f}{:>11.0f} {:>5.0f}{:>5.0f}{:>6.0f}{:>6.0f}{:>8.0f}{:>7.0f}\n", clocks, chip, share(use.box),
               share(use.bus), share(use.transform), share(use.lane), share(use.memory), share(use.inside));
    std::fflush(stdout);
    text_ << fmt::format(",{:.5g},{:.5g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g}\n", clocks, chip, share(use.box),
                         share(use.bus), share(use.transform), share(use.lane), share(use.memory), share(use.inside));
  }

  Options options_;
  std::vector<NamedLibrary> libraries_;  ///< Debian's FCL first
  std::vector<PeerPair> peers_;          ///< the present pair in each of them
  std::unique_ptr<Device> cpu_;
  std::ostringstream text_;
  std::map<std::string, std::map<std::string, GeometricMean>> means_;  ///< class and memory, way
  std::size_t queries_ = 0, differences_ = 0, fcl_errs_ = 0;
};

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  cchip::testing::Options o;
  CLI::App app{
      "Queries per second of the simulated chip, of the CPU device, FCL, Coal, CGAL and ODE in the same poses.\n"
      "Exit codes: 0 done, 3 an answer is not the exact one, 2 the run could not be made."};
  app.add_option("--chip-mhz", o.chip_mhz, "clock of the chip: row chip in docs/hardware/fpga.md")
      ->check(CLI::PositiveNumber)
      ->required();
  app.add_option("--poses", o.poses, "poses of each class and pair of meshes; of all contacts and lone a twentieth")
      ->check(CLI::Range(8, 1000000))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "repeats the poses (or CCHIP_SEED)")->capture_default_str();
  app.add_option("--pairs", o.pairs, "pairs of meshes")
      ->delimiter(',')
      ->check(CLI::IsMember(cchip::testing::mesh_pair_names()))
      ->capture_default_str();
  std::vector<unsigned> chips;
  std::vector<int> widths = {128, 256, 512};
  app.add_option("--chips", chips,
                 "another table: numbers of chips that share one memory (1..8), without the other libraries")
      ->delimiter(',')
      ->check(CLI::Range(1, 8));
  app.add_option("--widths", widths, "with --chips: widths of the memory's bus, bit")
      ->delimiter(',')
      ->check(CLI::IsMember({128, 256, 512}))
      ->capture_default_str();
  app.add_option("--csv", o.csv, "the same figures as a file; empty: none")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (!chips.empty()) return cchip::testing::run_scaling({chips, widths, o.poses, o.chip_mhz, o.seed, o.pairs});
  return cchip::testing::Benchmark(o).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "chip_speed: %s\n", error.what());
  return 2;
}
