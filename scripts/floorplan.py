# SPDX-License-Identifier: Apache-2.0
"""Floorplan of cchip_chip on the Lattice LFE5U-85F, by stock means: a place for every block RAM and multiplier.

nextpnr leaves a cell with an attribute BEL where it is and draws the logic to it; regions it takes from Python alone,
which its build for WebAssembly does not have. The device has block RAMs in four rows and multipliers in three, 52 in
each, in groups of four. What is chosen is which groups a block gets; inside a block the order is that of its data, so
that the RAMs that hold the same bits of a line lie above each other.

    y = 82    get data: leaves   C  C  C  C  C  C  C  C  C      C cache: data, in row 46 the beats that arrive, in row
                                                                70 tags
    y = 70    get data: nodes    C  C  C  C  C  C  C  C  C
    y = 58    box test                 transform             multipliers
    y = 46    box test           traversal   cache
    y = 34    box test                 slot                  multipliers
    y = 22    box test                 operands, queues
    y = 10    box test                 slot                  multipliers

usage: floorplan.py heat FILE.svg TITLE=TABLE...     TABLE: congestion_by_coordinate of nextpnr's router2 (fpga.py
                                                     --heat), side by side

Memory and bus come to the cache at the upper edge; lines go left to get data and down to the box test, vertices to the
right. Where registers, bus and cache meet, and where the test lies at its lower row of multipliers, more wires are
needed than there are: every fourth row of tiles there is kept empty, by cells that are fixed and connected to
nothing."""
import csv
import json
import re
import sys

RAM, MULTIPLIER = "DP16KD", "MULT18X18D"
GROUPS = 13
WIDTH, HEIGHT = 126, 95  # tiles
EMPTY = (  # columns and rows of tiles
    (range(66, 105), range(71, 94, 4)),  # registers, bus, cache
    (range(64, 104), range(3, 22, 4)),  # the test at its lower row of multipliers
)


