#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes folders to hand to an FPGA project: one self-contained Verilog file per top module and all that goes with it.

usage: export.py [--out FOLDER] [--mhz F] [TOP...]
  --out FOLDER  default build/export; FOLDER/TOP is deleted and written anew
  --mhz F       clock of the constraint templates, default: what docs/hardware/fpga.md measured on ECP5, rounded down
  TOP           default: every primitive test of rtl/cchip.f, the array, the reconfigurable
                subsystem, the blank module and the whole chip, also with three clocks

FOLDER/TOP holds TOP.v, whose ports have Vivado's interface attributes, with every list rtl/cchip_DEVICE.f a variant
TOP_DEVICE.v with the multiplier leaf of that device, file lists, constraints, datasheets, licences, a self-checking
bench with its vectors, TOP.vhd for VHDL, of tops with buses TOP_hw.tcl for Platform Designer, README.md and, of the
chip after `make venv`, its IP-XACT component. The vectors are those of tests/fusesoc: nothing has to be built. Modules
are found by name: one module per file, named like it. Exit codes: 0 done, 1 something is missing."""
import argparse
import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys

import datasheet
import hw_tcl
import interfaces
import vhdl

ROOT = pathlib.Path(__file__).resolve().parent.parent
RTL = ROOT / "rtl"
MODELS = ROOT / "sim" / "rtl_models" / "sim.f"  # for simulation only
INCLUDES = ("cchip_defs.vh", "cchip_assert.vh")
BLANK = "cchip_primtest_blank"
SUBSYSTEM = "cchip_primtest_subsystem"
CHIP = "cchip_chip"
CDC = "cchip_chip_cdc"
CLOCKS = {CDC: ("clk", "axil_clk", "mem_clk")}  # of all others: clk
# Pairs of the vectors: the default parameters of each top.
KINDS = {"cchip_primtest_tri_tri": "tri_tri", "cchip_primtest_tri_quad": "tri_quad",
         "cchip_primtest_quad_quad": "quad_quad", "cchip_primtest_array": "tri_tri",
         SUBSYSTEM: "tri_tri"}
VECTORS = ROOT / "tests" / "fusesoc"  # what the bit-exact model expects; test_fusesoc.py compares them with it
# Simulation models of the blocks that the leaves of a device instantiate, and what the blocks are.
CELLS = {"_ecp5": {"MULT18X18D": "multiplier block", "DP16KD": "block RAM"}}
# Pages below docs/: of every top, and of some.
PAGES = ("develop/architecture.md", "hardware/definitions.md")
MORE_PAGES = {SUBSYSTEM: ("hardware/registers.md",),
              CHIP: tuple(f"hardware/{name}.md" for name in ("chip", "chip-registers", "image", "programmers-guide"))}
# Clock of the constraints: medians of docs/hardware/fpga.md, rounded down; the chip's is that of the triangle test with
# one seed.
MHZ = {"cchip_primtest_array": 145, SUBSYSTEM: 130, CHIP: 68, CDC: 68}
# Bench of a top, the first of its files, and what else is copied.
BENCH = "tests/icarus/bench_primtest.v"
WIRE = "cpp_ref/include/cchip/internal/wire"
FILES = {BLANK: ("tests/icarus/bench_blank.v",),
         SUBSYSTEM: (BENCH, "tests/icarus/bench_subsystem.v", f"{WIRE}/registers.hpp"),
         CHIP: ("tests/icarus/bench_chip.v", f"{WIRE}/chip_registers.hpp", "examples/chip_poll.h",
                "examples/chip_poll.c",
                "examples/chip_instance.v")}
FILES[CDC] = ("tests/icarus/bench_chip_cdc.v", *FILES[CHIP][1:-1])


class ExportError(Exception):
    pass


# ---- sources


def read_list(path):
    """Files of a list by module name, in its order."""
    lines = [line.strip() for line in path.read_text().splitlines()]
    return {pathlib.Path(line).stem: path.parent / line for line in lines if line.endswith(".v")}


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


def closure(top, files):
    """Modules that `top` needs, itself included, in the order of the list. The chip's slots have three kinds of pairs:
    their region names the test of points, which is never in it."""
    needed, found = [top], set()
    files = {name: file for name, file in files.items() if top not in (CHIP, CDC) or name != "cchip_primtest_point_tri"}
    while needed:
        name = needed.pop()
        if name not in found:
            found.add(name)
            words = set(re.findall(r"\w+", without_comments(files[name].read_text())))
            needed += words & files.keys()
    return [name for name in files if name in found]


def version():
    """Version of the project, and the commit where git knows it."""
    number = re.search(r"project\(collisionchip VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
    try:
        commit = subprocess.run(["git", f"--git-dir={ROOT}/.git", f"--work-tree={ROOT}", "describe", "--always",
                                 "--dirty", "--tags"],
                                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout.strip()
    except OSError:
        commit = ""
    return f"{number} ({commit})" if commit else number


def body(path):
    """A source without licence line and without the include files, which stand at the top of the one file."""
    lines = path.read_text().splitlines()
    includes = [f'`include "{name}"' for name in INCLUDES]
    kept = [line for line in lines if "SPDX-License-Identifier" not in line and line.strip() not in includes]
    left = [line for line in kept if line.strip().startswith("`include")]
    if left:
        raise ExportError(f"{path.relative_to(ROOT)}: {left[0].strip()}: only {' and '.join(INCLUDES)} can be inlined")
    return "\n".join(kept) + "\n"


def guarded(path):
    """A module that may occur in more than one exported file of a project."""
    guard = f"CCHIP_EXPORT_{path.stem.upper()}"
    return f"\n// ---- {path.relative_to(ROOT)}\n`ifndef {guard}\n`define {guard}\n{body(path)}`endif\n"


def one_file(top, files, list_name):
    """Verilog of a top and everything below it. Each module is guarded: two exported files fit into one project."""
    names = closure(top, files)
    text = f"""// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
