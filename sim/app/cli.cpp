// SPDX-License-Identifier: Apache-2.0
#include "cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cchip/device/device.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/sim/output_file.hpp>
#include <cchip/stimulus/command_line.hpp>
#include <cchip/stimulus/csv_reader.hpp>
#include <cchip/stimulus/pair_columns.hpp>
#include <cchip/stimulus/progress.hpp>
#include <cchip/stimulus/usage_error.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <optional>
#include <utility>

#include "check.hpp"
#include "collide.hpp"
#include "demo.hpp"
#include "distance.hpp"
#include "engines.hpp"
#include "hardware.hpp"
#include "mesh_source.hpp"
#include "pair_runner.hpp"
#include "pose.hpp"
#include "reconfig.hpp"

namespace cchip::app {
namespace {

/// Words of the command line and what they mean, in the order of the help text.
template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

const Choices<EngineKind> engines = {
    {"rtl", EngineKind::rtl}, {"model", EngineKind::model}, {"eigen", EngineKind::eigen}, {"exact", EngineKind::exact}};
const Choices<EngineKind> hardware_engines = {engines[0], engines[1]};
const Choices<PairMode> programs = {{"exhaustive", PairMode::exhaustive}, {"directed", PairMode::directed}};
const Choices<Format> formats = {{"table", Format::table}, {"csv", Format::csv}, {"jsonl", Format::jsonl}};

constexpr WholeRange at_least_1 = {1, std::numeric_limits<std::uint64_t>::max()};
/// Of a payload: what a bitstream needs, and what the simulated memory holds three times for each slot.
constexpr WholeRange bitstream_bits = {8 * defs::bitstream_payload_min, 8 << 24};

using Contacts = CollisionRequest::Contacts;
const Choices<std::optional<Contacts>> contact_choices = {{"first", Contacts::first}, {"all", Contacts::all}};
const Choices<InsideRule> inside_choices = {{"odd", InsideRule::odd}, {"nonzero", InsideRule::nonzero}};
const Choices<bool> count_choices = {{"touching", false}, {"crossing", true}};

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
  if (picture) run.on_hit = [&](const PairJob& job) { picture->add_hit(job); };
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

template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value, const Choices<Value>& choices,
                        const std::string& description) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto choose = [&value, &choices](const std::string& word) {
    for (const auto& choice : choices) {
      if (choice.first == word) value = choice.second;
    }
  };
  return command.add_option_function<std::string>(name, choose, description)->check(CLI::IsMember(words));
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

std::string device_words() {
  std::string words;
  for (const std::string& name : device_names()) words += (words.empty() ? "" : ", ") + name;
  return words;
}

const std::string exit_codes =
    "Exit codes: 0 done, 1 internal error or the output cannot be written (check: a certificate is refused),\n"
    "2 wrong input or command line, 3 answers differ, 4 answered without faces that cannot be used,\n"
    "5 a contact (collide --exit-code).\n";

/// Two meshes, --lenient, and the option --pose, which is returned.
template <class Options>
CLI::Option* add_meshes(CLI::App& command, Options& options) {
  add_text(command, "A", options.file_a, "mesh that stays; - reads standard input")->required();
  add_text(command, "B", options.file_b, "mesh that is placed")->required();
  command.add_flag("--lenient", options.lenient,
                   "leave out faces that cannot be used, name them on standard error, and end with exit code 4");
  command.add_flag("--single", options.single,
                   "round the coordinates of both files to single precision, so that parts from programs that round "
                   "and from others meet");
  return add_text(command, "--pose", options.pose,
                  "tx,ty,tz[,rx,ry,rz]: rotate B by degrees about x, then y, then z, then move it");
}

void add_pairs(CLI::App& app, PairsOptions& options) {
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
}

void add_meshpairs(CLI::App& app, MeshPairsOptions& options) {
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
}

void add_collide(CLI::App& app, CollideOptions& options) {
  CLI::App* command = app.add_subcommand(
      "collide", "Do two meshes (OBJ, STL, PLY, OFF) touch, and where? B placed by one pose or by many");
  auto* pose = add_meshes(*command, options);
  auto* matrix =
      add_text(*command, "--pose-matrix", options.pose_matrix,
               "twelve numbers, the 3x4 matrix [R|t] of any affine map row by row; or the sixteen of a 4x4 matrix");
  auto* poses =
      add_text(*command, "--poses", options.poses_file,
               "CSV file with columns tx, ty, tz and r00..r22, rx..rz, roll..yaw or qx..qw: a query for each row; - "
               "reads standard input");
  pose->excludes(matrix)->excludes(poses);
  matrix->excludes(poses);
  auto* contacts = add_choice(*command, "--contacts", options.contacts, contact_choices,
                              "stop at the first contact or find all (default: all, with --poses first)");
  auto* most = add_whole(*command, "--most", options.max_contacts,
                         "find at most N contacts of a query (default: no limit)", at_least_1);
  auto* counts = add_choice(*command, "--counts", options.only_crossing, count_choices,
                            "the least that counts as a contact: touching (default) or crossing");
  auto* relation = command->add_flag("--relation", options.relation,
                                     "tell touching from crossing (a single query for all contacts does in any case)");
  auto* within = add_text(*command, "--within", options.within,
                          "faces at most this far apart are contacts, too (default 0: they touch)");
  auto* solids = command->add_flag("--solids", options.solids,
                                   "how closed meshes lie to each other as solids: is one inside the other?");
  for (auto* other : {poses, contacts, most, counts, relation, within}) solids->excludes(other);
  add_choice(*command, "--inside", options.inside, inside_choices,
             "inside is what a surface encloses an odd number of times (default), or a number that is not 0: nonzero")
      ->needs(solids);
  auto* points = command->add_flag("--points", options.points,
                                   "A is a file of points (PLY, XYZ, PCD): which of them meet which faces of B?");
  for (auto* other : {poses, counts, relation, within, solids}) points->excludes(other);
  add_text(*command, "--radius", options.radius, "each point is a sphere with this radius (default 0)")->needs(points);
  command->add_flag("--exit-code", options.exit_code, "end with exit code 5 if there is a contact");
  add_text(*command, "--device", options.device, "what answers: " + device_words() + " (default cpu)");
  add_choice(*command, "--format", options.format, formats, "output (default table)");
  add_text(*command, "--expect", options.expect,
           "compare with this column of the poses: 0 or 1, with --contacts all their number")
      ->needs(poses);
  add_whole(
      *command, "--slots", options.slots,
      "with --device sim: 1 or 2 slots whose modules are exchanged for the objects at hand (default 0: a static chip)",
      WholeRange{0, 2});
  add_whole(*command, "--chips", options.chips,
            "with --device sim: 1 to 8 chips that share one memory and the queries of --poses (default 1)",
            WholeRange{1, most_chips});
  add_text(
      *command, "--trace", options.trace,
      "with --device sim: write the waveform of the chip's first 30,000 clocks (FST) and a .gtkw layout beside it");
  add_text(*command, "--ply", options.ply,
           "write both meshes, the faces that cross and those that touch coloured, with the curves where they cross")
      ->excludes(poses)
      ->excludes(solids)
      ->excludes(points);
  add_text(*command, "--html", options.html,
           "write a page for a browser: both meshes to turn, cut and click, with the list of their contacts")
      ->excludes(poses)
      ->excludes(solids)
      ->excludes(points);
  add_text(*command, "--certificate", options.certificate,
           "write a proof of each answer into this file, for cchip check")
      ->excludes(solids)
      ->excludes(points);
  command->footer(exit_codes +
                  "Examples:\n"
                  "  cchip collide a.obj b.stl --pose 0.5,0,0\n"
                  "  cchip collide a.obj b.stl --pose 0.5,0,0 --format csv > contacts.csv\n"
                  "  cchip collide a.obj b.stl --pose 0.5,0,0 --html contacts.html && xdg-open contacts.html\n"
                  "  cchip collide a.obj b.stl --poses poses.csv --expect touches\n"
                  "  cchip collide a.obj b.stl --poses poses.csv --counts crossing\n"
                  "  cchip collide a.obj b.stl --pose 2,0,0 --within 0.5\n"
                  "  cchip collide a.obj b.stl --pose 0.5,0,0 --solids\n"
                  "  cchip collide scan.ply b.stl --points --radius 0.01\n"
                  "  cchip collide a.obj b.stl --pose 0.5,0,0 --device sim --trace chip.fst");
}

void add_distance(CLI::App& app, DistanceOptions& options) {
  CLI::App* command = app.add_subcommand(
      "distance", "How far are two meshes apart, or how far along a direction until they touch or are clear?");
  auto* pose = add_meshes(*command, options);
  add_text(*command, "--pose-matrix", options.pose_matrix,
           "twelve numbers, the 3x4 matrix [R|t] of any affine map row by row; or the sixteen of a 4x4 matrix")
      ->excludes(pose);
  auto* error = add_text(*command, "--relative-error", options.relative_error,
                         "the bounds may differ by this part of the distance, 0.01 for 1 % (default 0)");
  auto* stop = add_text(*command, "--stop-above", options.stop_above,
                        "of a distance above this one say no more than that (default: no limit)");
  add_text(*command, "--along", options.along,
           "x,y,z: in place of the distance, how many times this vector B must be moved by until it meets A, or, if "
           "they touch, until it is clear of A")
      ->excludes(error)
      ->excludes(stop)
      ->excludes(add_text(*command, "--ply", options.ply,
                          "write both meshes with the line between their nearest points, for MeshLab or Blender"));
  add_choice(*command, "--format", options.format, formats, "output (default table)");
  command->footer(exit_codes +
                  "Examples:\n"
                  "  cchip distance a.obj b.stl --pose 2,0,0\n"
                  "  cchip distance a.obj b.stl --pose 2,0,0 --relative-error 0.01 --stop-above 0.5\n"
                  "  cchip distance a.obj b.stl --pose 2,0,0 --along 0,0,1");
}

void add_check(CLI::App& app, CheckOptions& options) {
  CLI::App* command = app.add_subcommand(
      "check",
      "Do the proofs hold that collide --certificate wrote? By exact arithmetic, without the code of the answers");
  auto* pose = add_meshes(*command, options);
  add_text(*command, "FILE", options.certificates, "the certificates; - reads standard input")->required();
  auto* matrix =
      add_text(*command, "--pose-matrix", options.pose_matrix,
               "twelve numbers, the 3x4 matrix [R|t] of any affine map row by row; or the sixteen of a 4x4 matrix");
  auto* poses =
      add_text(*command, "--poses", options.poses_file,
               "CSV file with columns r00..r22, tx, ty, tz: a certificate for each row; - reads standard input");
  pose->excludes(matrix)->excludes(poses);
  matrix->excludes(poses);
  command->footer(exit_codes +
                  "Examples:\n"
                  "  cchip collide a.obj b.stl --pose 0.5,0,0 --certificate proof.jsonl\n"
                  "  cchip check a.obj b.stl proof.jsonl --pose 0.5,0,0");
}

void add_demo(CLI::App& app, DemoOptions& options) {
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
}

void add_reconfig(CLI::App& app, ReconfigJobOptions& options) {
  CLI::App* command =
      app.add_subcommand("reconfig", "Meshes through two slots whose modules are exchanged at run time");
  add_whole(*command, "--bitstream-bits", options.bitstream_bits,
            "payload of each bitstream (default 16384; the paper's: 5504088, takes minutes)", bitstream_bits);
  add_whole(*command, "--pairs", options.pairs, "pairs of each kind, at most (default 1500)", at_least_1);
  add_choice(*command, "--program", options.mode, programs, "axis programme (default exhaustive)");
  add_text(*command, "--waves", options.wave_folder, "folder for sim-reconfig.fst (default build/waves)");
  add_whole(*command, "--seed", options.seed, seed_words);
  command->footer(exit_codes);
}

std::string command_names(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands({})) names += (names.empty() ? "" : ", ") + command->get_name();
  return names;
}

