// SPDX-License-Identifier: Apache-2.0
/// \file
/// The main job: a torus and a gear in three poses through the hardware, every answer checked.
#ifndef CCHIP_APP_DEMO_HPP
#define CCHIP_APP_DEMO_HPP

#include <Eigen/Geometry>
#include <cchip/mesh.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "engines.hpp"

namespace cchip::app {

struct DemoOptions {
  EngineOptions engine;
  std::string wave_folder = "build/waves";
};

struct DemoPose {
  std::string name;
  std::string words;
  Eigen::Isometry3d gear;
};

/// The meshes and poses of the demonstration.
struct DemoScene {
  Mesh torus;
  Mesh gear;
  std::vector<DemoPose> poses;
};
DemoScene make_demo_scene();

/// What came out of one pose.
struct DemoCounts {
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;
  std::uint64_t mismatches = 0;
  std::uint64_t indefinite = 0;
  /// Pairs that are coplanar or degenerate on the grid and that the hardware leaves open with "hit":
  /// only their final answer is checked.
  std::uint64_t special = 0;
  std::uint64_t beats = 0;    ///< axes of all pairs
  std::uint64_t clocks = 0;   ///< clocks that this pose took
  double engine_seconds = 0;  ///< time that the engine needed, without the checks
};

/// All candidate pairs of the two meshes through the engine, every answer compared with the Eigen
/// reference and the exact oracle.
DemoCounts run_demo_pose(PairEngine& engine, PairMode mode, const Mesh& torus, const Mesh& gear);

/// Runs all poses and reports to `out`; returns the exit code.
int run_demo(const DemoOptions& options, std::ostream& out);

}  // namespace cchip::app

#endif
