#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Exact truth for triangle pairs, and a judge of answers to them. Integers of any length, nothing but Python's standard
library; no code of the project.

usage: check.py truth FILE...           fill in the last column of sets: 1 the triangles share a point, 0 they do not
       check.py verify FILE...          the last column is the truth
       check.py judge FILE ANSWERS      ANSWERS holds a line `NUMBER HIT DEFINITE` for each pair of FILE, in any order;
                                        NUMBER counts from 0
       check.py self-test [PAIRS [SEED]]  two methods agree on random pairs of a small grid, degenerate and coplanar
                                        ones among them (default 3000, 1)

A set is text. Lines that begin with # are comments; `# scale S` says that coordinates are in 1/S grid steps. Every
other line is a pair: 18 integers, vertices 0, 1, 2 of A, then of B, each x y z; the truth is a 19th. Triangles are
closed sets; coplanar ones, segments and points are pairs like all others.
The truth is found by edges: two triangles share a point exactly if an edge of one meets the other. The second method
of self-test knows neither edges nor planes: a point is shared exactly if 0 is in the hull of the nine differences of
vertices, that is in the hull of at most four of them (Caratheodory).
Last lines are `key=value`. Exit codes: 0 good, 1 something is wrong, 2 bad arguments or file."""
import itertools
import random
import sys

# ---- vectors of integers


def sub(p, q):
    return (p[0] - q[0], p[1] - q[1], p[2] - q[2])


def cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def dot(p, q):
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


ZERO = (0, 0, 0)

# ---- first method: edges


def flat(n):
    """A projection to two coordinates that is one to one on planes with the normal n, which is not 0."""
    drop = max(range(3), key=lambda i: abs(n[i]))
    keep = [i for i in range(3) if i != drop]
    return lambda p: (p[keep[0]], p[keep[1]])


def turn(p, q, r):
    """Twice the signed area of a triangle in the plane."""
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def sign(x):
    return (x > 0) - (x < 0)


def segments_meet_flat(p, q, r, s):
    """Segments pq and rs in the plane, not both points."""
    a, b, c, d = sign(turn(p, q, r)), sign(turn(p, q, s)), sign(turn(r, s, p)), sign(turn(r, s, q))
    if a * b < 0 and c * d < 0:
        return True
    inside = lambda u, v, x: all(min(u[i], v[i]) <= x[i] <= max(u[i], v[i]) for i in range(2))
    return ((a == 0 and inside(p, q, r)) or (b == 0 and inside(p, q, s)) or
            (c == 0 and inside(r, s, p)) or (d == 0 and inside(r, s, q)))


def segments_meet(p, q, r, s):
    d, e = sub(q, p), sub(s, r)
    n = cross(d, e)
    if n != ZERO:
        if dot(n, sub(r, p)):
            return False
        see = flat(n)
        return segments_meet_flat(see(p), see(q), see(r), see(s))
    along = d if d != ZERO else e
    if along == ZERO:
        return p == r
    if cross(along, sub(r, p)) != ZERO:
        return False
    at = lambda x: dot(along, x)
    return max(min(at(p), at(q)), min(at(r), at(s))) <= min(max(at(p), at(q)), max(at(r), at(s)))


def edge_meets_triangle(p, q, t):
    n = cross(sub(t[1], t[0]), sub(t[2], t[0]))
    if n == ZERO:  # a segment or a point is the union of its edges
        return any(segments_meet(p, q, t[i], t[i - 1]) for i in range(3))
    above, beyond = dot(n, sub(p, t[0])), dot(n, sub(q, t[0]))
    if above * beyond > 0:
        return False
    if above == beyond == 0:
        see = flat(n)
        a, b, *c = map(see, (p, q, *t))
        turns = [turn(c[i - 1], c[i], a) for i in range(3)]
        return (min(turns) >= 0 or max(turns) <= 0 or
                any(segments_meet_flat(a, b, c[i], c[i - 1]) for i in range(3)))
    # the edge meets the plane in (above q - beyond p) / (above - beyond)
    down = above - beyond
    at = tuple(above * q[i] - beyond * p[i] for i in range(3))
    sides = (dot(n, cross(sub(t[i], t[i - 1]), tuple(at[j] - down * t[i - 1][j] for j in range(3)))) for i in range(3))
    return all(side * down >= 0 for side in sides)


def meet(a, b):
    """Do closed triangles, three points each, share a point?"""
    for i in range(3):
        if max(p[i] for p in a) < min(p[i] for p in b) or max(p[i] for p in b) < min(p[i] for p in a):
            return False
    return any(edge_meets_triangle(x[i], x[i - 1], y) for x, y in ((a, b), (b, a)) for i in range(3))


# ---- second method: 0 in the hull of the differences


def volume(p, q, r):
    return dot(p, cross(q, r))


def holds_zero(points):
    """Is 0 a convex combination of one to four points that are affinely independent, or else of fewer of them?"""
    if len(points) == 1:
        return points[0] == ZERO
    if len(points) == 2:
        p, q = points
        return cross(p, q) == ZERO and dot(p, q) <= 0
    if len(points) == 3:
        p, q, r = points
        n = cross(sub(q, p), sub(r, p))
        if n == ZERO or dot(n, p):
            return False  # in a line: two of them do; or 0 off the plane
        return all(dot(n, cross(x, y)) >= 0 for x, y in ((p, q), (q, r), (r, p)))
    p, q, r, s = points
    parts = (volume(q, r, s), -volume(p, r, s), volume(p, q, s), -volume(p, q, r))
    return sum(parts) != 0 and (min(parts) >= 0 or max(parts) <= 0)


def meet_by_hull(a, b):
    differences = sorted({sub(p, q) for p in a for q in b})
    return any(holds_zero(points) for size in range(1, 5) for points in itertools.combinations(differences, size))


# ---- files


class BadFileError(Exception):
    """One line."""


def read_set(path):
    """(scale, [(A, B, truth or None)])."""
    scale, pairs = 1, []
    with open(path) as file:
        for number, line in enumerate(file, 1):
            words = line.split()
            if line.startswith("#"):
                if words[1:2] == ["scale"]:
                    scale = int(words[2])
                continue
            try:
                values = [int(word) for word in words]
            except ValueError:
                values = []
            if len(values) not in (18, 19) or not set(values[18:]) <= {0, 1}:
                raise BadFileError(f"{path}:{number}: needs 18 integers and perhaps the truth, 0 or 1")
            points = [tuple(values[i:i + 3]) for i in range(0, 18, 3)]
            pairs.append((tuple(points[:3]), tuple(points[3:]), values[18] if len(values) == 19 else None))
    if not pairs:
        raise BadFileError(f"{path}: no pairs")
    return scale, pairs


def fill(path):
    _, pairs = read_set(path)
    with open(path) as file:
        head = [line for line in file if line.startswith("#")]
    with open(path, "w") as file:
        file.writelines(head)
        for a, b, _ in pairs:
            file.write(" ".join(str(x) for point in (*a, *b) for x in point) + f" {int(meet(a, b))}\n")


def verify(path):
    wrong = sum(truth != int(meet(a, b)) for a, b, truth in read_set(path)[1])
    print(f"{path}: wrong={wrong}")
    return wrong


def judge(path, answers):
    """Counts of a core's answers to a set, {name: number}. A definite answer that is not the truth is wrong, and so is
    "no" for triangles that meet."""
    _, pairs = read_set(path)
    found = {}
    with open(answers) as file:
        for line in file:
            number, hit, definite = map(int, line.split())
            if not 0 <= number < len(pairs) or number in found:
                raise BadFileError(f"{answers}: pair {number} is not in the set, or is answered twice")
            found[number] = hit, definite
    counts = dict(pairs=len(pairs), meet=0, missing=len(pairs) - len(found), undecided=0, wrong_no=0, wrong_yes=0)
    for number, (_, _, truth) in enumerate(pairs):
        if truth is None:
            raise BadFileError(f"{path}: pair {number} has no truth: check.py truth {path}")
        hit, definite = found.get(number, (1, 0))
        counts["meet"] += truth
        counts["undecided"] += not definite
        counts["wrong_no"] += truth == 1 and hit == 0
        counts["wrong_yes"] += truth == 0 and hit == 1 and definite == 1
    return counts


def self_test(count, seed):
    chance = random.Random(seed)
    wrong = hits = 0
    for _ in range(count):
        reach = chance.choice((1, 1, 2, 3))
        depth = chance.choice((0, reach, reach))  # a third lies in a plane
        triangle = lambda: tuple((chance.randint(-reach, reach), chance.randint(-reach, reach),
                                  chance.randint(-depth, depth)) for _ in range(3))
        a, b = triangle(), triangle()
        if chance.random() < 0.2:
            a = (a[0], a[1], chance.choice(a[:2]))
        if chance.random() < 0.1:
            b = (b[0], b[0], b[0])
        order = chance.sample(range(3), 3)
        answers = {meet(a, b), meet(b, a), meet([a[i] for i in order], b), meet_by_hull(a, b)}
        wrong += len(answers) > 1
        hits += True in answers
    print(f"self-test pairs={count} meet={hits} wrong={wrong} seed={seed}")
    return wrong


def main(words):
    if words[:1] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    command, *rest = words or [""]
    try:
        if command == "truth" and rest:
            for path in rest:
                fill(path)
            return 0
        if command == "verify" and rest:
            return 1 if sum([verify(path) for path in rest]) else 0
        if command == "judge" and len(rest) == 2:
            counts = judge(*rest)
            print(" ".join(f"{name}={count}" for name, count in counts.items()))
            return 1 if counts["missing"] or counts["wrong_no"] or counts["wrong_yes"] else 0
        if command == "self-test" and len(rest) <= 2:
            return 1 if self_test(*map(int, (rest + ["3000", "1"][len(rest):]))) else 0
    except (OSError, ValueError, BadFileError) as error:
        print(f"check.py: {error}", file=sys.stderr)
        return 2
    print("usage: check.py truth|verify|judge|self-test ..., check.py --help", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
