// SPDX-License-Identifier: Apache-2.0
// Collision checks per second of a robot arm in front of a shelf, by the CPU device and other libraries in the same
// run, in turns, in the same configurations: docs/cpp/speed.md, "A robot cell".
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/shapes.hpp>
#include <filesystem>
#include <map>
#include <random>
#include <sstream>

#include "machine.hpp"
#include "measure.hpp"
#include "other_libraries.hpp"
#include "robot.hpp"

namespace cchip::testing {
namespace {

/// URDF of each arm below the folder of the robots.
const std::map<std::string, std::string> arms = {{"panda", "robots/panda_description/urdf/panda.urdf"},
                                                 {"ur3", "robots/ur_description/urdf/ur3_joint_limited_robot.urdf"},
                                                 {"ur5", "robots/ur_description/urdf/ur5_joint_limited_robot.urdf"},
                                                 {"ur10", "robots/ur_description/urdf/ur10_joint_limited_robot.urdf"}};

/// Random configurations in which a pair must touch each time to be left out.
constexpr int contact_samples = 1000;
/// A library that would take longer than this in a whole run takes no part.
constexpr double most_seconds = 60;

struct Options {
  std::vector<std::string> names = {"panda", "ur5"};
  std::size_t paths = 200;
  std::size_t steps = 50;
  int passes = 3;
  std::uint64_t seed = sim::seed_from_environment();
  std::string robots = CCHIP_ROBOTS;
  std::string csv = "build/bench/robot.csv";
  bool slow = false;
};

/// Something that does not move, where it is.
struct Part {
  std::string name;
  Mesh mesh;
  Pose place;
};

/// A bench on which the arm is mounted, and a shelf of posts and boards with things on them, in front of the arm.
/// Metres.
std::vector<Part> make_surroundings() {
  std::vector<Part> parts;
  const auto put = [&](const std::string& name, Mesh mesh, const Vec3d& at, const Vec3d& degrees = Vec3d::Zero()) {
    parts.push_back({name, std::move(mesh), make_pose(at, degrees)});
  };
  // 5 mm below the base, which would touch it in each configuration
  put("bench", make_box({0.7, 0.7, 0.04}), {0, 0, -0.025});
  for (const double x : {0.42, 0.78}) {
    for (const double y : {-0.47, 0.47}) put("post", make_box({0.04, 0.04, 1.5}), {x, y, 0.25});
  }
  for (const double z : {0.1, 0.45, 0.8}) put("board", make_box({0.32, 0.9, 0.02}), {0.6, 0, z});
  Mesh body = make_body(10, 0.6, 3);
  for (Vec3d& v : body.vertices) v *= 0.06;
  put("carton", make_box({0.12, 0.16, 0.14}), {0.58, -0.3, 0.181}, {0, 0, 20});
  put("ball", make_sphere(0.06, 8), {0.56, 0.05, 0.171});
  put("figure", std::move(body), {0.6, 0.32, 0.22});
  put("gear", make_gear(0.07, 0.085, 0.03, 0.04, 24, 4), {0.58, -0.2, 0.481}, {0, 0, 5});
  put("carton", make_box({0.2, 0.14, 0.1}), {0.6, 0.2, 0.511}, {0, 0, -35});
  put("ring", make_torus(0.08, 0.025, 32, 16), {0.58, 0, 0.836});
  return parts;
}

/// Whether any face of one touches any of the other, exactly: the oracle in integers of any size, for each pair of
/// faces whose boxes, a nanometre larger on each side than rounded, overlap.
bool exact_hit(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b) {
  constexpr double margin = 1e-9;
  const auto boxes = [margin](const Mesh& mesh, const Pose& pose) {
    const Mesh placed = transformed(mesh, pose);
    std::vector<Eigen::AlignedBox3d> result;
    for (const Mesh::Face& face : placed.faces) {
      Eigen::AlignedBox3d box;
      for (std::size_t i = 0; i < (face.kind == Kind::tri ? 3U : 4U); ++i) box.extend(placed.vertices[face.vertex[i]]);
      box.min().array() -= margin;
      box.max().array() += margin;
      result.push_back(box);
    }
    return result;
  };
  const auto boxes_a = boxes(a, pose_a);
  const auto boxes_b = boxes(b, pose_b);
  for (std::size_t i = 0; i < boxes_a.size(); ++i) {
    for (std::size_t k = 0; k < boxes_b.size(); ++k) {
      if (!boxes_a[i].intersects(boxes_b[k])) continue;
      if (exact_intersects(a.primitive(i), pose_a, b.primitive(k), pose_b)) return true;
    }
  }
  return false;
}

/// An arm in its surroundings: bodies, first the links that have meshes, then the parts; pairs of bodies to ask about.
class Cell {
 public:
  struct Pair {
    std::size_t a;
    std::size_t b;
  };

