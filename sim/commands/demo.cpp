// SPDX-License-Identifier: Apache-2.0
#include "demo.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cchip/collide.hpp>
#include <cchip/device.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/grid/local_grid.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/pose.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/usage_error.hpp>
#include <cchip/shapes.hpp>
#include <chrono>
#include <filesystem>

#include "candidates.hpp"
#include "pair_runner.hpp"

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

/// Counts one pair. The references see only the grid pair or the doubles, never the engine's answer.
void check(const PairJob& job, const GridPair& pair, int coord_w, const EngineAnswer& answer, DemoCounts& counts) {
  const bool on_doubles = exact_intersects(job.a, job.b);
  const bool agrees = answer.grid == eigen_intersects(pair, coord_w) && answer.grid == exact_intersects(pair) &&
                      (!answer.definite || answer.grid == on_doubles);
  ++counts.pairs;
  counts.hits += answer.definite ? answer.grid : on_doubles;
  counts.mismatches += !agrees;
  counts.indefinite += !answer.definite;
  counts.beats += static_cast<std::uint64_t>(answer.beats);
}

double ratio(std::uint64_t count, std::uint64_t of) {
  return of == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(of);
}

constexpr auto row_format = "{:<11}{:<10}{:<12}{:>7}{:>7}{:>12}{:>12}{:>12}{:>16}{:>9}\n";

const char* to_name(PairMode mode) { return mode == PairMode::exhaustive ? "exhaustive" : "directed"; }

void print_row(std::ostream& out, const std::array<std::string, 3>& names, const DemoCounts& c) {
  fmt::print(out, row_format, names[0], names[1], names[2], c.pairs, c.hits, c.mismatches, c.indefinite,
             fmt::format("{:.2f}", ratio(c.beats, c.pairs)), fmt::format("{:.3f}", ratio(c.beats, c.clocks)), c.clocks);
}

void print_introduction(std::ostream& out, const PairEngine& engine) {
  fmt::print(
      out,
      "Do two meshes touch? Every pair of faces whose boxes overlap goes through engine {} ({}-bit coordinates);\n"
      "every answer is compared with two independent references: the floating-point test (Eigen) and exact\n"
      "integer arithmetic.\n\n"
      "tri-tri:   torus and gear, both of triangles\n"
      "  apart      the gear hovers tilted over the torus: boxes overlap, surfaces do not\n"
      "  touching   the gear lies flat on the torus, its face holds the torus' highest ring; nothing is rounded\n"
      "  deep       the gear cuts through the tube of the torus\n"
      "tri-quad:  the same gear, cutting through a torus of quads\n"
      "quad-quad: two tori of quads\n"
      "  linked     like links of a chain, without contact\n"
      "  deep       one cuts through the other\n"
      "exhaustive: the paper's schedule, every axis; directed: each axis chosen from the answers before.\n\n",
      engine.name(), engine.coord_w());
  fmt::print(out, row_format, "kinds", "pose", "programme", "pairs", "hits", "mismatches", "indefinite", "axes/pair",
             "axes per clock", "clocks");
}

void print_explanation(std::ostream& out, const DemoCounts& total) {
  fmt::print(out,
             "\npairs: candidate pairs; hits: faces that share a point; axes/pair: axes tested in the pipeline.\n"
             "indefinite: answers that the hardware leaves open because rounding to its grid could have changed them;\n"
             "the host decided them exactly.\n"
             "Simulated {} clocks in {:.2f} s: {:.0f} clocks per second.\n",
             total.clocks, total.engine_seconds, static_cast<double>(total.clocks) / total.engine_seconds);
}

void add(DemoCounts& total, const DemoCounts& c) {
  using C = DemoCounts;
  for (const auto count : {&C::pairs, &C::hits, &C::mismatches, &C::indefinite, &C::beats, &C::clocks}) {
    total.*count += c.*count;
  }
  total.engine_seconds += c.engine_seconds;
}

