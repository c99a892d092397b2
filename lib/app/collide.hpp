// SPDX-License-Identifier: Apache-2.0
/// \file
/// The command `cchip collide`: two meshes in one pose or in many.
#ifndef CCHIP_APP_COLLIDE_HPP
#define CCHIP_APP_COLLIDE_HPP

#include <cchip/collide.hpp>
#include <cchip/solids.hpp>
#include <cstddef>
#include <optional>
#include <string>

#include "cli.hpp"
#include "row_writer.hpp"

namespace cchip::app {

struct CollideOptions {
  std::string file_a;
  std::string file_b;
  std::string pose;         ///< of B: see parse_pose(); empty: none
  std::string pose_matrix;  ///< of B: see parse_affine_matrix(); empty: none
  std::string poses_file;   ///< CSV; empty: one query
  /// Nothing: all contacts of a single query, but only the first of each of many.
  std::optional<CollisionRequest::Contacts> contacts;
  std::size_t max_contacts = 0;  ///< 0: no limit
  bool only_crossing = false;    ///< contacts that only touch do not count
  bool relation = false;         ///< tell touching from crossing; a single query for all contacts does in any case
  std::string within;            ///< faces at most this far apart are contacts; empty: those that share a point
  bool points = false;           ///< A is a file of points, see load_points()
  std::string radius;            ///< of each point's sphere; empty: 0
  bool solids = false;           ///< how the solids lie to each other, in place of contacts
  InsideRule inside = InsideRule::odd;
  bool exit_code = false;  ///< exit code 5 if a query found a contact
  bool lenient = false;    ///< faces that cannot be used are left out
  bool single = false;     ///< coordinates are rounded to single precision
  std::string device = "cpu";
  Format format = Format::table;
  std::string expect;       ///< column of the file; empty: none
  std::string ply;          ///< path of the coloured picture with the curves; empty: none
  std::string html;         ///< path of the view for a browser; empty: none
  std::string certificate;  ///< path of the proofs of the answers; empty: none
  std::string tree_a;       ///< files of trees that these cite; empty: none
  std::string tree_b;
  std::uint64_t slots = 0;             ///< of device sim, with swaps; 0: a static chip
  std::uint64_t chips = 1;             ///< of device sim
  const Hardware* hardware = nullptr;  ///< null: there is none
  std::string trace;                   ///< path of the waveform of device sim; empty: none
};

/// Runs it and returns the exit code.
/// \throws UsageError
int run_collide(const CollideOptions& options, const Streams& streams);

}  // namespace cchip::app

#endif
