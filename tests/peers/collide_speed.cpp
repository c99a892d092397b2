// SPDX-License-Identifier: Apache-2.0
// Queries per second of the CPU device and of FCL (OBBRSS, as Debian builds it), the same poses, yes or no, one thread.
#include <fmt/format.h>

#include <cchip/device/device.hpp>
#include <cchip/mesh/shapes.hpp>
#include <chrono>
#include <cmath>
#include <functional>
#include <random>

#include "fcl_model.hpp"

using namespace cchip;
using namespace cchip::testing;

namespace {

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Poses of B along a random direction from A's centre, at `share` of the distance at which they just touch.
std::vector<Eigen::Isometry3d> poses_at(Device& device, const Object& a, const Object& b, double share, int count) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < count; ++i) {
    const double x = normal(random);
    const double y = normal(random);
    const Vec3d direction = Vec3d(x, y, normal(random)).normalized();
    const Vec3d turn = 180 * direction;
    double near = 0;
    double far = 10;
    for (int step = 0; step < 40; ++step) {
      const double middle = (near + far) / 2;
      const Pose pose(make_pose(middle * direction, turn));
      (collide(device, a, Pose::Identity(), b, pose).hit ? near : far) = middle;
    }
    poses.push_back(make_pose(share * far * direction, turn));
  }
  return poses;
}

void measure(const char* name, const Mesh& mesh_a, const Mesh& mesh_b, int count) {
  const auto device = open_device("cpu");
  const Object a(mesh_a);
  const Object b(mesh_b);
  const auto model_a = fcl_model(mesh_a);
  const auto model_b = fcl_model(mesh_b);
  for (const auto& [kind, share] : {std::pair("touch", 1 - 1e-9), std::pair("near", 1.01), std::pair("deep", 0.7)}) {
    const auto poses = poses_at(*device, a, b, share, count);
    int hits = 0;
    int fcl_hits = 0;
    CollisionCounts counts;
    const double ours = seconds_of([&] {
      for (const auto& pose : poses) {
        const CollisionResult result = collide(*device, a, Pose::Identity(), b, Pose(pose));
        hits += result.hit;
        counts += result.counts;
      }
    });
    const double theirs = seconds_of([&] {
      for (const auto& pose : poses) {
        fcl_hits += fcl_collide(*model_a, Eigen::Isometry3d::Identity(), *model_b, pose).isCollision();
      }
    });
    const double n = static_cast<double>(poses.size());
    fmt::print("{:<16}{:<6}{:>7}{:>7}{:>10}{:>12.0f}{:>12.0f}{:>8.2f}{:>9.1f}{:>10.1f}{:>8.1f}{:>7}\n", name, kind,
               poses.size(), hits, fcl_hits, n / ours, n / theirs, theirs / ours, static_cast<double>(counts.steps) / n,
               static_cast<double>(counts.box_tests) / n, static_cast<double>(counts.pairs) / n, counts.open);
  }
}

}  // namespace

int main() {
  fmt::print("{:<16}{:<6}{:>7}{:>7}{:>10}{:>12}{:>12}{:>8}{:>9}{:>10}{:>8}{:>7}\n", "meshes", "pose", "poses", "hits",
             "FCL hits", "queries/s", "FCL's", "times", "steps", "box tests", "pairs", "open");
  measure("torus, gear", make_torus(1, 0.25, 64, 32), make_gear(1.25, 1.5, 0.5, 0.5, 36, 6), 300);
  measure("spheres, 50000", make_sphere(1, 50, 0.02), make_sphere(1, 50, 0.02, 2), 300);
}
