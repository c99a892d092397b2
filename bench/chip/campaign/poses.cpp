// SPDX-License-Identifier: Apache-2.0
// Poses of many meshes through the simulated device against the CPU device.
#include <fmt/format.h>

#include <algorithm>
#include <cchip/cpu_device.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/shapes.hpp>

#include "campaign.hpp"
#include "mesh_pairs.hpp"

namespace cchip::testing {
namespace {

std::vector<std::string> campaign_meshes() {
  std::vector<std::string> names = mesh_pair_names();
  names.insert(names.end(), {"torus-gear", "quads-quads", "sphere-quads"});
  return names;
}

MeshPair campaign_pair(const std::string& name) {
  if (name == "torus-gear") return {name, make_torus(1, 0.25, 64, 32), make_gear(1.25, 1.5, 0.5, 0.5, 36, 6)};
  if (name == "quads-quads") {
    return {name, make_torus(1, 0.25, 96, 48, Kind::quad), make_torus(0.7, 0.3, 64, 48, Kind::quad)};
  }
  if (name == "sphere-quads") return {name, make_body(24, 0.3, 5), make_torus(1, 0.4, 64, 32, Kind::quad)};
  return mesh_pair(name);
}

class PosesCampaign {
 public:
  explicit PosesCampaign(const PosesSettings& settings) : settings_(settings), cpu_(open_cpu_device({1, ""})) {}

  int run() {
    if (settings_.meshes.empty()) settings_.meshes = campaign_meshes();
    fmt::print("seed={}\n{:<14} {:<5} {:>8} {:>8} {:>10} {:>8} {:>9} {:>10} {:>11}\n", settings_.seed, "meshes", "mode",
               "queries", "hits", "contacts", "open", "fallbacks", "clocks", "differences");
    for (const std::string& name : settings_.meshes) run_pair(name);
    fmt::print("{}\n", total_.summary());
    return total_.queries != 0 && total_.differences == 0 ? 0 : 3;
  }

 private:
  void run_pair(const std::string& name) {
    const MeshPair meshes = campaign_pair(name);
    const Object a(meshes.a);
    const Object b(meshes.b);
    PoseMaker maker(*cpu_, a, b, settings_.seed);
    Random random(settings_.seed);
    SimulatedChipOptions chip;
    chip.seed = settings_.seed;
    chip.memory = any_memory(random);
    const std::unique_ptr<Device> device = open_simulated_chip(chip);
    const std::size_t pairs = settings_.meshes.size();
    for (const bool all : {false, true}) {
      Totals now;
      const std::size_t poses = ((all ? settings_.all : settings_.first) + pairs - 1) / pairs;
      for (std::size_t done = 0; done < poses;) {
        const std::size_t batch = std::min<std::size_t>(poses - done, 1 + random() % 200);
        answer(maker, random, a, b, *device, batch, all, now);
        done += batch;
      }
      fmt::print("{:<14} {:<5} {:>8} {:>8} {:>10} {:>8} {:>9} {:>10.1f} {:>11}\n", name, all ? "all" : "first",
                 now.queries, now.hits, now.contacts, now.open, now.fallbacks,
                 static_cast<double>(now.clocks) / std::max(1.0, static_cast<double>(now.queries)), now.differences);
      std::fflush(stdout);
      total_ += now;
    }
  }

  void answer(PoseMaker& maker, Random& random, const Object& a, const Object& b, Device& device, std::size_t count,
              bool all, Totals& now) {
    std::vector<PosePair> poses;
    const Approach approach = maker.approach();
    for (std::size_t i = 0; i < count; ++i) {
      poses.push_back(maker.pose(approach, pose_classes[random() % std::size(pose_classes)]));
    }
    compare(*cpu_, device, a, b, poses, all, now);
  }

  PosesSettings settings_;
  std::unique_ptr<Device> cpu_;
  Totals total_;
};

}  // namespace

int run_poses(const PosesSettings& settings) { return PosesCampaign(settings).run(); }

}  // namespace cchip::testing
