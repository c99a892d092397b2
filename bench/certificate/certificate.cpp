// SPDX-License-Identifier: Apache-2.0
// Answers for pairs of meshes with their proofs: every certificate is checked; sizes and times for
// docs/cpp/certificates.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cchip/certificate_file.hpp>
#include <cchip/certify.hpp>
#include <cchip/check.hpp>
#include <cchip/device.hpp>
#include <cchip/driver/model_device.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/seed.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "measure.hpp"
#include "mesh_pairs.hpp"

namespace cchip::testing {
namespace {

struct Options {
  std::size_t poses = 20;
  std::string device = "cpu";
  std::uint64_t seed = sim::seed_from_environment();
  std::vector<std::string> meshes = mesh_pair_names();
  std::vector<std::string> classes;
  bool flush = true;
  bool trees = false;
  std::string save;  ///< folder; empty: none
};

/// Of the queries of one row of the table.
struct Costs {
  std::size_t hits = 0;
  std::vector<double> cells, bytes, query, make, check;
};

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

template <class Function>
auto timed(std::vector<double>& times, const Function& function) {
  const double start = seconds(Clock::cpu);
  auto result = function();
  times.push_back(seconds(Clock::cpu) - start);
  return result;
}

void write_off(const Mesh& mesh, const std::string& path) {
  std::ofstream out(path);
  out << "OFF\n" << mesh.vertices.size() << ' ' << mesh.faces.size() << " 0\n";
  for (const Vec3d& v : mesh.vertices) out << fmt::format("{:.17g} {:.17g} {:.17g}\n", v[0], v[1], v[2]);
  for (const Mesh::Face& face : mesh.faces) {
    out << static_cast<int>(face.kind);
    for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) out << ' ' << face.vertex[k];
    out << '\n';
  }
}

class Benchmark {
 public:
  explicit Benchmark(const Options& options)
      : options_(options), device_(open_device(options.device)), progress_("certificates") {}

  int run() {
    fmt::print("{:<14} {:<9} {:>7} {:>6} {:>8} {:>9} {:>9} {:>10} {:>9} {:>9} {:>9} {:>7}\n", "meshes", "class",
               "queries", "hits", "cells", "kB", "max kB", "query, ms", "make, ms", "check, ms", "max, ms", "ratio");
    for (const std::string& name : options_.meshes) {
      MeshPair pair = mesh_pair(name);
      pair.a.file_face.clear();  // an OFF has them by their own numbers
      pair.b.file_face.clear();
      const Object a(std::move(pair.a)), b(std::move(pair.b));
      PoseMaker maker(*device_, a, b, options_.seed);
      for (const PoseClass c : pose_classes) {
        run_class(name, name_of(c), a, b, [&] { return maker.pose(maker.approach(), c); });
      }
    }
    if (options_.flush) {
      std::mt19937_64 random(options_.seed);
      for (MeshPair& pair : flush_pairs()) {
        const Object a(std::move(pair.a)), b(std::move(pair.b));
        for (const FlushPlace place : flush_places) {
          run_class("flush " + pair.name, name_of(place), a, b, [&] { return flush_poses(place, random); });
        }
      }
    }
    fmt::print("certified={} refused={}\n", certified_, refused_);
    return refused_ == 0 && certified_ > 0 ? 0 : 3;
  }