// {top}, collisionchip {version()}: one file with all its modules, plain Verilog-2005.
// Written by scripts/export.py from rtl/{list_name}. Do not edit.
/* verilator lint_off DECLFILENAME */ // many modules in one file
"""
    for name in INCLUDES:
        text += f"\n// ---- rtl/include/{name}\n{body(RTL / 'include' / name)}"
    for name in names:
        text += guarded(files[name]) if name != top else interfaces.with_attributes(guarded(files[name]), top)
    return text + "/* verilator lint_on DECLFILENAME */\n"


def simulation_models(top):
    """Verilog of the models for simulation only that a top may instantiate, or nothing."""
    models = read_list(MODELS)
    names = [name for name in closure(top, read_list(RTL / "cchip.f") | models) if name in models]
    return "".join(
        ["// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1\n// Models for simulation only, to be read after "
         f"{top}.v, whose definitions they use. Written by scripts/export.py. Do not edit.\n"
         "/* verilator lint_off DECLFILENAME */ // many modules in one file\n",
         *(guarded(models[name]) for name in names),
         "/* verilator lint_on DECLFILENAME */\n"] if names else [])


def variants(top):
    """(suffix, text) of the one file and of its variants for devices."""
    portable = one_file(top, read_list(RTL / "cchip.f"), "cchip.f")
    result = [("", portable)]
    names = closure(top, read_list(RTL / "cchip.f"))
    for path in sorted(RTL.glob("cchip_*.f")):
        files = read_list(path)
        missing = [name for name in names if name not in files]
        if missing:
            raise ExportError(f"rtl/{path.name}: {missing[0]} is missing, which {top} needs; add its line from "
                              "rtl/cchip.f")
        if any(files[name] != read_list(RTL / "cchip.f")[name] for name in names):
            result.append((path.stem[len("cchip"):], one_file(top, files, path.name)))
    return result


# ---- constraints: templates


def constraints(top, mhz):
    period = f"{1000 / mhz:.3f}"
    # the device's configuration error comes from any clock, to two flip-flops
    asynchronous = top in (SUBSYSTEM, CHIP, CDC)
    false_path = "set_false_path -from [get_ports cfg_error]\n" if asynchronous else ""
    clocks = CLOCKS.get(top, ("clk",))
    create = "".join(f"create_clock -name {name} -period {period} [get_ports {name}]\n" for name in clocks)
    frequency = "".join(f'FREQUENCY PORT "{name}" {mhz:g} MHZ;\n' for name in clocks)
    pins = " ".join(clocks)
    read_xdc, read_sdc = (f"# The crossings: {how} after this file.\n" if len(clocks) > 1 else ""
                          for how in ("read_xdc -unmanaged cdc.xdc", "cdc.sdc"))
    inside = f"[get_ports {{{pins}}}]" if len(clocks) > 1 else "[get_ports clk]"
    no_clock = " && ".join(f"NAME != {name}" for name in clocks)
    head = f"""# SPDX-License-Identifier: Apache-2.0