  Cell(const std::string& name, const Options& options, Device& device)
      : name_(name), robot_(std::filesystem::path(options.robots) / arms.at(name), options.robots) {
    for (std::size_t i = 0; i < robot_.links().size(); ++i) {
      if (robot_.links()[i].mesh.faces.empty()) continue;
      links_.push_back(i);
      names_.push_back(robot_.links()[i].name);
      objects_.emplace_back(robot_.links()[i].mesh);
    }
    for (Part& part : make_surroundings()) {
      names_.push_back(part.name);
      objects_.emplace_back(std::move(part.mesh));
      places_.push_back(part.place);
    }
    choose_pairs(options.seed, device);
  }

  const std::string& name() const { return name_; }
  std::size_t links() const { return links_.size(); }
  const std::vector<Object>& objects() const { return objects_; }
  const std::vector<Pair>& pairs() const { return pairs_; }
  std::size_t faces(std::size_t first, std::size_t last) const {
    std::size_t count = 0;
    for (std::size_t i = first; i < last; ++i) count += objects_[i].mesh().faces.size();
    return count;
  }
  const std::string& left_out() const { return left_out_; }

  std::vector<double> random_values(std::mt19937_64& random) const {
    std::vector<double> values;
    for (const Robot::Axis& axis : robot_.axes()) {
      values.push_back(std::uniform_real_distribution<double>(axis.lower, axis.upper)(random));
    }
    return values;
  }
  /// Appends the poses of the links.
  void place(const std::vector<double>& values, std::vector<Pose>& poses) const {
    const std::vector<Pose> all = robot_.poses(values);
    for (const std::size_t link : links_) poses.push_back(all[link]);
  }
  /// \param poses of the links in all configurations
  const Pose& pose(const std::vector<Pose>& poses, std::size_t configuration, std::size_t body) const {
    return body < links() ? poses[configuration * links() + body] : places_[body - links()];
  }
  CollisionQuery query(const std::vector<Pose>& poses, std::size_t configuration, const Pair& pair) const {
    return {&objects_[pair.a], &pose(poses, configuration, pair.a), &objects_[pair.b],
            &pose(poses, configuration, pair.b)};
  }

 private:
  /// Pairs of links first, then each link with each part; neither neighbours nor what touches in every sample.
  void choose_pairs(std::uint64_t seed, Device& device) {
    for (std::size_t a = 0; a < links(); ++a) {
      for (std::size_t b = a + 1; b < links(); ++b) {
        if (!robot_.adjacent(links_[a], links_[b])) pairs_.push_back({a, b});
      }
    }
    for (std::size_t a = 0; a < links(); ++a) {
      for (std::size_t b = links(); b < objects_.size(); ++b) pairs_.push_back({a, b});
    }
    std::vector<Pose> poses;
    std::mt19937_64 random(seed);
    for (int i = 0; i < contact_samples; ++i) place(random_values(random), poses);
    const auto always = [&](const Pair& pair) {
      CollisionResult result;
      for (std::size_t i = 0; i < contact_samples; ++i) {
        device.collide(query(poses, i, pair), {}, result);
        if (!result.hit) return false;
      }
      left_out_ += (left_out_.empty() ? "" : ", ") + names_[pair.a] + " and " + names_[pair.b];
      return true;
    };
    pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), always), pairs_.end());
  }

  std::string name_;
  Robot robot_;
  std::vector<std::size_t> links_;  ///< numbers in the robot
  std::vector<std::string> names_;  ///< of the bodies
  std::vector<Object> objects_;     ///< of the bodies
  std::vector<Pose> places_;        ///< of the parts
  std::vector<Pair> pairs_;
  std::string left_out_;
};

