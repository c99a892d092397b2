// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where parts are on a path, and how far they move at most.
#ifndef CCHIP_ASSEMBLY_PART_PATHS_HPP
#define CCHIP_ASSEMBLY_PART_PATHS_HPP

#include <cchip/assembly_motion.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cchip::assembly {

/// How two parts move to each other.
struct PairPath {
  /// For each step from row to row, a bound of how much the distance of two points of theirs changes per time.
  std::vector<double> speed;
  /// A bound of how far rounding moves points of them together.
  double rounding = 0;
};

class PartPaths {
 public:
  PartPaths() = default;
  virtual ~PartPaths() = default;
  PartPaths(const PartPaths&) = delete;
  PartPaths& operator=(const PartPaths&) = delete;

  virtual std::size_t rows() const = 0;
  /// \param time of 0 .. rows() - 1
  virtual std::pair<Pose, Pose> poses(std::size_t a, std::size_t b, double time) const = 0;
  virtual PairPath path_of(std::size_t a, std::size_t b) const = 0;
  virtual std::vector<std::string> notes() const { return {}; }
};

/// Refers to the assembly.
/// \throws std::invalid_argument as check_motion()
std::unique_ptr<PartPaths> part_paths(const Assembly& assembly, const AssemblyMotion& motion);

}  // namespace cchip::assembly

#endif
