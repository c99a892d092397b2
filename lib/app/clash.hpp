// SPDX-License-Identifier: Apache-2.0
/// \file
/// The command `cchip clash`: is an assembly as its rules want it?
#ifndef CCHIP_APP_CLASH_HPP
#define CCHIP_APP_CLASH_HPP

#include <string>

#include "cli.hpp"

namespace cchip::app {

struct ClashOptions {
  std::string assembly;     ///< TOML file, folder, OBJ, glTF, GLB, 3MF or URDF
  std::string rules;        ///< a file with more rules; empty: none
  std::string json;         ///< the report; "-": standard output, in place of the table; empty: none
  std::string junit;        ///< the report as JUnit XML; empty: none
  std::string accept;       ///< rules that accept what parts do now; empty: none
  std::string unit;         ///< of the assembly, in place of the file's; empty: that
  std::string clearance;    ///< in place of the file's; empty: that
  std::string joints;       ///< "name=value,...": of a robot; empty: as near 0 as they may be
  std::string packages;     ///< as AssemblyLoadOptions::packages
  std::string srdf;         ///< as AssemblyLoadOptions::srdf
  bool neighbours = false;  ///< as AssemblyLoadOptions::neighbours
  std::string path;         ///< CSV file of configurations; empty: none
  std::string least_step;   ///< as MotionOptions::least_step; empty: its default
  std::string html;         ///< a page with a view of each pair; empty: none
  std::string receipts;     ///< folder for receipts; empty: none
  std::string verify;       ///< folder of receipts to check in place of judging; empty: none
  unsigned threads = 0;     ///< 0: as many as there are cores
  bool lenient = false;     ///< faces that cannot be used are left out
};

/// Runs it and returns the exit code.
/// \throws UsageError
int run_clash(const ClashOptions& options, const Streams& streams);

}  // namespace cchip::app

#endif
