// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"

#include <fmt/format.h>

#include <cchip/program/csv_reader.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/usage_error.hpp>
#include <cchip/stimulus/pair_columns.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include "candidates.hpp"
#include "demo.hpp"
#include "engines.hpp"
#include "mesh_source.hpp"
#include "options.hpp"
#include "pair_runner.hpp"
#include "pose.hpp"
#include "reconfig.hpp"

namespace cchip::app {
namespace {

const Choices<EngineKind> engines = {
    {"rtl", EngineKind::rtl}, {"model", EngineKind::model}, {"eigen", EngineKind::eigen}, {"exact", EngineKind::exact}};
const Choices<EngineKind> hardware_engines = {engines[0], engines[1]};
const Choices<PairMode> programs = {{"exhaustive", PairMode::exhaustive}, {"directed", PairMode::directed}};
/// Of a payload: what a bitstream needs, and what the simulated memory holds three times for each slot.
constexpr WholeRange bitstream_bits = {8 * defs::bitstream_payload_min, 8 << 24};

struct PairsOptions {
  std::string file;
  EngineOptions engine;
  Format format = Format::table;
  ColumnOptions columns;
};

struct MeshPairsOptions {
  std::string file_a;
  std::string file_b;
  std::string pose;
  std::string pose_matrix;
  std::uint64_t limit = 0;
  std::string ply;       ///< path of the coloured picture; empty: none
  bool lenient = false;  ///< faces that cannot be used are left out
  bool single = false;   ///< coordinates are rounded to single precision
  EngineOptions engine;
  Format format = Format::table;
};

/// stdout stays machine-readable: the summary of CSV and JSON lines goes to stderr. A terminal gets a sentence.
int report(const Summary& summary, Format format, const Streams& streams) {
  const bool sentence = format == Format::table && streams.person;
  (format == Format::table ? streams.out : streams.err) << (sentence ? to_sentence(summary) : to_line(summary)) << '\n';
  if (summary.mismatches > 0) return exit_mismatch;
  return summary.left_out.value_or(0) > 0 ? exit_left_out : exit_ok;
}

/// Part of the file that is read; negative if it has no size.
double fraction_read(const CsvReader& reader) {
  std::error_code error;
  const auto size = std::filesystem::file_size(reader.name(), error);
  return error || size == 0 ? -1.0 : static_cast<double>(reader.bytes_read()) / static_cast<double>(size);
}

Summary answer_stream(std::istream& in, const std::string& name, const PairsOptions& options, const Streams& streams) {
  CsvReader reader(in, name);
  CsvRow row;
  if (!reader.next(row)) {
    throw row_error(name, 1, "the file is empty; write a first row with the column names a0x to b2z");
  }
  const PairColumns columns(row, name, options.columns);

  Progress progress(streams.err, streams.progress);
  const auto engine = make_engine(options.engine);
  const RunOptions run{options.engine.mode, options.format, !options.columns.expect.empty()};
  const auto locate = [&](const PairJob& job) { return fmt::format("{}:{}", name, job.row); };
  PairRunner runner(*engine, run, columns.passed_names(), locate, streams.out, streams.err);
  const bool has_size = &in != &streams.in;
  while (reader.next(row)) {
    runner.add(columns.parse(std::move(row)));
    if (streams.progress && runner.pairs_taken() % 1024 == 0) {
      progress.update(runner.pairs_taken(), has_size ? fraction_read(reader) : -1.0);
    }
  }
  return runner.finish();
}

int run_pairs(const PairsOptions& options, const Streams& streams) {
  sim::check_outputs({{"FILE", options.file}}, trace_files(options.engine));
  Summary summary;
  if (options.file == "-") {
    summary = answer_stream(streams.in, "-", options, streams);
  } else {
    std::ifstream in(options.file, std::ios::binary);
    if (!in || std::filesystem::is_directory(options.file)) {
      throw UsageError(fmt::format("{}: the file cannot be read ({}); check its name and permissions", options.file,
                                   in ? "is a directory" : std::strerror(errno)));
    }
    summary = answer_stream(in, options.file, options, streams);
  }
  return report(summary, options.format, streams);
}

Eigen::Isometry3d pose_of(const MeshPairsOptions& options) {
  if (!options.pose_matrix.empty()) return parse_pose_matrix(options.pose_matrix);
  return options.pose.empty() ? Eigen::Isometry3d::Identity() : parse_pose(options.pose);
}

Summary answer_meshes(const MeshPairsOptions& options, const Streams& streams) {
  std::vector<sim::NamedPath> outputs = trace_files(options.engine);
  outputs.push_back({"--ply", options.ply});
  sim::check_outputs({{"A", options.file_a}, {"B", options.file_b}}, outputs);
  check_picture_name(options.ply);
  check_standard_input({options.file_a, options.file_b});
  const Eigen::Isometry3d pose = pose_of(options);
  MeshReader reader(streams, options.lenient, options.single);
  const Mesh a = reader.read(options.file_a);
  const Mesh b = transformed(reader.read(options.file_b), pose);
  std::optional<HitPicture> picture;
  if (!options.ply.empty()) picture.emplace(options.ply);
  Progress progress(streams.err, streams.progress);
  const auto engine = make_engine(options.engine);
  RunOptions run{options.engine.mode, options.format};
  if (picture) run.on_hit = [&](const PairJob& job) { add_hit(*picture, job); };
  const auto locate = [&](const PairJob& job) {
    return fmt::format("{} face {}, {} face {}", options.file_a, job.passed[0], options.file_b, job.passed[1]);
  };
  PairRunner runner(*engine, run, mesh_pair_names(), locate, streams.out, streams.err);
  const std::uint64_t total = progress.enabled() ? count_candidates(a, b, options.limit) : 0;
  for_each_candidate(a, b, options.limit, [&](PairJob job) {
    runner.add(std::move(job));
    if (runner.pairs_taken() % 256 == 0) progress.update_of(runner.pairs_taken(), total);
  });
  Summary summary = runner.finish();
  if (options.lenient) summary.left_out = reader.faces_left_out();
  if (picture) picture->write(a, b);
  return summary;
}

int run_meshpairs(const MeshPairsOptions& options, const Streams& streams) {
  const Summary summary = answer_meshes(options, streams);
  return report(summary, options.format, streams);
}

const std::string engine_words =
    "rtl: Verilated hardware (default), model: its clock-exact model, eigen: floating "
    "point, exact: integers";
const std::string seed_words = "seed of what the RTL leaves undefined at power-up (default 1)";

/// Options that every command with an engine has.
void add_engine_options(CLI::App& command, EngineOptions& engine, Format& format) {
  add_choice(command, "--engine", engine.kind, engines, engine_words);
  add_choice(command, "--program", engine.mode, programs, "axis programme of the hardware (default exhaustive)");
  add_choice(command, "--format", format, formats, "output (default table)");
  auto* trace = add_text(command, "--trace", engine.trace_path,
                         "write the waveform of the RTL (FST) and a .gtkw layout beside it");
  add_whole(command, "--trace-clocks", engine.trace_clocks, "clocks in the waveform (default 0: all)")->needs(trace);
  add_whole(command, "--seed", engine.seed, seed_words);
}

Run add_pairs(CLI::App& app) {
  const auto held = std::make_shared<PairsOptions>();
  PairsOptions& options = *held;
  CLI::App* command = app.add_subcommand("pairs", "Answer the pairs of primitives in a CSV file");
  add_text(*command, "FILE", options.file, "CSV file with columns a0x..a2z, b0x..b2z; - reads standard input")
      ->required();
  add_engine_options(*command, options.engine, options.format);
  add_text(*command, "--expect", options.columns.expect, "compare the answers with this column (0 or 1)");
  command->add_flag("--all-columns", options.columns.pass_all, "pass the coordinate columns through, too");
  command->footer(exit_codes +
                  "Examples:\n"
                  "  cchip pairs pairs.csv\n"
                  "  cchip pairs pairs.csv --engine exact --expect touches\n"
                  "  generate | cchip pairs - --format jsonl > answers.jsonl\n"
                  "  cchip pairs pairs.csv --trace run.fst && gtkwave run.fst run.gtkw");
  return [held](const Streams& streams) { return run_pairs(*held, streams); };
}

Run add_meshpairs(CLI::App& app) {
  const auto held = std::make_shared<MeshPairsOptions>();
  MeshPairsOptions& options = *held;
  CLI::App* command = app.add_subcommand(
      "meshpairs", "Answer the candidate pairs of two meshes (OBJ, STL, PLY, OFF), B placed by a pose");
  auto* pose = add_meshes(*command, options);
  add_text(*command, "--pose-matrix", options.pose_matrix,
           "twelve numbers, the 3x4 matrix [R|t] row by row; or the sixteen of a 4x4 matrix")
      ->excludes(pose);
  add_whole(*command, "--limit", options.limit, "answer the first N candidate pairs only (default 0: all)");
  add_text(*command, "--ply", options.ply, "write both meshes, the faces that hit coloured, for MeshLab or Blender");
  add_engine_options(*command, options.engine, options.format);
  command->footer(exit_codes +
                  "Examples:\n"
                  "  cchip meshpairs a.obj b.stl --pose 0.5,0,0\n"
                  "  cchip meshpairs a.off a.off --pose 0,0,1,0,0,90 --format csv > hits.csv\n"
                  "  cchip meshpairs a.obj b.stl --ply hits.ply > pairs.txt && meshlab hits.ply");
  return [held](const Streams& streams) { return run_meshpairs(*held, streams); };
}

Run add_demo(CLI::App& app) {
  const auto held = std::make_shared<DemoOptions>();
  DemoOptions& options = *held;
  CLI::App* command =
      app.add_subcommand("demo", "Torus and gear, of triangles and of quads, through the RTL, every answer checked");
  auto* engine = add_choice(*command, "--engine", options.engine.kind, hardware_engines, "rtl (default) or its model");
  auto* waves = add_text(*command, "--waves", options.wave_folder, "folder of the waveform (default build/waves)");
  auto* seed = add_whole(*command, "--seed", options.engine.seed, seed_words);
  add_text(*command, "--ply", options.ply, "run nothing: write torus and gear, the faces that hit coloured")
      ->excludes(engine)
      ->excludes(waves)
      ->excludes(seed);
  command->footer(exit_codes);
  return [held](const Streams& streams) { return run_demo(*held, streams.out); };
}

Run add_reconfig(CLI::App& app) {
  const auto held = std::make_shared<ReconfigJobOptions>();
  ReconfigJobOptions& options = *held;
  CLI::App* command =
      app.add_subcommand("reconfig", "Meshes through two slots whose modules are exchanged at run time");
  add_whole(*command, "--bitstream-bits", options.bitstream_bits,
            "payload of each bitstream (default 16384; the paper's: 5504088, takes minutes)", bitstream_bits);
  add_whole(*command, "--pairs", options.pairs, "pairs of each kind, at most (default 1500)", at_least_1);
  add_choice(*command, "--program", options.mode, programs, "axis programme (default exhaustive)");
  add_text(*command, "--waves", options.wave_folder, "folder for sim-reconfig.fst (default build/waves)");
  add_whole(*command, "--seed", options.seed, seed_words);
  command->footer(exit_codes);
  return [held](const Streams& streams) { return run_reconfig_job(*held, streams.out); };
}

}  // namespace

std::vector<Command> hardware_commands() {
  return {{"pairs", add_pairs}, {"meshpairs", add_meshpairs}, {"demo", add_demo}, {"reconfig", add_reconfig}};
}

}  // namespace cchip::app
