// SPDX-License-Identifier: Apache-2.0
// Prints the cost of a tree and an image of a large mesh: tree_build [FACES ...].
// tree_build --open POSES [FACES ...] prints how many pairs of faces the model of the chip leaves open in queries of
// two such meshes, and compares its contacts with those of the CPU device.
#include <sys/resource.h>

#include <cchip/device.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/pose.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include "bvh_meshes.hpp"

using namespace cchip;

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Greatest resident memory of this process so far, MB.
double peak_megabytes() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// A mesh of about `faces` triangles.
Mesh large_mesh(int faces, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const int across = static_cast<int>(std::sqrt(faces / 6.0));
  return testing::noisy(make_torus(2, 0.7, 3 * across, across), 0.3 / across, random);
}

void build(int faces) {
  const Mesh mesh = large_mesh(faces, 1);
  const double before = peak_megabytes();
  const auto start = std::chrono::steady_clock::now();
  const bvh::Tree tree = bvh::build_tree(mesh);
  const double tree_time = seconds_since(start);
  const bvh::Image image = bvh::make_image(mesh, tree);
  const double time = seconds_since(start);
  const bvh::HeaderLine header = image.header();
  std::printf("faces=%zu tree_s=%.2f image_s=%.2f memory_mb=%.0f mesh_mb=%.0f lines=%u inner=%u leaves=%u depth=%d\n",
              mesh.faces.size(), tree_time, time - tree_time, peak_megabytes(), before, header.lines, header.inner,
              header.leaves, header.depth);
}

struct Class {
  const char* name;
  double least;  ///< distance of the centres over that at which the objects begin to touch
  double greatest;
};
constexpr Class classes[] = {{"touch", 0.95, 1.05}, {"near", 1.001, 1.02}, {"deep", 0.3, 0.7}};

/// \returns whether both devices found the same contacts
bool measure_open(int faces, int poses) {
  const Object a(large_mesh(faces, 1));
  const Object b(large_mesh(faces, 2));
  const auto cpu = open_device("cpu");
  const auto chip = open_device("model");
  CollisionRequest all;
  all.contacts = CollisionRequest::Contacts::all;
  std::size_t mismatches = 0;
  for (const Class& c : classes) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(c.least, c.greatest);
    std::size_t hits = 0;
    CollisionStats first;
    CollisionStats every;
    for (int i = 0; i < poses; ++i) {
      const Vec3d direction = testing::random_vector(random, 1).normalized();
      const Vec3d turn = testing::random_vector(random, 180);
      double near = 0;
      double far = 10;
      for (int step = 0; step < 40; ++step) {
        const double middle = (near + far) / 2;
        (collide(*cpu, a, Pose::Identity(), b, Pose(make_pose(middle * direction, turn))).hit ? near : far) = middle;
      }
      const Pose pose(make_pose(share(random) * far * direction, turn));
      first += collide(*chip, a, Pose::Identity(), b, pose).stats;
      const CollisionResult result = collide(*chip, a, Pose::Identity(), b, pose, all);
      every += result.stats;
      hits += result.hit ? 1 : 0;
      mismatches += result.contacts == collide(*cpu, a, Pose::Identity(), b, pose, all).contacts ? 0 : 1;
    }
    const auto percent = [](const CollisionStats& x) {
      return x.pairs == 0 ? 0 : 100 * static_cast<double>(x.open) / static_cast<double>(x.pairs);
    };
    std::printf(
        "faces=%zu pose=%s poses=%d hits=%zu mismatches=%zu first_pairs=%llu first_open=%llu first_open_percent=%.3f "
        "all_pairs=%llu all_open=%llu all_open_percent=%.3f\n",
        a.mesh().faces.size(), c.name, poses, hits, mismatches, static_cast<unsigned long long>(first.pairs),
        static_cast<unsigned long long>(first.open), percent(first), static_cast<unsigned long long>(every.pairs),
        static_cast<unsigned long long>(every.open), percent(every));
    std::fflush(stdout);
  }
  return mismatches == 0;
}

}  // namespace

int main(int argc, char** argv) {
  const bool open = argc > 2 && std::strcmp(argv[1], "--open") == 0;
  const int from = open ? 3 : 1;
  bool right = true;
  const auto run = [&](int faces) {
    if (open) {
      right = measure_open(faces, std::atoi(argv[2])) && right;
    } else {
      build(faces);
    }
  };
  for (int i = from; i < argc; ++i) run(std::atoi(argv[i]));
  if (argc == from) run(1000000);
  return right ? 0 : 1;
}
