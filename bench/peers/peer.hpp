// SPDX-License-Identifier: Apache-2.0
/// \file
/// Another library behind a C interface: fcl_peer.cpp, coal_peer.cpp, cgal_peer.cpp, ode_peer.cpp. Each is a module
/// that exports one function, so that one process can hold several, even two builds of FCL: as C++ libraries they would
/// share the symbols of their templates, and each brings its own versions of Boost and octomap.
#ifndef CCHIP_BENCH_PEER_HPP
#define CCHIP_BENCH_PEER_HPP

#include <cstddef>
#include <cstdint>

/// Do two boxes overlap or touch? Six numbers each: least x, y, z, greatest x, y, z.
inline bool cchip_boxes_meet(const double* p, const double* q) {
  bool apart = false;
  for (int axis = 0; axis < 3; ++axis) {
    apart |= p[axis] > q[3 + axis];
    apart |= q[axis] > p[3 + axis];
  }
  return !apart;
}

/// A broad phase: boxes by numbers from 0, as above.
struct CchipBroadPeer {
  void* (*make)(const double* boxes, std::size_t count);
  void (*destroy)(void* broad);
  void (*move)(void* broad, const std::size_t* numbers, const double* boxes, std::size_t count);
  /// Takes boxes out and puts others with the same numbers in.
  void (*replace)(void* broad, const std::size_t* numbers, const double* boxes, std::size_t count);
  /// How many pairs overlap. Whatever boxes the library keeps, those that it was given decide.
  std::size_t (*count)(void* broad);
};

/// Meshes with poses, and the pairs of them in contact.
struct CchipScenePeer {
  /// Object i is mesh i, which CchipPeer::make made and which outlives the scene, under pose i.
  void* (*make)(void* const* meshes, const double* poses, std::size_t count);
  void (*destroy)(void* scene);
  /// Gives all objects new poses.
  void (*move)(void* scene, const double* poses);
  /// How many pairs are in contact. The first `room` of them, the lesser number first, are written to `pairs`.
  std::size_t (*contacts)(void* scene, std::uint32_t* pairs, std::size_t room);
  /// How many pairs the broad phase leaves.
  std::size_t (*candidates)(void* scene);
};

struct CchipPeer {
  /// Version, how the module was compiled and which of the library's ways it uses, for example "0.7.0, compiled with
  /// AVX2".
  const char* description;
  /// A mesh of triangles with the library's tree. `vertices`: x, y, z of each; `triangles`: three numbers each.
  void* (*make)(const double* vertices, std::size_t vertex_count, const std::uint32_t* triangles,
                std::size_t triangle_count);
  void (*destroy)(void* mesh);
  /// Yes or no. Poses are 4 x 4 matrices, column by column, rigid. One call at a time.
  int (*hit)(void* a, const double* pose_a, void* b, const double* pose_b);
  /// At most `most` contacts; returns their number. The first `room` of them, triangle of A and triangle of B, are
  /// written to `pairs`. A library may report a pair twice. Null: the library has no such answer.
  std::size_t (*contacts)(void* a, const double* pose_a, void* b, const double* pose_b, std::size_t most,
                          std::uint32_t* pairs, std::size_t room);
  /// The distance, with a relative error of at most `rel_error` as the library understands it; 0 or less: they meet.
  /// The nearest points in the world, x, y, z of A's and then of B's, are written to `points`. Null: no such answer.
  double (*distance)(void* a, const double* pose_a, void* b, const double* pose_b, double rel_error,
                     double* points) = nullptr;
  /// Is the distance at most d? Null: no such answer.
  int (*within)(void* a, const double* pose_a, void* b, const double* pose_b, double d) = nullptr;
  /// The error of a distance that the library's own default settings allow, in units of the world.
  double distance_tolerance = 0;
  /// Null: none that the benchmarks ask.
  const CchipBroadPeer* broad = nullptr;
  const CchipScenePeer* scene = nullptr;
};

/// The one exported function, `cchip_peer`.
using CchipPeerFunction = const CchipPeer*();

#endif