# {top}: template. It constrains the one clock, {mhz:g} MHz: change that to yours.
# {'All ports but cfg_error' if asynchronous else 'All ports'} belong to this clock, rst included (synchronous). Where the clock comes from your design and is constrained
# there, leave this file out.
""" if len(clocks) == 1 else f"""# SPDX-License-Identifier: Apache-2.0
# {top}: template. It constrains the three clocks, each {mhz:g} MHz: change that to yours. axil_clk: s_axil, irq and
# axil_rst; mem_clk: m_axi, m_axi_cfg and mem_rst; clk: rst and cfg; cfg_error: none. Where the clocks come from your
# design and are constrained there, leave this file out, and only this one: the crossings are not in it.
"""  # noqa: E501  lines of what is written
    lpf = head + f"""# Lattice ECP5 (Diamond, nextpnr-ecp5). The ports are more than a package has pins: build the module inside your design,
# and replace "clk" by the name of the clock there. nextpnr: FREQUENCY PORT for a pin, FREQUENCY NET for a clock of a PLL.
{frequency}# LOCATE COMP "clk" SITE "...";
# IOBUF PORT "clk" IO_TYPE=LVCMOS33;
"""  # noqa: E501  lines of what is written
    xdc = head + f"""# AMD (Vivado), for the module on its own: synth_design -mode out_of_context -top {top}.
{create}{false_path}{read_xdc}# A clock buffer of your design, so that timing counts its delay:
# set_property HD.CLK_SRC BUFGCTRL_X0Y0 [get_ports clk]
# Ports that leave the device (out of context none do): values of your board.
# set_input_delay -clock clk 0.000 [get_ports -filter {{DIRECTION == IN && {no_clock}}}]
# set_output_delay -clock clk 0.000 [get_ports -filter {{DIRECTION == OUT}}]
"""
    sdc = head + f"""# Intel (Quartus) and others that read SDC. On its own in Quartus make the ports virtual, they are more than a package has
# pins: in the .qsf, set_instance_assignment -name VIRTUAL_PIN ON -to *, and OFF for {pins}.
{create}{false_path}# Quartus only:
{read_sdc}# derive_clock_uncertainty
# Ports that leave the device: values of your board.
# set_input_delay -clock clk 0.000 [remove_from_collection [all_inputs] {inside}]
# set_output_delay -clock clk 0.000 [all_outputs]
"""  # noqa: E501  lines of what is written
    return {"lpf": lpf, "xdc": xdc, "sdc": sdc}


# ---- pages


def vectors(top):
    """The file of pairs for the bench of a top."""
    return VECTORS / f"vectors_{KINDS[top]}.hex"


def page(path, text, exported):
    """A page of docs/ with that text; links to what is not exported, and pictures, become text. `exported`: names of
    pages below docs/. A link to the RTL of a module leads to its datasheet."""
    rtl = {ROOT / file: ROOT / "docs" / "modules" / f"{module}.md" for module, file in datasheet.rtl_files().items()}

    def keep(match):
        target = match.group(2).split("#")[0]
        if not target or ":" in target:
            return match.group(0)
        found = (path.parent / target).resolve()
        found = rtl.get(found, found)
        if os.path.relpath(found, ROOT / "docs") not in exported or found == path:
            return match.group(1)
        return match.group(0).replace(f"({target}", f"({os.path.relpath(found, path.parent)}")
    return re.sub(r"!?\[([^\]]*)\]\(([^)]*)\)", keep, text)


def write_pages(folder, names):
    pages = [*PAGES, *(f"modules/{name}.md" for name in names)]
    for name in names:
        pages += MORE_PAGES.get(name, ())
    for name in pages:
        path = ROOT / "docs" / name
        text = datasheet.datasheet(path.stem) if name.startswith("modules/") else path.read_text()
        (folder / "docs" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "docs" / name).write_text(page(path, text, pages))


def blocks(suffix, text):
    """Blocks of a device that a text instantiates."""
    return [name for name in CELLS.get(suffix, {}) if re.search(rf"\b{name}\b *#", without_comments(text))]


def readme(top, files, mhz, described):
    def variant(suffix, text):
        cells = blocks(suffix, text)
        if not cells:
            return (f"- `{top}{suffix}.v` instead on {suffix[1:].upper()}: the leaves that rtl/cchip{suffix}.f names, "
                    "without cells of a device.\n")
        return (f"- `{top}{suffix}.v` instead on {suffix[1:].upper()}: with that device's "
                f"{' and '.join(CELLS[suffix][name] for name in cells)}, "
                "whose registers synthesis does not find otherwise. Simulate it with "
                f"{' and '.join(f'`{name}.v`' for name in cells)}, our models.\n")

    device = "".join(variant(s, text) for s, text in files if s)
    bench = pathlib.Path(FILES.get(top, (BENCH,))[0]).stem
    macro, wrapper, run, verdict = "", "", "vvp -n bench.vvp", "`PASS`"
    if top == CHIP:
        run += " +memory=memory.hex +records=records.hex"
        verdict = "`wrong=0` in its last line"
    elif top in KINDS:
        run += f" +vectors=vectors.hex +pairs={len(vectors(top).read_text().splitlines())}"
        macro = f"-DCCHIP_BENCH_TOP={'bench_subsystem' if top == SUBSYSTEM else top} "
        wrapper = "bench_subsystem.v " if top == SUBSYSTEM else ""
    compiled = f"iverilog -g2005 {macro}-s {bench} -o bench.vvp {bench}.v {wrapper}{top}.v"
    more = {
        SUBSYSTEM: "- [Registers](docs/hardware/registers.md), for C++ `registers.hpp`. `simulation_models.v` with "
                   "parameter `SIMULATION` = 1: a slot holds all modules, bitstreams exchange them.\n",
        CHIP: "- [Programmer's guide](docs/hardware/programmers-guide.md), "
              "[registers](docs/hardware/chip-registers.md), [images and records](docs/hardware/image.md); "
              "for C++ `chip_registers.hpp`, a driver in C `chip_poll.c`. "
              "`simulation_models.v` is for `SWAPS` = 1 with `SIMULATION` = 1.\n"}
    more[CDC] = more[CHIP]
    more = more.get(top, "")
    integration = chip_notes(top, mhz) if top in (CHIP, CDC) else ""
    ip_xact = (f"- `{top}.xml`: IP-XACT component, IEEE 1685-2014: buses, registers, ports, parameters.\n"
               if described else "")
    platform = "; `_hw.tcl`: for Platform Designer, run by no Quartus" if top in (SUBSYSTEM, CHIP, CDC) else ""
    return f"""<!-- SPDX-License-Identifier: Apache-2.0 -->
