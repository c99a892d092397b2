// SPDX-License-Identifier: Apache-2.0
/// \file
/// The command `cchip distance`: how far two meshes are apart, at all or along a direction.
#ifndef CCHIP_APP_DISTANCE_HPP
#define CCHIP_APP_DISTANCE_HPP

#include <string>

#include "cli.hpp"
#include "row_writer.hpp"

namespace cchip::app {

struct DistanceOptions {
  std::string file_a;
  std::string file_b;
  std::string pose;            ///< of B, as in CollideOptions
  std::string pose_matrix;     ///< of B, as in CollideOptions
  std::string relative_error;  ///< the distance may be so inexact; empty: as exact as doubles are
  std::string stop_above;      ///< of a greater distance nothing more is asked; empty: none
  std::string along;           ///< x,y,z: how far must B move in this direction, in place of the distance; empty: none
  std::string ply;             ///< both meshes and the line between the nearest points; empty: none
  bool lenient = false;        ///< faces that cannot be used are left out
  bool single = false;         ///< coordinates are rounded to single precision
  Format format = Format::table;
};

/// Runs it and returns the exit code.
/// \throws UsageError
int run_distance(const DistanceOptions& options, const Streams& streams);

}  // namespace cchip::app

#endif