/// True if the pose of the command seems to be written as several words.
bool is_pose_in_words(const CLI::App& command, const std::string& word) {
  for (const char* const name : {"--pose", "--pose-matrix"}) {
    const CLI::Option* pose = command.get_option_no_throw(name);
    if (pose != nullptr && pose->count() > 0) return read_decimal(word.substr(0, word.find(','))).has_value();
  }
  return false;
}

/// Letters that have to be put in, left out or changed to make one word of the other.
std::size_t letters_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const std::size_t changed = diagonal + (a[i - 1] == b[k - 1] ? 0 : 1);
      diagonal = row[k];
      row[k] = std::min({changed, row[k] + 1, row[k - 1] + 1});
    }
  }
  return row[b.size()];
}

/// " did you mean X?" for the name that the word is most like, if it is like one at all.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names) {
  constexpr std::size_t most_letters_wrong = 2;
  std::size_t least = most_letters_wrong + 1;
  std::string best;
  for (const std::string& name : names) {
    const std::size_t wrong = letters_between(word, name);
    const std::size_t letters = name.size() - name.find_first_not_of('-');
    if (wrong < least && wrong < letters) {
      least = wrong;
      best = name;
    }
  }
  return best.empty() ? "" : " did you mean " + best + "?";
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string help_of(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? "cchip --help" : fmt::format("cchip {} --help", chosen.front()->get_name());
}

