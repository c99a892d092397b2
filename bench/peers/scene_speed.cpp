// SPDX-License-Identifier: Apache-2.0
// Scenes of moving objects: cchip::Scene and FCL's DynamicAABBTreeCollisionManager, the same frames in turns:
// docs/cpp/scenes.md.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/config.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/collide/scene.hpp>
#include <cchip/cpu/cpu_device.hpp>
#include <cchip/internal/reference/brute_force.hpp>
#include <cchip/mesh/shapes.hpp>
#include <cchip/sim/seed.hpp>
#include <numeric>
#include <random>

#include "broad_peers.hpp"
#include "fcl_model.hpp"
#include "machine.hpp"
#include "measure.hpp"

namespace cchip::testing {
namespace {

#ifdef CCHIP_HAS_BULLET
constexpr bool has_bullet = true;
#else
constexpr bool has_bullet = false;
#endif

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
    for (const Mesh& mesh : meshes) {
      objects.emplace_back(normalised(mesh));
      models.push_back(fcl_model(objects.back().mesh()));
    }
  }
  std::vector<Object> objects;
  std::vector<std::shared_ptr<FclModel>> models;
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

/// FCL's manager.
class FclScene {
 public:
  FclScene(const Bodies& bodies, const std::vector<RigidPose>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      objects_.push_back(std::make_unique<fcl::CollisionObject<double>>(bodies.models[i % bodies.models.size()],
                                                                        Eigen::Isometry3d(poses[i].matrix())));
      numbers_.push_back(i);
    }
    std::vector<fcl::CollisionObject<double>*> pointers;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      objects_[i]->setUserData(&numbers_[i]);
      pointers.push_back(objects_[i].get());
    }
    manager_.registerObjects(pointers);
    manager_.setup();
  }

  void move(const std::vector<RigidPose>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      objects_[i]->setTransform(Eigen::Isometry3d(poses[i].matrix()));
      objects_[i]->computeAABB();
    }
    manager_.update();
  }
  /// Not sorted.
  Pairs touching() {
    Pairs pairs;
    manager_.collide(&pairs, [](fcl::CollisionObject<double>* a, fcl::CollisionObject<double>* b, void* to) {
      const fcl::CollisionRequest<double> request(1, false);
      fcl::CollisionResult<double> result;
      if (fcl::collide(a, b, request, result) > 0) {
        static_cast<Pairs*>(to)->push_back(std::minmax(number(*a), number(*b)));
      }
      return false;
    });
    return pairs;
  }
  std::size_t count_candidates() {
    std::size_t count = 0;
    manager_.collide(&count, [](fcl::CollisionObject<double>*, fcl::CollisionObject<double>*, void* to) {
      ++*static_cast<std::size_t*>(to);
      return false;
    });
    return count;
  }

 private:
  static std::size_t number(const fcl::CollisionObject<double>& object) {
    return *static_cast<std::size_t*>(object.getUserData());
  }
  fcl::DynamicAABBTreeCollisionManager<double> manager_;
  std::vector<std::unique_ptr<fcl::CollisionObject<double>>> objects_;
  std::vector<std::size_t> numbers_;
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
      : options_(options), one_(open_cpu_device({1, {}})), cores_(open_cpu_device()) {}

  int run() {
    fmt::print("{}; load {}; {}; FCL {} of Debian; seed {}\n", machine_description(), load_description(), compiler,
               FCL_VERSION, options_.seed);
    if (!options_.broad) {
      fmt::print("milliseconds a frame: every object moved, then all pairs in contact\n");
      fmt::print("objects  contacts each  FCL pairs  our pairs  FCL      ours     times  all cores  times\n");
      for (const std::size_t objects : options_.sizes) run(objects);
    }
    fmt::print("milliseconds a step of the broad phase: some objects changed, then all pairs of boxes that overlap\n");
    fmt::print("objects  step                    pairs  ours    FCL     times  Bullet  times\n");
    for (const std::size_t objects : options_.sizes) {
      run_broad(objects, Step::all_move);
      run_broad(objects, Step::some_move);
      run_broad(objects, Step::some_are_replaced);
    }
    if (!has_bullet) fmt::print("without Bullet: scripts/bootstrap --dev brings it\n");
    fmt::print("frames={} contacts={} fcl_differences={} differences={}\n", frames_, contacts_, fcl_differences_,
               differences_);
    return differences_ == 0 ? 0 : 3;
  }

 private:
  void run(std::size_t objects) {
    std::mt19937_64 random(options_.seed);
    const std::size_t frames = std::clamp<std::size_t>(40000 / objects, 8, 400);
    std::vector<std::vector<double>> seconds(3);
    std::size_t contacts = 0;
    std::size_t fcl_candidates = 0;
    std::size_t candidates = 0;
    for (int pass = 0; pass < options_.passes; ++pass) {
      const Frames poses = make_frames(objects, frames, options_.contacts, random);
      FclScene theirs(bodies_, poses.front());
      OurScene ours(bodies_, poses.front());
      OurScene ours_cores = ours;
      std::vector<Pairs> their_pairs(frames);
      std::vector<Pairs> our_pairs(frames);
      std::vector<Pairs> cores_pairs(frames);
      const auto each = [](const auto& action) {
        return [action](std::size_t first, std::size_t count) {
          for (std::size_t k = first; k < first + count; ++k) action(k);
        };
      };
      std::vector<Variant> ways = {{"FCL", Clock::cpu, each([&](std::size_t k) {
                                      theirs.move(poses[k]);
                                      their_pairs[k] = theirs.touching();
                                    })},
                                   {"ours", Clock::cpu, each([&](std::size_t k) {
                                      ours.move(poses[k]);
                                      our_pairs[k] = ours.touching(*one_);
                                    })},
                                   {"cores", Clock::wall, each([&](std::size_t k) {
                                      ours_cores.move(poses[k]);
                                      cores_pairs[k] = ours_cores.touching(*cores_);
                                    })}};
      measure_pass(ways, frames, 4, [](std::size_t) {});
      for (std::size_t i = 0; i < ways.size(); ++i) seconds[i].push_back(ways[i].passes.front());
      for (std::size_t k = 0; k < frames; ++k) {
        contacts += our_pairs[k].size();
        std::sort(their_pairs[k].begin(), their_pairs[k].end());
        ours.move(poses[k]);
        theirs.move(poses[k]);
        fcl_candidates += theirs.count_candidates();
        candidates += ours.scene.candidates().size();
        compare(ours.scene, our_pairs[k], their_pairs[k]);
        differences_ += difference(our_pairs[k], cores_pairs[k]).size();
        if (objects <= 100) differences_ += difference(our_pairs[k], every_pair(ours.scene, *one_)).size();
      }
    }
    frames_ += frames * static_cast<std::size_t>(options_.passes);
    contacts_ += contacts;
    std::vector<double> ms;
    for (const std::vector<double>& all : seconds) ms.push_back(1e3 * median(all));
    const double each = static_cast<double>(frames) * options_.passes * static_cast<double>(objects);
    fmt::print("{:7}  {:13.1f}  {:9.1f}  {:9.1f}  {:7.3f}  {:7.3f}  {:5.1f}  {:9.3f}  {:5.1f}\n", objects,
               2 * static_cast<double>(contacts) / each, static_cast<double>(fcl_candidates) / each,
               static_cast<double>(candidates) / each, ms[0], ms[1], ms[0] / ms[1], ms[2], ms[0] / ms[2]);
    std::fflush(stdout);
  }

  enum class Step { all_move, some_move, some_are_replaced };

  /// The same steps for all in turns. The others are given our boxes, ours computes them from the poses.
  void run_broad(std::size_t objects, Step step) {
    std::mt19937_64 random(options_.seed);
    const std::size_t steps = std::clamp<std::size_t>(400000 / objects, 40, 400);
    const std::size_t count = step == Step::all_move ? objects : std::max<std::size_t>(1, objects / 100);
    std::vector<std::vector<double>> seconds(3);
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
      peers.push_back(std::make_unique<FclBroad>());
#ifdef CCHIP_HAS_BULLET
      peers.push_back(std::make_unique<BulletBroad>());
#endif
      for (const auto& peer : peers) peer->begin(boxes);
      std::vector<double> total(3);
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
    const double fcl = 1e3 * median(seconds[1]);
    const double bullet = 1e3 * median(seconds[2]);
    const char* names[] = {"all move", "1 % moves", "1 % out, 1 % in"};
    fmt::print("{:7}  {:16}  {:11.1f}  {:6.3f}  {:6.3f}  {:5.2f}", objects, names[static_cast<int>(step)],
               static_cast<double>(pairs) / static_cast<double>(steps) / options_.passes, ours, fcl, fcl / ours);
    fmt::print(has_bullet ? "  {:6.3f}  {:5.2f}\n" : "\n", bullet, bullet / ours);
    std::fflush(stdout);
  }

  /// Where FCL says otherwise, integers of any size decide over all pairs of faces.
  void compare(const Scene& scene, const Pairs& ours, const Pairs& theirs) {
    for (const auto& [a, b] : difference(ours, theirs)) {
      const bool touch = !brute_force_contacts(scene.object(a + 1).mesh(), scene.pose(a + 1),
                                               scene.object(b + 1).mesh(), scene.pose(b + 1))
                              .empty();
      const bool we_say = std::binary_search(ours.begin(), ours.end(), std::make_pair(a, b));
      ++(touch == we_say ? fcl_differences_ : differences_);
    }
  }

  Options options_;
  Bodies bodies_;
  std::unique_ptr<Device> one_;  ///< one thread
  std::unique_ptr<Device> cores_;
  std::size_t frames_ = 0;
  std::size_t contacts_ = 0;
  std::size_t fcl_differences_ = 0;
  std::size_t differences_ = 0;  ///< pairs of ours that are not the exact ones
};

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  cchip::testing::Options o;
  CLI::App app{
      "Frames of scenes of moving objects: cchip::Scene on the CPU device and FCL's DynamicAABBTreeCollisionManager, "
      "the same frames in turns. Then broad phases alone, Bullet's btDbvtBroadphase included.\n"
      "The last line: frames, pairs in contact, those in which FCL is not exact, those in which we are not: exact "
      "integers decide where FCL says otherwise, up to 100 objects every pair is asked, and all broad phases must "
      "count "
      "as many pairs.\n"
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
