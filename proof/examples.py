#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Examples of certificates that cite trees: what the proved checker accepts, and what it refuses and why.

    examples.py CHECKED

CHECKED: the program cchip-checked."""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "lib/python/src/collisionchip"))
import check  # noqa: E402

# An octahedron of eight faces: along (1, 1, 1) it ends at 1, the box of face 0 at 3. Faces 0 to 3 are its upper half.
OCTAHEDRON = ([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
              [[i, (i + 1) % 4, top] for top in (4, 5) for i in range(4)])


def repeated(times, last=0):
    """The octahedron with each face several times, face 0 last and more often. Of 32 faces the eight parts have four
    each, and so no boxes; of 33 faces the last part has five, all of them face 0."""
    return OCTAHEDRON[0], [f for f in reversed(OCTAHEDRON[1]) for _ in range(times)] + OCTAHEDRON[1][:1] * last


FOLD = repeated(5)
TWO = ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 0, 0], [6, 0, 0], [5, 1, 0]], [[0, 1, 2], [3, 4, 5]])
THREE = ([*TWO[0], [10, 0, 0], [11, 0, 0], [10, 1, 0]], [*TWO[1], [6, 7, 8]])
TURNED = [1, -1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0]  # the box of an octahedron reaches -2 along x, its vertices -1


def at(x, y, z, turn=(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)):
    return [*turn[:3], x, *turn[4:7], y, *turn[8:11], z]


def separated(*direction):
    return {"cell": "separated", "direction": [str(x) for x in direction]}


def point(kind, a, b, **more):
    return {"cell": kind, "faces": [a, b], "a": ["1", "0", "0"], "b": ["1", "0", "0"], **more}


A, B = {"cell": "split_a"}, {"cell": "split_b"}
DIAGONAL = separated(1, 1, 1)
HALVES = [A, B, DIAGONAL, DIAGONAL, B, DIAGONAL, DIAGONAL]
FAR, BACK = separated(1, 0, 0), separated(-1, 0, 0)
PAIRS = [A, B, point("meet", 0, 0), FAR, B, BACK, point("meet", 1, 1)]
NEAR = [point("near", *c["faces"]) if "faces" in c else c for c in PAIRS]
BOTH = [[0, 0, None], [1, 1, None]]


def keys(cells, **of_all):
    return [{**cell, **of_all} for cell in cells]


# name, mesh, pose, cells, other than usual (keys of the claim; order: that of the tree of A), what is printed
CASES = [
    ("far", FOLD, at(3, 0, 0), [FAR], {}, "accepted"),
    ("boxes that touch", FOLD, at(2, 0, 0), [FAR], {}, "refused: cell 0: it does not hold"),
    ("boxes that overlap", FOLD, at(.9, .9, .9), [DIAGONAL], {}, "refused: cell 0: it does not hold"),
    ("halves of 20 faces have no box", FOLD, at(.9, .9, .9), HALVES, {}, "accepted"),
    ("32 faces have no box", repeated(4), at(.9, .9, .9), [DIAGONAL], {}, "accepted"),
    ("33 faces have a box", repeated(4, 1), at(.9, .9, .9), [DIAGONAL], {}, "refused: cell 0: it does not hold"),
    ("33 faces backwards", repeated(4, 1), at(.9, .9, .9), [DIAGONAL], {"order": range(32, -1, -1)},
     "accepted"),
    ("the upper half first", OCTAHEDRON, at(0, 0, 1.5), [A, separated(0, 0, 1)], {},
     "refused: cell 1: it does not hold"),
    ("the lower half first", OCTAHEDRON, at(0, 0, 1.5), [A, separated(0, 0, 1)], {"order": [4, 5, 6, 7, 0, 1, 2, 3]},
     "refused: cell 2: it does not hold"),
    ("a cell is missing", OCTAHEDRON, at(.9, .9, .9), HALVES[:-1], {}, "refused: cell 6"),
    ("a place of a split is not read", OCTAHEDRON, at(.9, .9, .9), keys(HALVES, at=1), {}, "accepted"),
    ("the box is posed", FOLD, at(2.5, 0, 0, TURNED), [FAR], {}, "refused: cell 0: it does not hold"),
    ("the posed box is apart", FOLD, at(3.5, 0, 0, TURNED), [FAR], {}, "accepted"),
    ("within", FOLD, at(3, 0, 0), [FAR], {"within": 0.5}, "accepted"),
    ("within the gap", FOLD, at(3, 0, 0), [FAR], {"within": 1}, "refused: cell 0: it does not hold"),
    ("below the gap", FOLD, at(3, 0, 0), [FAR], {"below": 1}, "accepted"),
    ("along", FOLD, at(2, 0, 0), [FAR], {"along": [1, 9, 0]}, "accepted"),
    ("along, back", FOLD, at(2, 0, 0), [FAR], {"along": [-1, 9, 0]}, "refused: cell 0: it does not hold"),
    ("pairs", TWO, at(0, 0, 0), PAIRS, {"contacts": BOTH}, "accepted"),
    ("pairs within", TWO, at(0, 0, 1), NEAR, {"contacts": BOTH, "within": 1}, "accepted"),
    ("three faces are one and two", THREE, at(3.5, 0, 0), [A, FAR, B, BACK, A, FAR, B, BACK, FAR], {}, "accepted"),
    ("a contact is left out", TWO, at(0, 0, 0), PAIRS, {"contacts": BOTH[1:]}, "refused: claim: it does not follow"),
    ("a point of two faces", TWO, at(0, 0, 0), [A, point("meet", 0, 0), *PAIRS[4:]], {"contacts": BOTH},
     "refused: cell 1: it does not hold"),
    ("one face is split", TWO, at(0, 0, 0), [A, A], {}, "refused: cell 1: it does not hold"),
    ("a face twice", TWO, at(0, 0, 0), PAIRS, {"contacts": BOTH, "order": [0, 0]}, "refused: cell 0: an order"),
    ("a face too few", TWO, at(0, 0, 0), PAIRS, {"contacts": BOTH, "order": [0]}, "refused: cell 0: an order"),
    ("a face too many", TWO, at(0, 0, 0), PAIRS, {"contacts": BOTH, "order": [0, 1, 2]}, "refused: cell 0: an order"),
    ("another tree", TWO, at(0, 0, 0), PAIRS, {"contacts": BOTH, "tree_a": "0" * 16},
     "refused: cell 0: the certificate cites"),
    ("a tree of another mesh", TWO, at(0, 0, 0), PAIRS, {"contacts": BOTH, "of": OCTAHEDRON},
     "refused: cell 0: a tree is of"),
    ("one contact", TWO, at(0, 0, 0), [PAIRS[2]], {"contacts": BOTH[:1], "all": False},
     "refused: claim: a certificate of"),
    ("version 1", TWO, at(0, 0, 0), PAIRS, {"collisionchip_certificate": 1}, "malformed: no key at"),
    ("no trees are given", TWO, at(0, 0, 0), PAIRS, {"given": False}, "malformed: the certificate cites trees"),
]


def write(folder, name, mesh, pose, cells, other):
    other, path = dict(other), folder / name.replace(" ", "_")
    order, of = other.pop("order", range(len(mesh[1]))), other.pop("of", mesh)
    path.with_suffix(".off").write_text("\n".join(
        [f"OFF\n{len(mesh[0])} {len(mesh[1])} 0", *(" ".join(map(str, v)) for v in mesh[0]),
         *(" ".join(map(str, [len(f), *f])) for f in mesh[1])]) + "\n")
    hashes = [check.hash_mesh(*m, range(len(m[1]))) for m in (mesh, of)]
    trees, given = [], other.pop("given", True)
    for side, (hash_of_mesh, numbers) in enumerate(((hashes[1], order), (hashes[0], range(len(mesh[1]))))):
        file = path.with_suffix(".tree_" + "ab"[side])
        file.write_text(json.dumps({"collisionchip_tree": 1, "mesh": hash_of_mesh, "order": list(numbers)}) + "\n")
        trees.append((file, check.hash_words(struct.pack(f"<{1 + len(numbers)}Q", int(hash_of_mesh, 16), *numbers))))
    poses = struct.pack("<24d", *at(0, 0, 0), *pose)
    claim = {"collisionchip_certificate": 3, "mesh_a": hashes[0], "mesh_b": hashes[0], "poses": check.hash_words(poses),
             "all": True, "least": "touching", "relation": None, "contacts": [], "tree_a": trees[0][1],
             "tree_b": trees[1][1], **other}
    path.with_suffix(".jsonl").write_text("".join(json.dumps(line) + "\n" for line in [claim, *cells]))
    return "\t".join(map(str, [path.with_suffix(".off"), path.with_suffix(".off"), path.with_suffix(".jsonl"),
                               ",".join(map(str, pose)), *(file for file, _ in trees if given)]))


def main(checked):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        lines = [write(folder, *case[:-1]) for case in CASES]
        (folder / "list").write_text("".join(line + "\n" for line in lines))
        run = subprocess.run([checked, "--batch", folder / "list"], stdout=subprocess.PIPE, text=True, check=True)
        verdicts = run.stdout.splitlines()
        assert len(verdicts) == len(CASES), "a verdict for each example"
        wrong = [f"{case[0]}: {verdict}, but should be: {case[-1]}" for case, verdict in zip(CASES, verdicts)
                 if not verdict.startswith(case[-1])]
        # The same as one command, whose exit codes differ.
        for n in (0, 1, len(CASES) - 1):
            a, b, file, pose, *trees = lines[n].split("\t")
            options = [f"--tree-{side}={tree}" for side, tree in zip("ab", trees)]
            code = subprocess.run([checked, a, b, file, "--pose-matrix=" + pose, *options], stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL).returncode
            if code != {"a": 0, "r": 1, "m": 2}[CASES[n][-1][0]]:
                wrong.append(f"{CASES[n][0]}: exit code {code}")
    print(*wrong, sep="\n", end="\n" if wrong else "")
    print(f"examples={len(CASES)} accepted={sum(v == 'accepted' for v in verdicts)} wrong={len(wrong)}")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage:" + __doc__)
    main(sys.argv[1])
