// SPDX-License-Identifier: Apache-2.0
#include "cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cchip/device.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/program/command_line.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/usage_error.hpp>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "check.hpp"
#include "clash.hpp"
#include "collide.hpp"
#include "distance.hpp"
#include "hardware.hpp"
#include "options.hpp"

namespace cchip::app {
namespace {

using Contacts = CollisionRequest::Contacts;
const Choices<std::optional<Contacts>> contact_choices = {{"first", Contacts::first}, {"all", Contacts::all}};
const Choices<InsideRule> inside_choices = {{"odd", InsideRule::odd}, {"nonzero", InsideRule::nonzero}};
const Choices<bool> count_choices = {{"touching", false}, {"crossing", true}};

std::string device_words() {
  std::string words;
  for (const std::string& name : device_names()) words += (words.empty() ? "" : ", ") + name;
  return words;
}

Run add_collide(CLI::App& app, const Hardware* hardware) {
  const auto held = std::make_shared<CollideOptions>();
  CollideOptions& options = *held;
  options.hardware = hardware;
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
  if (hardware != nullptr) {
    add_whole(*command, "--slots", options.slots,
              "with --device sim: 1 or 2 slots whose modules are exchanged for the objects at hand (default 0: a "
              "static chip)",
              WholeRange{0, 2});
    add_whole(*command, "--chips", options.chips,
              "with --device sim: 1 to 8 chips that share one memory and the queries of --poses (default 1)",
              WholeRange{1, hardware->most_chips});
    add_text(
        *command, "--trace", options.trace,
        "with --device sim: write the waveform of the chip's first 30,000 clocks (FST) and a .gtkw layout beside it");
  }
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
  auto* certificate = add_text(*command, "--certificate", options.certificate,
                               "write a proof of each answer into this file, for cchip check")
                          ->excludes(solids)
                          ->excludes(points);
  add_trees(*command, options)->needs(certificate);
  command->footer(
      exit_codes +
      "Examples:\n"
      "  cchip collide a.obj b.stl --pose 0.5,0,0\n"
      "  cchip collide a.obj b.stl --pose 0.5,0,0 --format csv > contacts.csv\n"
      "  cchip collide a.obj b.stl --pose 0.5,0,0 --html contacts.html && xdg-open contacts.html\n"
      "  cchip collide a.obj b.stl --poses poses.csv --expect touches\n"
      "  cchip collide a.obj b.stl --poses poses.csv --counts crossing\n"
      "  cchip collide a.obj b.stl --pose 2,0,0 --within 0.5\n"
      "  cchip collide a.obj b.stl --pose 0.5,0,0 --solids\n"
      "  cchip collide scan.ply b.stl --points --radius 0.01" +
      (hardware == nullptr ? "" : "\n  cchip collide a.obj b.stl --pose 0.5,0,0 --device sim --trace chip.fst"));
  return [held](const Streams& streams) { return run_collide(*held, streams); };
}

Run add_distance(CLI::App& app) {
  const auto held = std::make_shared<DistanceOptions>();
  DistanceOptions& options = *held;
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
  return [held](const Streams& streams) { return run_distance(*held, streams); };
}

Run add_check(CLI::App& app) {
  const auto held = std::make_shared<CheckOptions>();
  CheckOptions& options = *held;
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
  add_trees(*command, options);
  command->footer(exit_codes +
                  "Examples:\n"
                  "  cchip collide a.obj b.stl --pose 0.5,0,0 --certificate proof.jsonl\n"
                  "  cchip check a.obj b.stl proof.jsonl --pose 0.5,0,0");
  return [held](const Streams& streams) { return run_check(*held, streams); };
}

Run add_tree(CLI::App& app) {
  const auto held = std::make_shared<TreeOptions>();
  TreeOptions& options = *held;
  CLI::App* command = app.add_subcommand(
      "tree", "Makes a tree of a mesh, once, which proofs of collide --certificate cite: they are short then");
  add_text(*command, "MESH", options.mesh, "mesh file (OBJ, OFF, PLY, STL); - reads standard input")->required();
  add_text(*command, "FILE", options.file, "the tree")->required();
  add_reading(*command, options);
  command->footer(
      exit_codes +
      "Examples:\n"
      "  cchip tree a.obj a.tree\n"
      "  cchip tree b.stl b.tree\n"
      "  cchip collide a.obj b.stl --poses poses.csv --certificate proofs.jsonl --tree-a a.tree --tree-b b.tree\n"
      "  cchip check a.obj b.stl proofs.jsonl --poses poses.csv --tree-a a.tree --tree-b b.tree");
  return [held](const Streams& streams) { return run_tree(*held, streams); };
}

Run add_clash(CLI::App& app) {
  const auto held = std::make_shared<ClashOptions>();
  ClashOptions& options = *held;
  CLI::App* command = app.add_subcommand(
      "clash", "Is an assembly all right? Parts, poses and rules in; what overlaps, touches or is too near out");
  add_text(*command, "ASSEMBLY", options.assembly,
           "TOML file with parts and rules; or a folder of mesh files, an OBJ with a part for each 'o', glTF, GLB, 3MF "
           "or URDF")
      ->required();
  add_text(*command, "--rules", options.rules, "TOML file with more rules, which come last");
  add_text(*command, "--json", options.json, "write the report; - writes it to standard output in place of the table");
  add_text(*command, "--junit", options.junit, "write the report as JUnit XML, a test case for each pair that meets");
  CLI::Option* html =
      add_text(*command, "--html", options.html, "write a page for browsers with a view of each pair that meets");
  CLI::Option* accept = add_text(*command, "--accept", options.accept,
                                 "write rules that accept what parts do now, for --rules or the key rules of ASSEMBLY");
  add_text(*command, "--unit", options.unit, "um, mm, cm, m, in or ft: that of the assembly's numbers");
  add_text(*command, "--clearance", options.clearance,
           "parts without a rule must be this far apart (default: what ASSEMBLY says, or 0: they must not touch)");
  add_text(*command, "--joints", options.joints,
           "name=value,name=value: joints of a URDF, radians or metres (default: as near 0 as their limits allow)");
  add_text(*command, "--packages", options.packages,
           "folder of the packages of package:// (default: the folders above the URDF)");
  add_text(*command, "--srdf", options.srdf, "SRDF file; pairs that its disable_collisions name may do anything");
  CLI::Option* path = add_text(
      *command, "--path", options.path,
      "CSV file of configurations, a column for each joint (or part,tx,ty,tz and a rotation); judges the motion "
      "from row to row");
  add_text(*command, "--least-step", options.least_step,
           "time between looks below which a motion is called unproved (default 1e-4 of a row)")
      ->needs(path);
  accept->excludes(path);
  html->excludes(path);
  add_text(*command, "--receipts", options.receipts,
           "folder that gets a proof of each verdict, for --verify and cchip check")
      ->excludes(path);
  add_text(*command, "--verify", options.verify,
           "folder of receipts: check these, without judging, against the assembly as it is now")
      ->excludes(path)
      ->excludes(accept)
      ->excludes("--receipts")
      ->excludes("--junit")
      ->excludes(html);
  command->add_flag("--neighbours", options.neighbours, "look at links that a joint joins, too");
  add_whole(*command, "--threads", options.threads, "threads (default 0: as many as there are cores)",
            WholeRange{0, 4096});
  command->add_flag("--lenient", options.lenient,
                    "leave out faces that cannot be used, name them on standard error, and end with exit code 4");
  command->footer(
      "Exit codes: 0 all is as the rules want it, 1 violations (or an internal error, which standard error names),\n"
      "2 wrong input or command line, 4 no violation, but faces left out, or a pair not judged or unproved.\n"
      "Examples:\n"
      "  cchip clash assembly.toml\n"
      "  cchip clash assembly.toml --junit clash.xml --html clash.html\n"
      "  cchip clash robot.urdf --joints shoulder=1.57,elbow=-0.5\n"
      "  cchip clash robot.urdf --path path.csv --clearance 0.01\n"
      "  cchip clash parts/ --unit mm --accept accepted.toml\n"
      "  cchip clash parts/ --unit mm --rules accepted.toml\n"
      "  cchip clash assembly.toml --receipts proofs && cchip clash assembly.toml --verify proofs");
  return [held](const Streams& streams) { return run_clash(*held, streams); };
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
  if (is_hardware_command(word)) return word + ": " + without_hardware;
  return fmt::format("{}: no such command;{} the commands are {}", word, did_you_mean(word, list_commands(app)),
                     command_names(app));
}

/// What is wrong with a command line that CLI11 refuses.
std::string unreadable(const CLI::App& app, const CLI::ParseError& error) {
  std::string what = error.what();
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError)) {
    const std::string name = what.substr(0, what.find(' '));
    what = name == "A"          ? "the first mesh, A, is missing"
           : name == "B"        ? "the second mesh, B, is missing"
           : name == "ASSEMBLY" ? "the assembly, ASSEMBLY, is missing"
           : name == "FILE"     ? "the file of the pairs, FILE, is missing"
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

int dispatch(std::vector<std::string> arguments, const Streams& streams, const Hardware* hardware) {
  CLI::App app(
      "Exact collision detection: do these meshes or primitives touch? On this computer, by the library collisionchip, "
      "or on its hardware, simulated.",
      "cchip");
  const std::string version = "cchip " CCHIP_VERSION;
  app.set_version_flag("-v,--version", version);
  app.require_subcommand(1);
  const std::string examples_of_hardware =
      "  cchip pairs pairs.csv --expect touches\n"
      "  cchip meshpairs a.obj b.stl --pose 0.5,0,0\n";
  app.footer(exit_codes + "Examples:\n" + (hardware == nullptr ? "" : "  cchip demo\n") +
             "  cchip collide a.obj b.stl --pose 0.5,0,0\n" +
             (hardware == nullptr ? "  cchip distance a.obj b.stl --pose 2,0,0\n" : examples_of_hardware) +
             "\"cchip COMMAND --help\" lists the options of a command.");
  std::vector<Command> commands = {
      {"collide", [hardware](CLI::App& to) { return add_collide(to, hardware); }},
      {"distance", add_distance},
      {"check", add_check},
      {"tree", add_tree},
      {"clash", add_clash},
  };
  if (hardware != nullptr) commands.insert(commands.end(), hardware->commands.begin(), hardware->commands.end());
  std::vector<Run> runs;
  for (const Command& command : commands) runs.push_back(command.add(app));
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
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (app.got_subcommand(commands[i].name)) return runs[i](streams);
  }
  streams.out << version << '\n';
  return exit_ok;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

int run_cli(std::vector<std::string> arguments, const Streams& streams, const Hardware* hardware) {
  try {
    const int code = dispatch(std::move(arguments), streams, hardware);
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
