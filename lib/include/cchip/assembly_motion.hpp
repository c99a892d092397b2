// SPDX-License-Identifier: Apache-2.0
/// \file
/// Does an assembly stay as it should be while its parts move? docs/cpp/clash.md
///
/// Between two rows nothing is missed: distances at some configurations and bounds of how far parts move prove the
/// rest, in real arithmetic, with the rounding of poses counted. Link collisionchip::assembly.
#ifndef CCHIP_ASSEMBLY_MOTION_HPP
#define CCHIP_ASSEMBLY_MOTION_HPP

#include <array>
#include <cchip/assembly.hpp>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace cchip {

/// Configurations, one a row, at the times 0, 1, 2 ... Of a robot its joints move, each value linearly in time; of
/// other assemblies parts.
struct AssemblyMotion {
  std::vector<std::string> joints = {};          ///< of a robot; the others stay where they are
  std::vector<std::vector<double>> values = {};  ///< for each row one for each of `joints`, radians or metres
  std::vector<std::string> parts = {};           ///< of other assemblies; the others stay
  /// For each row one for each of `parts`: from where the assembly has it to where it is. Between rows the translation
  /// is linear in time, and the rotation the shortest one about an axis, at constant speed.
  std::vector<std::vector<RigidPose>> moves = {};
};

struct MotionPair {
  std::size_t a = 0;  ///< numbers of parts, a < b
  std::size_t b = 0;
  /// The time of the first violation found, and the pair then. Before it, all is proved but `unproved` and the last
  /// step. After it, nothing was looked at.
  std::optional<double> time = std::nullopt;
  AssemblyPair violation = {};
  /// Bounds of the least distance of the surfaces, but in `unproved`: proved, and found. Without a violation.
  double clearance_lower = std::numeric_limits<double>::infinity();
  double clearance_upper = std::numeric_limits<double>::infinity();
  /// From when to when nothing was proved; ascending. Parts that touch as rules allow are among them while they move.
  std::vector<std::array<double, 2>> unproved = {};
};

struct MotionReport {
  std::vector<MotionPair> pairs;  ///< all but those left out and those that may do anything; ascending
  std::size_t violations = 0;     ///< pairs
  std::size_t unproved = 0;       ///< pairs without a violation
  std::size_t looks = 0;          ///< distances that were taken
  std::vector<std::string> notes;
};

struct MotionOptions {
  unsigned threads = 0;      ///< 0: as many as there are cores; the report does not depend on it
  double least_step = 1e-4;  ///< of time; steps are halved while they are longer
  double rel_error = 0.1;  ///< clearance_lower is not below (1 - rel_error) clearance_upper, unless steps get too short
};

/// Looks at all pairs at the first row, and from there to the last one.
/// \throws std::invalid_argument as check() and move_joints(); there is no row, a part or joint is not there, a move is
/// no
///         rotation to 1e-9, or an option is out of its range
MotionReport check_motion(const Assembly& assembly, const AssemblyMotion& motion, const MotionOptions& options = {});

}  // namespace cchip

#endif
