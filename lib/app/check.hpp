// SPDX-License-Identifier: Apache-2.0
/// \file
/// The command `cchip check`: do the proofs hold that `cchip collide --certificate` has written?
#ifndef CCHIP_APP_CHECK_HPP
#define CCHIP_APP_CHECK_HPP

#include <string>

#include "cli.hpp"

namespace cchip::app {

struct CheckOptions {
  std::string file_a;
  std::string file_b;
  std::string certificates;  ///< lines of JSON, one certificate after another
  std::string pose;          ///< of B, as in CollideOptions
  std::string pose_matrix;
  std::string poses_file;  ///< CSV; empty: one certificate
  bool lenient = false;    ///< faces that cannot be used are left out, as they were for `collide`
  bool single = false;     ///< coordinates are rounded to single precision
};

/// Runs it and returns the exit code: exit_refused if a certificate does not hold.
/// \throws UsageError a file cannot be read, or there is another number of certificates than of poses
int run_check(const CheckOptions& options, const Streams& streams);

}  // namespace cchip::app

#endif