 private:
  template <class MakePose>
  void run_class(const std::string& meshes, const std::string& name, const Object& a, const Object& b,
                 const MakePose& make_pose) {
    const std::vector<std::string>& wanted = options_.classes;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) return;
    Costs costs;
    std::optional<CertificateTree> tree_a, tree_b;
    if (options_.trees) {
      std::vector<double> times;
      tree_a.emplace(timed(times, [&] { return make_certificate_tree(a.mesh()); }));
      tree_b.emplace(timed(times, [&] { return make_certificate_tree(b.mesh()); }));
      std::ostringstream text;
      write_certificate_tree(*tree_a, text);
      fmt::print("tree of A: {:.0f} ms, {:.0f} kB\n", 1000 * times[0], static_cast<double>(text.str().size()) / 1000);
    }
    const CitedTrees trees = options_.trees ? CitedTrees{&*tree_a, &*tree_b} : CitedTrees{};
    for (std::size_t i = 0; i < options_.poses; ++i) {
      const PosePair pose = make_pose();
      const CollisionQuery query = {&a, &pose.a, &b, &pose.b};
      CollisionRequest request;  // first, all, all with relations in turn
      if (i % 3 != 0) request.contacts = CollisionRequest::Contacts::all;
      request.relation = i % 3 == 2;
      CollisionResult answer;
      device_->collide(query, request, answer);  // once without the clock: what it needs is in the caches then
      timed(costs.query, [&] {
        device_->collide(query, request, answer);
        return 0;
      });
      costs.hits += answer.hit ? 1 : 0;
      try {
        const Certificate certificate = timed(costs.make, [&] { return certify(query, request, answer, trees); });
        const CertificateVerdict verdict = timed(costs.check, [&] {
          return options_.trees ? check_certificate(*tree_a, pose.a, *tree_b, pose.b, certificate)
                                : check_certificate(a.mesh(), pose.a, b.mesh(), pose.b, certificate);
        });
        ++certified_;
        std::ostringstream text;
        write_certificate(certificate, text);
        costs.bytes.push_back(static_cast<double>(text.str().size()));
        costs.cells.push_back(static_cast<double>(certificate.cells.size()));
        if (!verdict.accepted) refuse(meshes, name, i, fmt::format("cell {}: {}", verdict.cell, verdict.reason));
        if (i < 3) save(meshes + " " + name + " " + std::to_string(i), a.mesh(), b.mesh(), pose, text.str(), trees);
      } catch (const std::runtime_error& error) {
        refuse(meshes, name, i, error.what());
      }
      progress_.update(certified_, -1);
    }
    progress_.clear();
    if (costs.check.empty()) return;
    const double query = median(costs.query);
    const double make = median(costs.make);
    fmt::print("{:<14} {:<9} {:>7} {:>6} {:>8.0f} {:>9.1f} {:>9.1f} {:>10.4f} {:>9.2f} {:>9.2f} {:>9.2f} {:>7.0f}\n",
               meshes, name, options_.poses, costs.hits, median(costs.cells), median(costs.bytes) / 1000,
               percentile(costs.bytes, 1) / 1000, 1000 * query, 1000 * make, 1000 * median(costs.check),
               1000 * percentile(costs.check, 1), make / query);
    std::fflush(stdout);
  }

  void refuse(const std::string& meshes, const std::string& name, std::size_t i, const std::string& why) {
    ++refused_;
    fmt::print("refused: {} {}, pose {}: {}\n", meshes, name, i, why);
  }

  /// Meshes, poses and certificate as check.py takes them.
  void save(const std::string& name, const Mesh& a, const Mesh& b, const PosePair& pose, const std::string& text,
            const CitedTrees& trees) {
    if (options_.save.empty()) return;
    const std::filesystem::path folder = std::filesystem::path(options_.save) / name;
    std::filesystem::create_directories(folder);
    write_off(a, folder / "a.off");
    write_off(b, folder / "b.off");
    std::ofstream poses(folder / "poses");
    for (const Pose* p : {&pose.a, &pose.b}) {
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) poses << fmt::format("{:.17g}\n", (*p)(row, column));
      }
    }
    std::ofstream(folder / "certificate.jsonl") << text;
    for (const CertificateTree* tree : {trees.a, trees.b}) {
      if (tree == nullptr) continue;
      std::ofstream out(folder / (tree == trees.a ? "a.tree" : "b.tree"));
      write_certificate_tree(*tree, out);
    }
  }

  const Options options_;
  std::unique_ptr<Device> device_;
  Progress progress_;
  std::size_t certified_ = 0;
  std::size_t refused_ = 0;
};

}  // namespace
}  // namespace cchip::testing

int main(int argc, char** argv) try {
  using namespace cchip::testing;
  cchip::add_model_device();
  cchip::add_simulated_chip();
  CLI::App app{
      "Answers for pairs of meshes with their proofs: each certificate is made and checked; medians of sizes and "
      "times.\n"
      "Exit codes: 0 all accepted, 3 one refused, 2 the run could not be made, others: wrong arguments."};
  Options options;
  app.add_option("--poses", options.poses, "of each pair of meshes and class")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--device", options.device, "what answers")
      ->check(CLI::IsMember(cchip::device_names()))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "repeats a run (or CCHIP_SEED)")->capture_default_str();
  app.add_option("--meshes", options.meshes, "pairs of meshes")->check(CLI::IsMember(mesh_pair_names()));
  app.add_option("--classes", options.classes,
                 "of poses: touch, near, deep, far, graze; together, shifted, turned, apart");
  app.add_flag("!--no-flush", options.flush, "without the meshes that have flush faces");
  app.add_flag("--trees", options.trees, "certificates cite trees, which are made and checked once for a class");
  app.add_option("--save", options.save, "folder: three of each class with their meshes, for check.py");
  CLI11_PARSE(app, argc, argv);
  return Benchmark(options).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_certificate: %s\n", error.what());
  return 2;
}