std::vector<std::string> list_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::string no_such_command(const CLI::App& app, const std::string& word) {
  return fmt::format("{}: no such command;{} the commands are {}", word, did_you_mean(word, list_commands(app)),
                     command_names(app));
}

/// What is wrong with a command line that CLI11 refuses.
std::string unreadable(const CLI::App& app, const CLI::ParseError& error) {
  std::string what = error.what();
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError)) {
    const std::string name = what.substr(0, what.find(' '));
    what = name == "A"      ? "the first mesh, A, is missing"
           : name == "B"    ? "the second mesh, B, is missing"
           : name == "FILE" ? "the file of the pairs, FILE, is missing"
                            : what;
  }
  return what + "; see " + help_of(app);
}

/// What is wrong with a command line in which `words` were not understood.
std::string unknown_words(const CLI::App& app, const std::vector<std::string>& words) {
  const auto option =
      std::find_if(words.begin(), words.end(), [](const std::string& word) { return word.rfind("-", 0) == 0; });
  const auto chosen = app.get_subcommands();
  if (chosen.empty() && option != words.begin()) {
    return no_such_command(app, words.front());
  }
  if (!chosen.empty() && is_pose_in_words(*chosen.front(), words.front())) {
    return fmt::format("{}: the pose is one word; write its numbers with commas and no spaces, like 0.5,0,0,0,0,90",
                       words.front());
  }
  if (option != words.end()) {
    const std::string name = option->substr(0, option->find('='));
    const std::string guess = did_you_mean(name, option_names(chosen.empty() ? app : *chosen.front()));
    return fmt::format("{}: no such option;{} see {}", name, guess, help_of(app));
  }
  return fmt::format("{}: one argument too many; see {}", words.front(), help_of(app));
}

