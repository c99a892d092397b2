// SPDX-License-Identifier: Apache-2.0
/// \file
/// A robot as its URDF describes it: links with their collision meshes, joints, forward kinematics.
#ifndef CCHIP_BENCH_ROBOT_HPP
#define CCHIP_BENCH_ROBOT_HPP

#include <cchip/mesh.hpp>
#include <cchip/pose.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace cchip::testing {

/// Box around the origin, closed, fronts outside: 12 triangles. \param size edges along x, y, z
Mesh make_box(const Vec3d& size);

/// A tree of links. Lengths are metres, angles radians.
class Robot {
 public:
  struct Link {
    std::string name;
    /// All its collision geometry in the frame of the link; no faces if it has none.
    Mesh mesh;
    /// Links that fixed joints connect have the same number: their meshes never move against each other.
    std::size_t body = 0;
  };
  /// A coordinate that moves on its own, by the limits of its joint.
  struct Axis {
    std::string joint;
    double lower = 0;
    double upper = 0;
  };

  /// Reads a URDF: joints that are fixed, revolute, continuous (one turn) or prismatic, also those that mimic another;
  /// collision geometry that is a box or a mesh which load_mesh() reads. `package://<name>/` stands for `package`.
  /// \throws std::runtime_error one line: file, line number, what is wrong, what to do
  Robot(const std::filesystem::path& urdf, const std::filesystem::path& package);

  const std::vector<Link>& links() const { return links_; }
  const std::vector<Axis>& axes() const { return axes_; }
  /// Whether one joint moves one body against the other, or both links belong to the same body. Planners do not ask
  /// about such links, because their meshes overlap where the joint is.
  bool adjacent(std::size_t link_a, std::size_t link_b) const;
  /// Poses of all links for a value of each axis; the first link of the tree is at the origin.
  std::vector<Pose> poses(const std::vector<double>& values) const;

 private:
  struct Joint {
    std::size_t parent = 0;
    std::size_t child = 0;
    RigidPose origin = RigidPose::Identity();
    Vec3d direction = Vec3d::UnitX();
    bool turns = false;  ///< else it slides
    bool fixed = true;
    std::size_t axis = 0;  ///< its value is factor * that of the axis + offset
    double factor = 1;
    double offset = 0;
  };

  std::vector<Link> links_;
  std::vector<Joint> joints_;  ///< a joint comes after the one that moves its parent
  std::vector<Axis> axes_;
};

}  // namespace cchip::testing

#endif
