// SPDX-License-Identifier: Apache-2.0
// Long comparisons of RTL and model with the exact oracle.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <memory>

#include "commands.hpp"

namespace cchip::campaign {
namespace {

void add_common(CLI::App& command, CommonOptions& options) {
  command.add_option("--seed", options.seed, "repeats a run (or CCHIP_SEED)")->capture_default_str();
  command.add_option("--threads", options.threads, "threads; the outcome does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command.add_option("--shape", options.shape, "kinds of the primitives")
      ->check(CLI::IsMember({"all", "tri-tri", "tri-quad", "quad-quad"}))
      ->capture_default_str();
  command.add_option("--least-pairs", options.least_pairs, "goal: pairs in all")->capture_default_str();
  command.add_option("--least-hits", options.least_hits, "goal: pairs that meet")->capture_default_str();
}

void add_coord_w(CLI::App& command, int& coord_w) {
  command.add_option("--coord-w", coord_w, "bits of a coordinate")
      ->check(CLI::Range(defs::coord_w_min, defs::coord_w_max))
      ->capture_default_str();
}

void add_pairs(CLI::App& command, std::uint64_t& pairs, const char* what) {
  command.add_option("--pairs", pairs, what)->capture_default_str();
}

void add_certify(CLI::App& command, std::uint64_t& certify) {
  command
      .add_option("--certify", certify,
                  "pairs per shape whose answers by the CPU device are certified, and the certificates checked")
      ->capture_default_str();
}

/// The chosen subcommand is stored in `chosen`.
void add_commands(CLI::App& app, std::function<int()>& chosen) {
  const auto add = [&](const char* name, const char* what, auto options, int (*run)(const decltype(options)&)) {
    CLI::App* command = app.add_subcommand(name, what);
    const auto shared = std::make_shared<decltype(options)>(options);
    add_common(*command, *shared);
    command->callback([&chosen, shared, run] { chosen = [shared, run] { return run(*shared); }; });
    return std::pair(command, shared);
  };
  const auto [random, r] =
      add("random", "both programmes of the model against the exact oracle, random pairs", RandomOptions{}, run_random);
  add_pairs(*random, r->pairs, "pairs per shape");
  add_certify(*random, r->certify);
  add_coord_w(*random, r->coord_w);
  const auto [grid, g] =
      add("grid", "the same on the grid -1..1: all triangle pairs up to symmetry, samples with quads", GridOptions{},
          run_grid);
  add_pairs(*grid, g->pairs, "pairs per shape; 0: all of triangles, none with quads");
  grid->add_option("--rtl", g->rtl, "pairs per shape that also go through the RTL, in both programmes")
      ->capture_default_str();
  const auto [relation, n] = add("relation", "apart, touching or crossing: exact predicates against the definition",
                                 RelationOptions{}, run_relation);
  add_pairs(*relation, n->pairs, "pairs per shape; 0: all triangle pairs of the grid -1..1, none with quads");
  add_certify(*relation, n->certify);
  relation->add_flag("--random", n->random, "random pairs of all classes instead of the grid -1..1");
  add_coord_w(*relation, n->coord_w);
  const auto [collide, d] =
      add("collide",
          "collide() under singular, sheared, mirrored, huge, tiny and nearly touching poses, against exact "
          "predicates",
          CollideOptions{}, run_collide);
  add_pairs(*collide, d->pairs, "pairs of faces in all");
  add_coord_w(*collide, d->coord_w);
  const auto [boxes, b] = add("boxes", "box test in RTL: volumes that touch in a point, every rounding at its worst",
                              BoxesOptions{}, run_boxes);
  add_pairs(*boxes, b->pairs, "pairs of volumes");
  const auto [classes, c] = add("classes", "RTL against model and exact oracle, class by class, with throughput",
                                ClassesOptions{}, run_classes);
  add_pairs(*classes, c->pairs, "pairs per class and shape");
  classes->add_option("--csv", c->csv, "file for the beats of every class and programme");
  const auto [certainty, e] = add("certainty", "definite answers against exact ones of primitives off the grid",
                                  CertaintyOptions{}, run_certainty);
  add_pairs(*certainty, e->pairs, "pairs in all");
  certainty->add_option("--bounds", e->bounds, "cases for the bounds alone")->capture_default_str();
  certainty->add_option("--offset", e->offset, "offsets, as a multiple of what eta allows: over 1 must fail")
      ->check(CLI::Range(0.0, 4.0))
      ->capture_default_str();
  certainty
      ->add_option("--least-definite", e->least_definite, "goal: % of the pairs with eta 1, shape and programme each")
      ->capture_default_str();
  certainty
      ->add_option("--least-definite-hits", e->least_definite_hits,
                   "goal: definite hits, % of the pairs with eta 1, shape and programme each")
      ->capture_default_str();
  certainty->add_flag("!--signs-only", e->depth, "without the depth rule (docs/develop/architecture.md, certainty)");
  certainty->add_option("--eta", e->eta, "eta of every pair; 0: drawn, 15 included")
      ->check(CLI::Range(0, 14))
      ->capture_default_str();
  add_coord_w(*certainty, e->coord_w);
  const auto [leaves, l] = add("leaves", "leaf pairs of two meshes whose 26-DOPs overlap", LeavesOptions{}, run_leaves);
  leaves->add_option("meshes", l->meshes, "mesh files, each against itself; none: built-in torus, gear, quad torus");
  leaves->add_option("--poses", l->poses, "poses of the second mesh")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  leaves->add_option("--pairs", l->pairs_max, "most leaf pairs per mesh and pose")->capture_default_str();
  leaves->add_flag("--quads", l->quads, "keep the quads of the files");
  leaves->add_flag("!--signs-only", l->depth, "without the depth rule (docs/develop/architecture.md, certainty)");
  leaves->add_option("--eta", l->eta, "eta of a pair that was rounded; the chip's own vertex transform has 2 to 4")
      ->check(CLI::Range(1, 14))
      ->capture_default_str();
  leaves->add_option("--most-indefinite", l->most_indefinite, "goal: % of the pairs of a shape at 16 bit, directed")
      ->capture_default_str();
  leaves->add_option("--most-beats", l->most_beats, "goal: mean beats of a shape at 16 bit, directed")
      ->capture_default_str();
}

}  // namespace
}  // namespace cchip::campaign

int main(int argc, char** argv) try {
  CLI::App app{
      "Campaigns: long comparisons of RTL and model with the exact oracle.\n"
      "Exit codes: 0 nothing wrong, 3 wrong results or a missed goal, 2 the run could not be made, others: wrong "
      "arguments."};
  app.require_subcommand(1);
  std::function<int()> chosen;
  cchip::campaign::add_commands(app, chosen);
  CLI11_PARSE(app, argc, argv);
  return chosen();
} catch (const std::exception& error) {
  std::fprintf(stderr, "cchip_campaign: %s\n", error.what());
  return 2;
}
