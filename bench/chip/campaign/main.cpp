// SPDX-License-Identifier: Apache-2.0
// Long runs of cchip_chip behind its driver: poses of many meshes against the CPU device, faults, soft resets, swaps.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "campaign.hpp"

int main(int argc, char** argv) {
  using namespace cchip::testing;
  CLI::App app("Campaigns of the whole chip in RTL behind its driver.");
  app.require_subcommand(1);
  PosesSettings poses;
  auto* poses_command = app.add_subcommand("poses", "the simulated device against the CPU device, face for face");
  poses_command->add_option("--meshes", poses.meshes, "pairs of meshes; default: ten")->delimiter(',');
  poses_command->add_option("--first", poses.first, "queries for the first contact, in all")->capture_default_str();
  poses_command->add_option("--all", poses.all, "queries for all contacts, in all")->capture_default_str();
  poses_command->add_option("--seed", poses.seed, "of poses, memory, power-up")->capture_default_str();
  AdversarialSettings adversarial;
  auto* adversarial_command =
      app.add_subcommand("adversarial", "scenes made to break rounding, against the CPU device");
  adversarial_command->add_option("--scenes", adversarial.scenes, "pairs of objects, all kinds in turn")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  adversarial_command->add_option("--poses", adversarial.poses, "of each scene; a tenth of them with all contacts")
      ->capture_default_str();
  adversarial_command->add_option("--faces", adversarial.faces, "of the largest object")->capture_default_str();
  adversarial_command->add_option("--kinds", adversarial.kinds, "only these")->delimiter(',');
  adversarial_command->add_option("--seed", adversarial.seed, "of the first scene")->capture_default_str();
  FaultSettings faults;
  auto* faults_command = app.add_subcommand("faults", "queries under faults, alone and in pairs");
  faults_command->add_option("--queries", faults.queries, "in all")->capture_default_str();
  faults_command->add_option("--faults", faults.faults, "only these")->delimiter(',');
  faults_command->add_option("--stop", faults.stop, "clocks of the longest stop of the host")->capture_default_str();
  faults_command->add_option("--seed", faults.seed, "of everything")->capture_default_str();
  faults_command->add_flag("--all-bins", faults.all_bins, "every fault in each phase and mode, or exit code 3");
  ResetSettings resets;
  auto* resets_command = app.add_subcommand("resets", "soft resets at any clock, each followed by right queries");
  resets_command->add_option("--resets", resets.resets, "how many")->capture_default_str();
  resets_command->add_option("--seed", resets.seed, "of everything")->capture_default_str();
  resets_command
      ->add_option("--slots", resets.slots, "1 or 2 slots, whose modules are exchanged meanwhile; 0: no swaps")
      ->check(CLI::Range(0, 2))
      ->capture_default_str();
  MixedSettings mixed;
  auto* mixed_command = app.add_subcommand("mixed", "batches of triangle and quad objects through a chip with swaps");
  mixed_command->add_option("--slots", mixed.slots, "1 or 2")->check(CLI::Range(1, 2))->capture_default_str();
  mixed_command->add_option("--queries", mixed.queries, "in all")->capture_default_str();
  mixed_command->add_option("--faults", mixed.faults,
                            "of bitstreams and swaps: all, or one of silent, bus_error, "
                            "damaged, forced, abort, slow, commands");
  mixed_command
      ->add_option("--busy", mixed.busy, "percent of batches whose queries end early while swaps follow each other")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  mixed_command->add_option("--seed", mixed.seed, "of everything")->capture_default_str();
  CurveSettings curve;
  auto* curve_command = app.add_subcommand("curve", "triangles and quads in turn: overhead against queries per swap");
  curve_command->add_option("--queries", curve.queries, "per swap")->delimiter(',')->capture_default_str();
  curve_command->add_option("--rounds", curve.rounds, "swaps of each kind that are measured")->capture_default_str();
  bool three = false;
  curve_command->add_flag("--three", three, "three modules in turn, on one slot and on two");
  curve_command->add_option("--triangle-bytes", curve.triangle_bytes, "payload")->capture_default_str();
  curve_command->add_option("--quad-bytes", curve.quad_bytes, "payload")->capture_default_str();
  curve_command->add_option("--seed", curve.seed, "of poses and power-up")->capture_default_str();
  app.footer("Exit codes: 0 nothing wrong, 3 a wrong or lost answer, others: wrong arguments.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0 && app.get_subcommands().empty()) {
      std::string names;
      for (const CLI::App* command : app.get_subcommands({}))
        names += (names.empty() ? "" : ", ") + command->get_name();
      fmt::print(stderr, "cchip_chip_campaign: {}; the first argument is a campaign: {}\n", error.what(), names);
      return 2;
    }
    return app.exit(error);
  }
  try {
    if (*poses_command) return run_poses(poses);
    if (*adversarial_command) return run_adversarial(adversarial);
    if (*faults_command) return run_faults(faults);
    if (*mixed_command) return run_mixed(mixed);
    if (*curve_command) return three ? run_three(curve) : run_curve(curve);
    return run_resets(resets);
  } catch (const std::exception& error) {
    fmt::print(stderr, "cchip_chip_campaign: {}\n", error.what());
    return 2;
  }
}
