// SPDX-License-Identifier: Apache-2.0
#include "demo.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cchip/eigen_reference.hpp>
#include <cchip/exact_oracle.hpp>
#include <cchip/local_grid.hpp>
#include <chrono>
#include <filesystem>

#include "mesh_source.hpp"
#include "pair_runner.hpp"
#include "pose.hpp"
#include "usage_error.hpp"

namespace cchip::app {
namespace {

constexpr std::uint64_t wave_clocks = 5000;
constexpr std::size_t batch = 4096;

// Multiples of the meshes' step, so that the touching pose is exact.
constexpr double step = 1.0 / 4096;
constexpr double torus_radius = 1.0;
constexpr double tube_radius = 0.375;
constexpr double gear_thickness = 0.5;

double greatest_z(const Mesh& mesh) {
  double z = mesh.vertices.front().z();
  for (const Vec3d& v : mesh.vertices) z = std::max(z, v.z());
  return z;
}

/// Vertices on multiples of `step`: a pose without rotation needs no rounding on the grid.
Mesh snapped(Mesh mesh) {
  for (Vec3d& v : mesh.vertices) v = (v / step).array().round() * step;
  return mesh;
}

bool is_special(const GridPair& pair) { return is_coplanar(pair) || is_degenerate(pair.a) || is_degenerate(pair.b); }

/// Counts one pair. The references see only the grid pair or the doubles, never the engine's answer.
void check(const PairJob& job, const GridPair& pair, int coord_w, const EngineAnswer& answer, DemoCounts& counts) {
  const bool on_doubles = exact_intersects(job.a, job.b);
  const bool left_open = answer.grid && !answer.definite && is_special(pair);
  bool agrees = true;
  if (answer.definite) agrees = answer.grid == on_doubles;
  if (!left_open) {
    agrees = agrees && answer.grid == eigen_intersects(pair, coord_w) && answer.grid == exact_intersects(pair);
  }
  ++counts.pairs;
  counts.hits += answer.definite ? answer.grid : on_doubles;
  counts.mismatches += !agrees;
  counts.indefinite += !answer.definite;
  counts.special += left_open;
  if (answer.hardware) counts.beats += static_cast<std::uint64_t>(answer.hardware->beats);
}

double ratio(std::uint64_t count, std::uint64_t of) {
  return of == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(of);
}

void print_row(std::ostream& out, const std::string& name, const DemoCounts& c) {
  fmt::print(out, "{:<10}{:>10}{:>8}{:>12}{:>12}{:>14}{:>16}{:>10}\n", name, c.pairs, c.hits, c.mismatches,
             c.indefinite, fmt::format("{:.2f}", ratio(c.beats, c.pairs)),
             fmt::format("{:.3f}", ratio(c.beats, c.clocks)), c.clocks);
}

void print_introduction(std::ostream& out, const DemoScene& scene, const PairEngine& engine) {
  fmt::print(out,
             "Does a gear touch a torus? Every pair of triangles whose boxes overlap goes through engine {}\n"
             "({}-bit coordinates); every answer is compared with two independent references: the floating-point\n"
             "test (Eigen) and exact integer arithmetic.\n\n"
             "Meshes: torus with {} triangles, gear with {} triangles.\n",
             engine.name(), engine.coord_w(), scene.torus.faces.size(), scene.gear.faces.size());
  for (const DemoPose& pose : scene.poses) fmt::print(out, "Pose {:<9} {}\n", pose.name + ":", pose.words);
  fmt::print(out, "\n{:<10}{:>10}{:>8}{:>12}{:>12}{:>14}{:>16}{:>10}\n", "pose", "pairs", "hits", "mismatches",
             "indefinite", "beats/pair", "axes per clock", "clocks");
}

void print_explanation(std::ostream& out, const DemoCounts& total) {
  fmt::print(out,
             "\npairs: candidate pairs; hits: triangles that share a point; beats: axes tested in the pipeline.\n"
             "indefinite: answers that the hardware leaves open (in this version all pairs that needed rounding, and\n"
             "hits of coplanar or degenerate triangles); the host decided them exactly.\n"
             "{} of them are coplanar or degenerate on the grid: there only the final answer was compared.\n"
             "Simulated {} clocks in {:.2f} s: {:.0f} clocks per second.\n",
             total.special, total.clocks, total.engine_seconds,
             static_cast<double>(total.clocks) / total.engine_seconds);
}

void add(DemoCounts& total, const DemoCounts& c) {
  total.pairs += c.pairs;
  total.hits += c.hits;
  total.mismatches += c.mismatches;
  total.indefinite += c.indefinite;
  total.special += c.special;
  total.beats += c.beats;
  total.clocks += c.clocks;
  total.engine_seconds += c.engine_seconds;
}

DemoCounts run_poses(PairEngine& engine, PairMode mode, const DemoScene& scene, std::ostream& out) {
  print_introduction(out, scene, engine);
  DemoCounts total;
  for (const DemoPose& pose : scene.poses) {
    const DemoCounts counts = run_demo_pose(engine, mode, scene.torus, transformed(scene.gear, pose.gear));
    print_row(out, pose.name, counts);
    out.flush();
    add(total, counts);
  }
  print_row(out, "total", total);
  print_explanation(out, total);
  return total;
}

/// The waveform's path, its folder made; empty for engines without one.
std::string prepare_waves(const DemoOptions& options) {
  if (options.engine.kind != EngineKind::rtl) return {};
  std::error_code error;
  std::filesystem::create_directories(options.wave_folder, error);
  if (error) {
    throw UsageError(fmt::format("{}: the folder cannot be made ({}); give another with --waves", options.wave_folder,
                                 error.message()));
  }
  return (std::filesystem::path(options.wave_folder) / "sim.fst").string();
}

}  // namespace

DemoScene make_demo_scene() {
  DemoScene scene;
  scene.torus = snapped(make_torus(torus_radius, tube_radius, 64, 32));
  scene.gear = snapped(make_gear(1.25, 1.5, 0.5, gear_thickness, 36, 6));
  const double on_top = greatest_z(scene.torus) + gear_thickness / 2;
  scene.poses = {
      {"apart", "the gear hovers tilted over the torus; boxes overlap, surfaces do not",
       make_pose({0, 0, on_top + 0.095}, {5, 0, 0})},
      {"touching",
       "the gear lies flat on the torus, its face holds the torus' highest ring exactly; nothing is rounded",
       make_pose({0, 0, on_top}, {0, 0, 0})},
      {"deep", "the gear cuts through the tube of the torus", make_pose({0.9, 0.2, 0.1}, {65, 20, 10})},
  };
  return scene;
}

DemoCounts run_demo_pose(PairEngine& engine, PairMode mode, const Mesh& torus, const Mesh& gear) {
  DemoCounts counts;
  std::vector<PairJob> jobs;
  std::vector<GridPair> pairs;
  const std::uint64_t clocks_before = engine.statistics().clocks;
  const auto answer_batch = [&] {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<EngineAnswer> answers = engine.run(pairs, mode);
    counts.engine_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (std::size_t i = 0; i < jobs.size(); ++i) check(jobs[i], pairs[i], engine.coord_w(), answers.at(i), counts);
    jobs.clear();
    pairs.clear();
  };
  for_each_candidate(torus, gear, 0, [&](PairJob job) {
    pairs.push_back(quantise(job.a, job.b, engine.coord_w()).pair);
    jobs.push_back(std::move(job));
    if (jobs.size() == batch) answer_batch();
  });
  answer_batch();
  counts.clocks = engine.statistics().clocks - clocks_before;
  return counts;
}

int run_demo(const DemoOptions& options, std::ostream& out) {
  EngineOptions engine_options = options.engine;
  engine_options.trace_path = prepare_waves(options);
  engine_options.trace_clocks = wave_clocks;
  DemoCounts total;
  {
    const auto engine = make_engine(engine_options);
    total = run_poses(*engine, engine_options.mode, make_demo_scene(), out);
  }
  finish_trace(engine_options);
  if (!engine_options.trace_path.empty()) {
    const auto layout = std::filesystem::path(engine_options.trace_path).replace_extension(".gtkw").string();
    fmt::print(out, "\nLook at the first {} clocks, signals grouped by macro stage:\n  gtkwave {} {}\n", wave_clocks,
               engine_options.trace_path, layout);
  }
  const Summary summary{total.pairs, total.hits, total.mismatches, total.indefinite, total.beats, total.clocks};
  fmt::print(out, "{}\n", to_line(summary));
  return total.mismatches > 0 ? exit_mismatch : exit_ok;
}

}  // namespace cchip::app