def natural(name):
    """Key that sorts numbers in names as numbers."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]


def by_bits(name):
    """First the number of the RAM inside its memory, which says which bits it holds, then everything else."""
    found = re.search(r"gen_block\[(\d+)\]", name)
    return int(found[1]) if found else 0, natural(name)


# what, kind, order, [(y, groups)]; whoever comes first takes his cells
PLAN = (
    (r"u_cache\.u_data", RAM, by_bits, [(82, range(4, 13)), (70, range(4, 11))]),
    (r"u_cache\.u_fill", RAM, natural, [(46, range(8, 10))]),
    (r"u_cache\.gen_port", RAM, natural, [(70, range(11, 13))]),
    (r"u_get_data.*u_leaf_lines", RAM, by_bits, [(82, range(0, 4))]),
    (r"u_get_data", RAM, by_bits, [(70, range(0, 4))]),
    (r"u_bv_unit\.u_feed", RAM, by_bits, [(46, range(0, 6))]),
    (r"u_bv_unit\.u_pose", RAM, natural, [(22, range(0, 3))]),
    (r"u_traversal", RAM, natural, [(46, range(6, 8))]),
    (r"", RAM, natural, [(22, range(8, 11))]),
    (r"u_bv_unit", MULTIPLIER, natural, [(58, range(0, 7)), (34, range(0, 6)), (10, range(0, 7))]),
    (r"u_transform", MULTIPLIER, natural, [(58, range(7, 13)), (34, (12, 11)), (10, (12,))]),
    # a test in two rows, for in one its logic lies too close
    (r"", MULTIPLIER, natural, [(10, range(8, 12)), (34, range(8, 13)), (10, (7, 12)), (34, (7, 6)), (58, (12,))]),
)


def sites(kind, y, group):
    """The four BELs of a group, from left to right: [(name, x)]."""
    left = 4 + 9 * group + (2 if group > 6 else 0)  # the clock's column is in the middle
    parts = [(0, "EBR0"), (2, "EBR1"), (4, "EBR2"), (6, "EBR3")] if kind == RAM else \
        [(0, "MULT18_0"), (1, "MULT18_1"), (4, "MULT18_4"), (5, "MULT18_5")]
    return [(f"X{left + x}/Y{y}/{name}", left + x) for x, name in parts]


def anchors(kinds):
    """{cell: BEL} of the block RAMs and multipliers in {cell: type}. A block that needs more than the plan gives it
    gets the nearest free places of its kind. ValueError: the device has too few."""
    rows = {RAM: (22, 46, 70, 82), MULTIPLIER: (10, 34, 58)}
    free = {kind: {bel: (x, y) for y in rows[kind] for group in range(GROUPS) for bel, x in sites(kind, y, group)}
            for kind in rows}
    found, over = {}, []
    left = {cell: kind for cell, kind in kinds.items() if kind in rows}
    for pattern, kind, order, where in PLAN:
        cells = sorted((cell for cell, of in left.items() if of == kind and re.search(pattern, cell)), key=order)
        taken = set(found.values())
        near = [bel for y, groups in where for group in groups for bel, _ in sites(kind, y, group)]
        places = [bel for bel in near if bel not in taken]
        found.update(zip(cells, places))
        over += [(cell, kind, near[-1]) for cell in cells[len(places):]]
        for cell in cells:
            del left[cell]
    at = {kind: dict(places) for kind, places in free.items()}
    for cell, bel in found.items():
        del free[kinds[cell]][bel]
    for cell, kind, near in over:
        if not free[kind]:
            raise ValueError(f"the LFE5U-85F has {len(at[kind])} {kind}, the design needs "
                             f"{sum(of == kind for of in kinds.values())}")
        x, y = at[kind][near]
        found[cell] = min(free[kind], key=lambda bel: abs(free[kind][bel][0] - x) + abs(free[kind][bel][1] - y))
        del free[kind][found[cell]]
    return found


def empty_tiles():
    """Cells connected to nothing that fill the tiles of EMPTY: {name: cell of Yosys' JSON}. Eight look-up tables and
    eight flip-flops in each tile."""
    kinds = {f"K{half}": ("LUT4", {"INIT": "0" * 16}) for half in "01"} | {
        f"FF{half}": ("TRELLIS_FF", {"GSR": "DISABLED"}) for half in "01"}
    tiles = [(x, y) for columns, rows in EMPTY for x in columns for y in rows]
    return {f"floorplan_empty_{x}_{y}_{part}_{name}": {
        "hide_name": 0, "type": kind, "parameters": parameters, "port_directions": {}, "connections": {},
        "attributes": {"BEL": f"X{x}/Y{y}/SLICE{part}.{name}", "keep": "1"}}
        for x, y in tiles for part in "ABCD" for name, (kind, parameters) in kinds.items()}


def anchored(netlist, settings):
    """The text of Yosys' JSON with a place at every block RAM and multiplier, tiles that stay empty, and settings of
    nextpnr that have no option."""
    design = json.loads(netlist)
    top = max(design["modules"].values(), key=lambda module: len(module["cells"]))  # the others are primitives
    top["settings"] = settings
    cells = top["cells"]
    for cell, bel in anchors({name: cell["type"] for name, cell in cells.items()}).items():
        cells[cell].setdefault("attributes", {})["BEL"] = bel
    cells.update(empty_tiles())
    return json.dumps(design)


# ---- picture

COLOURS = ("#4c78a8", "#f58518", "#54a24b", "#e45756", "#72b7b2", "#b279a2", "#eeca3b", "#9d755d", "#ff9da6", "#79706e")
TILE = 6  # px


def picture(at, kinds, block_of, title):
    """SVG of a placed design: each tile has the colour of the block with most cells there, the darker the fuller;
    frames are block RAMs and multipliers. at: {cell: (x, y)}, kinds: {cell: type}, block_of: of a cell."""
    tiles, sizes = {}, {}
    for cell, place in at.items():
        block = block_of(cell)
        sizes[block] = sizes.get(block, 0) + 1
        tiles.setdefault(place, {}).setdefault(block, 0)
        tiles[place][block] += 1
    large = sorted(sizes, key=lambda block: -sizes[block])[:len(COLOURS)]
    colour = dict(zip(large, COLOURS))
    height = TILE * HEIGHT
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {TILE * WIDTH + 190} {height + 30}" '
             'font-family="sans-serif" font-size="13">',
             f"<!-- SPDX-License-Identifier: Apache-2.0 --><title>{title}</title>",
             f'<rect width="100%" height="100%" fill="#fff"/><text x="6" y="17">{title}</text>']
    squares = {}
    for (x, y), inside in sorted(tiles.items()):
        block = max(inside, key=inside.get)
        level = min(3, sum(inside.values()) // 6)  # up to 24 cells in a tile
        squares.setdefault((colour.get(block, "#bbb"), level),
                           []).append(f"M{TILE * x},{24 + height - TILE * (y + 1)}h{TILE}v{TILE}h-{TILE}z")
    for (fill, level), paths in sorted(squares.items()):
        parts.append(f'<path fill="{fill}" fill-opacity="{0.35 + 0.2 * level:.2f}" d="{"".join(paths)}"/>')
    for cell, (x, y) in sorted(at.items()):
        if kinds[cell] in (RAM, MULTIPLIER):
            wide = 2 if kinds[cell] == RAM else 1
            parts.append(f'<rect x="{TILE * x}" y="{24 + height - TILE * (y + 1)}" width="{TILE * wide}" '
                         f'height="{TILE}" '
                         f'fill="{colour.get(block_of(cell), "#bbb")}" stroke="#000" stroke-width="0.8"/>')
    for number, block in enumerate([*large, "others"]):
        parts.append(f'<rect x="{TILE * WIDTH + 12}" y="{34 + 22 * number}" width="14" height="14" '
                     f'fill="{colour.get(block, "#bbb")}"/>'
                     f'<text x="{TILE * WIDTH + 32}" y="{46 + 22 * number}">{block}</text>')
    return "\n".join([*parts, "</svg>"]) + "\n"


def heat(tables):
    """SVG of where wires are overused, the tables of {title: rows}, a row for each column of tiles, side by side in one
    scale."""
    most = max((int(count) for rows in tables.values() for row in rows for count in row if count), default=1)
    side, height = 3 * WIDTH, 3 * HEIGHT
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {(side + 12) * len(tables)} {height + 48}" '
             'font-family="sans-serif" font-size="13">',
             '<!-- SPDX-License-Identifier: Apache-2.0 --><title>Overused wires</title><rect width="100%" '
             'height="100%" fill="#fff"/>']
    for number, (title, rows) in enumerate(tables.items()):
        left, total, own, squares = number * (side + 12), 0, 0, {}
        for x, row in enumerate(rows):
            for y, count in enumerate(row):
                if count and int(count) > 0:
                    total += int(count)
                    own = max(own, int(count))
                    level = min(5, 1 + 5 * int(count) // (most + 1))
                    squares.setdefault(level, []).append(f"M{left + 3 * x},{24 + height - 3 * (y + 1)}h3v3h-3z")
        parts += [f'<rect x="{left}" y="24" width="{side}" height="{height}" fill="#f4f4f4"/>',
                  f'<text x="{left}" y="16">{title}</text>',
                  f'<text x="{left}" y="{height + 42}">overused wires: {total}, at most {own} in a tile</text>']
        parts += [f'<path fill="#b00" fill-opacity="{0.2 * level:.1f}" d="{"".join(paths)}"/>'
                  for level, paths in sorted(squares.items())]
    return "\n".join([*parts, "</svg>"]) + "\n"


def main():
    if len(sys.argv) < 4 or sys.argv[1] != "heat" or not all("=" in word for word in sys.argv[3:]):
        print(__doc__)
        return 2
    tables = {}
    for word in sys.argv[3:]:
        title, path = word.split("=", 1)
        with open(path, newline="") as file:
            tables[title] = [[count.strip() for count in row] for row in csv.reader(file)]
    with open(sys.argv[2], "w") as file:
        file.write(heat(tables))
    return 0


if __name__ == "__main__":
    sys.exit(main())
