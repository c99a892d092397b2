// SPDX-License-Identifier: Apache-2.0
// Prints the cost of a tree and an image of a large mesh: tree_build [FACES ...].
#include <sys/resource.h>

#include <cchip/bvh/image.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
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

void build(int faces) {
  std::mt19937_64 random(1);
  const int across = static_cast<int>(std::sqrt(faces / 6.0));
  const Mesh mesh = testing::noisy(make_torus(2, 0.7, 3 * across, across), 0.3 / across, random);
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

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) build(std::atoi(argv[i]));
  if (argc == 1) build(1000000);
}
