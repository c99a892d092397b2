#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the sets of triangle pairs of the benchmark, in the format of check.py, without the truth: check.py adds it.

usage: make_sets.py FOLDER [--pairs N] [--seed N]

N pairs a set (default 2000), four times as many in `mesh`; the seed (default 1) is printed. The same seed gives the
same pairs. Sets on the grid, 16 bit:
  general       every coordinate anywhere
  small         every coordinate in -2..2
  far           two triangles of 1/16 of the grid anywhere
  face          a vertex of B on a face of A, or a step beside it
  edge          an edge of B through an edge of A, or a step beside it
  vertex        a vertex in common
  shared_edge   two vertices in common
  coplanar      all in one plane, which is any
  parallel      in parallel planes, a step apart
  degenerate    A a segment or a point, often on B
Sets of 1/1024 step, so that a core gets rounded coordinates:
  rounded       every coordinate anywhere
  grazing       as face and edge, within a step and a half of touching
  mesh          faces of two tori in random poses whose bounding boxes overlap
No code of the project; nothing but Python's standard library."""
import argparse
import bisect
import math
import pathlib
import random

MOST = 32767  # of a coordinate
FINE = 1024


class Maker:
    def __init__(self, seed):
        self.chance = random.Random(seed)

    def within(self, most):
        return self.chance.randint(-most, most)

    def point(self, most):
        return tuple(self.within(most) for _ in range(3))

    def triangle(self, most):
        return [self.point(most) for _ in range(3)]

    def lattice(self, most):
        """A function from two integers in -4..4 to points of a plane."""
        origin, u, v = self.point(most // 3), self.point(most // 16), self.point(most // 16)
        return lambda i, j: tuple(o + i * x + j * y for o, x, y in zip(origin, u, v))

    def shuffled(self, a, b):
        for points in (a, b):
            self.chance.shuffle(points)
        return (a, b) if self.chance.random() < 0.5 else (b, a)

    def beside(self, p, reach):
        """p, or another point with coordinates up to reach away, as likely."""
        return p if self.chance.random() < 0.5 else tuple(x + self.within(reach) for x in p)

    def size(self):
        return self.chance.choice((48, 480, 4800, MOST))

    # ---- sets on the grid

    def general(self):
        return self.triangle(MOST), self.triangle(MOST)

    def small(self):
        return self.triangle(2), self.triangle(2)

    def far(self):
        return [[tuple(x + y for x, y in zip(centre, p)) for p in self.triangle(2000)]
                for centre in (self.point(30000), self.point(30000))]

    def face(self, scale=1, reach=1):
        most = self.size() * scale
        at = self.lattice(most)
        a = [at(self.within(4), self.within(4)) for _ in range(3)]
        touched = at(self.within(2), self.within(2))
        return self.shuffled(a, [self.beside(touched, reach), self.point(most), self.point(most)])

    def edge(self, scale=1, reach=1):
        most = self.size() * scale
        at = self.lattice(most)
        i, j, m, n = (self.within(4) for _ in range(4))
        a = [at(i, j), at(m, n), self.point(most)]
        # the middle of the edge is a point of the grid if it is one of the lattice
        middle = at((i + m) // 2, (j + n) // 2)
        d = self.point(most // 4)
        through = self.beside(middle, reach)
        b = [tuple(x + y for x, y in zip(through, d)), tuple(x - y for x, y in zip(through, d)), self.point(most)]
        return self.shuffled(a, b)

    def vertex(self):
        most = self.size()
        a = self.triangle(most)
        return self.shuffled(a, [a[0], self.point(most), self.point(most)])

    def shared_edge(self):
        most = self.size()
        a = self.triangle(most)
        return self.shuffled(a, [a[0], a[1], self.point(most)])

    def coplanar(self):
        at = self.lattice(self.size())
        triangle = lambda: [at(self.within(4), self.within(4)) for _ in range(3)]
        return triangle(), triangle()

    def parallel(self):
        a, b = self.coplanar()
        shift = [0, 0, 0]
        shift[self.chance.randrange(3)] = self.chance.choice((-1, 1))
        return a, [tuple(x + s for x, s in zip(p, shift)) for p in b]

    def degenerate(self):
        at = self.lattice(self.size())
        p, q = at(self.within(4), self.within(4)), at(self.within(4), self.within(4))
        a = [p, q, self.chance.choice((p, q))]
        b = [self.chance.choice((p, at(self.within(4), self.within(4)))), at(self.within(4), self.within(4)),
             self.point(48)]
        return self.shuffled(a, b)

    # ---- sets between the points of the grid

    def rounded(self):
        return self.triangle(MOST * FINE), self.triangle(MOST * FINE)

    def grazing(self):
        return self.chance.choice((self.face, self.edge))(FINE, FINE * 3 // 2)

    def torus(self, most):
        """Faces of a torus of 48 times 24 quads in a random pose."""
        matrix = self.rotation()
        shift = [self.chance.uniform(-0.1, 0.1) for _ in range(3)]

        def at(i, j):
            u, v = 2 * math.pi * i / 48, 2 * math.pi * j / 24
            local = ((1 + 0.4 * math.cos(v)) * math.cos(u), (1 + 0.4 * math.cos(v)) * math.sin(u), 0.4 * math.sin(v))
            return tuple(round(most / 2 * (sum(m * x for m, x in zip(row, local)) + s))
                         for row, s in zip(matrix, shift))

        corners = {(i, j): at(i, j) for i in range(48) for j in range(24)}
        for i in range(48):
            for j in range(24):
                p, q, r, s = (corners[(i + x) % 48, (j + y) % 24] for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
                yield [p, q, r]
                yield [p, r, s]

    def rotation(self):
        w, x, y, z = (self.chance.gauss(0, 1) for _ in range(4))
        n = math.sqrt(w * w + x * x + y * y + z * z)
        w, x, y, z = w / n, x / n, y / n, z / n
        return ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))

    def mesh(self, count):
        pairs = []
        box = lambda face: [(min(x), max(x)) for x in zip(*face)]
        while len(pairs) < count:
            first, second = ([(box(face), face) for face in self.torus(MOST * FINE)] for _ in range(2))
            second.sort(key=lambda item: item[0][0][0])
            widest = max(item[0][0][1] - item[0][0][0] for item in second)
            lows = [item[0][0][0] for item in second]
            for of_a, a in first:
                for k in range(*span(lows, of_a[0][0] - widest, of_a[0][1])):
                    of_b, b = second[k]
                    if all(low <= high and other <= end for (low, end), (other, high) in zip(of_a, of_b)):
                        pairs.append((a, b))
        return self.chance.sample(pairs, count)


def span(sorted_values, low, high):
    return bisect.bisect_left(sorted_values, low), bisect.bisect_right(sorted_values, high)


GRID = ("general", "small", "far", "face", "edge", "vertex", "shared_edge", "coplanar", "parallel", "degenerate")
BETWEEN = ("rounded", "grazing", "mesh")


def write(folder, name, count, seed):
    # each set has a seed of its own: a further set does not change the others
    maker = Maker(f"{seed} {name}")
    scale = 1 if name in GRID else FINE
    if name == "mesh":
        pairs = maker.mesh(4 * count)
    else:
        pairs = []
        while len(pairs) < count:
            a, b = getattr(maker, name)()
            if all(abs(x) <= MOST * scale for p in (*a, *b) for x in p):
                pairs.append((a, b))
    path = folder / f"{name}.txt"
    with open(path, "w") as file:
        file.write(f"# {name}: {len(pairs)} pairs, seed {seed}\n# scale {scale}\n")
        for a, b in pairs:
            file.write(" ".join(str(x) for p in (*a, *b) for x in p) + "\n")
    return path


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=True)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--pairs", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    for name in GRID + BETWEEN:
        write(options.folder, name, options.pairs, options.seed)
    print(f"sets={len(GRID + BETWEEN)} pairs={options.pairs} seed={options.seed} folder={options.folder}")


if __name__ == "__main__":
    main()
