// SPDX-License-Identifier: Apache-2.0
/// \file
/// The rows of the table in docs/cpp/touching.md.
#ifndef CCHIP_BENCH_TOUCHING_CASES_HPP
#define CCHIP_BENCH_TOUCHING_CASES_HPP

#include <cchip/mesh.hpp>
#include <cchip/pose.hpp>
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

/// The same parts, in millimetres, at the origin, 5 km and 50 km away from it: one bit of a coordinate apart, flush,
/// one bit pressed into each other. Either their coordinates are those of the place, as in a site model, or one pose,
/// which turns and moves, places both, as in an assembly.
struct FarCase {
  const char* part;
  const char* place;
  const char* how;  ///< coordinates, or pose
  const char* state;
  bool meets;
  Mesh a;
  Mesh b;
  Pose pose = Pose::Identity();  ///< of both
};
std::vector<FarCase> far_cases();

}  // namespace cchip::testing

#endif