# {top}, collisionchip {version()}

- `{top}.v`: the whole RTL in one file, no include folder, top `{top}`; `.f`: as a file list; `.vhd`: its component for VHDL{platform}.
{device}{more}{ip_xact}- [Datasheet](docs/modules/{top}.md): ports, parameters, timing, area.
- `constraints/`: templates for ECP5 (LPF), Vivado (XDC), Quartus and others (SDC), clock {mhz:g} MHz; each says what to change.
- Licence of the RTL: [Solderpad 2.1](LICENSES/SHL-2.1.txt), or take it as [Apache-2.0](LICENSES/Apache-2.0.txt) like all the rest.
- Check with Icarus; other simulators take the same macro and plusargs, `{bench}.v` explains them. It must print {verdict}:

      {compiled}
      {run}
{integration}"""  # noqa: E501  lines of what is written


def chip_notes(top, mhz):
    """What an integrator of the chip has to know, for its README.md."""
    with open(ROOT / "docs" / "figures" / "fpga_chip_bill.csv", newline="") as file:
        size = next(row for row in csv.DictReader(file) if (row["row"], row["block"]) == (CHIP.split("_")[1], "all"))
    first = """- **Instance**: `chip_instance.v`, default parameters, ports of swaps tied off. With `SWAPS` = 0 tie their inputs to 0.
- **Reset**: `rst` is active high and synchronous to `clk`, for 2 clocks or more, also after power-up. It"""  # noqa: E501  lines of what is written
    if top == CDC:
        first = """- **Clocks**: of any ratio. Crossings: after the clocks, in Vivado `read_xdc -unmanaged constraints/cdc.xdc`, in Quartus `constraints/cdc.sdc`; both are written from the manuals, no tool of theirs has read them. nextpnr times no path between two clocks and bounds
  none: keep the slower period above the longest wire.
- **Reset**: `rst`, `axil_rst`, `mem_rst`, active high, each on its clock for 2 clocks or more, together or in turn, also after power-up. A reset"""  # noqa: E501  lines of what is written
    return f"""
## In a design

{first} forgets what is outstanding on both buses: reset these with it.
- **Reset while the bus lives on** (a processor's): clear `control.enable`, write `control.soft_reset`, wait until `status.resetting` is 0: then nothing is outstanding on `m_axi` (with `SWAPS`, wait for a swap's end, too). Hold all accesses to the registers, then `rst`. If
  `resetting` stays 1, memory has lost a response: only a reset of chip and bus helps, or a firewall or shutdown manager between them that completes the rest.
