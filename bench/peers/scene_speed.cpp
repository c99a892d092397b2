// SPDX-License-Identifier: Apache-2.0
// Scenes of moving objects: cchip::Scene and the DynamicAABBTreeCollisionManager of FCL and of Coal, the same frames in
// turns: docs/cpp/scenes.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/judge/brute_force.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/scene.hpp>
#include <cchip/shapes.hpp>
#include <functional>
#include <numeric>
#include <random>

#include "broad_peers.hpp"
#include "machine.hpp"
#include "measure.hpp"
#include "other_libraries.hpp"

namespace cchip::testing {
namespace {

struct Options {
  std::vector<std::size_t> sizes = {10, 100, 1000, 10000};
  double contacts = 6;
  int passes = 3;
  bool broad = false;  ///< only the table of broad phases
  std::uint64_t seed = sim::seed_from_environment();
};

/// Pairs in contact of a frame, by the objects' numbers, ascending.
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
using Frames = std::vector<std::vector<RigidPose>>;

/// Bodies with a diameter near 1 and some hundred triangles.
struct Bodies {
  Bodies() {
    const Mesh meshes[] = {make_sphere(0.5, 4), make_torus(0.35, 0.15, 20, 12), make_gear(0.4, 0.5, 0.15, 0.3, 10, 1),
                           make_body(4, 0.2)};
    for (const Mesh& mesh : meshes) objects.emplace_back(normalised(mesh));
  }
  std::vector<Object> objects;
};

/// An object that swings and turns.
struct Motion {
  Vec3d place;
  Vec3d swing;
  double phase;
  Vec3d angles;
  Vec3d turn;
  RigidPose pose(double time) const {
    return make_pose(place + std::sin(phase + 0.1 * time) * swing, angles + time * turn);
  }
};

/// In a cube so large that an object is near `contacts` of `objects`.
Motion make_motion(std::size_t objects, double contacts, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] {
    const double x = unit(random);
    const double y = unit(random);
    return Vec3d(x, y, unit(random));
  };
  // Bodies of diagonal 1 mostly touch if their middles are closer than 0.7.
  const double side = std::cbrt(static_cast<double>(objects) * 4.19 * 0.343 / contacts);
  Motion motion = {};
  motion.place = side / 2 * vector();
  motion.swing = 0.3 * vector();
  motion.phase = 3 * unit(random);
  motion.angles = 180 * vector();
  motion.turn = 3 * vector();
  return motion;
}

Frames make_frames(std::size_t objects, std::size_t frames, double contacts, std::mt19937_64& random) {
  Frames result(frames);
  for (std::size_t i = 0; i < objects; ++i) {
    const Motion motion = make_motion(objects, contacts, random);
    for (std::size_t k = 0; k < frames; ++k) result[k].push_back(motion.pose(static_cast<double>(k)));
  }
  return result;
}

/// One library's bodies.
struct TheirBodies {
  TheirBodies(const NamedLibrary& named, const Bodies& bodies) : name(named.name), functions(*named.library.scene()) {
    for (const Object& object : bodies.objects) meshes.push_back(named.library.mesh(object.mesh()));
  }
  std::string name;
  const CchipScenePeer& functions;
  std::vector<PeerMesh> meshes;
};

/// The manager of a library behind a C interface.
class TheirScene {
 public:
  TheirScene(const TheirBodies& bodies, const std::vector<RigidPose>& poses)
      : peer_(bodies.functions), scene_(nullptr, peer_.destroy) {
    std::vector<void*> models;
    for (std::size_t i = 0; i < poses.size(); ++i) models.push_back(bodies.meshes[i % bodies.meshes.size()].model());
    scene_.reset(peer_.make(models.data(), numbers_of(poses), poses.size()));
  }
  void move(const std::vector<RigidPose>& poses) { peer_.move(scene_.get(), numbers_of(poses)); }
  /// Not sorted.
  Pairs touching() {
    std::size_t count = peer_.contacts(scene_.get(), found_.data(), found_.size() / 2);
    if (2 * count > found_.size()) {
      found_.resize(4 * count);
      count = peer_.contacts(scene_.get(), found_.data(), found_.size() / 2);
    }
    Pairs pairs;
    for (std::size_t i = 0; i < count; ++i) pairs.emplace_back(found_[2 * i], found_[2 * i + 1]);
    return pairs;
  }
  std::size_t count_candidates() { return peer_.candidates(scene_.get()); }

