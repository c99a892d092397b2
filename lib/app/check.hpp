// SPDX-License-Identifier: Apache-2.0
/// \file
/// The command `cchip check`: do the proofs hold that `cchip collide --certificate` has written? And `cchip tree`.
#ifndef CCHIP_APP_CHECK_HPP
#define CCHIP_APP_CHECK_HPP

#include <cchip/certificate_tree.hpp>
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
  std::string tree_a;      ///< files of the trees that the certificates cite; empty: none
  std::string tree_b;
  bool lenient = false;  ///< faces that cannot be used are left out, as they were for `collide`
  bool single = false;   ///< coordinates are rounded to single precision
};

/// Runs it and returns the exit code: exit_refused if a certificate does not hold.
/// \throws UsageError a file cannot be read, or there is another number of certificates than of poses
int run_check(const CheckOptions& options, const Streams& streams);

struct TreeOptions {
  std::string mesh;
  std::string file;  ///< of the tree
  bool lenient = false;
  bool single = false;
};

/// Makes the tree of a mesh for certificates.
int run_tree(const TreeOptions& options, const Streams& streams);

/// Reads the tree of a mesh, which is kept by reference.
/// \throws UsageError the file cannot be read or is not the tree of this mesh
CertificateTree read_tree(const std::string& path, const Mesh& mesh);

}  // namespace cchip::app

#endif
