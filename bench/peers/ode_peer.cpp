// SPDX-License-Identifier: Apache-2.0
// ODE's mesh against mesh (OPCODE). Its contacts are points for a simulation, not pairs of faces: yes or no only.
#include <ode/ode.h>
#include <ode/version.h>

#include <string>
#include <vector>

#include "peer.hpp"

namespace {

/// ODE refers to the vertices and the numbers, it does not copy them.
struct Body {
  std::vector<double> vertices;
  std::vector<dTriIndex> triangles;
  dTriMeshDataID data = dGeomTriMeshDataCreate();
  dGeomID geom = nullptr;

  Body(const double* points, size_t point_count, const uint32_t* numbers, size_t triangle_count)
      : vertices(points, points + 3 * point_count), triangles(numbers, numbers + 3 * triangle_count) {
    dGeomTriMeshDataBuildDouble(data, vertices.data(), 3 * sizeof(double), static_cast<int>(point_count),
                                triangles.data(), static_cast<int>(triangles.size()), 3 * sizeof(dTriIndex));
    geom = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
  }
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body() {
    dGeomDestroy(geom);
    dGeomTriMeshDataDestroy(data);
  }

  void place(const double* pose) const {
    dMatrix3 rotation = {};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        rotation[4 * row + column] = static_cast<dReal>(pose[4 * column + row]);
    }
    dGeomSetRotation(geom, rotation);
    dGeomSetPosition(geom, static_cast<dReal>(pose[12]), static_cast<dReal>(pose[13]), static_cast<dReal>(pose[14]));
  }
};

void* make(const double* vertices, size_t vertex_count, const uint32_t* triangles, size_t triangle_count) {
  return new Body(vertices, vertex_count, triangles, triangle_count);
}

void destroy(void* mesh) { delete static_cast<Body*>(mesh); }

int hit(void* a, const double* pose_a, void* b, const double* pose_b) {
  const Body& body_a = *static_cast<const Body*>(a);
  const Body& body_b = *static_cast<const Body*>(b);
  body_a.place(pose_a);
  body_b.place(pose_b);
  dContactGeom contact;
  return dCollide(body_a.geom, body_b.geom, static_cast<int>(CONTACTS_UNIMPORTANT | 1U), &contact, sizeof contact) > 0;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const CchipPeer* cchip_peer() {
  static const bool started = dInitODE2(0) != 0 && dAllocateODEDataForThread(dAllocateMaskAll) != 0;
  static const std::string description =
      std::string(dODE_VERSION) + (dCheckConfiguration("ODE_EXT_opcode") != 0 ? ", OPCODE" : ", not OPCODE") +
      (dCheckConfiguration("ODE_double_precision") != 0 ? ", double precision" : ", single precision");
  static const CchipPeer peer = {description.c_str(), make, destroy, hit, nullptr};
  return started ? &peer : nullptr;
}
