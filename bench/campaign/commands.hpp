// SPDX-License-Identifier: Apache-2.0
/// \file
/// The subcommands of cchip_campaign. Each prints its tables and a last line key=value, and returns the exit code:
/// 0, or wrong_result (a missed goal included).
#ifndef CCHIP_CAMPAIGN_COMMANDS_HPP
#define CCHIP_CAMPAIGN_COMMANDS_HPP

#include <cchip/internal/wire/definitions.hpp>
#include <cchip/stimulus/campaign.hpp>

namespace cchip::campaign {

using namespace stimulus;

struct RandomOptions : CommonOptions {
  std::uint64_t pairs = 1000000;  ///< per shape
  std::uint64_t certify = 0;      ///< of them, whose answers prove themselves (certify_sample.hpp)
  int coord_w = defs::coord_w_default;
};
/// Random pairs of all classes: both programmes of the model against the exact oracle.
int run_random(const RandomOptions& options);

struct GridOptions : CommonOptions {
  std::uint64_t pairs = 0;  ///< with a quad, per shape; triangles: 0 all pairs, else a sample
  std::uint64_t rtl = 0;    ///< pairs that also go through the RTL, per shape
};
/// Primitives of the grid -1..1: all pairs of triangles up to symmetry, samples of pairs with quads.
int run_grid(const GridOptions& options);

struct RelationOptions : CommonOptions {
  std::uint64_t pairs = 0;    ///< per shape; 0: all triangle pairs of the grid
  std::uint64_t certify = 0;  ///< of them, as above
  bool random = false;        ///< random pairs of all classes instead of the grid -1..1
  int coord_w = defs::coord_w_default;
};
/// Whether primitives are apart, touch or cross: exact predicates against the definition.
int run_relation(const RelationOptions& options);

struct CollideOptions : CommonOptions {
  std::uint64_t pairs = 1000000;  ///< of faces, in all
  int coord_w = defs::coord_w_default;
};
/// collide() of meshes of a few faces under any poses against exact predicates.
int run_collide(const CollideOptions& options);

struct BoxesOptions : CommonOptions {
  std::uint64_t pairs = 10000000;  ///< of volumes that touch
};
/// Volumes that touch in a point through the RTL of the box test: none may be separated.
int run_boxes(const BoxesOptions& options);

struct ClassesOptions : CommonOptions {
  std::uint64_t pairs = 100000;  ///< per class, shape and programme
  std::string csv;               ///< file for the mean beats; empty: none
};
/// RTL against model and exact oracle, class by class.
int run_classes(const ClassesOptions& options);

struct CertaintyOptions : CommonOptions {
  std::uint64_t pairs = 10000000;  ///< in all
  std::uint64_t bounds = 1000000;  ///< cases of the bounds alone
  int coord_w = defs::coord_w_default;
  bool depth = true;  ///< with the depth rule
  int eta = 0;        ///< of every pair; 0: drawn
  double offset = 1;  ///< offsets as a multiple of what eta allows; over 1 must fail
  /// Goals: definite answers, definite hits, per cent of the pairs with eta = 1, for each shape and programme.
  double least_definite = 20;
  double least_definite_hits = 2;
};
/// Primitives between the grid points: no definite answer may contradict the exact one.
int run_certainty(const CertaintyOptions& options);

struct LeavesOptions : CommonOptions {
  std::vector<std::string> meshes;  ///< files; none: the built-in ones
  int poses = 6;
  std::uint64_t pairs_max = 200000;  ///< leaf pairs per mesh and pose
  bool quads = false;                ///< keep the quads of the files
  bool depth = true;                 ///< with the depth rule
  int eta = 1;                       ///< of a pair that was rounded: that of a sender with more error than the host
  /// Goals for each shape, DIRECTED at the default width: per cent of the pairs, mean beats.
  double most_indefinite = 0.25;
  double most_beats = 4;
};
/// Leaf pairs of two meshes whose 26-DOPs overlap.
int run_leaves(const LeavesOptions& options);

}  // namespace cchip::campaign

#endif
