#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the proved checker with check.py and `cchip check`: certificates of random small meshes and changed ones.

    campaign.py CHECKED CCHIP N [EVERY [SECONDS]]

CHECKED: the program cchip-checked; CCHIP: the command cchip. N certificates of contacts and distances are made, some
with trees of the meshes, and each is changed once, some to claims of `below` and of translations. The last line counts
the accepted ones of each kind: `trees` cite trees, and of these `boxes` have a cell `separated` of a set with boxes.
Every EVERY-th case (100) also goes to `cchip check`, which is a process for each. After SECONDS it ends with what it
has reached. CCHIP_SEED repeats a run."""
import fractions
import json
import math
import os
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "lib/python/src/collisionchip"))
import check  # noqa: E402

IDENTITY = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]
COLUMNS = ["r00", "r01", "r02", "tx", "r10", "r11", "r12", "ty", "r20", "r21", "r22", "tz"]


def random_mesh(rng, parallel, large=False):
    """Vertices and faces: triangles, parallelograms, warped quads and degenerate ones, on a coarse grid or not; or on
    the grid and parallel to the axes. Large: of more than 32 faces, so that sets of its tree have boxes."""
    step = rng.choice([1.0, 0.5] if parallel else [1.0, 0.5, 2.0**-20, 1e-3, 2.0**60])
    grid = lambda n: step * rng.randint(-n, n) if rng.random() < 0.9 else step * rng.uniform(-n, n)
    vertices, faces = [], []
    reach = 9 if large else 3
    for _ in range(rng.randint(33, 80) if large else rng.randint(1, 7)):
        first = len(vertices)
        p, u, v = ([grid(n) for _ in range(3)] for n in (reach, 2, 2))
        if parallel:
            p, axes = [step * rng.randint(-reach, reach) for _ in range(3)], rng.sample(range(3), 2)
            u, v = ([step * rng.choice([-2, -1, 1, 2]) * (i == axis) for i in range(3)] for axis in axes)
        corners = [p, [a + b for a, b in zip(p, u)], [a + b + c for a, b, c in zip(p, u, v)],
                   [a + c for a, c in zip(p, v)]]
        if not parallel and rng.random() < 0.2:
            corners[rng.randrange(4)][rng.randrange(3)] += grid(1)
        if rng.random() < 0.5:
            corners.pop()
        vertices += corners
        faces.append(list(range(first, len(vertices))))
    return vertices, faces, list(range(len(faces)))


def random_pose(rng, scale):
    kind = rng.random()
    if kind < 0.6:
        rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    elif kind < 0.8:
        rows = [[float(rng.randint(-1, 1)) for _ in range(3)] for _ in range(3)]
    else:
        rows = [[rng.uniform(-1, 1) for _ in range(3)] for _ in range(3)]
    return [x for row in rows for x in
            row + [scale * (rng.randint(-4, 4) if rng.random() < 0.8 else rng.uniform(-4, 4))]]


def write_off(path, mesh):
    vertices, faces, _ = mesh
    rows = [" ".join(repr(x) for x in v) for v in vertices] + [" ".join(map(str, [len(f), *f])) for f in faces]
    path.write_text("\n".join([f"OFF\n{len(vertices)} {len(faces)} 0", *rows]) + "\n")


def change_value(rng, value):
    """Another value of JSON in the place of one."""
    if isinstance(value, bool):
        return rng.choice([not value, None, int(value)])
    if isinstance(value, int):
        return rng.choice([value + 1, value - 1, 0, -value, float(value), str(value), True, 2**32, 2**64,
                           [value, value], [value, value + 1]])
    if isinstance(value, float):
        return rng.choice([math.nextafter(value, math.inf), math.nextafter(value, 0), 2 * value, value / 2, -value,
                           0.0, -0.0, math.inf, 5e-324, 2**70 + 1, int(value), repr(value), None, [value]])
    if isinstance(value, str):
        if value.lstrip("-").isdigit():
            n = int(value)
            return rng.choice([str(n + 1), str(n - 1), str(-n), str(2 * n), "0", "1", "-0", "0" + value, "+" + value,
                               value + "0", " " + value, n])
        words = ["apart", "touching", "crossing", "split_a", "split_b", "separated", "meet", "touch", "cross", "near",
                 "a1", "a2", "a3", "b1", "b2", "b3", "a0", ""]
        return rng.choice([*words, value.upper(), None])
    if isinstance(value, list):
        value, kind = list(value), rng.randrange(6)
        if kind == 0 or not value:
            value.insert(rng.randint(0, len(value)), rng.choice([0, 1, "1", [0, 0], [0, 0, None], *value]))
        elif kind == 1:
            value.pop(rng.randrange(len(value)))
        elif kind == 2:
            rng.shuffle(value)
        elif kind == 3:
            value = [str(2 * int(x)) if isinstance(x, str) and x.lstrip("-").isdigit() else x for x in value]
        else:
            n = rng.randrange(len(value))
            value[n] = change_value(rng, value[n])
        return value
    if value is None:
        return rng.choice(["apart", "touching", "crossing", 0])
    return rng.choice([None, {}, [value]])


def change_lines(rng, lines):
    """One change of a certificate: of a value, of a line or of a byte."""
    lines, n, kind = list(lines), rng.randrange(len(lines)) if rng.random() < 0.6 else 0, rng.random()
    if kind < 0.65:
        value = json.loads(lines[n])
        key = rng.choice(list(value))
        if rng.random() < 0.05:
            del value[key]
        elif rng.random() < 0.05:
            value["other"] = change_value(rng, value[key])
        else:
            value[key] = change_value(rng, value[key])
        lines[n] = json.dumps(value)
    elif kind < 0.75 and len(lines) > 1:
        i, k = rng.randrange(1, len(lines)), rng.randrange(1, len(lines))
        step = rng.randrange(3)
        if step == 0:
            lines[i], lines[k] = lines[k], lines[i]
        elif step == 1:
            lines.insert(i, lines[k])
        else:
            del lines[i]
    else:
        data = bytearray(lines[n].encode())
        at = rng.randrange(len(data))
        byte = rng.choice([rng.randrange(256), *b"0123456789-,[]{}\"\\ \t\r\n"])
        step = rng.randrange(3)
        data[at:at + (step != 0)] = b"" if step == 1 else bytes([byte])
        return b"\n".join([*(x.encode() for x in lines[:n]), bytes(data), *(x.encode() for x in lines[n + 1:])]) + b"\n"
    return ("\n".join(lines) + "\n").encode()


def retell(rng, lines):
    """Another kind of cell for one pair of faces, with a claim to match: apart, meeting, touching or crossing."""
    claim, cells = json.loads(lines[0]), [json.loads(line) for line in lines[1:]]
    points = [cell for cell in cells if "faces" in cell]
    if not points:
        return lines
    cell = rng.choice(points)
    kind = rng.choice(["separated", "meet", "touch", "cross"])
    direction = cell.get("direction") or [str(rng.randint(-1, 1)) for _ in range(3)]
    told = {"meet": None, "touch": "touching", "cross": "crossing"}
    mine = [k for k in claim["contacts"] if k[:2] == cell["faces"]]
    claim["contacts"] = [k for k in claim["contacts"] if k not in mine]
    faces = cell["faces"]
    if kind == "separated":
        cell.clear()
        cell.update({"cell": kind, "direction": direction})
    else:
        cell.update({"cell": kind, "direction": direction, "span": rng.sample(["a1", "a2", "b1", "b2"], 3)})
        claim["contacts"] = sorted([*claim["contacts"], [*faces, told[kind]]], key=lambda k: k[:2])
    if rng.random() < 0.8:
        claim["relation"] = None
    return [json.dumps(line, separators=(",", ":")) for line in [claim, *cells]]


def measure_otherwise(rng, lines):
    """The claim with another distance, with `below` in the place of `within`, or about a translation."""
    claim, cells = json.loads(lines[0]), [json.loads(line) for line in lines[1:]]
    distance = claim.pop("within", None)
    if distance is None and rng.random() < 0.8 or rng.random() < (0.1 if claim["contacts"] else 0.4):
        kinds = {"touch"} if rng.random() < 0.7 and any(c["cell"] == "touch" for c in cells) else {"touch", "separated"}
        directions = [[int(x) for x in cell["direction"]] for cell in cells if cell["cell"] in kinds]
        along = [0.0 if len(kinds) == 1 else rng.choice([-1.0, 0.0, 0.0, 1.0, rng.uniform(-1, 1)]) for _ in range(3)]
        for d in rng.choices(directions, k=2) if directions else []:
            along = [x + y / (max(map(abs, d)) or 1) for x, y in zip(along, d)]
        claim.update(along=along, contacts=[], relation=None)
        cells = [{"cell": "separated", "direction": cell["direction"]} if cell["cell"] == "touch" else cell
                 for cell in cells]
        if rng.random() < 0.8:
            claim["least"] = "touching"
    else:
        kind = rng.randrange(4) if distance else 0
        claim["below" if kind else "within"] = change_value(rng, distance) if kind == 1 else distance or 1.0
    if "within" in claim or rng.random() < 0.95:
        claim["collisionchip_certificate"] = rng.choice([3 if "tree_a" in claim else 2] * 20 + [1])
    return [json.dumps(line, separators=(",", ":")) for line in [claim, *cells]]


def part_near(rng, lines, meshes, poses):
    """Separated in the place of near: all points that are w apart, or of one cell. With `below` it may be true."""
    claim, cells = json.loads(lines[0]), [json.loads(line) for line in lines[1:]]
    if "within" not in claim or not claim["all"]:
        return move_near(rng, lines)
    corners = [check.Posed(m[0], p) for m, p in zip(meshes, (poses[:12], poses[12:]))]
    square = fractions.Fraction(claim["within"])**2
    near = [cell for cell in cells if cell["cell"] == "near"]
    one = rng.choice(near) if near and rng.random() < 0.2 else None
    for cell in near:
        points = []
        for side, weights in enumerate((cell["a"], cell["b"])):
            weights = [fractions.Fraction(int(w)) for w in weights]
            vertices = [corners[side][v] for v in meshes[side][1][cell["faces"][side]]]
            points.append([check.dot(weights, axis) / sum(weights) for axis in zip(*vertices)])
        way = [q - p for p, q in zip(*points)]
        if cell is one or check.dot(way, way) == square:
            claim["contacts"] = [k for k in claim["contacts"] if k[:2] != cell["faces"]]
            common = math.lcm(*(x.denominator for x in way))
            whole = [int(x * common) for x in way]
            cell.clear()
            cell.update(cell="separated", direction=[str(x // (math.gcd(*whole) or 1)) for x in whole])
    if rng.random() < 0.5:
        claim["below"] = claim.pop("within")
    return [json.dumps(line, separators=(",", ":")) for line in [claim, *cells]]


def move_near(rng, lines):
    """Other weights of the points of a cell `near`, or another distance."""
    claim, cells = json.loads(lines[0]), [json.loads(line) for line in lines[1:]]
    points = [cell for cell in cells if cell["cell"] == "near"]
    key = "within" if "within" in claim else "below"
    if points and rng.random() < 0.6:
        cell, side = rng.choice(points), rng.choice("ab")
        n = rng.randrange(len(cell[side]))
        weight = int(cell[side][n])
        cell[side][n] = str(rng.choice([weight + 1, weight - 1, 2 * weight, 0, weight * 10**6 + 1, -weight]))
    elif key in claim:
        claim[key] = change_value(rng, claim[key])
    else:
        claim[rng.choice(["within", "below", "along"])] = rng.choice([1.0, None, [1.0, 0.0, 0.0]])
        claim["collisionchip_certificate"] = rng.choice([1, 2, 3])
    return [json.dumps(line, separators=(",", ":")) for line in [claim, *cells]]


def with_hashes(lines, meshes, poses):
    """The certificate as one of other meshes or poses: the hashes fit, the proofs mostly do not."""
    claim = json.loads(lines[0])
    claim["mesh_a"], claim["mesh_b"] = (check.hash_mesh(*m) for m in meshes)
    claim["poses"] = check.hash_words(struct.pack("<24d", *(x + 0.0 for x in poses)))
    return [json.dumps(claim, separators=(",", ":")), *lines[1:]]


def regroup(rng, lines):
    """With trees: one cell for two halves, or two halves in the place of one cell."""
    lines, kinds = list(lines), [None, *(json.loads(line)["cell"] for line in lines[1:])]
    whole = [n for n in range(1, len(lines)) if kinds[n] == "separated"]
    halved = [n for n in whole[:-1] if kinds[n - 1] in ("split_a", "split_b") and kinds[n + 1] == "separated"]
    if halved and rng.random() < 0.7:
        n = rng.choice(halved)
        lines[n - 1:n + 2] = [rng.choice(lines[n:n + 2])]
    elif whole:
        n = rng.choice(whole)
        lines[n:n + 1] = [json.dumps({"cell": rng.choice(["split_a", "split_b"])}), lines[n], lines[n]]
    return lines


def one_cell(rng, lines, meshes, trees, pose):
    """One cell for all faces, and a pose in which hulls of the meshes touch along its direction or nearly: those of the
    checkers, or those of one halving fewer or more."""
    d, pose = [rng.randint(-2, 2) for _ in range(2)] + [rng.choice([-1, 1])], list(pose)
    a, b = (check.hull(check.read_tree(tree.decode())[1], mesh, check.Posed(mesh[0], p), rng.choice([2, 3, 4]))
            for tree, mesh, p in zip(trees, meshes, (IDENTITY, pose)))
    overlap = max(check.dot(d, p) for p in a) - min(check.dot(d, q) for q in b)
    pose[11] = float(fractions.Fraction(pose[11]) + overlap / d[2])
    pose[11] = rng.choice([pose[11], math.nextafter(pose[11], math.inf), math.nextafter(pose[11], -math.inf)])
    claim = {key: value for key, value in json.loads(lines[0]).items() if key not in ("within", "below", "along")}
    claim.update(least="touching", relation=rng.choice([None, "apart"]), contacts=[])
    cell = {"cell": "separated", "direction": list(map(str, d))}
    return pose, with_hashes([json.dumps(claim), json.dumps(cell)], meshes, IDENTITY + pose)


def write_tree(mesh, order):
    return (json.dumps({"collisionchip_tree": 1, "mesh": mesh, "order": order}) + "\n").encode()


def change_tree(rng, lines, trees):
    """Another tree, which the certificate cites or not."""
    trees, side, kind = list(trees), rng.randrange(2), rng.random()
    if kind < 0.1:
        return lines, [] if kind < 0.05 else trees[::-1]
    if kind < 0.4:
        trees[side] = change_lines(rng, [trees[side].decode().rstrip("\n")])
        return lines, trees
    mesh, order = check.read_tree(trees[side].decode())
    i, k = rng.randrange(len(order)), rng.randrange(len(order))
    if kind < 0.8:
        order[i], order[k] = order[k], order[i]
    else:
        order[i:i + rng.randrange(2)] = [order[k]]
    claim = json.loads(lines[0])
    claim["tree_" + "ab"[side]] = check.hash_tree(mesh, order)
    trees[side] = write_tree(mesh, order)
    return [json.dumps(claim, separators=(",", ":")), *lines[1:]], trees


def make_trees(rng, cchip, names):
    """Those of the command, some with the faces in another order; None if it cuts faces."""
    trees = []
    for name in names:
        path = name.with_suffix(".tree")
        run = subprocess.run([cchip, "tree", name, path], stderr=subprocess.PIPE, text=True, check=True)
        if "were cut" in run.stderr:
            return None
        if rng.random() < 0.3:
            mesh, order = check.read_tree(path.read_text())
            rng.shuffle(order)
            path.write_bytes(write_tree(mesh, order))
        trees.append(path.read_bytes())
    return trees


def uses_boxes(lines, meshes):
    """Of cells that are accepted: is one `separated` of a set of more than 32 faces?"""
    todo = [[len(m[1]) for m in meshes]]
    for kind in (json.loads(line)["cell"] for line in lines[1:]):
        sets = todo.pop()
        if kind in ("split_a", "split_b"):
            side = kind == "split_b"
            halves = (sets[side] + 1) // 2, sets[side] // 2
            todo += [[sets[0], n] if side else [n, sets[1]] for n in halves]
        elif kind == "separated" and max(sets) > 32:
            return True
    return False


def accepted_by_python(data, meshes, poses, trees):
    """The claim of the last certificate, or None, and whether it uses boxes."""
    try:
        claim, trees = None, [check.read_tree(tree.decode()) for tree in trees]
        for lines in check.split(data.decode()):
            claim = check.check(meshes, poses, lines, trees)
        return claim, bool(claim) and claim["collisionchip_certificate"] == 3 and uses_boxes(lines, meshes)
    except (check.Refused, ValueError, KeyError, TypeError, RecursionError, OverflowError):
        return None, False


class Campaign:
    def __init__(self, checked, cchip, every, folder):
        self.checked, self.cchip, self.every, self.folder = checked, cchip, every, folder
        self.cases = []
        self.counts = dict.fromkeys(["certificates", "changed", "accepted", "within", "below", "along", "trees",
                                     "boxes", "refused", "cchip", "differences"], 0)

    def add(self, names, meshes, pose, data, changed, trees):
        path = self.folder / f"{len(self.cases)}.jsonl"
        path.write_bytes(data)
        files = [path.with_suffix(".tree_" + side) for side, _ in zip("ab", trees)]
        for file, tree in zip(files, trees):
            file.write_bytes(tree)
        claim, boxes = accepted_by_python(data, meshes, IDENTITY + pose, trees)
        self.cases.append((names, pose, path, files, changed, claim is not None))
        self.counts["trees"] += claim is not None and claim["collisionchip_certificate"] == 3
        self.counts["boxes"] += boxes
        for key in {"within", "below", "along"} & (claim or {}).keys():
            self.counts[key] += 1
        self.counts["changed" if changed else "certificates"] += 1

    def compare(self):
        numbers = lambda pose: ",".join(map(repr, pose))
        lines = ["\t".join(map(str, [*names, path, numbers(pose), *files]))
                 for names, pose, path, files, *_ in self.cases]
        (self.folder / "list").write_text("".join(line + "\n" for line in lines))
        run = subprocess.run([self.checked, "--batch", self.folder / "list"], stdout=subprocess.PIPE, text=True,
                             check=True)
        verdicts = run.stdout.splitlines()
        assert len(verdicts) == len(self.cases), "a verdict for each case"
        for n, ((names, pose, path, files, changed, python), verdict) in enumerate(zip(self.cases, verdicts)):
            answers = {"cchip-checked": verdict == "accepted", "check.py": python}
            if n % self.every == 0:
                command = [self.cchip, "check", *names, path, "--pose-matrix=" + numbers(pose),
                           *(f"--tree-{side}={file}" for side, file in zip("ab", files))]
                code = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
                answers["cchip check"] = code == 0
                self.counts["cchip"] += 1
                expected = 0 if verdict == "accepted" else 1 if verdict.startswith("refused") else 2
                if code != expected:
                    print(f"exit code of cchip check {code}, of cchip-checked {expected}: {verdict}")
                    answers["exit code"] = not answers["check.py"]
            self.counts["accepted" if python else "refused"] += 1
            if len(set(answers.values())) != 1 or (not changed and not python):
                self.counts["differences"] += 1
                print(f"{answers}, {verdict}, pose {pose}\n"
                      f"{names[0].read_text()}{names[1].read_text()}{path.read_bytes()!r}",
                      *(file.read_bytes() for file in files), sep="\n")
        self.cases = []


def main(checked, cchip, count, every="100", seconds="inf"):
    seed = int(os.environ.get("CCHIP_SEED", random.randrange(2**32)))
    print(f"CCHIP_SEED={seed}", flush=True)
    rng, count, end = random.Random(seed), int(count), time.monotonic() + float(seconds)
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        folder = pathlib.Path(folder)
        campaign, pair = Campaign(checked, cchip, int(every), folder), 0
        while campaign.counts["certificates"] < count and time.monotonic() < end:
            pair += 1
            names = [folder / f"{pair}a.off", folder / f"{pair}b.off"]
            parallel = rng.random() < 0.3
            cites = rng.random() < 0.4
            large = rng.choice([(1, 0), (0, 1), (1, 1)]) if cites and rng.random() < 0.3 else (0, 0)
            meshes = [random_mesh(rng, parallel, is_large) for is_large in large]
            for name, mesh in zip(names, meshes):
                write_off(name, mesh)
            trees = make_trees(rng, cchip, names) if cites else []
            if trees is None:
                continue
            scale = rng.choice([abs(x) or 1.0 for x in meshes[0][0][0]])
            poses = [random_pose(rng, scale / 2) for _ in range(min(20, count - campaign.counts["certificates"]))]
            rows = [",".join(COLUMNS), *(",".join(map(repr, p)) for p in poses)]
            (folder / "poses.csv").write_text("\n".join(rows) + "\n")
            distance = scale * (rng.choice([0.5, 1, 1.5, 2, 3]) if rng.random() < 0.6 else 3 * rng.random())
            options = ["--contacts", rng.choice(["first", "all"]),
                       *rng.choice([[], ["--relation"], ["--counts", "crossing"], *[["--within", repr(distance)]] * 3])]
            command = [cchip, "collide", *names, "--poses", folder / "poses.csv", *options,
                       "--certificate", folder / "made",
                       *(f"--tree-{side}={name.with_suffix('.tree')}" for side, name in zip("ab", names) if cites)]
            run = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            if run.returncode != 0:
                sys.exit(f"{command}: exit code {run.returncode}\n{run.stderr}")
            if "were cut" in run.stderr:
                continue  # faces with a dent are several parts, which check.py does not cut
            certificates = check.split((folder / "made").read_text())
            for pose, lines in zip(poses, certificates):
                campaign.add(names, meshes, pose, ("\n".join(lines) + "\n").encode(), False, trees)
                kind, within, given = rng.random(), "--within" in options, trees
                if "tree_a" in lines[0] and rng.random() < 0.4:
                    kind = rng.random()
                    if kind < 0.5 and any(large):
                        pose, lines = one_cell(rng, lines, meshes, trees, pose)
                    elif kind < 0.7:
                        lines = regroup(rng, lines)
                    else:
                        lines, given = change_tree(rng, lines, trees)
                    data = ("\n".join(lines) + "\n").encode()
                elif within and kind < 0.15:
                    data = ("\n".join(part_near(rng, lines, meshes, IDENTITY + pose)) + "\n").encode()
                elif within and kind < 0.25:
                    data = ("\n".join(move_near(rng, lines)) + "\n").encode()
                elif kind < (0.4 if within else 0.2):
                    data = ("\n".join(measure_otherwise(rng, lines)) + "\n").encode()
                elif kind < (0.5 if within else 0.3):
                    data = ("\n".join(retell(rng, lines)) + "\n").encode()
                elif kind < (0.65 if within else 0.4):
                    pose = rng.choice(poses)
                    data = ("\n".join(with_hashes(lines, meshes, IDENTITY + pose)) + "\n").encode()
                else:
                    data = change_lines(rng, lines)
                campaign.add(names, meshes, pose, data, True, given)
            if len(campaign.cases) >= 2000:
                campaign.compare()
        campaign.compare()
        print(" ".join(f"{name}={number}" for name, number in campaign.counts.items()))
        sys.exit(campaign.counts["differences"] != 0 or campaign.counts["accepted"] <= campaign.counts["certificates"])


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5, 6):
        sys.exit("usage:" + __doc__)
    main(*sys.argv[1:])