std::uint64_t count_candidates(const std::vector<DemoRun>& runs) {
  std::uint64_t pairs = 0;
  for (const DemoRun& run : runs) sweep_box_pairs(run.a, run.b, [&pairs](CandidatePair) { ++pairs; });
  return pairs;
}

DemoCounts do_runs(PairEngine& engine, std::ostream& out) {
  print_introduction(out, engine);
  DemoCounts total;
  const std::vector<DemoRun> runs = make_demo_runs();
  const std::uint64_t all = count_candidates(runs);
  Progress progress;
  for (const DemoRun& run : runs) {
    const DemoCounts counts = run_demo_pairs(
        engine, run.mode, run.a, run.b, [&](std::uint64_t pairs) { progress.update_of(total.pairs + pairs, all); });
    progress.clear();
    print_row(out, {run.kinds, run.pose, to_name(run.mode)}, counts);
    out.flush();
    add(total, counts);
  }
  print_row(out, {"total", "", ""}, total);
  print_explanation(out, total);
  return total;
}

/// Torus and gear as queries through the whole chip in RTL, from doorbell to done record, against the CPU device.
/// \return queries that differ
std::uint64_t run_chip(const std::string& trace_path, std::ostream& out) {
  fmt::print(
      out,
      "\nThe same torus and gear, each pose as one query through the whole chip: tree against tree in the broad\n"
      "phase, leaves through cache and vertex transform, faces through the primitive test, records into a ring.\n"
      "All contacts; what the chip leaves open the host decides; compared with the CPU device, face for face.\n\n"
      "{:<10}{:>10}{:>12}{:>8}{:>9}{:>12}\n",
      "pose", "contacts", "node pairs", "open", "clocks", "mismatches");
  SimulatedChipOptions options;
  options.trace_path = trace_path;
  const auto chip = open_simulated_chip(options);
  const auto cpu = open_device("cpu");
  CollisionRequest request;
  request.contacts = CollisionRequest::Contacts::all;
  std::uint64_t queries = 0, hits = 0, contacts = 0, mismatches = 0, open = 0, clocks = 0;
  Progress progress("queries");
  for (const DemoRun& run : make_demo_runs()) {
    if (run.kinds != "tri-tri" || run.mode != PairMode::directed) continue;
    const Object torus(run.a);
    const Object gear(run.b);
    const Pose here = Pose::Identity();
    const CollisionResult got = collide(*chip, torus, here, gear, here, request);
    const CollisionResult expected = collide(*cpu, torus, here, gear, here, request);
    const bool differs = got.hit != expected.hit || got.contacts != expected.contacts;
    progress.update_of(++queries, 3);
    progress.clear();
    fmt::print(out, "{:<10}{:>10}{:>12}{:>8}{:>9}{:>12}\n", run.pose, got.contacts.size(), got.stats.steps,
               got.stats.open, got.stats.clocks, differs ? 1 : 0);
    hits += got.hit ? 1 : 0;
    contacts += got.contacts.size();
    mismatches += differs ? 1 : 0;
    open += got.stats.open;
    clocks += got.stats.clocks;
  }
  fmt::print(out, "queries={} hits={} contacts={} mismatches={} open={} clocks={}\n", queries, hits, contacts,
             mismatches, open, clocks);
  return mismatches;
}

void write_picture(const std::string& path) {
  HitPicture picture(path);
  const auto runs = make_demo_runs();
  const auto deep = std::find_if(runs.begin(), runs.end(), [](const DemoRun& run) { return run.pose == "deep"; });
  for_each_candidate(deep->a, deep->b, 0, [&](const PairJob& job) {
    if (exact_intersects(job.a, job.b)) add_hit(picture, job);
  });
  picture.write(deep->a, deep->b);
}

/// The waveform's path, after making its folder; empty for engines without one.
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

