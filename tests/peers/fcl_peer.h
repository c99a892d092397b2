/* SPDX-License-Identifier: Apache-2.0 */
/** \file
 * FCL behind a C interface. fcl_peer.cpp is built once for each FCL as a module that exports one function, so that several
 * FCLs can be in one process: as C++ libraries they would share the symbols of their templates. */
#ifndef CCHIP_TESTS_PEERS_FCL_PEER_H
#define CCHIP_TESTS_PEERS_FCL_PEER_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
  /** FCL's version and how the module was compiled, for example "0.7.0, AVX2". */
  const char* description;
  /** A mesh of triangles with a tree of OBBRSS. `vertices`: x, y, z of each; `triangles`: three numbers each. */
  void* (*make)(const double* vertices, size_t vertex_count, const uint32_t* triangles, size_t triangle_count);
  void (*destroy)(void* mesh);
  /** Yes or no, one contact at most. Poses are 4 x 4 matrices, column by column, rigid. */
  int (*hit)(const void* a, const double* pose_a, const void* b, const double* pose_b);
  /** At most `most` contacts; returns their number. The first `room` of them, triangle of A and triangle of B, are written to
   * `pairs`. FCL may report a pair twice. */
  size_t (*contacts)(const void* a, const double* pose_a, const void* b, const double* pose_b, size_t most,
                     uint32_t* pairs, size_t room);
} CchipFclPeer;

/** The one exported function. */
#define CCHIP_FCL_PEER "cchip_fcl_peer"
typedef const CchipFclPeer* CchipFclPeerFunction(void);

#endif
