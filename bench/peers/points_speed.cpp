// SPDX-License-Identifier: Apache-2.0
// Time of a query of a point cloud and an object, for docs/cpp/points.md: a room of points as a depth camera sees it,
// and a body as large as the link of a robot.
#include <cchip/point_cloud.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "measure.hpp"

namespace {

using namespace cchip;

/// Walls, a floor and boxes on it, with noise as of a sensor: a room of 4 x 4 x 2.5, in metres.
std::vector<Vec3d> room(std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> noise(0, 0.003);
  std::vector<Vec3d> points(count);
  const Vec3d boxes[] = {{0.8, 0.6, 0.4}, {-1.1, 0.9, 0.7}, {0.3, -1.3, 1.1}, {-0.7, -0.8, 0.3}};
  for (Vec3d& p : points) {
    const double u = unit(random);
    const double v = unit(random);
    const auto which = random() % 8;
    if (which < 3) {
      p = Vec3d(4 * u - 2, 4 * v - 2, 0);
    } else if (which < 5) {
      p = which == 3 ? Vec3d(-2, 4 * u - 2, 2.5 * v) : Vec3d(4 * u - 2, 2, 2.5 * v);
    } else {  // the sides of a box
      const Vec3d& corner = boxes[random() % 4];
      const double size = 0.4;
      Vec3d q(u, v, 0);
      q = (random() % 3 == 0) ? Vec3d(u, v, 1) : (random() % 2 == 0) ? Vec3d(1, u, v) : Vec3d(u, 0, v);
      p = Vec3d(corner.x() + size * q.x(), corner.y() + size * q.y(), corner.z() * q.z());
    }
    for (double& x : p) x += noise(random);
  }
  return points;
}

/// Of the processor's time, so that other programs on the computer count less.
double microseconds() { return 1e6 * testing::seconds(testing::Clock::cpu); }

}  // namespace

int main(int argc, char** argv) {
  const std::size_t poses = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1000;
  if (poses == 0) {
    std::fputs("usage: points_speed [POSES]: at least 1\n", stderr);
    return 2;
  }
  std::puts(
      "| points | faces | answer | poses | first contact, us | nodes | pairs | exactly | all contacts, us | contacts "
      "|");
  std::puts("|---|---|---|---|---|---|---|---|---|---|");
  for (const std::size_t count : {std::size_t{10000}, std::size_t{100000}, std::size_t{1000000}}) {
    std::mt19937_64 random(1);
    const std::vector<Vec3d> points = room(count, random);
    const double start = microseconds();
    const PointCloud cloud(points, 0.01);
    const double build = microseconds() - start;
    for (const int cuts : {7, 22}) {
      Mesh mesh = make_body(cuts, 0.3);
      for (Vec3d& v : mesh.vertices) v = Vec3d(0.08 * v.x(), 0.08 * v.y(), 0.2 * v.z());  // 0.4 long
      const Object link(std::move(mesh));
      std::uniform_real_distribution<double> unit(-1, 1);
      // Poses all over the room, and those near its contents: clear by at most 0.05.
      enum Kind { clear, near_by, hit };
      std::vector<Pose> of[3];
      const PointCloud wider(points, 0.06);
      for (std::size_t tries = 0; tries < 300 * poses; ++tries) {
        Vec3d at;
        Vec3d turn;
        for (double& x : at) x = unit(random);
        for (double& x : turn) x = 180 * unit(random);
        const Pose pose = make_pose(Vec3d(1.8 * at.x(), 1.8 * at.y(), 1.2 + at.z()), turn);
        const Kind kind = collide(cloud, Pose::Identity(), link, pose).hit   ? hit
                          : collide(wider, Pose::Identity(), link, pose).hit ? near_by
                                                                             : clear;
        if (of[kind].size() < poses) of[kind].push_back(pose);
        if (of[clear].size() + of[near_by].size() + of[hit].size() == 3 * poses) break;
      }
      const char* const names[] = {"clear", "clear, near", "contact"};
      for (const Kind kind : {clear, near_by, hit}) {
        CloudResult result;
        double time[2] = {0, 0};
        CollisionStats counts;
        std::size_t contacts = 0;
        for (const bool all : {false, true}) {
          CloudRequest request;
          if (all) request.contacts = CollisionRequest::Contacts::all;
          for (int pass = 0; pass < 3; ++pass) {
            const double begin = microseconds();
            for (const Pose& pose : of[kind]) {
              collide(cloud, Pose::Identity(), link, pose, request, result);
              if (pass == 0 && !all) counts += result.stats;
              if (pass == 0 && all) contacts += result.contacts.size();
            }
            const double mean = (microseconds() - begin) / static_cast<double>(of[kind].size());
            if (pass == 0 || mean < time[all]) time[all] = mean;
          }
        }
        const auto mean = [&](std::uint64_t x) {
          return static_cast<double>(x) / static_cast<double>(of[kind].size());
        };
        std::printf("| %zu | %zu | %s | %zu | %.2f | %.0f | %.0f | %.3f | %.1f | %.0f |\n", count,
                    link.mesh().faces.size(), names[kind], of[kind].size(), time[0], mean(counts.steps),
                    mean(counts.pairs), mean(counts.open), time[1], mean(contacts));
        std::fflush(stdout);
      }
    }
    std::printf("%zu points: cloud built in %.1f ms\n", count, build / 1000);
  }
}
