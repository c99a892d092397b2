// SPDX-License-Identifier: Apache-2.0
// Poses of many meshes through the simulated device against the CPU device.
#include <fmt/format.h>

#include <algorithm>
#include <cchip/cpu/cpu_device.hpp>
#include <cchip/exact/posed_pairs.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/mesh/shapes.hpp>

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

struct PosesTotals {
  std::size_t queries = 0, hits = 0, differences = 0;
  std::uint64_t contacts = 0, open = 0, fallbacks = 0, clocks = 0;
};

class PosesCampaign {
 public:
  explicit PosesCampaign(const PosesSettings& settings) : settings_(settings), cpu_(open_cpu_device({1, ""})) {}

  int run() {
    if (settings_.meshes.empty()) settings_.meshes = campaign_meshes();
    fmt::print("seed={}\n{:<14} {:<5} {:>8} {:>8} {:>10} {:>8} {:>9} {:>10} {:>11}\n", settings_.seed, "meshes", "mode",
               "queries", "hits", "contacts", "open", "fallbacks", "clocks", "differences");
    for (const std::string& name : settings_.meshes) run_pair(name);
    fmt::print("queries={} hits={} differences={} contacts={} open={} fallbacks={} clocks_mean={:.1f}\n",
               total_.queries, total_.hits, total_.differences, total_.contacts, total_.open, total_.fallbacks,
               static_cast<double>(total_.clocks) / std::max(1.0, static_cast<double>(total_.queries)));
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
      PosesTotals now;
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
      total_.queries += now.queries;
      total_.hits += now.hits;
      total_.differences += now.differences;
      total_.contacts += now.contacts;
      total_.open += now.open;
      total_.fallbacks += now.fallbacks;
      total_.clocks += now.clocks;
    }
  }

  void answer(PoseMaker& maker, Random& random, const Object& a, const Object& b, Device& device, std::size_t count,
              bool all, PosesTotals& now) {
    std::vector<PosePair> poses;
    const Approach approach = maker.approach();
    for (std::size_t i = 0; i < count; ++i) {
      poses.push_back(maker.pose(approach, pose_classes[random() % std::size(pose_classes)]));
    }
    CollisionRequest request;
    if (all) request.contacts = CollisionRequest::Contacts::all;
    const std::vector<CollisionResult> right = collide(*cpu_, a, b, poses, request);
    const std::vector<CollisionResult> got = collide(device, a, b, poses, request);
    for (std::size_t i = 0; i < count; ++i) {
      const CollisionResult& x = got[i];
      ++now.queries;
      now.hits += x.hit ? 1 : 0;
      now.contacts += x.contacts.size();
      now.open += x.counts.open;
      now.fallbacks += x.counts.fallbacks;
      now.clocks += x.counts.clocks;
      const bool same = all ? x.hit == right[i].hit && x.contacts == right[i].contacts
                            : x.hit == right[i].hit && named_contact_holds(a, b, poses[i], x);
      if (same) continue;
      ++now.differences;
      fmt::print("a query differs: hit {} {}, contacts {} {}\n", x.hit, right[i].hit, x.contacts.size(),
                 right[i].contacts.size());
    }
  }

  /// The device may name any contact.
  static bool named_contact_holds(const Object& a, const Object& b, const PosePair& pose, const CollisionResult& x) {
    if (!x.hit) return x.contacts.empty();
    if (x.contacts.size() != 1) return false;
    if (!a.mesh().file_face.empty() || !b.mesh().file_face.empty()) return true;  // numbers of cut polygons
    return PosedPairs(pose.a, pose.b)
        .decide(a.mesh().primitive(x.contacts[0].face_a), b.mesh().primitive(x.contacts[0].face_b))
        .hit;
  }

  PosesSettings settings_;
  std::unique_ptr<Device> cpu_;
  PosesTotals total_;
};

}  // namespace

int run_poses(const PosesSettings& settings) { return PosesCampaign(settings).run(); }

}  // namespace cchip::testing
