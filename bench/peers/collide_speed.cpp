// SPDX-License-Identifier: Apache-2.0
// Queries per second of the CPU device and of other libraries in the same run, in turns, in the same poses:
// docs/cpp/speed.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "ask.hpp"
#include "machine.hpp"
#include "measure.hpp"
#include "other_libraries.hpp"

namespace cchip::testing {
namespace {

/// What a native build of FCL gained over Debian's where both were measured before (git e5efcc4 of FCL); stands in for
/// a native FCL where there is none.
constexpr double assumed_native_gain = 2.3;

constexpr const char* table_classes[] = {"touch",    "near",     "deep", "far",        "graze",     "touch all",
                                         "deep all", "coherent", "lone", "touch warm", "touch cold"};

/// What the caches hold when a variant begins a chunk.
enum class Caches {
  as_left,  ///< what the variants before it have read
  warm,     ///< what the chunk's queries need
  cold      ///< something else
};

/// Paths by the length of their steps, times that of "coherent".
struct Steps {
  const char* name;
  double step;
  const char* about;  ///< turn and move
};
constexpr Steps path_steps[] = {{"coherent / 10", 0.1, "0.05 degrees, 0.0001 of the size"},
                                {"coherent", 1, "0.5 degrees, 0.001"},
                                {"coherent x 10", 10, "5 degrees, 0.01"}};

bool is_flush(const std::string& class_name) { return class_name.rfind("flush", 0) == 0; }

bool is_fcl(const std::string& variant) { return variant.rfind("FCL", 0) == 0; }

struct Options {
  std::size_t poses = 3000;
  int passes = 3;
  std::uint64_t seed = sim::seed_from_environment();
  std::vector<std::string> pairs = mesh_pair_names();
  std::string csv = "build/bench/collide.csv";
  bool quick = false;
};

/// Rows of the CSV file, which scripts/plot_speed.py reads.
class Rows {
 public:
  void note(const std::string& key, const std::string& value) { text_ << "# " << key << ": " << value << '\n'; }
  void head() {
    text_ << "table,meshes,class,variant,queries,hits,seconds_each,steps,box_tests,pairs,open,bytes,differ\n";
  }
  void add(const std::string& table, const std::string& meshes, const std::string& pose_class,
           const std::string& variant, std::size_t queries, std::size_t hits, double seconds_each,
           const CollisionStats& counts = {}, double bytes = 0, std::size_t differ = 0) {
    const double n = std::max(1.0, static_cast<double>(queries));
    text_ << fmt::format("{},{},{},{},{},{},{:.4g},{:.5g},{:.5g},{:.5g},{:.5g},{:.4g},{}\n", table, meshes, pose_class,
                         variant, queries, hits, seconds_each, static_cast<double>(counts.steps) / n,
                         static_cast<double>(counts.box_tests) / n, static_cast<double>(counts.pairs) / n,
                         static_cast<double>(counts.open) / n, bytes, differ);
  }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

/// The answers of one variant in one pass. They outlive the clock's run, so nothing of them may be optimised away.
struct Answers {
  const PeerPair* peer = nullptr;  ///< null: ours
  std::vector<char> hit;
  std::vector<Contact> witness;
  std::size_t contacts = 0;
  CollisionStats stats;
  explicit Answers(std::size_t queries) : hit(queries), witness(queries) {}
  void take(std::size_t i, const CollisionResult& result) {
    hit[i] = static_cast<char>(result.hit);
    if (result.hit) witness[i] = result.contacts.front();
    contacts += result.contacts.size();
    stats += result.stats;
  }
  std::size_t differ_from(const Answers& ours) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < hit.size(); ++i) count += hit[i] != ours.hit[i] ? 1 : 0;
    return count;
  }
};

class Benchmark {
 public:
  explicit Benchmark(const Options& options) : options_(options), libraries_(open_libraries()), progress_("queries") {
    const std::vector<std::string> targets = cpu_targets();
    for (std::size_t i = 0; i < targets.size(); ++i) {
      targets_.push_back({targets[i], open_cpu_device({1, targets[i]})});
    }
    all_cores_ = open_cpu_device();
  }

