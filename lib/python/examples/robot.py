#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An arm of three links turns towards posts. Which angles are free, and where on a path does it hit first?"""
import numpy as np

from collisionchip import Object, Scene, collide_many


def box(least, greatest):
    """Six quads; lengths in metres."""
    corners = [[x, y, z] for x in (least[0], greatest[0]) for y in (least[1], greatest[1])
               for z in (least[2], greatest[2])]
    return Object(corners, [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def joint(degrees, x=0.0):
    """A turn about z, then a step of x along the x axis that was turned."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0, c * x], [s, c, 0, s * x], [0, 0, 1, 0], [0, 0, 0, 1.0]])


LINK = box((0, -0.1, -0.1), (1, 0.1, 0.1))
POST = box((-0.05, -0.05, -1), (0.05, 0.05, 1))


def place(scene, links, degrees):
    """Turns every joint of the arm by the same angle."""
    pose = np.eye(4)
    for link in links:
        scene.set_pose(link, pose @ joint(degrees))
        pose = pose @ joint(degrees, 1)


def main():
    scene = Scene()
    links = [scene.add(LINK) for _ in range(3)]
    for a, b in zip(links, links[1:]):
        scene.set_ignored(a, b)  # a joint connects them, so they always touch
    posts = [scene.add(POST, [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, 0]], groups=2, mask=1)
             for x, y in ((0.7, 2), (2.5, 1))]
    for degrees in range(0, 41, 10):
        place(scene, links, degrees)
        hits = [f"link {a} and post {b - posts[0] + 1}" for a, b, _ in scene.contacts()]
        print(f"joints at {degrees} degrees: {', '.join(hits) or 'free'}")

    # One object along a path: all its poses in one call.
    path = np.stack([joint(degrees) for degrees in np.linspace(0, 90, 901)])
    hits = collide_many(LINK, path, POST, [[1, 0, 0, 0.5], [0, 1, 0, 0.5], [0, 0, 1, 0]])
    print(f"a link that turns from 0 to 90 degrees hits a post from {hits.argmax() / 10} degrees on, in {hits.sum()} "
          "of "
          f"{len(hits)} poses")


if __name__ == "__main__":
    main()