 private:
  const double* numbers_of(const std::vector<RigidPose>& poses) {
    matrices_.clear();
    for (const RigidPose& pose : poses) matrices_.emplace_back(pose.matrix());
    return matrices_.front().data();
  }
  const CchipScenePeer& peer_;
  std::unique_ptr<void, void (*)(void*)> scene_;
  std::vector<Eigen::Matrix4d> matrices_;
  std::vector<std::uint32_t> found_;
};

/// Ours. An object's id is its number + 1.
struct OurScene {
  OurScene(const Bodies& bodies, const std::vector<RigidPose>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) scene.add(bodies.objects[i % bodies.objects.size()], poses[i]);
  }
  void move(const std::vector<RigidPose>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) scene.set_pose(i + 1, poses[i]);
  }
  Pairs touching(Device& device) const {
    Pairs pairs;
    for (const Scene::Pair& pair : scene.contacts(device)) pairs.emplace_back(pair.a - 1, pair.b - 1);
    return pairs;
  }
  Scene scene;
};

Pairs every_pair(const Scene& scene, Device& device) {
  Pairs pairs;
  for (Scene::Id a = 1; a <= scene.size(); ++a) {
    for (Scene::Id b = a + 1; b <= scene.size(); ++b) {
      const CollisionResult result = collide(device, scene.object(a), scene.pose(a), scene.object(b), scene.pose(b));
      if (result.hit) pairs.emplace_back(a - 1, b - 1);
    }
  }
  return pairs;
}

/// Pairs of one of them only.
Pairs difference(const Pairs& x, const Pairs& y) {
  Pairs result;
  std::set_symmetric_difference(x.begin(), x.end(), y.begin(), y.end(), std::back_inserter(result));
  return result;
}

class Benchmark {
 public:
  explicit Benchmark(const Options& options)
      : options_(options), one_(open_cpu_device({1, {}})), cores_(open_cpu_device()) {
    for (const NamedLibrary& named : open_libraries()) {
      if (named.library.broad() != nullptr) {
        broad_.push_back({named.name, [library = named.library] { return std::make_unique<LibraryBroad>(library); }});
      }
      if (named.library.scene() != nullptr) others_.emplace_back(named, bodies_);
    }
#ifdef CCHIP_HAS_BULLET
    broad_.push_back({"Bullet", [] { return std::make_unique<BulletBroad>(); }});
#endif
  }

  int run() {
    fmt::print("{}; load {}; {}; seed {}\n", machine_description(), load_description(), compiler, options_.seed);
    for (const auto& [name, library] : open_libraries()) {
      if (library.scene() != nullptr) fmt::print("{}: {}\n", name, library.description());
    }
    if (!options_.broad) {
      fmt::print("milliseconds a frame: every object moved, then all pairs in contact\n");
      fmt::print("objects  contacts each  FCL pairs  our pairs     ours  all cores");
      for (const TheirBodies& other : others_) fmt::print("  {:>10}  times", other.name);
      fmt::print("\n");
      for (const std::size_t objects : options_.sizes) run(objects);
    }
    fmt::print("milliseconds a step of the broad phase: some objects changed, then all pairs of boxes that overlap\n");
    fmt::print("objects  step                    pairs  ours  ");
    for (const auto& [name, make] : broad_) fmt::print("  {:>10}  times", name);
    fmt::print("\n");
    for (const std::size_t objects : options_.sizes) {
      run_broad(objects, Step::all_move);
      run_broad(objects, Step::some_move);
      run_broad(objects, Step::some_are_replaced);
    }
#ifndef CCHIP_HAS_BULLET
    fmt::print("without Bullet: scripts/bootstrap --dev brings it\n");
#endif
    if (*CCHIP_COAL_MODULE == 0) fmt::print("without Coal: scripts/run peers brings it\n");
    fmt::print("frames={} contacts={} their_differences={} differences={}\n", frames_, contacts_, their_differences_,
               differences_);
    return differences_ == 0 ? 0 : 3;
  }

