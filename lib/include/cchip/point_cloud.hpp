// SPDX-License-Identifier: Apache-2.0
/// \file
/// Point clouds: spheres against the faces of objects. docs/cpp/points.md
///
/// A sphere meets a face if the distance of its centre from the face is at most its radius: exactly, for the doubles of
/// points, radii, meshes and poses, in real arithmetic without rounding. Faces are surfaces, as in collide(): a sphere
/// wholly inside an object meets none of them.
#ifndef CCHIP_POINT_CLOUD_HPP
#define CCHIP_POINT_CLOUD_HPP

#include <cchip/collide.hpp>
#include <cchip/object.hpp>
#include <cchip/pose.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace cchip {

struct PointTree;

/// Points with a radius each, made ready for queries; copies share it. One that was moved from has no points: calls
/// that need them throw. Immutable, so it may be used by any number of threads at a time. A cloud without points meets
/// nothing.
class PointCloud {
 public:
  /// Takes O(points log(points)) time.
  /// \param radius of all spheres, in units of the world: poses move the points and leave it as it is. 0: points
  /// \throws std::invalid_argument 2^31 points or more, a coordinate that is not finite or beyond 2^1000, or a radius
  ///         that is negative, not finite or beyond 2^1000; one line with the number of the point
  /// \throws std::runtime_error the calling thread flushes small numbers to zero
  PointCloud(const std::vector<Vec3d>& points, double radius);
  /// The same with a radius for each point.
  /// \throws std::invalid_argument as above; another number of radii than points
  PointCloud(const std::vector<Vec3d>& points, const std::vector<double>& radii);

  /// \throws std::invalid_argument the cloud was moved from; so do points(), radii() and tree()
  std::size_t size() const;
  std::vector<Vec3d> points() const;  ///< what the cloud was made from
  std::vector<double> radii() const;  ///< of each point
  const PointTree& tree() const;      ///< what searches traverse; internal

 private:
  std::shared_ptr<const PointTree> tree_;
};

/// A sphere and a face that meet: number of the point, and of the face in the file (Mesh::file_face).
struct CloudContact {
  std::uint32_t point = 0;
  std::uint32_t face = 0;
  friend bool operator==(const CloudContact& x, const CloudContact& y) {
    return x.point == y.point && x.face == y.face;
  }
  friend bool operator!=(const CloudContact& x, const CloudContact& y) { return !(x == y); }
  friend bool operator<(const CloudContact& x, const CloudContact& y) {
    return x.point != y.point ? x.point < y.point : x.face < y.face;
  }
};

struct CloudRequest {
  /// The first contact that the search meets, which may be any, or all of them.
  CollisionRequest::Contacts contacts = CollisionRequest::Contacts::first;
  /// With Contacts::all: the search ends when it meets one contact more than this many. At least 1.
  std::size_t max_contacts = std::numeric_limits<std::size_t>::max();
};

struct CloudResult {
  bool hit = false;
  /// In ascending order, without duplicates. With Contacts::first at most one.
  std::vector<CloudContact> contacts;
  CollisionStats stats;  ///< `pairs`: points and faces; `open`: those of them that plain doubles left open
};

/// Which spheres of the cloud meet which faces of the object? Takes no memory from the heap but for contacts that
/// `result`, whose memory is used again, has no room for, and for integers of more than 512 bits where these decide.
/// Any number of threads may call it at a time.
/// \throws std::invalid_argument the cloud or the object was moved from, an entry of a pose is not finite or beyond
///         2^500 in magnitude, or `max_contacts` is 0
/// \throws std::runtime_error the calling thread flushes small numbers to zero
void collide(const PointCloud& cloud, const Pose& pose_cloud, const Object& object, const Pose& pose_object,
             const CloudRequest& request, CloudResult& result);
CloudResult collide(const PointCloud& cloud, const Pose& pose_cloud, const Object& object, const Pose& pose_object,
                    const CloudRequest& request = {});

/// An object where it is, such as a link of a robot. Refers to an object of the caller, which must stay as it is during
/// a call.
struct PlacedObject {
  const Object* object = nullptr;
  Pose pose = Pose::Identity();
};

/// The same for each of several objects, one result for each, in their order.
/// \throws as above; std::invalid_argument a pointer is null
void collide(const PointCloud& cloud, const Pose& pose_cloud, const std::vector<PlacedObject>& objects,
             const CloudRequest& request, std::vector<CloudResult>& results);
/// Does a sphere of the cloud meet any of the objects? Ends at the first contact.
/// \returns the number of the first object in the list that is met, or objects.size() if none is
/// \throws as above
std::size_t first_met(const PointCloud& cloud, const Pose& pose_cloud, const std::vector<PlacedObject>& objects);

}  // namespace cchip

#endif