int dispatch(std::vector<std::string> arguments, const Streams& streams) {
  CLI::App app(
      "Exact collision detection: do these meshes or primitives touch? On this computer, by the library collisionchip, "
      "or on its hardware, simulated.",
      "cchip");
  const std::string version = "cchip " CCHIP_VERSION;
  app.set_version_flag("-v,--version", version);
  app.require_subcommand(1);
  app.footer(exit_codes +
             "Examples:\n"
             "  cchip demo\n"
             "  cchip collide a.obj b.stl --pose 0.5,0,0\n"
             "  cchip pairs pairs.csv --expect touches\n"
             "  cchip meshpairs a.obj b.stl --pose 0.5,0,0\n"
             "\"cchip COMMAND --help\" lists the options of a command.");
  CollideOptions collide;
  DistanceOptions distance;
  CheckOptions check;
  PairsOptions pairs;
  MeshPairsOptions meshpairs;
  DemoOptions demo;
  add_collide(app, collide);
  add_distance(app, distance);
  add_check(app, check);
  add_pairs(app, pairs);
  add_meshpairs(app, meshpairs);
  add_demo(app, demo);
  ReconfigJobOptions reconfig;
  add_reconfig(app, reconfig);
  app.add_subcommand("version", "Print the version")->footer("");
  app.add_subcommand("help", "Print the options of a command: cchip help COMMAND")->footer("");
  if (!arguments.empty() && arguments.front() == "help") {
    arguments.erase(arguments.begin());
    const std::vector<std::string> names = list_commands(app);
    if (!arguments.empty() && arguments.front().rfind("-", 0) != 0 &&
        std::find(names.begin(), names.end(), arguments.front()) == names.end()) {
      throw UsageError(no_such_command(app, arguments.front()));
    }
    arguments.resize(std::min<std::size_t>(arguments.size(), 1));
    arguments.emplace_back("--help");
  }
  try {
    std::reverse(arguments.begin(), arguments.end());
    app.parse(std::move(arguments));
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request, streams.out, streams.err);
  } catch (const CLI::ParseError& error) {
    const std::vector<std::string> unknown = app.remaining(true);
    if (!unknown.empty()) throw UsageError(unknown_words(app, unknown));
    if (app.get_subcommands().empty()) {
      throw UsageError("the command is missing; the commands are " + command_names(app) + "; see cchip --help");
    }
    throw UsageError(unreadable(app, error));
  }
  if (app.got_subcommand("collide")) return run_collide(collide, streams);
  if (app.got_subcommand("distance")) return run_distance(distance, streams);
  if (app.got_subcommand("check")) return run_check(check, streams);
  if (app.got_subcommand("pairs")) return run_pairs(pairs, streams);
  if (app.got_subcommand("meshpairs")) return run_meshpairs(meshpairs, streams);
  if (app.got_subcommand("demo")) return run_demo(demo, streams.out);
  if (app.got_subcommand("reconfig")) return run_reconfig_job(reconfig, streams.out);
  streams.out << version << '\n';
  return exit_ok;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

int run_cli(std::vector<std::string> arguments, const Streams& streams) {
  add_chip_device();
  try {
    const int code = dispatch(std::move(arguments), streams);
    streams.out.flush();
    if (streams.out) return code;
    // What could not be written waits in the buffer; the cause is that of another attempt.
    streams.out.clear();
    errno = 0;
    streams.out.flush();
    const char* const cause = errno == 0 ? "the stream is closed or full" : std::strerror(errno);
    streams.err << "cchip: cannot write standard output: " << cause
                << "; check the disk space and the program that reads the pipe\n";
    return exit_internal;
  } catch (const UsageError& error) {
    streams.err << "cchip: " << one_line(error.what()) << '\n';
    return exit_usage;
  } catch (const sim::OutputError& error) {
    streams.err << "cchip: " << one_line(error.what()) << '\n';
    return exit_usage;
  } catch (const std::bad_alloc&) {
    streams.err << "cchip: not enough memory; give smaller input, or a smaller number to an option\n";
    return exit_internal;
  } catch (const std::exception& error) {
    streams.err << "cchip: internal error: " << one_line(error.what()) << '\n';
    return exit_internal;
  }
}

}  // namespace cchip::app