- **Coherency**: `AXI_ARCACHE` = 3, `AXI_AWCACHE` = 2: normal memory, not cacheable; `AXI_PROT` = 0: secure. A coherent port wants others, see docs/hardware/uio.md; there is no `AxUSER`. Map images and rings uncached, or flush and invalidate as the programmer's guide says. A port
  that snoops (ACP, HPC) needs `AxCACHE` and `AxUSER` set in your wrapper, as that port asks.
- **Records** are 16 bytes in one beat. Behind a bus narrower than 128 bit the host sets `confirm_records`, see docs/hardware/programmers-guide.md.
- **Size and clock**: default parameters after synthesis for ECP5: {size["sites"]} sites of LUT4, {size["FF"]} flip-flops, {size["DSP"]} multiplier blocks, {size["block RAM"]} block RAMs of 18 kbit. The constraints say {mhz:g} MHz, unless you chose
  another clock: it is that of the chip with the triangle test, routed for ECP5 grade 6 with one seed; with the quad test, or for another family, it was never routed. Begin lower.
"""  # noqa: E501  lines of what is written


# ---- all of it


def write_ip_xact(folder):
    """The component of the chip, where the packages of `make venv` are; returns whether."""
    result = subprocess.run([sys.executable, "-B", ROOT / "scripts" / "ip_xact.py", folder], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)
    if result.returncode == 77:
        print("without IP-XACT: make venv installs what it needs")
    elif result.returncode:
        raise ExportError(result.stdout.strip())
    return result.returncode == 0


def platform_designer(top, models):
    """The text of TOP_hw.tcl; models: whether simulation_models.v is in the folder."""
    files = [(f"{top}.v", "VERILOG", False)]
    files += [("simulation_models.v", "VERILOG", True)] if models else []
    files += [("constraints/cdc.sdc", "SDC", False)] if top in CLOCKS else []
    return hw_tcl.component(top, version().split()[0], files)


def export(top, options):
    folder = pathlib.Path(options.out) / top
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "constraints").mkdir(parents=True)
    files, mhz = variants(top), options.mhz or MHZ.get(top, 150)
    for suffix, text in files:
        (folder / f"{top}{suffix}.v").write_text(text)
        (folder / f"{top}{suffix}.f").write_text(
            f"// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1\n{top}{suffix}.v\n")
        for name in blocks(suffix, text):
            shutil.copy(ROOT / "tests" / "gates" / f"{name}.v", folder)
    models = simulation_models(top)
    if models:
        (folder / "simulation_models.v").write_text(models)
    (folder / f"{top}.vhd").write_text(vhdl.package(top))
    for kind, text in constraints(top, mhz).items():
        (folder / "constraints" / f"{top}.{kind}").write_text(text)
    if top in CLOCKS:
        for name in ("vivado/cdc.xdc", "quartus/cdc.sdc"):
            shutil.copy(ROOT / "scripts" / name, folder / "constraints")
    write_pages(folder, closure(top, read_list(RTL / "cchip.f") | (read_list(MODELS) if models else {})))
    shutil.copytree(ROOT / "LICENSES", folder / "LICENSES")
    for name in FILES.get(top, (BENCH,)):
        shutil.copy(ROOT / name, folder)
    if top == CHIP:
        for name in ("memory", "records"):
            shutil.copy(VECTORS / f"{name}_chip.hex", folder / f"{name}.hex")
    elif top in KINDS:
        shutil.copy(vectors(top), folder / "vectors.hex")
    if top in (SUBSYSTEM, CHIP, CDC):
        (folder / f"{top}_hw.tcl").write_text(platform_designer(top, models))
    described = top == CHIP and write_ip_xact(folder)
    (folder / "README.md").write_text(readme(top, files, mhz, described))
    print(f"wrote {os.path.relpath(folder)}")


def main():
    listed = read_list(RTL / "cchip.f")
    tops = [top for top in (*KINDS, BLANK, CHIP, CDC) if top in listed]
    if {"-h", "--help"} & set(sys.argv[1:]):
        print(__doc__)
        return 0
    parser = argparse.ArgumentParser(usage=re.search("usage: (.*)", __doc__).group(1), add_help=False)
    parser.add_argument("--out", default=ROOT / "build" / "export")
    parser.add_argument("--mhz", type=float)
    parser.add_argument("tops", nargs="*")
    options = parser.parse_args()
    try:
        for top in options.tops or tops:
            if top not in tops:
                raise ExportError(f"{top} cannot be exported, one of: {' '.join(tops)}")
            export(top, options)
    except (ExportError, vhdl.VhdlError, hw_tcl.HwTclError) as error:
        print(f"export.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
