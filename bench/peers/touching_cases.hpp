// SPDX-License-Identifier: Apache-2.0
/// \file
/// The rows of the table in docs/cpp/touching.md.
#ifndef CCHIP_BENCH_TOUCHING_CASES_HPP
#define CCHIP_BENCH_TOUCHING_CASES_HPP

#include <cchip/geometry/pose.hpp>
#include <cchip/mesh/mesh.hpp>
#include <string>
#include <vector>

namespace cchip::testing {

/// Two placed meshes; both poses are rigid.
struct TouchingCase {
  std::string name;
  Mesh a;
  Mesh b;
  Pose pose_b = Pose::Identity();
  Pose pose_a = Pose::Identity();
};

/// In the order of the table.
std::vector<TouchingCase> touching_cases();

}  // namespace cchip::testing

#endif
