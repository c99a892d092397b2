// SPDX-License-Identifier: Apache-2.0
// Time of within() and distance() beside that of collide(), for the pairs of meshes of docs/cpp/speed.md:
// docs/cpp/distance.md.
#include <cchip/cpu/distance.hpp>
#include <cchip/device/device.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "mesh_pairs.hpp"

namespace {

using namespace cchip;
using cchip::testing::PoseClass;

/// Mean microseconds of a call, the least of three passes.
template <class Call>
double time_of(std::size_t count, const Call& call) {
  double least = 0;
  for (int pass = 0; pass < 3; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) call(i);
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
    const double mean = time.count() / static_cast<double>(count);
    if (pass == 0 || mean < least) least = mean;
  }
  return least;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100;
  if (count == 0) {
    std::fputs("usage: distance_speed [POSES]: at least 1\n", stderr);
    return 2;
  }
  const auto device = open_device("cpu");
  std::puts(
      "| pair | pose | collide() | within half the distance | within twice the distance | distance(), 1 % | distance() "
      "|");
  std::puts("|---|---|---|---|---|---|---|");
  for (const std::string& name : testing::mesh_pair_names()) {
    testing::MeshPair meshes = testing::mesh_pair(name);
    if (!meshes.counts) continue;
    const Object a(std::move(meshes.a));
    const Object b(std::move(meshes.b));
    testing::PoseMaker maker(*device, a, b, 1);
    for (const PoseClass pose_class : {PoseClass::near, PoseClass::far}) {
      std::vector<PosePair> poses;
      std::vector<double> distances;
      while (poses.size() < count) {
        const PosePair pose = maker.pose(maker.approach(), pose_class);
        const double here = distance(a, pose.a, b, pose.b).upper;
        if (here == 0) continue;
        poses.push_back(pose);
        distances.push_back(here);
      }
      const auto within_factor = [&](double factor) {
        return time_of(count, [&](std::size_t i) { within(a, poses[i].a, b, poses[i].b, factor * distances[i]); });
      };
      const auto distance_within = [&](double rel_error) {
        DistanceRequest request;
        request.rel_error = rel_error;
        return time_of(count, [&](std::size_t i) { distance(a, poses[i].a, b, poses[i].b, request); });
      };
      const double alone = time_of(count, [&](std::size_t i) { collide(a, poses[i].a, b, poses[i].b); });
      std::printf("| %s | %s | %.2f | %.2f | %.2f | %.1f | %.1f |\n", name.c_str(), testing::name_of(pose_class), alone,
                  within_factor(0.5), within_factor(2), distance_within(0.01), distance_within(0));
      std::fflush(stdout);
    }
  }
}
