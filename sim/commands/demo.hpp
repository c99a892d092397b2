// SPDX-License-Identifier: Apache-2.0
/// \file
/// The main job: meshes of all kinds in several poses through the hardware, every answer checked.
#ifndef CCHIP_COMMANDS_DEMO_HPP
#define CCHIP_COMMANDS_DEMO_HPP

#include <Eigen/Geometry>
#include <cchip/internal/wire/pair.hpp>
#include <cchip/mesh.hpp>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "engines.hpp"

namespace cchip::app {

struct DemoOptions {
  EngineOptions engine;
  std::string wave_folder = "build/waves";
  /// If not empty: writes only a PLY of torus and gear in pose deep; the faces that hit by the exact oracle are
  /// coloured.
  std::string ply;
};

/// One row of the report: all candidate pairs of two meshes in one pose.
struct DemoRun {
  std::string kinds;  ///< "tri-tri", "tri-quad", "quad-quad"
  std::string pose;
  PairMode mode;
  Mesh a;
  Mesh b;  ///< in its pose
};
std::vector<DemoRun> make_demo_runs();

/// The results of one run.
struct DemoCounts {
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;
  std::uint64_t mismatches = 0;
  std::uint64_t indefinite = 0;
  std::uint64_t beats = 0;    ///< axes of all pairs
  std::uint64_t clocks = 0;   ///< clocks that this run took
  double engine_seconds = 0;  ///< time that the engine took, without the checks
};

/// All candidate pairs of the two meshes through the engine. Every answer on the grid is compared with the Eigen
/// reference and the exact oracle, every definite answer with the exact oracle on the doubles.
/// \param on_answered is called now and then with the number of pairs answered so far
DemoCounts run_demo_pairs(PairEngine& engine, PairMode mode, const Mesh& a, const Mesh& b,
                          const std::function<void(std::uint64_t)>& on_answered = {});

/// Does all runs and reports to `out`; returns the exit code.
int run_demo(const DemoOptions& options, std::ostream& out);

}  // namespace cchip::app

#endif
