# SPDX-License-Identifier: Apache-2.0
"""Timing of a design that nextpnr-ecp5 has placed and not routed: what limits its clock, and where each block lies.

nextpnr names paths only once it has routed a design, which takes hours for the whole chip. Right after placement it
writes what a path is made of: `--write` the places of the cells, `--sdf` their delays and set-up times and the delay
that it predicts for each wire from the distance. From these the latest arrival at every register follows, as nextpnr's
own estimate has it.

One clock; paths from and to registers, block RAMs, multipliers and distributed RAM. Delays are those of the slowest
corner."""
import collections
import dataclasses
import json
import re


@dataclasses.dataclass(frozen=True)
class Hop:
    """A cell on a path, and the wire behind it."""
    cell: str
    output: str  # pin
    cell_ns: float
    wire_ns: float


@dataclasses.dataclass(frozen=True)
class Path:
    """From a register to a pin of another one."""
    ns: float
    hops: tuple  # the source first
    end: str  # cell
    pin: str  # its input

    @property
    def source(self):
        return self.hops[0].cell

    @property
    def wire_ns(self):
        return sum(hop.wire_ns for hop in self.hops)


def plain(name):
    return name.replace("\\", "")


def slowest(text):
    """ns of the largest number of `(min:typ:max) ...`, which is in ps."""
    return max(map(float, re.findall(r"[-+.\deE]+(?=\))", text))) / 1000


class Placed:
    def __init__(self, netlist, delays):
        """netlist, delays: the text of what --write and --sdf wrote."""
        cells = next(module for module in json.loads(netlist)["modules"].values() if module["cells"])["cells"]
        self.kind = {name: cell["type"] for name, cell in cells.items()}
        self.at = {}  # (x, y) of each cell that has a place
        for name, cell in cells.items():
            if found := re.match(r"X(\d+)/Y(\d+)/", cell["attributes"].get("NEXTPNR_BEL", "")):
                self.at[name] = int(found[1]), int(found[2])
        self.driver = {}  # input (cell, pin) -> (output (cell, pin), ns)
        self.fan_out = collections.Counter()
        launch, through, self.setup = {}, collections.defaultdict(list), {}
        pin_of = lambda text: tuple(map(plain, text.rsplit("/", 1)))
        cell = None
        for line in delays.splitlines():
            what, _, rest = line.strip().partition(" ")
            if what == "(INTERCONNECT":
                source, sink, rest = rest.split(None, 2)
                self.driver[pin_of(sink)] = pin_of(source), slowest(rest)
                self.fan_out[pin_of(source)] += 1
            elif what == "(INSTANCE":
                cell = plain(rest[:-1])
            elif what == "(IOPATH" and self.kind[cell] != "DCCA":
                source, sink, rest = rest.split(None, 2)
                if source in ("CLK", "WCK", "CLKA", "CLKB", "CLK0"):
                    launch[cell, sink] = slowest(rest)
                else:
                    through[cell, sink].append((source, slowest(rest)))
            elif what == "(SETUPHOLD":
                found = re.match(r"\(\w+ (\S+)\) \(\w+ \S+\) \((\S+)\)", rest)
                self.setup[cell, plain(found[1])] = float(found[2].split(":")[-1]) / 1000
        self.arrive(launch, through)

    def arrive(self, launch, through):
        """Latest arrival at every output pin, ns, and the input of its cell by which it came."""
        self.arrival, self.by = dict(launch), {}
        waits, feeds, ready = {}, collections.defaultdict(list), list(launch)
        for pin, inputs in through.items():
            if pin in launch:
                continue
            sources = {self.driver[pin[0], source][0] for source, _ in inputs if (pin[0], source) in self.driver}
            waits[pin] = len(sources)
            for source in sources:
                feeds[source].append(pin)
        # pins that no register drives (constants, the harness' inputs) have no arrival, but what follows them does not
        # wait
        known = {pin for pins in feeds.values() for pin in pins} | set(launch)
        ready += [pin for pin in {*feeds, *through} if pin not in known]
        while ready:
            done = ready.pop()
            for pin in feeds[done]:
                waits[pin] -= 1
                if waits[pin] == 0:
                    self.reach(pin, through[pin])
                    ready.append(pin)

    def reach(self, pin, inputs):
        for source, cell_ns in inputs:
            before, wire_ns = self.driver.get((pin[0], source), (None, 0))
            ns = self.arrival.get(before, -1) + wire_ns + cell_ns
            if before in self.arrival and ns > self.arrival.get(pin, -1):
                self.arrival[pin], self.by[pin] = ns, (source, cell_ns)

    def ends(self):
        """[(ns, (cell, pin))] of every input of a register that another one reaches, the slowest first."""
        found = []
        for end, setup in self.setup.items():
            before, wire_ns = self.driver.get(end, (None, 0))
            if before in self.arrival:
                found.append((self.arrival[before] + wire_ns + setup, end))
        return sorted(found, key=lambda item: (-item[0], item[1]))

    def path(self, ns, end):
        """The slowest path to an end, as ends() gives it."""
        hops = []
        pin, wire_ns = self.driver[end]
        while pin in self.by:
            source, cell_ns = self.by[pin]
            hops.append(Hop(*pin, cell_ns, wire_ns))
            pin, wire_ns = self.driver[pin[0], source]
        hops.append(Hop(*pin, self.arrival[pin], wire_ns))
        return Path(ns, tuple(reversed(hops)), *end)

    def look_up_tables(self, path):
        return sum(self.kind[hop.cell] == "TRELLIS_COMB" and hop.output == "F" for hop in path.hops[1:])


def ranking(placed, name_of, limit_ns):
    """Sources by the slowest path that starts at each: [(path, ends behind limit_ns)]. Repaired from the top, the clock
    of the design is that of the first row left. name_of: of a cell; the bits of a register are one source."""
    first, behind = {}, collections.Counter()
    for ns, end in placed.ends():
        path = placed.path(ns, end)
        source = name_of(path.source)
        first.setdefault(source, path)
        behind[source] += ns > limit_ns
    return [(path, behind[source]) for source, path in first.items()]


def spread(placed, block_of):
    """{block: (cells, the middle 90 % of them in x and in y: width, height, and the middle of each)}; block_of: of a
    cell."""
    places = collections.defaultdict(list)
    for cell, at in placed.at.items():
        places[block_of(cell)].append(at)
    found = {}
    for block, at in places.items():
        quantile = lambda values, part: sorted(values)[min(len(values) - 1, int(part * len(values)))]
        sides = [[quantile(axis, part) for part in (0.05, 0.5, 0.95)] for axis in zip(*at)]
        found[block] = len(at), sides
    return found
