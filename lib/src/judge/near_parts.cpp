// SPDX-License-Identifier: Apache-2.0
#include <cchip/internal/judge/near_parts.hpp>
#include <cmath>

namespace cchip {

AxisBox<3> world_box(const Pose& pose, const Vec3d& p) {
  AxisBox<3> box;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    double value = pose(row, 3);
    double size = std::abs(value);
    for (Eigen::Index i = 0; i < 3; ++i) {
      value += pose(row, i) * p[i];
      size += std::abs(pose(row, i) * p[i]);
    }
    if (!(size < 0x1p1000)) {
      box.low[k] = -std::numeric_limits<double>::infinity();
      box.high[k] = std::numeric_limits<double>::infinity();
      continue;
    }
    // Six roundings, each of at most 2^-53 size, and what underflows.
    const double slack = size * 0x1p-49 + 0x1p-1060;
    box.low[k] = value - slack;
    box.high[k] = value + slack;
  }
  return box;
}

AxisBox<3> world_box(const Pose& pose, const Mesh& mesh, std::uint32_t face) {
  AxisBox<3> box;
  for (std::size_t i = 0; i < static_cast<std::size_t>(mesh.faces[face].kind); ++i) {
    box.add(world_box(pose, mesh.vertices[mesh.faces[face].vertex[i]]));
  }
  return box;
}

}  // namespace cchip