enum class Mode {
  check,  ///< is the configuration free: the pairs in their order, up to the first that touches
  all     ///< all pairs of a configuration
};
const char* name_of(Mode mode) { return mode == Mode::check ? "check" : "all pairs"; }

/// The answers of one variant in one pass.
struct Answers {
  bool ours = false;
  std::vector<char> hit;  ///< of each configuration, or of each pair of each configuration
  std::size_t asked = 0;
};

/// What one variant did in all passes about one arm.
struct Total {
  std::vector<double> seconds;  ///< a configuration, of each pass
  std::size_t asked = 0;
  std::size_t hits = 0;
  std::size_t differ = 0;  ///< answers that are not the exact ones
};

class Benchmark {
 public:
  explicit Benchmark(const Options& options)
      : options_(options), libraries_(open_libraries()), device_(open_cpu_device({1, ""})), progress_("paths") {}

  int run() {
    // All files are read first: a run does not end half-way for want of one.
    std::vector<Cell> cells;
    for (const std::string& name : options_.names) cells.emplace_back(name, options_, *device_);
    note("machine", machine_description());
    note("compiler", compiler);
    note("load before the run", load_description());
    for (const NamedLibrary& x : libraries_) note(x.name, x.library.description());
    for (const OtherLibrary& other : other_libraries) {
      if (*other.module == 0) note(other.name, fmt::format("not in this run; {} brings it", other.remedy));
    }
    note("instruction set", cpu_targets().front());
    note("run", fmt::format("seed {}, {} passes of {} paths of {} configurations for each arm", options_.seed,
                            options_.passes, options_.paths, options_.steps));
    rows_ << "arm,mode,variant,configurations,asked,hits,seconds_each,differ\n";
    for (const Cell& cell : cells) run_cell(cell);
    return summary();
  }

 private:
  struct PeerCell {
    std::string name;
    std::vector<PeerMesh> meshes;
  };
  /// Whether a pair touches in a configuration.
  using Ask = std::function<bool(std::size_t configuration, const Cell::Pair& pair)>;

  void note(const std::string& key, const std::string& value) {
    notes_ << "# " << key << ": " << value << '\n';
    fmt::print("# {}: {}\n", key, value);
  }
  std::size_t configurations() const { return options_.paths * options_.steps; }

  void run_cell(const Cell& cell) {
    note(cell.name(), fmt::format("{} links of {} triangles, {} parts of {}; {} pairs of bodies, left out as touching "
                                  "in each of {} samples: {}",
                                  cell.links(), cell.faces(0, cell.links()), cell.objects().size() - cell.links(),
                                  cell.faces(cell.links(), cell.objects().size()), cell.pairs().size(), contact_samples,
                                  cell.left_out().empty() ? "none" : cell.left_out()));
    std::mt19937_64 random(options_.seed + 1);
    std::vector<PeerCell> peers;
    for (const auto& [name, library] : libraries_) {
      PeerCell peer = {name, {}};
      for (const Object& object : cell.objects()) peer.meshes.push_back(library.mesh(object.mesh()));
      if (!options_.slow && is_slow(cell, peer)) continue;
      peers.push_back(std::move(peer));
    }
    std::map<Mode, std::map<std::string, Total>> totals;
    std::vector<std::string> names;
    for (int pass = 0; pass < options_.passes; ++pass) {
      const std::vector<Pose> poses = make_paths(cell, random);
      std::map<Mode, std::vector<Answers>> answers;
      for (const Mode mode : {Mode::check, Mode::all}) {
        std::vector<Variant> ways = variants(cell, peers, poses, mode, answers[mode]);
        measure_pass(ways, options_.paths, 8, [&](std::size_t count) { progress_.update(done_ += count, -1); });
        names.clear();
        for (std::size_t i = 0; i < ways.size(); ++i) {
          names.push_back(ways[i].name);
          Total& total = totals[mode][ways[i].name];
          total.seconds.push_back(ways[i].passes.front() / static_cast<double>(options_.steps));
          total.asked += answers[mode][i].asked;
          total.hits +=
              static_cast<std::size_t>(std::count(answers[mode][i].hit.begin(), answers[mode][i].hit.end(), 1));
        }
      }
      compare(cell, poses, names, answers, totals);
    }
    report(cell, names, totals);
  }

