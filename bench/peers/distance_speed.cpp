// SPDX-License-Identifier: Apache-2.0
// distance() and within() beside those of other libraries, the same poses in turns, for the pairs of meshes of
// docs/cpp/speed.md, and how many answers are wrong: docs/cpp/distance.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/device.hpp>
#include <cchip/distance.hpp>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "distance_count.hpp"
#include "distance_python.hpp"
#include "machine.hpp"
#include "measure.hpp"
#include "mesh_pairs.hpp"
#include "other_libraries.hpp"

namespace cchip::testing {
namespace {

struct Options {
  std::size_t poses = 100;
  std::size_t passes = 3;
  std::size_t proofs = 3;
  std::uint64_t seed = 1;
  bool nested = true;
  std::vector<std::string> pairs = mesh_pair_names();
  std::string python;
  std::string python_queries = "build/bench/distance_queries.txt";
};

/// What is asked, in the order of the tables.
enum Question { exactly, percent, half, twice, meets, question_count };
constexpr const char* nested = "nested";
constexpr const char* questions[] = {"distance", "distance, 1 %", "within half the distance",
                                     "within twice the distance", "collide, yes or no"};

/// Two meshes in some poses, all with distances of one kind.
struct Row {
  std::string pair;
  std::string pose_class;
  bool counts = false;  ///< in the geometric means
  std::vector<PosePair> poses;
  std::vector<TrueDistance> right = {};
  std::map<std::string, std::array<double, question_count>> times = {};  ///< microseconds, 0: not asked
  bool is_cold = false;                                                  ///< each query finds nothing in the caches
};

class Benchmark {
 public:
  explicit Benchmark(Options options) : options_(std::move(options)), device_(open_device("cpu")) {
    for (NamedLibrary& library : open_libraries()) {
      if (!library.library.has_distance()) continue;
      names_.push_back(library.name);
      versions_[library.name] = library.library.description();
      libraries_.push_back(std::move(library));
    }
  }

  int run() {
    fmt::print("{}\nload at the beginning {}; {} poses, {} passes, seed {}; times of C++ on one thread\n",
               machine_description(), load_description(), options_.poses, options_.passes, options_.seed);
    for (const std::string& name : options_.pairs) {
      const MeshPair meshes = mesh_pair(name);
      if (!meshes.counts) continue;
      const Object a(meshes.a);
      const Object b(meshes.b);
      PoseMaker maker(*device_, a, b, options_.seed);
      for (const PoseClass pose_class : {PoseClass::near, PoseClass::far, PoseClass::touch, PoseClass::graze}) {
        const bool apart = pose_class == PoseClass::near || pose_class == PoseClass::far;
        Row row = {name, name_of(pose_class), apart, {}};
        while (row.poses.size() < options_.poses) {
          const PosePair pose = maker.pose(maker.approach(), pose_class);
          if (apart && distance(a, pose.a, b, pose.b).upper == 0) continue;
          row.poses.push_back(pose);
        }
        answer(std::move(row), a, b);
        if (pose_class != PoseClass::near) continue;
        const std::vector<PosePair> near = rows_.back().poses;
        Row away = {name, "near, 5,000 away", false, near};
        for (PosePair& pose : away.poses) {
          for (Pose* each : {&pose.a, &pose.b}) each->translation() += Vec3d(5e3, -5e3, 5e3);
        }
        answer(std::move(away), a, b);
        Row lone = {name, "near, lone", false, near};
        lone.poses.resize(std::min<std::size_t>(lone.poses.size(), 10));
        lone.is_cold = true;
        answer(std::move(lone), a, b);
        answer({name, "path", false, maker.path(options_.poses)}, a, b);
      }
    }
    flush_rows();
    if (options_.nested) nested_rows();
    return summary();
  }

