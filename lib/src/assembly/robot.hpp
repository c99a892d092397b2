// SPDX-License-Identifier: Apache-2.0
/// \file
/// What URDF and SRDF files say, before meshes are read.
#ifndef CCHIP_ASSEMBLY_ROBOT_HPP
#define CCHIP_ASSEMBLY_ROBOT_HPP

#include <cchip/assembly.hpp>
#include <string>
#include <vector>

namespace cchip::assembly {

struct RobotShape {
  std::string file;  ///< of the mesh; empty: `mesh` is it
  Mesh mesh;
  Pose place = Pose::Identity();  ///< to the coordinates of the link, scaled
};

struct RobotLink {
  std::string name;
  std::vector<RobotShape> shapes;
};

struct Robot {
  std::vector<RobotLink> links;       ///< the root first
  std::vector<AssemblyJoint> joints;  ///< as Assembly::joints; each as near 0 as its limits allow
  std::vector<std::string> notes;
};

/// \throws std::runtime_error one line: file, link or joint, what is wrong, what to do
Robot read_urdf(const std::string& path, const AssemblyLoadOptions& options);

/// The pairs of disable_collisions, as rules.
/// \throws std::runtime_error one line: file, what is wrong, what to do; also for a link that is not there
std::vector<AssemblyRule> read_srdf(const std::string& path, const std::vector<RobotLink>& links,
                                    std::vector<std::string>& notes);

/// Meshes that contain the shapes. Edges of a cylinder and corners of a sphere lie outside by at most 0.13 and 0.35 %
/// of the radius.
Mesh box_mesh(const Vec3d& size);
Mesh cylinder_mesh(double radius, double length);
Mesh sphere_mesh(double radius);

/// All shapes in the coordinates of the link, rounded; faces of mirrored ones turned. Quads are cut.
/// \param meshes of the shapes
Mesh joined(const std::vector<const Mesh*>& meshes, const std::vector<Pose>& places);

}  // namespace cchip::assembly

#endif