std::vector<DemoRun> make_demo_runs() {
  const Mesh torus = snapped(make_torus(torus_radius, tube_radius, 64, 32));
  const Mesh quad_torus = snapped(make_torus(torus_radius, tube_radius, 64, 32, Kind::quad));
  const Mesh gear = snapped(make_gear(1.25, 1.5, 0.5, gear_thickness, 36, 6));
  const double on_top = greatest_z(torus) + gear_thickness / 2;
  const Mesh apart = transformed(gear, make_pose({0, 0, on_top + 0.095}, {5, 0, 0}));
  const Mesh touching = transformed(gear, make_pose({0, 0, on_top}, {0, 0, 0}));
  const Mesh deep = transformed(gear, make_pose({0.9, 0.2, 0.1}, {65, 20, 10}));
  std::vector<DemoRun> runs;
  for (const PairMode mode : {PairMode::exhaustive, PairMode::directed}) {
    runs.push_back({"tri-tri", "apart", mode, torus, apart});
    runs.push_back({"tri-tri", "touching", mode, torus, touching});
    runs.push_back({"tri-tri", "deep", mode, torus, deep});
  }
  const Mesh linked = transformed(quad_torus, make_pose({1.2, 0, 0}, {70, 0, 0}));
  const Mesh crossing = transformed(quad_torus, make_pose({1.4, 0.2, 0.1}, {65, 20, 10}));
  for (const PairMode mode : {PairMode::exhaustive, PairMode::directed}) {
    runs.push_back({"tri-quad", "deep", mode, deep, quad_torus});
    runs.push_back({"quad-quad", "linked", mode, quad_torus, linked});
    runs.push_back({"quad-quad", "deep", mode, quad_torus, crossing});
  }
  return runs;
}

DemoCounts run_demo_pairs(PairEngine& engine, PairMode mode, const Mesh& a, const Mesh& b,
                          const std::function<void(std::uint64_t)>& on_answered) {
  DemoCounts counts;
  std::vector<PairJob> jobs;
  std::vector<GridPair> pairs;
  const std::uint64_t clocks_before = engine.statistics().clocks;
  const auto answer_batch = [&] {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<EngineAnswer> answers = engine.run(pairs, mode);
    counts.engine_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (std::size_t i = 0; i < jobs.size(); ++i) check(jobs[i], pairs[i], engine.coord_w(), answers.at(i), counts);
    if (on_answered) on_answered(counts.pairs);
    jobs.clear();
    pairs.clear();
  };
  for_each_candidate(a, b, 0, [&](PairJob job) {
    pairs.push_back(quantise(job.a, job.b, engine.coord_w()).pair);
    jobs.push_back(std::move(job));
    if (jobs.size() == batch) answer_batch();
  });
  answer_batch();
  counts.clocks = engine.statistics().clocks - clocks_before;
  return counts;
}

int run_demo(const DemoOptions& options, std::ostream& out) {
  if (!options.ply.empty()) {
    write_picture(options.ply);
    return exit_ok;
  }
  EngineOptions engine_options = options.engine;
  engine_options.trace_path = prepare_waves(options);
  engine_options.trace_clocks = wave_clocks;
  DemoCounts total;
  {
    const auto engine = make_engine(engine_options);
    total = do_runs(*engine, out);
  }
  std::uint64_t chip_mismatches = 0;
  if (!engine_options.trace_path.empty()) {
    const auto chip_path = std::filesystem::path(engine_options.trace_path).replace_filename("sim-query.fst").string();
    chip_mismatches = run_chip(chip_path, out);
    fmt::print(out, "Look at the chip, from the images' invalidation to the first queries:\n  gtkwave {} {}\n",
               chip_path, std::filesystem::path(chip_path).replace_extension(".gtkw").string());
    const auto layout = std::filesystem::path(engine_options.trace_path).replace_extension(".gtkw").string();
    fmt::print(out, "\nLook at the first {} clocks of each module, signals grouped by macro stage:\n  gtkwave {} {}\n",
               wave_clocks, engine_options.trace_path, layout);
  }
  const Summary summary{total.pairs, total.hits, total.mismatches, total.indefinite, total.beats, total.clocks};
  fmt::print(out, "{}\n", to_line(summary));
  return total.mismatches + chip_mismatches > 0 ? exit_mismatch : exit_ok;
}

}  // namespace cchip::app
