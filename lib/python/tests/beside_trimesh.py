#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The same random scenes through collisionchip.CollisionManager and trimesh.collision.CollisionManager over python-fcl.

usage: beside_trimesh.py [SCENES]      (default 2000; CCHIP_SEED repeats a run)

Compares the names of in_collision_internal(), in_collision_single() and in_collision_other(), and the faces in contact
of pairs of meshes that are not convex. Where the two differ, integers of any size decide over all pairs of faces. In
half of the scenes all coordinates are multiples of 1/4, so that faces are flush. Exit code 1 if collisionchip was wrong
once."""
import collections
import sys

import numpy as np
import trimesh

import collisionchip
from collisionchip._core import _exact
from shapes import SEED, cube, poses, torus

OBJECTS = 10  # a scene


def meshes():
    """Meshes with corners on multiples of 1/4, and round ones."""
    bracket = np.array([(0, 0), (1.5, 0), (1.5, 0.5), (0.5, 0.5), (0.5, 1.5), (0, 1.5)])
    prism = trimesh.creation.extrude_triangulation(bracket, [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)], 0.5)
    flat = [trimesh.Trimesh(*cube(1), process=False), trimesh.Trimesh(*cube(0.5), process=False), prism]
    sphere = trimesh.creation.icosphere(subdivisions=1, radius=0.7)
    return flat, [*flat, trimesh.Trimesh(*torus(1, 0.3, 12, 5), process=False), sphere]


def quarter_poses(random, count):
    """Turns by 90 degrees, and translations by multiples of 1/4."""
    result = np.zeros((count, 4, 4))
    for pose in result:
        pose[range(3), random.permutation(3)] = random.choice([-1, 1], size=3)
        pose[:3, :3] *= np.linalg.det(pose[:3, :3]).round()
        pose[:3, 3] = random.integers(-4, 5, size=3) / 4
        pose[3, 3] = 1
    return result


def faces_by_pair(contacts):
    """{(lesser name, greater name): the pairs of faces}"""
    found = collections.defaultdict(set)
    for contact in contacts:
        a, b = sorted(contact.names)
        found[a, b].add((contact.index(a), contact.index(b)))
    return found


class Comparison:
    """Judges answers that differ, and counts them."""

    def __init__(self):
        self.count = collections.Counter()

    def names(self, ours, theirs, placed):
        self.count["pairs"] += len(ours)
        for a, b in ours ^ theirs:
            hit = _exact(*placed[a][1:], *placed[b][1:]).hit
            if ((a, b) in ours) != hit:
                self.count["differences"] += 1
                print(f"wrong: {a} {b}, exact: {hit}")
            if ((a, b) in theirs) != hit:
                convex = placed[a][0].is_convex or placed[b][0].is_convex
                self.count["other" if not convex else "missed" if hit else "solid"] += 1

    def faces(self, ours, theirs, placed):
        for a, b in set(ours) | set(theirs):
            if placed[a][0].is_convex or placed[b][0].is_convex:
                continue  # trimesh has no face numbers for them
            self.count["faces"] += len(ours[a, b])
            if ours[a, b] == theirs[a, b]:
                continue
            exact = {tuple(row) for row in _exact(*placed[a][1:], *placed[b][1:]).contacts.tolist()}
            self.count["faces_theirs"] += len(theirs[a, b] ^ exact)
            self.count["differences"] += len(ours[a, b] ^ exact)


def main():
    scenes = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    random = np.random.default_rng(SEED)
    flat, every = meshes()
    made = {id(mesh): collisionchip.Object(mesh.vertices, mesh.faces) for mesh in every}
    comparison = Comparison()
    for scene in range(scenes):
        pool = flat if scene % 2 else every
        where = quarter_poses(random, OBJECTS) if scene % 2 else poses(random, OBJECTS, 1)
        ours, theirs = collisionchip.CollisionManager(), trimesh.collision.CollisionManager()
        placed = {}
        for i in range(OBJECTS):
            mesh = pool[random.integers(len(pool))]
            name = f"{i:02}"
            placed[name] = (mesh, made[id(mesh)], where[i])
            if i < OBJECTS // 2:
                ours.add_object(name, mesh, where[i])
                theirs.add_object(name, mesh, where[i])
        half, other = OBJECTS // 2, f"{OBJECTS - 1:02}"
        our_hit, our_names, our_data = ours.in_collision_internal(return_names=True, return_data=True)
        _, their_names, their_data = theirs.in_collision_internal(return_names=True, return_data=True)
        assert our_hit == bool(our_names) == ours.in_collision_internal()
        comparison.names(our_names, their_names, placed)
        comparison.faces(faces_by_pair(our_data), faces_by_pair(their_data), placed)

        single = (placed[other][0], placed[other][2])
        our_hit, our_names = ours.in_collision_single(*single, return_names=True)
        _, their_names = theirs.in_collision_single(*single, return_names=True)
        assert our_hit == bool(our_names) == ours.in_collision_single(*single)
        comparison.names({(name, other) for name in our_names}, {(name, other) for name in their_names}, placed)

        our_second, their_second = collisionchip.CollisionManager(), trimesh.collision.CollisionManager()
        for name in list(placed)[half:]:
            our_second.add_object(name, placed[name][1], placed[name][2])
            their_second.add_object(name, placed[name][0], placed[name][2])
        our_hit, our_names = ours.in_collision_other(our_second, return_names=True)
        _, their_names = theirs.in_collision_other(their_second, return_names=True)
        assert our_hit == bool(our_names) == ours.in_collision_other(our_second)
        comparison.names(our_names, their_names, placed)
    count = comparison.count
    print(f"seed={SEED} pairs={count['pairs']} faces={count['faces']}")
    print(f"trimesh says otherwise: pairs with a convex mesh that do not touch: {count['solid']}, that touch: "
          f"{count['missed']}; "
          f"other pairs: {count['other']}; faces: {count['faces_theirs']}")
    print(f"scenes={scenes} differences={count['differences']}")
    return 1 if count["differences"] or not count["pairs"] else 0


if __name__ == "__main__":
    sys.exit(main())