 private:
  /// Flush faces, and the same with B's mesh 1/8 higher: the distance is 0, or 0.125 exactly, by construction.
  void flush_rows() {
    std::mt19937_64 random(options_.seed);
    for (MeshPair& meshes : flush_pairs()) {
      for (const double gap : {0.0, 0.125}) {
        const Object a(meshes.a);
        Mesh lifted = meshes.b;
        for (Vec3d& v : lifted.vertices) v.z() += gap;
        const Object b(lifted);
        for (const FlushPlace place : {FlushPlace::together, FlushPlace::turned}) {
          const bool turned = place == FlushPlace::turned;
          if (gap != 0 && turned) continue;  // the entries of a turn are rounded, so the distance is not 0.125
          Row row = {meshes.name,
                     fmt::format("flush{}{}", turned ? ", turned" : "", gap != 0 ? " but for 1/8" : ""),
                     false,
                     {}};
          while (row.poses.size() < options_.poses) row.poses.push_back(flush_poses(place, random));
          answer(std::move(row), a, b);
          for (const TrueDistance& d : rows_.back().right) known_wrong_ += d.lower != gap || d.upper != gap ? 1 : 0;
        }
      }
    }
  }

  /// Surfaces inside others, in random poses that both share; a mean of its own.
  void nested_rows() {
    std::mt19937_64 random(options_.seed);
    for (MeshPair& meshes : nested_pairs()) {
      const Object a(meshes.a);
      const Object b(meshes.b);
      Row row = {meshes.name, nested, false, {}};
      while (row.poses.size() < std::min<std::size_t>(options_.poses, 3)) {
        row.poses.push_back(flush_poses(FlushPlace::turned, random));
      }
      answer(std::move(row), a, b);
    }
  }

  void answer(Row row, const Object& a, const Object& b) {
    for (const PosePair& pose : row.poses) {
      const DistanceResult d = distance(a, pose.a, b, pose.b);
      row.right.push_back({d.lower, d.upper});
    }
    count_ours(row, a, b);
    std::vector<PeerMesh> peers_a;
    std::vector<PeerMesh> peers_b;
    for (const NamedLibrary& library : libraries_) {
      peers_a.push_back(library.library.mesh(a.mesh()));
      peers_b.push_back(library.library.mesh(b.mesh()));
      counts_[library.name][row.pose_class] +=
          count_answers(peers_a.back(), peers_b.back(), library.library.distance_tolerance(), a.mesh(), b.mesh(),
                        row.poses, row.right);
    }
    for (int question = 0; question < question_count; ++question) {
      measure(row, static_cast<Question>(question), a, b, peers_a, peers_b);
    }
    if (!options_.python.empty()) {
      for (const PythonAnswers& x : ask_python(options_.python, CCHIP_DISTANCE_PYTHON, options_.python_queries,
                                               a.mesh(), b.mesh(), row.poses, row.right)) {
        if (versions_.count(x.name) == 0) names_.push_back(x.name);
        versions_[x.name] = x.version + ", Python, wall clock, all cores";
        counts_[x.name][row.pose_class] += x.count;
        row.times[x.name] = {x.times[0], 0, x.times[1], x.times[2], x.times[3]};
      }
    }
    rows_.push_back(std::move(row));
    std::fprintf(stderr, "%s %s\n", rows_.back().pair.c_str(), rows_.back().pose_class.c_str());
  }

  /// Our own answers in the first poses of a row, where brute force in integers says what is right: no tolerance, but
  /// for the rounding of the points. The option of 1 % must keep its word.
  void count_ours(const Row& row, const Object& a, const Object& b) {
    if (row.pose_class == nested) return;  // so many are as near that brute force would take hours: test_distance
    DistanceCount& count = counts_["ours"][row.pose_class];
    DistanceRequest request;
    request.rel_error = 0.01;
    for (std::size_t i = 0; i < std::min(options_.proofs, row.poses.size()); ++i) {
      const PosePair& pose = row.poses[i];
      const TrueDistance& right = row.right[i];
      const DistanceResult d = distance(a, pose.a, b, pose.b);
      const bool proved = is_proved(a.mesh(), pose.a, b.mesh(), pose.b, d);
      ++(proved ? proved_ : disproved_);
      count.add_distance(proved ? d.upper : std::numeric_limits<double>::quiet_NaN(), right, 0);
      if (right.lower > 0) {
        const double rounding = 1e-15 * (1 + pose.a.translation().norm() + pose.b.translation().norm());
        count.add_points({d.upper, d.point_a, d.point_b}, PlacedFaces(a.mesh(), pose.a), PlacedFaces(b.mesh(), pose.b),
                         rounding);
      }
      const DistanceResult rough = distance(a, pose.a, b, pose.b, request);
      rough_wrong_ += rough.lower > right.upper || rough.upper < right.lower ||
                              rough.upper - rough.lower > request.rel_error * rough.upper
                          ? 1
                          : 0;
      for (const double limit : {half_distance(right), twice_distance(right)}) {
        count.add_decision(within(a, pose.a, b, pose.b, limit).hit, limit, right, 0);
      }
      count.add_edges([&](double limit) { return within(a, pose.a, b, pose.b, limit).hit; }, right);
    }
  }