 private:
  void run(std::size_t objects) {
    std::mt19937_64 random(options_.seed);
    const std::size_t frames = std::clamp<std::size_t>(40000 / objects, 8, 400);
    std::vector<std::vector<double>> seconds(2 + others_.size());
    std::size_t contacts = 0;
    std::size_t fcl_candidates = 0;
    std::size_t candidates = 0;
    for (int pass = 0; pass < options_.passes; ++pass) {
      const Frames poses = make_frames(objects, frames, options_.contacts, random);
      std::vector<TheirScene> theirs;
      for (const TheirBodies& other : others_) theirs.emplace_back(other, poses.front());
      OurScene ours(bodies_, poses.front());
      OurScene ours_cores = ours;
      std::vector<std::vector<Pairs>> their_pairs(others_.size(), std::vector<Pairs>(frames));
      std::vector<Pairs> our_pairs(frames);
      std::vector<Pairs> cores_pairs(frames);
      const auto each = [](const auto& action) {
        return [action](std::size_t first, std::size_t count) {
          for (std::size_t k = first; k < first + count; ++k) action(k);
        };
      };
      std::vector<Variant> ways = {{"ours", Clock::cpu, each([&](std::size_t k) {
                                      ours.move(poses[k]);
                                      our_pairs[k] = ours.touching(*one_);
                                    })},
                                   {"cores", Clock::wall, each([&](std::size_t k) {
                                      ours_cores.move(poses[k]);
                                      cores_pairs[k] = ours_cores.touching(*cores_);
                                    })}};
      for (std::size_t i = 0; i < others_.size(); ++i) {
        ways.push_back({others_[i].name, Clock::cpu, each([&, i](std::size_t k) {
                          theirs[i].move(poses[k]);
                          their_pairs[i][k] = theirs[i].touching();
                        })});
      }
      measure_pass(ways, frames, 4, [](std::size_t) {});
      for (std::size_t i = 0; i < ways.size(); ++i) seconds[i].push_back(ways[i].passes.front());
      for (std::size_t k = 0; k < frames; ++k) {
        contacts += our_pairs[k].size();
        ours.move(poses[k]);
        theirs[0].move(poses[k]);
        fcl_candidates += theirs[0].count_candidates();
        candidates += ours.scene.candidates().size();
        for (std::vector<Pairs>& pairs : their_pairs) {
          std::sort(pairs[k].begin(), pairs[k].end());
          compare(ours.scene, our_pairs[k], pairs[k]);
        }
        differences_ += difference(our_pairs[k], cores_pairs[k]).size();
        if (objects <= 100) differences_ += difference(our_pairs[k], every_pair(ours.scene, *one_)).size();
      }
    }
    frames_ += frames * static_cast<std::size_t>(options_.passes);
    contacts_ += contacts;
    std::vector<double> ms;
    for (const std::vector<double>& all : seconds) ms.push_back(1e3 * median(all));
    const double each = static_cast<double>(frames) * options_.passes * static_cast<double>(objects);
    fmt::print("{:7}  {:13.1f}  {:9.1f}  {:9.1f}  {:7.3f}  {:9.3f}", objects, 2 * static_cast<double>(contacts) / each,
               static_cast<double>(fcl_candidates) / each, static_cast<double>(candidates) / each, ms[0], ms[1]);
    for (std::size_t i = 2; i < ms.size(); ++i) fmt::print("  {:10.3f}  {:5.1f}", ms[i], ms[i] / ms[0]);
    fmt::print("\n");
    std::fflush(stdout);
  }

  enum class Step { all_move, some_move, some_are_replaced };

  /// The same steps for all in turns. The others are given our boxes, ours computes them from the poses.
  void run_broad(std::size_t objects, Step step) {
    std::mt19937_64 random(options_.seed);
    const std::size_t steps = std::clamp<std::size_t>(400000 / objects, 40, 400);
    const std::size_t count = step == Step::all_move ? objects : std::max<std::size_t>(1, objects / 100);
    std::vector<std::vector<double>> seconds(1 + broad_.size());
    std::size_t pairs = 0;
    for (int pass = 0; pass < options_.passes; ++pass) {
      std::vector<Motion> motions;
      std::vector<RigidPose> poses;
      std::vector<double> times(objects);
      std::vector<Scene::Id> ids;
      for (std::size_t i = 0; i < objects; ++i) {
        motions.push_back(make_motion(objects, options_.contacts, random));
        poses.push_back(motions.back().pose(0));
        ids.push_back(i + 1);
      }
      OurScene ours(bodies_, poses);
      OurScene boxes_of(bodies_, poses);  // for the others
      std::vector<WorldBox> boxes;
      for (std::size_t i = 0; i < objects; ++i) boxes.push_back(boxes_of.scene.box(i + 1));
      std::vector<std::unique_ptr<BroadPeer>> peers;
      for (const auto& [name, make] : broad_) peers.push_back(make());
      for (const auto& peer : peers) peer->begin(boxes);
      std::vector<double> total(1 + peers.size());
      std::vector<std::size_t> numbers(objects);
      std::iota(numbers.begin(), numbers.end(), std::size_t{0});
      const std::size_t unmeasured = 2;  // what begins is not a step
      for (std::size_t k = 0; k < steps + unmeasured; ++k) {
        std::vector<std::size_t> changed = numbers;
        if (count < objects) {
          changed.clear();
          std::sample(numbers.begin(), numbers.end(), std::back_inserter(changed), count, random);
        }
        poses.clear();
        boxes.clear();
        for (const std::size_t i : changed) {
          if (step == Step::some_are_replaced) motions[i] = make_motion(objects, options_.contacts, random);
          poses.push_back(motions[i].pose(++times[i]));
          boxes_of.scene.set_pose(i + 1, poses.back());
          boxes.push_back(boxes_of.scene.box(i + 1));
        }
        std::vector<std::size_t> found(1 + peers.size());
        for (std::size_t turn = 0; turn < found.size(); ++turn) {
          const std::size_t who = (turn + k) % found.size();
          const double start = cchip::testing::seconds(Clock::cpu);
          if (who > 0) {
            BroadPeer& peer = *peers[who - 1];
            if (step == Step::some_are_replaced) {
              peer.replace(changed, boxes);
            } else {
              peer.move(changed, boxes);
            }
            found[who] = peer.count();
          } else {
            for (std::size_t i = 0; i < changed.size(); ++i) {
              Scene::Id& id = ids[changed[i]];
              if (step == Step::some_are_replaced) {
                ours.scene.remove(id);
                id = ours.scene.add(bodies_.objects[changed[i] % bodies_.objects.size()], poses[i]);
              } else {
                ours.scene.set_pose(id, poses[i]);
              }
            }
            found[who] = ours.scene.candidates().size();
          }
          if (k >= unmeasured) total[who] += cchip::testing::seconds(Clock::cpu) - start;
        }
        for (const std::size_t x : found) differences_ += x == found[0] ? 0 : 1;
        if (k >= unmeasured) pairs += found[0];
      }
      for (std::size_t i = 0; i < total.size(); ++i) seconds[i].push_back(total[i] / static_cast<double>(steps));
    }
    const double ours = 1e3 * median(seconds[0]);
    const char* names[] = {"all move", "1 % moves", "1 % out, 1 % in"};
    fmt::print("{:7}  {:16}  {:11.1f}  {:6.3f}", objects, names[static_cast<int>(step)],
               static_cast<double>(pairs) / static_cast<double>(steps) / options_.passes, ours);
    for (std::size_t i = 1; i < seconds.size(); ++i) {
      const double theirs = 1e3 * median(seconds[i]);
      fmt::print("  {:10.3f}  {:5.2f}", theirs, theirs / ours);
    }
    fmt::print("\n");
    std::fflush(stdout);
  }