  int run() {
    rows_.note("machine", machine_description());
    rows_.note("compiler", compiler);
    rows_.note("load before the run", load_description());
    rows_.note("Debian's FCL", debian().description());
    rows_.note("native FCL", find("FCL native") != nullptr ? find("FCL native")->description()
                                                           : "none, Debian's time divided by 2.3 instead");
    for (const OtherLibrary& other : other_libraries) {
      const PeerLibrary* library = find(other.name);
      rows_.note(other.name, library != nullptr ? library->description()
                                                : fmt::format("not in this run; {} brings it", other.remedy));
    }
    std::string names;
    for (const Target& target : targets_) names += (names.empty() ? "" : ", ") + target.name;
    rows_.note("instruction sets", names);
    rows_.note("run", fmt::format("seed {}, {} passes of {} poses, of all contacts {}", options_.seed, options_.passes,
                                  options_.poses, all_poses()));
    fmt::print("{}", rows_.text());
    rows_.head();
    fmt::print(
        "\nqueries/s, in brackets times FCL built natively{}; batch: one thread; cores: batch on all, wall clock\n"
        "{:<14}{:<12}{:>6}{:>9}{:>9}{:>18}{:>18}{:>11}{:>7}{:>8}{:>8}{:>7}\n",
        find("FCL native") != nullptr ? "" : " (Debian's time / 2.3)", "meshes", "class", "hits", "Debian", "native",
        "single", "batch", "cores", "steps", "boxes", "pairs", "open");
    for (const std::string& name : options_.pairs) run_pair(name);
    run_scene();
    run_flush();
    print_targets();
    print_libraries();
    print_relation();
    print_hints();
    print_flush();
    print_objects();
    return summary();
  }

 private:
  struct Target {
    std::string name;
    std::unique_ptr<Device> device;
  };

  const PeerLibrary& debian() const { return libraries_.front().library; }
  /// Null: not in this run.
  const PeerLibrary* find(const std::string& name) const {
    for (const NamedLibrary& x : libraries_) {
      if (x.name == name) return &x.library;
    }
    return nullptr;
  }
  std::size_t all_poses() const { return std::max<std::size_t>(4, options_.poses / 30); }
  Device& best() { return *targets_.front().device; }
  std::function<void(std::size_t)> tick() {
    return [this](std::size_t count) {
      done_ += count;
      progress_.update(done_, -1);
    };
  }

  /// Seconds that FCL built natively takes, measured or assumed.
  static double native_seconds(const std::map<std::string, double>& seconds) {
    const auto found = seconds.find("FCL native");
    return found != seconds.end() ? found->second : seconds.at("FCL Debian") / assumed_native_gain;
  }

  void run_pair(const std::string& name) {
    MeshPair meshes = mesh_pair(name);
    print_build(meshes);
    const Bodies bodies(std::move(meshes), debian());
    peers_ = peer_pairs(libraries_, bodies.a.mesh(), bodies.b.mesh());
    PoseMaker maker(best(), bodies.a, bodies.b, options_.seed);
    std::vector<std::vector<Approach>> approaches(static_cast<std::size_t>(options_.passes));
    for (auto& pass : approaches) {
      for (std::size_t i = 0; i < options_.poses; ++i) {
        pass.push_back(maker.approach());
        tick()(1);
      }
    }
    for (const PoseClass c : pose_classes) {
      const auto poses = [&](int pass) {
        std::vector<PosePair> result;
        for (const Approach& approach : approaches[static_cast<std::size_t>(pass)]) {
          result.push_back(maker.pose(approach, c));
        }
        return result;
      };
      run_class(bodies, name_of(c), CollisionRequest{}, poses, 8, true);
    }
    if (!bodies.counts) return;
    for (const PoseClass c : {PoseClass::touch, PoseClass::deep}) {
      const auto poses = [&](int pass) {
        std::vector<PosePair> result;
        for (std::size_t i = 0; i < all_poses(); ++i) {
          result.push_back(maker.pose(approaches[static_cast<std::size_t>(pass)][i], c));
        }
        return result;
      };
      run_class(bodies, std::string(name_of(c)) + " all", all_contacts, poses, 4, false);
    }
    for (const Steps& steps : path_steps) {
      const auto paths = [&](int) {
        std::vector<PosePair> poses;
        while (poses.size() < options_.poses) {
          const std::size_t count = std::min<std::size_t>(100, options_.poses - poses.size());
          const std::vector<PosePair> more = maker.path(count, steps.step);
          poses.insert(poses.end(), more.begin(), more.end());
        }
        return poses;
      };
      run_class(bodies, steps.name, CollisionRequest{}, paths, 8, false);
    }
    for (const Caches caches : {Caches::warm, Caches::cold}) {
      const auto poses = [&](int pass) {
        std::vector<PosePair> result;
        for (const Approach& approach : approaches[static_cast<std::size_t>(pass)]) {
          result.push_back(maker.pose(approach, PoseClass::touch));
        }
        return result;
      };
      const std::size_t chunks = std::max<std::size_t>(1, options_.poses / 125);
      run_class(bodies, caches == Caches::warm ? "touch warm" : "touch cold", CollisionRequest{}, poses, chunks, false,
                caches);
    }
    run_lone(bodies, maker, approaches);
  }