  void measure(Row& row, Question question, const Object& a, const Object& b, const std::vector<PeerMesh>& peers_a,
               const std::vector<PeerMesh>& peers_b) {
    std::vector<Variant> variants;
    const auto add = [&](const std::string& name, auto ask) {
      variants.push_back({name, Clock::cpu, [&row, ask](std::size_t first, std::size_t count) {
                            for (std::size_t i = first; i < first + count; ++i) ask(row.poses[i], row.right[i]);
                          }});
    };
    DistanceRequest request;
    request.rel_error = question == percent ? 0.01 : 0;
    const auto limit = [question](const TrueDistance& right) {
      return question == half ? half_distance(right) : twice_distance(right);
    };
    add("ours", [&, question, limit, request](const PosePair& pose, const TrueDistance& right) {
      if (question == meets) {
        collide(a, pose.a, b, pose.b);
      } else if (question == half || question == twice) {
        within(a, pose.a, b, pose.b, limit(right));
      } else {
        distance(a, pose.a, b, pose.b, request);
      }
    });
    for (std::size_t i = 0; i < libraries_.size(); ++i) {
      const PeerMesh& peer_a = peers_a[i];
      const PeerMesh& peer_b = peers_b[i];
      add(libraries_[i].name, [&, question, limit, request](const PosePair& pose, const TrueDistance& right) {
        if (question == meets) {
          peer_a.hit(pose.a, peer_b, pose.b);
        } else if (question == half || question == twice) {
          peer_a.within(pose.a, peer_b, pose.b, limit(right));
        } else {
          peer_a.distance(pose.a, peer_b, pose.b, request.rel_error);
        }
      });
    }
    for (std::size_t pass = 0; pass < options_.passes; ++pass) {
      if (row.is_cold) {
        measure_pass(
            variants, row.poses.size(), row.poses.size(), [](std::size_t) {},
            [](std::size_t, std::size_t, std::size_t) { fill_caches(); });
      } else {
        measure_pass(variants, row.poses.size(), 10, [](std::size_t) {});
      }
    }
    for (const Variant& variant : variants) row.times[variant.name][question] = 1e6 * variant.seconds_each();
  }

  /// Microseconds of a call, and beneath how many times ours each library takes.
  void print_times(Question question) const {
    fmt::print("\n{}, microseconds of a call\n\n| pair | pose | ours |", questions[question]);
    for (const std::string& name : names_) fmt::print(" {} |", name);
    fmt::print("\n|---|---|---|");
    for (std::size_t i = 0; i < names_.size(); ++i) fmt::print("---|");
    std::map<std::string, GeometricMean> means;
    std::map<std::string, GeometricMean> nested_means;
    const auto cell = [](double us) { return us == 0 ? "" : fmt::format(us < 10 ? "{:.2f}" : "{:.0f}", us); };
    for (const Row& row : rows_) {
      const double ours = row.times.at("ours")[question];
      fmt::print("\n| {} | {} | {} |", row.pair, row.pose_class, cell(ours));
      for (const std::string& name : names_) {
        const double theirs = row.times.at(name)[question];
        fmt::print(" {} |", cell(theirs));
        if (row.counts && theirs > 0) means[name].add(theirs / ours);
        if (row.pose_class == nested && theirs > 0) nested_means[name].add(theirs / ours);
      }
    }
    fmt::print("\n| times ours, geometric mean of near and far | | 1 |");
    for (const std::string& name : names_) fmt::print(" {} |", cell(means[name].value()));
    fmt::print("\n| times ours, geometric mean of nested | | 1 |");
    for (const std::string& name : names_) fmt::print(" {} |", cell(nested_means[name].value()));
    fmt::print("\n");
  }

