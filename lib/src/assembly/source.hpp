// SPDX-License-Identifier: Apache-2.0
/// \file
/// What an assembly file says, before meshes are read.
#ifndef CCHIP_ASSEMBLY_SOURCE_HPP
#define CCHIP_ASSEMBLY_SOURCE_HPP

#include <cchip/assembly.hpp>
#include <cchip/pose.hpp>
#include <cstddef>
#include <string>
#include <vector>

namespace cchip::assembly {

struct PartSource {
  std::string name;  ///< empty: that of the file
  std::string file;  ///< as written
  std::string unit;  ///< empty: that of the assembly
  Pose pose = Pose::Identity();
  std::vector<std::string> groups = {};
  std::string place = {};  ///< "file:line", for messages
};

struct AssemblySource {
  std::string unit;
  double clearance = 0;
  std::vector<PartSource> parts;
  std::vector<AssemblyRule> rules;
  std::vector<std::string> rules_files;  ///< as written
};

/// \param with_parts false: a file of rules, which has no other key
/// \throws std::runtime_error one line: file, line, key, what to do
AssemblySource read_toml(const std::string& path, bool with_parts);

/// The length of a unit in millimetres; 0 if there is no such unit.
double millimetres(const std::string& unit);
/// "um, mm, cm, m, in or ft".
extern const char* const units;

}  // namespace cchip::assembly

#endif