  /// Ways to answer the queries of one pass about one pair of meshes.
  std::vector<Variant> variants(const Bodies& bodies, const CollisionRequest& request,
                                const std::vector<PosePair>& poses, std::vector<Answers>& answers, bool all_targets) {
    const bool all = request.contacts == CollisionRequest::Contacts::all;
    std::vector<Variant> result;
    answers.clear();
    answers.reserve(2 * targets_.size() + 3 + peers_.size());  // the variants refer to its elements
    CollisionRequest telling = request;
    telling.relation = true;
    const auto ask = [&](const std::string& name, Clock clock, Device& device, bool batch,
                         const CollisionRequest& asked) {
      Answers& mine = answers.emplace_back(poses.size());
      const auto query = [&bodies, &poses](std::size_t i) {
        return CollisionQuery{&bodies.a, &poses[i].a, &bodies.b, &poses[i].b};
      };
      if (batch) {
        result.push_back({name, clock, [&, query, asked](std::size_t first, std::size_t count) {
                            device.collide(
                                count, [&](std::size_t i) { return query(first + i); }, asked,
                                [&](std::size_t i, const CollisionResult& r) { mine.take(first + i, r); });
                          }});
      } else {
        result.push_back({name, clock, [&, query, asked](std::size_t first, std::size_t count) {
                            for (std::size_t i = first; i < first + count; ++i) {
                              device.collide(query(i), asked, result_);
                              mine.take(i, result_);
                            }
                          }});
      }
    };
    const auto ours = [&](const std::string& name, Clock clock, Device& device, bool batch) {
      ask(name, clock, device, batch, request);
    };
    const auto theirs = [&](const PeerPair& peer) {
      if (all && !peer.has_contacts) return;
      Answers& mine = answers.emplace_back(poses.size());
      mine.peer = &peer;
      result.push_back({peer.name, Clock::cpu, [&, all](std::size_t first, std::size_t count) {
                          for (std::size_t i = first; i < first + count; ++i) {
                            if (all) {
                              const std::size_t found = peer.a.count_contacts(poses[i].a, peer.b, poses[i].b);
                              mine.hit[i] = static_cast<char>(found > 0);
                              mine.contacts += found;
                            } else {
                              mine.hit[i] = static_cast<char>(peer.a.hit(poses[i].a, peer.b, poses[i].b));
                            }
                          }
                        }});
    };
    ours("single", Clock::cpu, best(), false);
    theirs(peers_.front());
    if (!all) {
      Answers& mine = answers.emplace_back(poses.size());
      result.push_back({"hint", Clock::cpu, [&, request](std::size_t first, std::size_t count) {
                          result_.contacts.clear();
                          for (std::size_t i = first; i < first + count; ++i) {
                            best().collide({&bodies.a, &poses[i].a, &bodies.b, &poses[i].b, result_}, request, result_);
                            mine.take(i, result_);
                          }
                        }});
    }
    ask("relation", Clock::cpu, best(), false, telling);
    ours("batch", Clock::cpu, best(), true);
    for (std::size_t i = 1; i < peers_.size(); ++i) theirs(peers_[i]);
    ours("cores", Clock::wall, *all_cores_, true);
    for (std::size_t i = 1; all_targets && i < targets_.size(); ++i) {
      ours("single " + targets_[i].name, Clock::cpu, *targets_[i].device, false);
      ours("batch " + targets_[i].name, Clock::cpu, *targets_[i].device, true);
    }
    return result;
  }

  void run_class(const Bodies& bodies, const std::string& class_name, const CollisionRequest& request,
                 const std::function<std::vector<PosePair>(int)>& make_poses, std::size_t chunks, bool all_targets,
                 Caches caches = Caches::as_left) {
    std::vector<std::vector<double>> passes;
    std::vector<std::string> names;
    std::size_t queries = 0;
    std::size_t hits = 0;
    std::map<std::string, std::size_t> differ;
    CollisionStats counts;
    for (int pass = 0; pass < options_.passes; ++pass) {
      const std::vector<PosePair> poses = make_poses(pass);
      std::vector<Answers> answers;
      std::vector<Variant> ways = variants(bodies, request, poses, answers, all_targets);
      measure_pass(ways, poses.size(), chunks, tick(), [&](std::size_t number, std::size_t first, std::size_t count) {
        if (caches == Caches::cold) fill_caches();
        if (caches != Caches::warm) return;
        Answers& mine = answers[number];
        const CollisionStats before = mine.stats;
        const std::size_t contacts = mine.contacts;
        ways[number].answer(first, count);
        mine.stats = before;
        mine.contacts = contacts;
      });
      passes.resize(ways.size());
      names.clear();
      for (std::size_t i = 0; i < ways.size(); ++i) {
        names.push_back(ways[i].name);
        passes[i].push_back(ways[i].passes.front());
        differ[ways[i].name] += answers[i].differ_from(answers.front());
      }
      queries += poses.size();
      counts += answers.front().stats;
      hits += static_cast<std::size_t>(std::count(answers.front().hit.begin(), answers.front().hit.end(), 1));
      compare(bodies, class_name, request, poses, ways, answers);
    }
    std::map<std::string, double> seconds;
    for (std::size_t i = 0; i < names.size(); ++i) seconds[names[i]] = median(passes[i]);
    report(bodies.name, class_name, queries, hits, names, seconds, differ, counts, bodies.counts);
  }