  /// Where another library says otherwise, integers of any size decide over all pairs of faces.
  void compare(const Scene& scene, const Pairs& ours, const Pairs& theirs) {
    for (const auto& [a, b] : difference(ours, theirs)) {
      const bool touch = !brute_force_contacts(scene.object(a + 1).mesh(), scene.pose(a + 1),
                                               scene.object(b + 1).mesh(), scene.pose(b + 1))
                              .empty();
      const bool we_say = std::binary_search(ours.begin(), ours.end(), std::make_pair(a, b));
      ++(touch == we_say ? their_differences_ : differences_);
    }
  }

  Options options_;
  Bodies bodies_;
  std::vector<TheirBodies> others_;  ///< FCL of Debian first
  std::unique_ptr<Device> one_;      ///< one thread
  std::unique_ptr<Device> cores_;
  struct Broad {
    std::string name;
    std::function<std::unique_ptr<BroadPeer>()> make;
  };
  std::vector<Broad> broad_;  ///< of other libraries
  std::size_t frames_ = 0;
  std::size_t contacts_ = 0;
  std::size_t their_differences_ = 0;
  std::size_t differences_ = 0;  ///< pairs of ours that are not the exact ones
};

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  cchip::testing::Options o;
  CLI::App app{
      "Frames of scenes of moving objects: cchip::Scene on the CPU device and the DynamicAABBTreeCollisionManager of "
      "FCL "
      "and of Coal, the same frames in turns. Then broad phases alone, Bullet's btDbvtBroadphase included.\n"
      "The last line: frames, pairs in contact, those in which another library is not exact, those in which we are "
      "not: exact integers decide where one says otherwise, up to 100 objects every pair is asked, and all broad "
      "phases "
      "must count as many pairs.\n"
      "Exit codes: 0 done, 3 an answer of ours is not the exact one, 2 the run could not be made."};
  app.add_option("--objects", o.sizes, "numbers of objects, one scene after the other")
      ->delimiter(',')
      ->check(CLI::Range(2, 1000000))
      ->capture_default_str();
  app.add_option("--contacts", o.contacts, "others that an object is near")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  app.add_option("--passes", o.passes, "passes, each with its own scene; times are their medians")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "repeats the scenes (or CCHIP_SEED)")->capture_default_str();
  app.add_flag("--broad", o.broad, "only the table of broad phases");
  auto* quick = app.add_flag("--quick", "up to 1,000 objects in one pass, for a first look; its ratios are rough");
  CLI11_PARSE(app, argc, argv);
  if (*quick) {
    o.sizes = {10, 100, 1000};
    o.passes = 1;
  }
  return cchip::testing::Benchmark(o).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "scene_speed: %s\n", error.what());
  return 2;
}
