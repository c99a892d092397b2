// SPDX-License-Identifier: Apache-2.0
// cchip_levels: the refinement levels on one stimulus, compared pair by pair.
#include <CLI/CLI.hpp>
#include <array>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/levels/added_deltas.hpp>
#include <cchip/levels/generator.hpp>
#include <cchip/levels/level.hpp>
#include <cchip/levels/stimulus_file.hpp>
#include <cchip/levels/summary.hpp>
#include <cchip/program/command_line.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/program/usage_error.hpp>
#include <fstream>
#include <iostream>
#include <systemc>

namespace cchip::levels {
namespace {

struct Level {
  const char* name;
  const char* description;
  bool reconfigures;
  LevelResult (*run)(const Stimulus&, const LevelOptions&);
};
constexpr std::array<Level, 5> all_levels = {{
    {"L0", "functional, all tests side by side", false, run_l0},
    {"L1", "the same reconfigurable, portals and control", true, run_l1},
    {"L2", "the same with configuration times", true, run_l2},
    {"L3", "Verilated RTL behind signal portals", true, run_l3},
    {"L4", "RTL slot and configuration controller, TLM", true, run_l4},
}};

struct Options {
  GeneratorOptions generator;
  LevelOptions level;
  std::string read_from;
  std::string write_to;
};

constexpr WholeRange pairs_range = {1, 100'000'000};  // they are held in memory
constexpr WholeRange payload_range = {0, 1 << 24};

Stimulus make_stimulus(const Options& options) {
  if (options.read_from.empty()) return generate(options.generator);
  std::ifstream in(options.read_from);
  if (!in) throw UsageError(options.read_from + ": cannot be read; check its path and permissions");
  return read_stimulus(in, options.read_from);
}

void save(const Stimulus& stimulus, const std::string& path) {
  sim::OutputFile out(path);
  write_stimulus(out.stream(), stimulus);
  out.commit();
}

LevelRun run(const Level& level, const Stimulus& stimulus, const LevelOptions& options) {
  LevelRun result{level.name, level.description, level.reconfigures, {}, {}};
  try {
    result.result = in_child([&] { return level.run(stimulus, options); });
  } catch (const std::runtime_error& error) {
    result.error = error.what();
  }
  return result;
}

int run(const Options& options) {
  sim::check_outputs({{"--read", options.read_from}}, {{"--write", options.write_to}});
  const Stimulus stimulus = make_stimulus(options);
  if (!options.write_to.empty()) save(stimulus, options.write_to);
  Summary summary(stimulus);
  Progress progress("levels");
  std::uint64_t done = 0;
  for (const Level& level : all_levels) {
    summary.add(run(level, stimulus, options.level));
    progress.update(++done, -1);  // levels take too different times for an estimate
  }
  if (summary.good()) summary.set_added_deltas(added_deltas(stimulus, options.level));
  progress.clear();
  summary.print(std::cout);
  return summary.good() ? exit_ok : exit_mismatch;
}

int run_with_arguments(int argc, char** argv) {
  Options options;
  options.generator.seed = sim::seed_from_environment();
  CLI::App command("Five refinement levels of the primitive tests on one stimulus, compared with the Eigen reference.");
  const auto with_default = [](CLI::Option* option, std::uint64_t value) {
    option->default_str(std::to_string(value));
  };
  with_default(add_whole(command, "--pairs", options.generator.pairs, "primitive pairs", pairs_range),
               options.generator.pairs);
  with_default(add_whole(command, "--object-pairs", options.generator.object_pairs, "object pairs, each needs a swap",
                         pairs_range),
               options.generator.object_pairs);
  with_default(
      add_whole(command, "--seed", options.generator.seed, "seed of stimulus and power-up values (or CCHIP_SEED)"),
      options.generator.seed);
  with_default(add_whole(command, "--bitstream", options.level.payload_bytes,
                         "payload of a bitstream, bytes; 0: the lengths of Table 1", payload_range),
               options.level.payload_bytes);
  command.add_flag("!--without-roc", options.level.reset_on_configuration,
                   "L3 without reset on configuration, to see what happens");
  command.add_flag("--points", options.generator.points, "object pairs of points with a radius and triangles, too");
  add_text(command, "--read", options.read_from, "CSV file with the stimulus instead of a random one");
  add_text(command, "--write", options.write_to, "CSV file that gets the stimulus");
  try {
    command.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return command.exit(error);  // --help
    throw UsageError(std::string(error.what()) + "; see cchip_levels --help");
  }
  if (options.level.payload_bytes != 0 && options.level.payload_bytes < defs::bitstream_payload_min) {
    throw UsageError("--bitstream: a bitstream has at least " + std::to_string(defs::bitstream_payload_min) +
                     " bytes; write 0, or 16 to 16777216");
  }
  options.level.seed = options.generator.seed;
  std::cout << "CCHIP_SEED=" << options.generator.seed << '\n';
  return run(options);
}

}  // namespace
}  // namespace cchip::levels

int sc_main(int argc, char** argv) {
  using namespace cchip;
  try {
    return levels::run_with_arguments(argc, argv);
  } catch (const UsageError& error) {
    std::cerr << "cchip_levels: " << error.what() << '\n';
    return exit_usage;
  } catch (const std::invalid_argument& error) {
    std::cerr << "cchip_levels: " << error.what() << '\n';
    return exit_usage;
  } catch (const sim::OutputError& error) {
    std::cerr << "cchip_levels: " << error.what() << '\n';
    return exit_usage;
  } catch (const std::exception& error) {
    std::cerr << "cchip_levels: " << error.what() << '\n';
    return exit_internal;
  }
}
