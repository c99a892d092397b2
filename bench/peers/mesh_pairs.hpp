// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pairs of meshes of the sizes that users have, for comparisons with other libraries, and poses of them by class.
#ifndef CCHIP_BENCH_MESH_PAIRS_HPP
#define CCHIP_BENCH_MESH_PAIRS_HPP

#include <cchip/collide.hpp>
#include <cchip/mesh.hpp>
#include <random>
#include <string>
#include <vector>

namespace cchip::testing {

struct MeshPair {
  std::string name;
  Mesh a;
  Mesh b;
  bool counts = true;  ///< in the geometric means
};

/// Names that mesh_pair() takes; those in the geometric means first.
const std::vector<std::string>& mesh_pair_names();
/// Every mesh has a bounding box with a diagonal of 1, but for the small one of the last pair.
/// \throws std::invalid_argument no pair of this name
/// \throws std::runtime_error a mesh file is missing
MeshPair mesh_pair(const std::string& name);

/// How two meshes with flush faces are placed. All poses have a translation of their own.
enum class FlushPlace {
  together,  ///< equal poses, axes along the world's
  shifted,   ///< B moved along the common plane
  turned,    ///< equal poses, turned at random
  apart      ///< turned alike, B moved along the common plane: entries of poses are rounded, so faces are flush but for
             ///< that
};
inline constexpr FlushPlace flush_places[] = {FlushPlace::together, FlushPlace::shifted, FlushPlace::turned,
                                              FlushPlace::apart};
const char* name_of(FlushPlace place);

/// Meshes with flush faces in the plane z = 0, outside the geometric means: two plates of small triangles, offset along
/// the plane; two boxes, one standing on the other.
std::vector<MeshPair> flush_pairs();
PosePair flush_poses(FlushPlace place, std::mt19937_64& random);

/// One surface inside another, apart all round: both in the same pose.
/// Spheres and lumps with the same triangles, cylinders with the same and with other ones, a shaft in its bush with a
/// clearance of 0.05, a part in its housing.
std::vector<MeshPair> nested_pairs();

/// Faces with more than three vertices, and all of them.
std::string describe_faces(const Mesh& mesh);

/// By the distance of B from the centre of A, relative to that of the outermost contact.
enum class PoseClass {
  touch,  ///< 0.95 to 1.05 times
  near,   ///< 1.001 to 1.02 times
  deep,   ///< 0.3 to 0.7 times
  far,    ///< 1.2 to 2 times
  graze   ///< off by 10^-6 to 10^-3 of the smaller mesh's size, in or out; not in the geometric means
};
inline constexpr PoseClass pose_classes[] = {PoseClass::touch, PoseClass::near, PoseClass::deep, PoseClass::far,
                                             PoseClass::graze};
const char* name_of(PoseClass pose_class);

/// Both objects turned and placed at random; B comes along a random direction towards the centre of A.
struct Approach {
  Pose pose_a = Pose::Identity();
  Pose pose_b = Pose::Identity();  ///< at the centre of A
  Vec3d direction = Vec3d::Zero();
  double distance = 0;  ///< from the centre of A, at which B touches first

  PosePair at(double from_centre) const;
};

/// Makes approaches and poses from a seed.
class PoseMaker {
 public:
  /// \param device answers while the outermost contact is sought
  PoseMaker(Device& device, const Object& a, const Object& b, std::uint64_t seed);
  Approach approach();
  PosePair pose(const Approach& approach, PoseClass pose_class);
  /// Small steps from one pose to the next, `count` of them, around the outermost contact: turns of up to half a degree
  /// and moves of up to a thousandth of the smaller mesh's size, times `step`.
  std::vector<PosePair> path(std::size_t count, double step = 1);
  /// Diagonal of the smaller mesh's bounding box.
  double size() const { return size_; }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3d direction();
  Pose turned();
  bool hit(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b);

  Device& device_;
  Object a_;
  Object b_;
  Object segment_;  ///< from the origin to (1, 0, 0)
  std::mt19937_64 random_;
  double radius_a_;
  double radius_b_;
  double size_;
  CollisionResult result_;
};

}  // namespace cchip::testing

#endif