  /// Random configurations joined by straight lines in the space of the joints: a path starts where the last one ended.
  std::vector<Pose> make_paths(const Cell& cell, std::mt19937_64& random) const {
    std::vector<Pose> poses;
    std::vector<double> from = cell.random_values(random);
    for (std::size_t path = 0; path < options_.paths; ++path) {
      const std::vector<double> to = cell.random_values(random);
      for (std::size_t step = 0; step < options_.steps; ++step) {
        const double t = static_cast<double>(step) / static_cast<double>(options_.steps);
        std::vector<double> values;
        for (std::size_t i = 0; i < to.size(); ++i) values.push_back(from[i] + t * (to[i] - from[i]));
        cell.place(values, poses);
      }
      from = to;
    }
    return poses;
  }

  /// Whether a library would need too long, by a sample.
  bool is_slow(const Cell& cell, const PeerCell& peer) {
    std::mt19937_64 random(options_.seed);
    constexpr std::size_t sample = 10;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < sample; ++i) cell.place(cell.random_values(random), poses);
    double start = 0;
    for (const bool measured : {false, true}) {  // CGAL prepares a pair when it is asked first
      start = seconds(Clock::cpu);
      for (std::size_t i = 0; i < (measured ? sample : 1); ++i) {
        for (const Cell::Pair& pair : cell.pairs()) {
          peer.meshes[pair.a].hit(cell.pose(poses, i, pair.a), peer.meshes[pair.b], cell.pose(poses, i, pair.b));
        }
      }
    }
    const double each = (seconds(Clock::cpu) - start) / static_cast<double>(sample);
    const double whole =
        each * static_cast<double>(configurations()) * options_.passes * static_cast<double>(options_.names.size());
    if (whole <= most_seconds) return false;
    note(cell.name() + ", " + peer.name,
         fmt::format("left out, it would take about {:.0f} s; --slow asks it all the same", whole));
    return true;
  }

  /// Ways to answer about the paths of one pass.
  std::vector<Variant> variants(const Cell& cell, const std::vector<PeerCell>& peers, const std::vector<Pose>& poses,
                                Mode mode, std::vector<Answers>& answers) {
    std::vector<Variant> result;
    answers.reserve(2 + peers.size());  // the variants refer to its elements
    const auto answers_of = [&](bool ours) -> Answers& {
      Answers& mine = answers.emplace_back();
      mine.ours = ours;
      mine.hit.resize(configurations() * (mode == Mode::all ? cell.pairs().size() : 1));
      return mine;
    };
    const auto one_by_one = [&](const std::string& name, bool ours, const Ask& ask) {
      Answers& mine = answers_of(ours);
      result.push_back({name, Clock::cpu, [this, &cell, &mine, ask, mode](std::size_t first, std::size_t count) {
                          for (std::size_t i = first * options_.steps; i < (first + count) * options_.steps; ++i) {
                            answer_one(cell, ask, mode, i, mine);
                          }
                        }});
    };
    one_by_one("single", true, [&](std::size_t i, const Cell::Pair& pair) {
      device_->collide(cell.query(poses, i, pair), {}, result_);
      return result_.hit;
    });
    for (const PeerCell& peer : peers) {
      one_by_one(peer.name, false, [&](std::size_t i, const Cell::Pair& pair) {
        return peer.meshes[pair.a].hit(cell.pose(poses, i, pair.a), peer.meshes[pair.b], cell.pose(poses, i, pair.b));
      });
      if (&peer != &peers.front()) continue;
      Answers& mine = answers_of(true);
      result.push_back({"batch", Clock::cpu, [&, mode](std::size_t first, std::size_t count) {
                          for (std::size_t i = first; i < first + count; ++i) answer_path(cell, poses, mode, i, mine);
                        }});
    }
    return result;
  }

  static void answer_one(const Cell& cell, const Ask& ask, Mode mode, std::size_t configuration, Answers& answers) {
    const std::vector<Cell::Pair>& pairs = cell.pairs();
    if (mode == Mode::all) {
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        answers.hit[configuration * pairs.size() + k] = static_cast<char>(ask(configuration, pairs[k]));
      }
      answers.asked += pairs.size();
      return;
    }
    for (const Cell::Pair& pair : pairs) {
      ++answers.asked;
      if (!ask(configuration, pair)) continue;
      answers.hit[configuration] = 1;
      return;
    }
  }

  /// A path in batches. All pairs: one call. A check: a call for each pair, with the configurations that are still
  /// free, so that the same is asked as one by one.
  void answer_path(const Cell& cell, const std::vector<Pose>& poses, Mode mode, std::size_t path, Answers& answers) {
    const std::vector<Cell::Pair>& pairs = cell.pairs();
    const std::size_t start = path * options_.steps;
    if (mode == Mode::all) {
      const std::size_t n = pairs.size();
      device_->collide(
          options_.steps * n, [&](std::size_t i) { return cell.query(poses, start + i / n, pairs[i % n]); }, {},
          [&](std::size_t i, const CollisionResult& r) { answers.hit[start * n + i] = static_cast<char>(r.hit); });
      answers.asked += options_.steps * n;
      return;
    }
    free_.resize(options_.steps);
    for (std::size_t i = 0; i < options_.steps; ++i) free_[i] = start + i;
    for (const Cell::Pair& pair : pairs) {
      if (free_.empty()) return;
      device_->collide(
          free_.size(), [&](std::size_t i) { return cell.query(poses, free_[i], pair); }, {},
          [&](std::size_t i, const CollisionResult& r) {
            if (r.hit) answers.hit[free_[i]] = 1;
          });
      answers.asked += free_.size();
      free_.erase(std::remove_if(free_.begin(), free_.end(), [&](std::size_t i) { return answers.hit[i] != 0; }),
                  free_.end());
    }
  }

  /// Where answers are not alike, exact integers decide which are wrong.
  void compare(const Cell& cell, const std::vector<Pose>& poses, const std::vector<std::string>& names,
               const std::map<Mode, std::vector<Answers>>& answers,
               std::map<Mode, std::map<std::string, Total>>& totals) {
    const std::vector<Cell::Pair>& pairs = cell.pairs();
    const std::vector<Answers>& all = answers.at(Mode::all);
    const std::vector<Answers>& checks = answers.at(Mode::check);
    for (std::size_t i = 0; i < configurations(); ++i) {
      bool touches = false;  // exactly
      for (std::size_t k = i * pairs.size(); k < (i + 1) * pairs.size(); ++k) {
        bool hit = all.front().hit[k] != 0;
        if (std::any_of(all.begin(), all.end(), [&](const Answers& x) { return (x.hit[k] != 0) != hit; })) {
          const CollisionQuery query = cell.query(poses, i, pairs[k % pairs.size()]);
          hit = exact_hit(query.a->mesh(), *query.pose_a, query.b->mesh(), *query.pose_b);
          ++decided_;
        }
        for (std::size_t v = 0; v < all.size(); ++v) judge(all[v], k, hit, totals[Mode::all][names[v]]);
        touches = touches || hit;
      }
      for (std::size_t v = 0; v < checks.size(); ++v) judge(checks[v], i, touches, totals[Mode::check][names[v]]);
    }
  }

  void judge(const Answers& answers, std::size_t i, bool exact, Total& total) {
    if ((answers.hit[i] != 0) == exact) return;
    ++total.differ;
    if (answers.ours) ++differences_;
  }

  void report(const Cell& cell, std::vector<std::string> names, std::map<Mode, std::map<std::string, Total>>& totals) {
    const std::size_t n = configurations() * static_cast<std::size_t>(options_.passes);
    const auto batch = std::find(names.begin(), names.end(), "batch");
    std::rotate(names.begin() + 1, batch, batch + 1);  // ours together
    configurations_ += n;
    queries_ += totals[Mode::all]["single"].asked;
    hits_ += totals[Mode::all]["single"].hits;
    progress_.clear();
    fmt::print("\n{}: {} configurations, {:.1f} % touch; {} pairs of bodies in all, {:.2f} % touch\n{:<12}",
               cell.name(), n, 100 * static_cast<double>(totals[Mode::check]["single"].hits) / static_cast<double>(n),
               totals[Mode::all]["single"].asked,
               100 * static_cast<double>(totals[Mode::all]["single"].hits) /
                   static_cast<double>(totals[Mode::all]["single"].asked),
               "");
    for (const Mode mode : {Mode::check, Mode::all}) {
      fmt::print("{:>20}{:>14}{:>14}{:>8}", mode == Mode::check ? "checks/s" : "all pairs: checks/s", "queries/s",
                 "single ahead", "wrong");
    }
    for (const std::string& name : names) {
      fmt::print("\n{:<12}", name);
      for (const Mode mode : {Mode::check, Mode::all}) {
        const Total& total = totals[mode][name];
        const double each = median(total.seconds);
        const double ahead = each / median(totals[mode]["single"].seconds);
        fmt::print("{:>20.0f}{:>14.0f}{:>14.2f}{:>8}", 1 / each,
                   static_cast<double>(total.asked) / static_cast<double>(n) / each, ahead, total.differ);
        rows_ << fmt::format("{},{},{},{},{},{},{:.4g},{}\n", cell.name(), name_of(mode), name, n, total.asked,
                             total.hits, each, total.differ);
      }
    }
    fmt::print("\n");
    std::fflush(stdout);
    auto& checks = totals[Mode::check];
    const double fcl = median(checks["FCL Debian"].seconds);
    single_.add(fcl / median(checks["single"].seconds));
    batch_.add(fcl / median(checks["batch"].seconds));
  }

  int summary() {
    note("answers that were not alike, decided by exact integers", fmt::format("{}", decided_));
    if (!options_.csv.empty()) {
      const std::filesystem::path folder = std::filesystem::path(options_.csv).parent_path();
      if (!folder.empty()) std::filesystem::create_directories(folder);
      sim::OutputFile file(options_.csv);
      file.stream() << notes_.str() << rows_.str();
      file.commit();
    }
    fmt::print("configurations={} queries={} hits={} single={:.1f} batch={:.1f} differences={}\n", configurations_,
               queries_, hits_, single_.value(), batch_.value(), differences_);
    return differences_ == 0 ? 0 : 3;
  }

  Options options_;
  std::vector<NamedLibrary> libraries_;  ///< Debian's FCL first
  std::unique_ptr<Device> device_;       ///< one thread
  CollisionResult result_;               ///< reused, as a user does
  std::vector<std::size_t> free_;        ///< reused
  std::ostringstream notes_;
  std::ostringstream rows_;
  GeometricMean single_;  ///< times Debian's FCL, checks
  GeometricMean batch_;
  std::size_t configurations_ = 0;
  std::size_t queries_ = 0;
  std::size_t hits_ = 0;
  std::size_t decided_ = 0;
  std::size_t differences_ = 0;  ///< answers of ours that are not the exact ones
  std::size_t done_ = 0;
  Progress progress_;
};