  void print_counts() const {
    fmt::print(
        "\nwrong answers\n\n| library | poses | distances | wrong | inexact | greatest error | pairs of points | "
        "wrong | yes or no | wrong | at the distance | wrong |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    std::vector<std::string> all = {"ours"};
    all.insert(all.end(), names_.begin(), names_.end());
    for (const std::string& name : all) {
      for (const auto& [pose_class, x] : counts_.at(name)) {
        fmt::print("| {} | {} | {} | {} | {} | {:.1e} | {} | {} | {} | {} | {} | {} |\n", name, pose_class, x.answers,
                   x.wrong, x.inexact, x.greatest_error, x.points, x.wrong_points, x.decisions, x.wrong_decisions,
                   x.edges, x.wrong_edges);
      }
    }
  }

  int summary() const {
    for (int question = 0; question < question_count; ++question) print_times(static_cast<Question>(question));
    print_counts();
    fmt::print("\n");
    for (const auto& [name, version] : versions_) fmt::print("{}: {}\n", name, version);
    for (const OtherLibrary& other : other_libraries) {
      if (*other.module == 0) fmt::print("{}: not in this build; {} brings it\n", other.name, other.remedy);
    }
    fmt::print("CGAL and ODE: no distance of two meshes\n");
    if (options_.python.empty())
      fmt::print("trueform, MeshLib: not asked; scripts/run peers brings them, --python asks\n");
    DistanceCount ours;
    DistanceCount theirs;
    for (const auto& [name, classes] : counts_) {
      for (const auto& entry : classes) (name == "ours" ? ours : theirs) += entry.second;
    }
    const std::size_t wrong = ours.wrong + ours.wrong_points + ours.wrong_decisions + ours.wrong_edges + rough_wrong_ +
                              known_wrong_ + disproved_;
    fmt::print("answers={} theirs_wrong={} proved={} disproved={} ours_wrong={}\n", ours.answers + theirs.answers,
               theirs.wrong + theirs.wrong_points + theirs.wrong_decisions, proved_, disproved_, wrong);
    return wrong == 0 ? 0 : 3;
  }

  Options options_;
  std::unique_ptr<Device> device_;
  std::vector<NamedLibrary> libraries_;
  std::vector<std::string> names_;  ///< of all libraries that have answered, but ours
  std::map<std::string, std::string> versions_;
  std::vector<Row> rows_;
  std::map<std::string, std::map<std::string, DistanceCount>> counts_;  ///< library, class
  std::size_t proved_ = 0;
  std::size_t disproved_ = 0;
  std::size_t rough_wrong_ = 0;
  std::size_t known_wrong_ = 0;
};

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  cchip::testing::Options o;
  CLI::App app{
      "Times and wrong answers of distance() and within(), FCL's, Coal's and those of Python's libraries.\n"
      "Exit codes: 0 done, 3 an answer of ours is wrong, 2 the run could not be made."};
  app.add_option("--poses", o.poses, "poses of each class and pair of meshes")->check(CLI::Range(1, 1000000));
  app.add_option("--passes", o.passes, "times are medians of so many passes")->check(CLI::Range(1, 100));
  app.add_option("--proofs", o.proofs, "poses of each row that brute force in integers checks");
  app.add_option("--seed", o.seed, "repeats the poses");
  app.add_flag("--nested,!--no-nested", o.nested, "one surface inside another, too (default)");
  app.add_option("--pairs", o.pairs, "pairs of meshes")
      ->delimiter(',')
      ->check(CLI::IsMember(cchip::testing::mesh_pair_names()));
  app.add_option("--python", o.python,
                 "a Python with trueform or MeshLib; scripts/run peers: build/touching/bin/python");
  app.add_option("--python-queries", o.python_queries, "file for the queries that it reads")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return cchip::testing::Benchmark(o).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "distance_speed: %s\n", error.what());
  return 2;
}
