// SPDX-License-Identifier: Apache-2.0
/// \file
/// FCL behind a C interface. fcl_peer.cpp is built once for each FCL, as a module that exports one function, so that
/// several FCLs can be in one process: as C++ libraries they would share the symbols of their templates.
#ifndef CCHIP_TESTS_PEERS_FCL_PEER_HPP
#define CCHIP_TESTS_PEERS_FCL_PEER_HPP

#include <cstddef>
#include <cstdint>

struct CchipFclPeer {
  /// FCL's version and how the module was compiled, for example "0.7.0, compiled with AVX2".
  const char* description;
  /// A mesh of triangles with a tree of OBBRSS. `vertices`: x, y, z of each; `triangles`: three numbers each.
  void* (*make)(const double* vertices, std::size_t vertex_count, const std::uint32_t* triangles,
                std::size_t triangle_count);
  void (*destroy)(void* mesh);
  /// Yes or no, one contact at most. Poses are 4 x 4 matrices, column by column, rigid.
  int (*hit)(const void* a, const double* pose_a, const void* b, const double* pose_b);
  /// At most `most` contacts; returns their number. The first `room` of them, triangle of A and triangle of B, are
  /// written to `pairs`. FCL may report a pair twice.
  std::size_t (*contacts)(const void* a, const double* pose_a, const void* b, const double* pose_b, std::size_t most,
                          std::uint32_t* pairs, std::size_t room);
};

/// The one exported function, `cchip_fcl_peer`.
using CchipFclPeerFunction = const CchipFclPeer*();

#endif