std::vector<std::string> arm_names() {
  std::vector<std::string> names;
  for (const auto& arm : arms) names.push_back(arm.first);
  return names;
}

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  cchip::testing::Options o;
  CLI::App app{
      "Collision checks per second of robot arms in front of a shelf: the CPU device, FCL, Coal, CGAL and ODE, the "
      "same "
      "configurations in turns.\n"
      "The last line: configurations, pairs of bodies in them, those that touch, checks of ours over those of Debian's "
      "FCL one by one and in batches, our wrong answers.\n"
      "Exit codes: 0 done, 3 an answer of ours is not the exact one, 2 the run could not be made."};
  app.add_option("--arms", o.names, "arms, one after the other")
      ->delimiter(',')
      ->check(CLI::IsMember(cchip::testing::arm_names()))
      ->capture_default_str();
  app.add_option("--paths", o.paths, "paths of an arm in a pass")->check(CLI::Range(8, 100000))->capture_default_str();
  app.add_option("--steps", o.steps, "configurations of a path")->check(CLI::Range(2, 10000))->capture_default_str();
  app.add_option("--passes", o.passes, "passes, each with its own paths; times are their medians")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "repeats the paths (or CCHIP_SEED)")->capture_default_str();
  app.add_option("--robots", o.robots, "folder of the robots, as scripts/run robots installs it")
      ->capture_default_str();
  app.add_option("--csv", o.csv, "the same figures as a file; empty: none")->capture_default_str();
  app.add_flag("--slow", o.slow, "ask libraries, too, that take more than a minute");
  auto* quick = app.add_flag("--quick", "20 paths in one pass, for a first look; its ratios are rough");
  CLI11_PARSE(app, argc, argv);
  if (*quick) {
    o.paths = 20;
    o.passes = 1;
  }
  return cchip::testing::Benchmark(o).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "robot_speed: %s\n", error.what());
  return 2;
}