  /// Counts the answers that are not ours, and those that exact integers do not explain.
  void compare(const Bodies& bodies, const std::string& class_name, const CollisionRequest& request,
               const std::vector<PosePair>& poses, const std::vector<Variant>& ways,
               const std::vector<Answers>& answers) {
    const Answers& first = answers.front();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t k = 1; k < answers.size(); ++k) {
        ++compared_;
        if (answers[k].hit[i] == first.hit[i]) continue;
        Difference difference = {0, 1};  // two variants of ours must not differ
        if (const PeerPair* peer = answers[k].peer) {
          if (first.hit[i] != 0) {
            difference = bodies.judge(poses[i], true, first.witness[i]);
          } else if (peer->has_contacts) {
            difference = bodies.judge(poses[i], {}, peer->a.contacts(poses[i].a, peer->b, poses[i].b));
          } else {
            difference = bodies.judge(poses[i], false, {});
          }
        }
        note(difference, bodies.name, class_name, ways[k].name, i);
      }
      if (request.contacts != CollisionRequest::Contacts::all) continue;
      ++compared_;
      best().collide({&bodies.a, &poses[i].a, &bodies.b, &poses[i].b}, request, result_);
      note(bodies.judge(poses[i], result_.contacts, bodies.fcl_a.contacts(poses[i].a, bodies.fcl_b, poses[i].b)),
           bodies.name, class_name, "contacts", i);
    }
    for (std::size_t k = 1; k < answers.size(); ++k) {
      const bool same = answers[k].peer != nullptr || answers[k].contacts == first.contacts ||
                        request.contacts != CollisionRequest::Contacts::all;
      if (!same) note({0, 1}, bodies.name, class_name, ways[k].name + ", number of contacts", 0);
    }
  }

  void note(const Difference& difference, const std::string& meshes, const std::string& class_name,
            const std::string& variant, std::size_t pose) {
    if (is_fcl(variant) || variant == "contacts") {
      fcl_errs_ += difference.asked - std::min(difference.asked, difference.unexplained);
    }
    differences_ += difference.unexplained;
    if (difference.unexplained == 0) return;
    progress_.clear();
    fmt::print("{}, {}, {}: answer {} differs, {} pairs of faces\n", meshes, class_name, variant, pose,
               difference.unexplained);
  }

  /// \param differ answers of each variant that are not ours
  void report(const std::string& meshes, const std::string& class_name, std::size_t queries, std::size_t hits,
              const std::vector<std::string>& names, const std::map<std::string, double>& seconds,
              const std::map<std::string, std::size_t>& differ, const CollisionStats& counts, bool in_means) {
    for (const std::string& name : names) {
      // A table of its own keeps what is never in the means apart.
      rows_.add(is_flush(class_name) ? "flush" : "query", meshes, class_name, name, queries, hits, seconds.at(name),
                counts, 0, differ.at(name));
      differ_[class_name][name] += differ.at(name);
    }
    queries_[class_name] += queries;
    hits_[class_name] += hits;
    if (is_flush(class_name)) {
      for (const auto& [name, time] : seconds) means_["flush"][name].add(native_seconds(seconds) / time);
    }
    if (is_flush(class_name)) flush_.push_back({meshes, class_name, queries, differ.at("FCL Debian"), 0, seconds});
    const double reference = native_seconds(seconds);
    const bool boolean = class_name == "touch" || class_name == "near" || class_name == "deep";
    if (in_means) {
      for (const auto& [name, time] : seconds) means_[class_name][name].add(reference / time);
      if (boolean) {
        for (const auto& [name, time] : seconds) means_["booleans"][name].add(reference / time);
      } else if (class_name.find(" all") != std::string::npos) {
        for (const auto& [name, time] : seconds) means_["contacts"][name].add(reference / time);
      }
      if (seconds.count("FCL native") != 0) native_gain_.add(seconds.at("FCL Debian") / reference);
    }
    const auto rate = [&](const char* name) {
      const auto found = seconds.find(name);
      return found == seconds.end() ? std::string("-") : fmt::format("{:.0f}", 1 / found->second);
    };
    const auto ratio = [&](const char* name) {
      const auto found = seconds.find(name);
      return found == seconds.end() ? std::string("-")
                                    : fmt::format("{:.0f} ({:.1f})", 1 / found->second, reference / found->second);
    };
    const double n = static_cast<double>(queries);
    progress_.clear();
    fmt::print("{:<14}{:<12}{:>6}{:>9}{:>9}{:>18}{:>18}{:>11}{:>7.1f}{:>8.0f}{:>8.1f}{:>7.2f}\n", meshes, class_name,
               hits, rate("FCL Debian"), rate("FCL native"), ratio("single"), ratio("batch"), rate("cores"),
               static_cast<double>(counts.steps) / n, static_cast<double>(counts.box_tests) / n,
               static_cast<double>(counts.pairs) / n, static_cast<double>(counts.open) / n);
    std::fflush(stdout);
  }

  /// Flush faces, the normal case of assemblies: first and all contacts.
  void run_flush() {
    for (MeshPair& meshes : flush_pairs()) {
      const Bodies bodies(std::move(meshes), debian());
      peers_ = peer_pairs(libraries_, bodies.a.mesh(), bodies.b.mesh());
      for (const FlushPlace place : flush_places) {
        for (const CollisionRequest& request : {CollisionRequest{}, all_contacts}) {
          std::mt19937_64 random(options_.seed);
          const auto poses = [&](int) {
            std::vector<PosePair> result;
            for (std::size_t i = 0; i < all_poses(); ++i) result.push_back(flush_poses(place, random));
            return result;
          };
          const std::size_t errs_before = fcl_errs_;
          const bool all = request.contacts == CollisionRequest::Contacts::all;
          const std::string name = fmt::format("flush {}{}", name_of(place), all ? " all" : "");
          run_class(bodies, name, request, poses, 4, false);
          flush_.back().fcl_errs = fcl_errs_ - errs_before;
        }
      }
    }
  }

  /// One query alone, after the caches were filled with something else.
  void run_lone(const Bodies& bodies, PoseMaker& maker, const std::vector<std::vector<Approach>>& approaches) {
    const std::size_t count = std::clamp<std::size_t>(options_.poses / 30, 5, 60);
    std::vector<PosePair> poses;
    for (std::size_t i = 0; i < count; ++i) poses.push_back(maker.pose(approaches[0][i], PoseClass::touch));
    std::vector<Answers> answers;
    std::vector<Variant> ways = variants(bodies, {}, poses, answers, false);
    std::vector<std::vector<double>> times(ways.size());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < ways.size(); ++k) {
        if (ways[k].name == "batch" || ways[k].name == "cores") continue;
        fill_caches();
        const double start = seconds(Clock::wall);
        ways[k].answer(i, 1);
        times[k].push_back(seconds(Clock::wall) - start);
      }
      tick()(1);
    }
    std::map<std::string, double> each;
    std::map<std::string, std::size_t> differ;
    std::vector<std::string> names;
    for (std::size_t k = 0; k < ways.size(); ++k) {
      if (times[k].empty()) continue;
      names.push_back(ways[k].name);
      each[ways[k].name] = median(times[k]);
      differ[ways[k].name] = answers[k].differ_from(answers.front());
    }
    const auto hits = static_cast<std::size_t>(std::count(answers[0].hit.begin(), answers[0].hit.end(), 1));
    report(bodies.name, "lone", count, hits, names, each, differ, answers[0].stats, bodies.counts);
  }

  /// One object that moves against a scene of several: a batch of one query with each of them.
  void run_scene() {
    std::vector<Mesh> meshes = {
        make_body(25, 0.3, 11), make_body(40, 0.8, 12),      make_gear(1.25, 1.5, 0.5, 0.5, 48, 8),
        make_body(15, 0.6, 13), make_torus(1, 0.25, 64, 32), make_body(30, 0.2, 14),
        make_sphere(1, 20),     make_body(50, 0.7, 15)};
    const Object mover(normalised(make_body(39, 0.8, 16)));
    std::vector<Object> objects;
    std::vector<Pose> places;
    std::mt19937_64 random(options_.seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto vector = [&](double range) {
      const double x = unit(random);
      const double y = unit(random);
      return Vec3d(range * x, range * y, range * unit(random));
    };
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      objects.emplace_back(normalised(std::move(meshes[i])));
      const Vec3d corner((i & 1U) != 0 ? 0.4 : -0.4, (i & 2U) != 0 ? 0.4 : -0.4, (i & 4U) != 0 ? 0.4 : -0.4);
      places.emplace_back(make_pose(corner, vector(180)));
    }
    struct Scene {
      std::string name;
      std::vector<PeerMesh> objects;
      PeerMesh mover;
    };
    std::vector<Scene> scenes;
    for (const auto& [name, library] : libraries_) {
      Scene& scene = scenes.emplace_back(Scene{name, {}, library.mesh(mover.mesh())});
      for (const Object& object : objects) scene.objects.push_back(library.mesh(object.mesh()));
    }
    const std::size_t n = objects.size();
    const std::size_t poses = std::max<std::size_t>(8, options_.poses / 4);
    std::vector<std::vector<double>> passes;
    std::vector<std::string> names;
    std::size_t hits = 0;
    std::map<std::string, std::size_t> differ;
    CollisionStats counts;
    for (int pass = 0; pass < options_.passes; ++pass) {
      std::vector<Pose> moves;
      for (std::size_t i = 0; i < poses; ++i) moves.emplace_back(make_pose(vector(0.4), vector(180)));
      std::vector<Answers> answers;
      answers.reserve(3 + scenes.size());
      std::vector<Variant> ways;
      const auto ours = [&](const std::string& name, Clock clock, Device& device, bool batch) {
        Answers& mine = answers.emplace_back(n * poses);
        ways.push_back({name, clock, [&, batch](std::size_t first, std::size_t count) {
                          for (std::size_t i = first; i < first + count; ++i) {
                            const auto query = [&](std::size_t k) {
                              return CollisionQuery{&mover, &moves[i], &objects[k], &places[k]};
                            };
                            const auto take = [&](std::size_t k, const CollisionResult& r) { mine.take(n * i + k, r); };
                            if (batch) {
                              device.collide(n, query, {}, take);
                              continue;
                            }
                            for (std::size_t k = 0; k < n; ++k) {
                              device.collide(query(k), {}, result_);
                              take(k, result_);
                            }
                          }
                        }});
      };
      const auto theirs = [&](const Scene& s) {
        Answers& mine = answers.emplace_back(n * poses);
        ways.push_back({s.name, Clock::cpu, [&](std::size_t first, std::size_t count) {
                          for (std::size_t i = first; i < first + count; ++i) {
                            for (std::size_t k = 0; k < n; ++k) {
                              mine.hit[n * i + k] = static_cast<char>(s.mover.hit(moves[i], s.objects[k], places[k]));
                            }
                          }
                        }});
      };
      ours("single", Clock::cpu, best(), false);
      theirs(scenes.front());
      ours("batch", Clock::cpu, best(), true);
      for (std::size_t i = 1; i < scenes.size(); ++i) theirs(scenes[i]);
      ours("cores", Clock::wall, *all_cores_, true);
      measure_pass(ways, poses, 8, tick());
      passes.resize(ways.size());
      names.clear();
      for (std::size_t i = 0; i < ways.size(); ++i) {
        names.push_back(ways[i].name);
        passes[i].push_back(ways[i].passes.front() / static_cast<double>(n));
        differ[ways[i].name] += answers[i].differ_from(answers.front());
      }
      counts += answers.front().stats;
      hits += static_cast<std::size_t>(std::count(answers.front().hit.begin(), answers.front().hit.end(), 1));
    }
    std::map<std::string, double> seconds;
    for (std::size_t i = 0; i < names.size(); ++i) seconds[names[i]] = median(passes[i]);
    report("scene", fmt::format("{} objects", n), n * poses * static_cast<std::size_t>(options_.passes), hits, names,
           seconds, differ, counts, false);
  }

  struct Built {
    std::string meshes, side, faces;
    double bytes = 0, milliseconds = 0, moved_milliseconds = 0, fcl_bytes = 0, fcl_milliseconds = 0;
  };

  /// Time and memory of an object of either library. What the device derives from it at the first query counts.
  void print_build(const MeshPair& meshes) {
    for (const bool second : {false, true}) {
      const Mesh& mesh = second ? meshes.b : meshes.a;
      const double n = static_cast<double>(mesh.faces.size());
      Built built = {meshes.name, second ? "B" : "A", describe_faces(mesh)};
      const double before = heap_bytes();
      double start = seconds(Clock::cpu);
      {
        const Object object(mesh);
        collide(best(), object, Pose::Identity(), object, Pose::Identity());
        built.milliseconds = 1000 * (seconds(Clock::cpu) - start);
        built.bytes = (heap_bytes() - before) / n;
        std::vector<Vec3d> vertices = mesh.vertices;
        start = seconds(Clock::cpu);
        const Object moved = object.moved(std::move(vertices));
        built.moved_milliseconds = 1000 * (seconds(Clock::cpu) - start);
      }
      const double between = heap_bytes();
      start = seconds(Clock::cpu);
      const PeerMesh fcl = debian().mesh(mesh);
      built.fcl_milliseconds = 1000 * (seconds(Clock::cpu) - start);
      built.fcl_bytes = (heap_bytes() - between) / n;
      rows_.add("object", built.meshes, built.side + " " + built.faces, "ours", 0, 0, built.milliseconds / 1000, {},
                built.bytes);
      rows_.add("object", built.meshes, built.side + " " + built.faces, "ours moved", 0, 0,
                built.moved_milliseconds / 1000);
      rows_.add("object", built.meshes, built.side + " " + built.faces, "FCL Debian", 0, 0,
                built.fcl_milliseconds / 1000, {}, built.fcl_bytes);
      built_.push_back(built);
    }
  }

  void print_objects() {
    fmt::print(
        "\nobjects: bytes a face, build time with the mesh and time of moved(), ms\n"
        "{:<14}{:<6}{:<14}{:>10}{:>10}{:>10}{:>12}{:>10}\n",
        "meshes", "which", "faces", "bytes", "ms", "moved", "FCL: bytes", "ms");
    for (const Built& x : built_) {
      fmt::print("{:<14}{:<6}{:<14}{:>10.0f}{:>10.1f}{:>10.1f}{:>12.0f}{:>10.0f}\n", x.meshes, x.side, x.faces, x.bytes,
                 x.milliseconds, x.moved_milliseconds, x.fcl_bytes, x.fcl_milliseconds);
    }
  }

  void print_targets() {
    fmt::print("\ninstruction sets, times FCL built natively, geometric means of the meshes: single, batch\n{:<10}",
               "");
    for (const PoseClass c : pose_classes) fmt::print("{:>16}", name_of(c));
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      fmt::print("\n{:<10}", targets_[i].name);
      const std::string suffix = i == 0 ? "" : " " + targets_[i].name;
      for (const PoseClass c : pose_classes) {
        fmt::print("{:>16}", fmt::format("{:.1f}, {:.1f}", means_[name_of(c)]["single" + suffix].value(),
                                         means_[name_of(c)]["batch" + suffix].value()));
      }
    }
    fmt::print("\n");
  }

  /// How many times faster a single query is than in each other library, and its answers that are not ours.
  void print_libraries() {
    fmt::print(
        "\nother libraries: single is faster by, geometric means of the meshes; their answers that "
        "differ\n{:<12}{:>10}",
        "", "answers");
    for (const NamedLibrary& x : libraries_) fmt::print("{:>18}", x.name);
    for (const char* c : table_classes) {
      fmt::print("\n{:<12}{:>10}", c, queries_[c]);
      for (const NamedLibrary& x : libraries_) {
        auto& means = means_[c];
        const bool has = means.count(x.name) != 0;
        fmt::print(
            "{:>18}",
            has ? fmt::format("{:.1f}, {}", means["single"].value() / means[x.name].value(), differ_[c][x.name]) : "-");
      }
    }
    fmt::print("\n");
  }

  struct Flush {
    std::string meshes, class_name;
    std::size_t queries, fcl_differs, fcl_errs;
    std::map<std::string, double> seconds;  ///< variant
  };

  /// FCL's times beside ours, and how often it is wrong about faces that are flush.
  void print_flush() {
    fmt::print(
        "\nflush faces, not in the means: microseconds a query; FCL's wrong answers to yes or no, and pairs of faces "
        "that "
        "exact integers decide otherwise\n{:<10}{:<22}{:>10}{:>10}{:>10}{:>10}{:>8}{:>9}{:>9}{:>10}\n",
        "meshes", "class", "Debian", "native", "single", "relation", "times", "queries", "wrong", "in pairs");
    for (const Flush& x : flush_) {
      const auto us = [&x](const char* name) {
        const auto found = x.seconds.find(name);
        return found == x.seconds.end() ? std::string("-") : fmt::format("{:.1f}", 1e6 * found->second);
      };
      fmt::print("{:<10}{:<22}{:>10}{:>10}{:>10}{:>10}{:>8.1f}{:>9}{:>9}{:>10}\n", x.meshes, x.class_name,
                 us("FCL Debian"), us("FCL native"), us("single"), us("relation"),
                 x.seconds.at("FCL Debian") / x.seconds.at("single"), x.queries, x.fcl_differs, x.fcl_errs);
    }
  }

  /// What it costs to tell touching from crossing.
  void print_relation() {
    fmt::print("\nwith relation: seconds of a single query, times those without; geometric means of the meshes\n");
    for (const char* c : table_classes) {
      auto& means = means_[c];
      if (means.count("relation") == 0) continue;
      fmt::print("  {:<12} {:>6.2f}\n", c, means["single"].value() / means["relation"].value());
    }
  }

  /// Queries in a row that take the contact of the one before as their hint.
  void print_hints() {
    fmt::print(
        "\nhint: the contact of the query before, on paths; times FCL built natively, geometric means of the meshes\n"
        "{:<16}{:<38}{:>8}{:>8}{:>8}\n",
        "class", "most turn and move of a step", "hits", "single", "hint");
    for (const Steps& steps : path_steps) {
      auto& means = means_[steps.name];
      const double queries = static_cast<double>(std::max<std::size_t>(1, queries_[steps.name]));
      fmt::print("{:<16}{:<38}{:>7.0f}%{:>8.1f}{:>8.1f}\n", steps.name, steps.about,
                 100 * static_cast<double>(hits_[steps.name]) / queries, means["single"].value(),
                 means["hint"].value());
    }
  }

  /// What to read first.
  void print_short() {
    fmt::print("\nin short, geometric means, times FCL built natively:\n{:<46}{:>8}{:>8}\n", "", "single", "batch");
    const std::pair<const char*, const char*> rows[] = {{"booleans", "do they touch (touch, near, deep)"},
                                                        {"touch warm", "touch, trees in the caches"},
                                                        {"touch cold", "touch, 125 in a row after other work"},
                                                        {"lone", "touch, one query after other work"},
                                                        {"contacts", "all contacts"},
                                                        {"far", "far apart"},
                                                        {"flush", "flush faces, where FCL is often wrong"}};
    for (const auto& [name, about] : rows) {
      auto& means = means_[name];
      const bool batch = means.count("batch") != 0;
      fmt::print("{:<46}{:>8.1f}{:>8}\n", about, means["single"].value(),
                 batch ? fmt::format("{:.1f}", means["batch"].value()) : "-");
    }
  }

  int summary() {
    if (!options_.csv.empty()) {
      std::filesystem::create_directories(std::filesystem::path(options_.csv).parent_path());
      sim::OutputFile file(options_.csv);
      const double gain = native_gain_.value();
      file.stream() << rows_.text() << fmt::format("# FCL built natively is faster by: {:.2f}\n", gain);
      file.stream() << fmt::format("# answers compared with FCL's: {}, FCL errs in: {}, differences: {}\n", compared_,
                                   fcl_errs_, differences_);
      file.commit();
    }
    fmt::print("\ngeometric means, times FCL built natively:");
    for (const char* c : table_classes) {
      fmt::print("\n  {:<12} single {:>6.1f}", c, means_[c]["single"].value());
      if (means_[c].count("batch") != 0) {
        fmt::print("  batch {:>6.1f}  cores {:>6.1f}", means_[c]["batch"].value(), means_[c]["cores"].value());
      }
    }
    fmt::print("\n");
    print_short();
    if (find("FCL native") != nullptr)
      fmt::print("FCL built natively is {:.2f} times as fast as Debian's here\n", native_gain_.value());
    fmt::print("answers and sets of contacts compared: {}; pairs of faces in which FCL errs by exact integers: {}\n",
               compared_, fcl_errs_);
    fmt::print("single={:.1f} batch={:.1f} all_contacts={:.1f} differences={}\n", means_["booleans"]["single"].value(),
               means_["booleans"]["batch"].value(), means_["contacts"]["single"].value(), differences_);
    return differences_ == 0 ? 0 : 3;
  }

  Options options_;
  std::vector<NamedLibrary> libraries_;  ///< Debian's FCL first
  std::vector<PeerPair> peers_;          ///< the present pair in each of them
  std::vector<Target> targets_;          ///< one thread each, the best first
  std::unique_ptr<Device> all_cores_;
  CollisionResult result_;  ///< reused, as a user does
  Rows rows_;
  std::vector<Built> built_;
  std::vector<Flush> flush_;
  std::map<std::string, std::map<std::string, GeometricMean>> means_;  ///< class, variant
  std::map<std::string, std::map<std::string, std::size_t>> differ_;   ///< class, variant
  std::map<std::string, std::size_t> queries_;                         ///< class
  std::map<std::string, std::size_t> hits_;                            ///< class
  GeometricMean native_gain_;
  std::size_t compared_ = 0;
  std::size_t fcl_errs_ = 0;
  std::size_t differences_ = 0;
  std::size_t done_ = 0;
  Progress progress_;
};

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  cchip::testing::Options o;
  CLI::App app{
      "Queries per second of the CPU device, FCL, Coal, CGAL and ODE, the same poses in turns.\n"
      "Exit codes: 0 done, 3 an answer differs from another library's and exact integers say that ours is wrong, 2 the "
      "run could "
      "not be made."};
  app.add_option("--poses", o.poses, "poses of each class and pair of meshes in a pass")
      ->check(CLI::Range(8, 1000000))
      ->capture_default_str();
  app.add_option("--passes", o.passes, "passes, each with its own poses; times are their medians")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "repeats the poses (or CCHIP_SEED)")->capture_default_str();
  app.add_option("--pairs", o.pairs, "pairs of meshes")
      ->delimiter(',')
      ->check(CLI::IsMember(cchip::testing::mesh_pair_names()))
      ->capture_default_str();
  app.add_option("--csv", o.csv, "the same figures as a file; empty: none")->capture_default_str();
  auto* quick = app.add_flag("--quick", "300 poses in one pass, for a first look; its ratios are rough");
  CLI11_PARSE(app, argc, argv);
  if (*quick) {
    o.poses = 300;
    o.passes = 1;
  }
  return cchip::testing::Benchmark(o).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "collide_speed: %s\n", error.what());
  return 2;
}
