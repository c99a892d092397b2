// SPDX-License-Identifier: Apache-2.0
// The same answers from every instruction set of the CPU device, in single queries and in batches, and from FCL but for
// what exact integers explain: six pairs of meshes, fresh poses from far to deep.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/seed.hpp>

#include "ask.hpp"

namespace cchip::testing {
namespace {

struct Options {
  std::size_t poses = 100000;
  std::uint64_t seed = sim::seed_from_environment();
  /// One query of this many is asked for all contacts, too.
  std::size_t every = 50;
};

struct Totals {
  std::size_t poses = 0;
  std::size_t hits = 0;
  std::size_t answers = 0;
  std::size_t contact_queries = 0;
  std::size_t contacts = 0;
  std::size_t fcl_errs = 0;  ///< pairs of faces in which FCL is not exact
  std::size_t differences = 0;
};

class Agreement {
 public:
  Agreement() : debian_(PeerLibrary::fcl_debian()), progress_("poses") {
    for (const std::string& target : cpu_targets()) devices_.push_back({target, open_cpu_device({1, target})});
    devices_.push_back({"all cores", open_cpu_device()});
  }

  Totals run(const Options& options) {
    const std::vector<std::string>& names = mesh_pair_names();
    const std::size_t last = options.poses / 50;  // the pair of sizes 10^4 : 1 is slow
    for (std::size_t i = 0; i + 1 < names.size(); ++i) {
      const std::size_t pairs = names.size() - 1;
      const std::size_t others = options.poses - last;
      run_pair(names[i], others * (i + 1) / pairs - others * i / pairs, options);
    }
    if (last > 0) run_pair(names.back(), last, options);
    return totals_;
  }

 private:
  struct OurDevice {
    std::string name;
    std::unique_ptr<Device> device;
  };

  void run_pair(const std::string& name, std::size_t count, const Options& options) {
    const Bodies bodies(mesh_pair(name), debian_);
    PoseMaker maker(*devices_.front().device, bodies.a, bodies.b, options.seed);
    std::vector<PosePair> poses;
    while (poses.size() < count) {
      const Approach approach = maker.approach();
      for (const PoseClass c : {PoseClass::touch, PoseClass::graze, PoseClass::deep, PoseClass::graze, PoseClass::near,
                                PoseClass::deep, PoseClass::far}) {
        if (poses.size() < count) poses.push_back(maker.pose(approach, c));
      }
      progress_.update(totals_.poses + poses.size(), -1);
    }
    first(bodies, poses);
    std::vector<PosePair> some;
    for (std::size_t i = 0; i < poses.size(); i += options.every) some.push_back(poses[i]);
    everything(bodies, some);
    totals_.poses += poses.size();
    totals_.contact_queries += some.size();
  }

  CollisionQuery query(const Bodies& bodies, const PosePair& poses) {
    return {&bodies.a, &poses.a, &bodies.b, &poses.b};
  }

  /// Yes or no.
  void first(const Bodies& bodies, const std::vector<PosePair>& poses) {
    std::vector<char> expected(poses.size());
    std::vector<Contact> witness(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      devices_.front().device->collide(query(bodies, poses[i]), {}, result_);
      expected[i] = static_cast<char>(result_.hit);
      if (result_.hit) witness[i] = result_.contacts.front();
      totals_.hits += result_.hit;
      // A contact that we name must be one, regardless of FCL.
      if (result_.hit && i % 16 == 0) note(bodies, "witness", i, bodies.judge(poses[i], true, witness[i]));
      const bool theirs = bodies.fcl_a.hit(poses[i].a, bodies.fcl_b, poses[i].b);
      if (theirs != result_.hit) note(bodies, "FCL", i, bodies.judge(poses[i], result_.hit, witness[i]));
      progress_.update(totals_.poses + i, -1);
    }
    totals_.answers += 2 * poses.size();
    const auto check = [&](const OurDevice& device, std::size_t i, const CollisionResult& result) {
      ++totals_.answers;
      if (result.hit == (expected[i] != 0)) return;
      note(bodies, device.name, i, {0, 1});
    };
    for (const OurDevice& device : devices_) {
      for (std::size_t i = 0; i < poses.size(); ++i) {
        device.device->collide(query(bodies, poses[i]), {}, result_);
        check(device, i, result_);
      }
      device.device->collide(
          poses.size(), [&](std::size_t i) { return query(bodies, poses[i]); }, {},
          [&](std::size_t i, const CollisionResult& result) { check(device, i, result); });
      progress_.update(totals_.poses + poses.size(), -1);
    }
  }

  /// All contacts.
  void everything(const Bodies& bodies, const std::vector<PosePair>& poses) {
    std::vector<std::vector<Contact>> expected;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      devices_.front().device->collide(query(bodies, poses[i]), all_contacts, result_);
      expected.push_back(result_.contacts);
      totals_.contacts += result_.contacts.size();
      note(bodies, "FCL, contacts", i,
           bodies.judge(poses[i], result_.contacts, bodies.fcl_a.contacts(poses[i].a, bodies.fcl_b, poses[i].b)));
    }
    totals_.answers += 2 * poses.size();
    for (const OurDevice& device : devices_) {
      const auto check = [&](std::size_t i, const CollisionResult& result) {
        ++totals_.answers;
        if (result.contacts != expected[i]) note(bodies, device.name + ", contacts", i, {0, 1});
      };
      for (std::size_t i = 0; i < poses.size(); ++i) {
        device.device->collide(query(bodies, poses[i]), all_contacts, result_);
        check(i, result_);
      }
      device.device->collide(
          poses.size(), [&](std::size_t i) { return query(bodies, poses[i]); }, all_contacts, check);
    }
  }

  void note(const Bodies& bodies, const std::string& who, std::size_t pose, const Difference& difference) {
    if (who != "witness") totals_.fcl_errs += difference.asked - std::min(difference.asked, difference.unexplained);
    totals_.differences += difference.unexplained;
    if (difference.unexplained == 0) return;
    progress_.clear();
    fmt::print("{}: {} differs in pose {}\n", bodies.name, who, pose);
  }

  PeerLibrary debian_;
  std::vector<OurDevice> devices_;
  CollisionResult result_;
  Totals totals_;
  Progress progress_;
};

int run(const Options& options) {
  std::string names;
  for (const std::string& target : cpu_targets()) names += (names.empty() ? "" : ", ") + target;
  fmt::print("seed {}; instruction sets {}; FCL {}\n", options.seed, names, PeerLibrary::fcl_debian().description());
  const Totals t = Agreement().run(options);
  fmt::print("poses={} hits={} answers={} contact_queries={} contacts={} fcl_errs={} differences={}\n", t.poses, t.hits,
             t.answers, t.contact_queries, t.contacts, t.fcl_errs, t.differences);
  return t.differences == 0 ? 0 : 3;
}

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  cchip::testing::Options o;
  CLI::App app{
      "Answers of every instruction set of the CPU device and of FCL in the same poses.\n"
      "Exit codes: 0 no difference but those that exact integers explain, 3 differences, 2 the run could not be made."};
  app.add_option("--poses", o.poses, "poses, in all")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--every", o.every, "one pose of this many is asked for all contacts, too")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seed", o.seed, "repeats the poses (or CCHIP_SEED)")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return cchip::testing::run(o);
} catch (const std::exception& error) {
  std::fprintf(stderr, "collide_agreement: %s\n", error.what());
  return 2;
}
