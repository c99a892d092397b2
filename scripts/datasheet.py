#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what the datasheets claim and keeps them in step with the RTL.

usage: datasheet.py                        measure everything, rewrite the generated tables (some minutes)
       datasheet.py MODULE... | architecture   the same for some pages only
       datasheet.py --check                run no tool; exit 1 if a module of rtl/cchip.f has no datasheet, or one
                                           whose parameters, ports or markers do not agree with the RTL
       datasheet.py --latency MODULE       clocks from an input to the output it changes (Icarus Verilog)
       datasheet.py --stream [NAME=VALUE...]   cchip_primtest_tri_tri: latency, clocks per pair, drain (Icarus Verilog)
       datasheet.py --widths               widths and smallest SUBSTAGES for every COORD_W (Icarus Verilog)
       datasheet.py --leaves               18x18 multipliers for every COORD_W, both projections (Yosys)

Tables are written between the lines `<!-- generated: begin NAME -->` and `<!-- generated: end -->` (a datasheet
has one, without NAME). Tools: Debian's yosys 0.23 and iverilog 11; default parameters unless a table says otherwise."""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
RTL = ROOT / "rtl"
MODULES = ROOT / "docs" / "modules"
ARCHITECTURE = ROOT / "docs" / "architecture.md"
BLOCK = r"(<!-- generated: begin{} -->\n).*?(<!-- generated: end -->)"

# How a change of the inputs is made visible: (what is prepared, what changes, the output that answers).
STIMULI = {
    "cchip_delay": ("", "d = 1;", "q"),
    "cchip_skid_buffer": ("", "s_valid = 1;", "m_valid"),
    "cchip_fifo": ("", "s_valid = 1;", "m_valid"),
    "cchip_ram": ("write = 1; tick; write_addr = 1; write_data = 1; tick; write = 0;", "read_addr = 1;", "read_data"),
    "cchip_mul18": ("", "a = 1; b = 1;", "p"),
    "cchip_mul_wide": ("", "a = 1; b = 1;", "p"),
    "cchip_dot3": ("", "a = 1; b = 1;", "q"),
    "cchip_cross3": ("", "a = 1; b = 1 << dut.E_W;", "q"),
    "cchip_sat_select": ("", "s_a = 1;", "m_e_from"),
    "cchip_sat_axis": ("", "s_e_to = 1; s_f_to = 1 << dut.COORD_W;", "m_axis"),
    "cchip_sat_project": ("", "s_axis = 1; s_points = 1;", "m_projection"),
    "cchip_sat_compare": ("", "s_projection = ~s_projection;", "m_separated"),
    "cchip_sat_pipeline": ("", "s_beat_valid = 1;", "m_verdict_valid"),
    "cchip_axis_controller": ("", "s_pair_valid = 1;", "m_beat_valid"),
}


def fail(message):
    sys.exit(f"datasheet.py: {message}")


def run(*command, cwd=ROOT):
    result = subprocess.run(command, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode:
        fail(f"{command[0]} failed:\n{result.stdout}")
    return result.stdout


# ---- the RTL


def rtl_files():
    lines = [line.strip() for line in (RTL / "cchip.f").read_text().splitlines()]
    return {pathlib.Path(line).stem: line for line in lines if line.endswith(".v")}


def squeeze(text):
    return re.sub(r"\s+", "", text)


def parse(module):
    """Parameters [(name, default)] and ports [(name, direction, width)] of a module, in order; blanks removed."""
    text = re.sub(r"//[^\n]*", "", (RTL / rtl_files()[module]).read_text())
    head = re.search(rf"\bmodule\s+{module}\b(.*?)\);", text, re.S)
    if not head:
        fail(f"{rtl_files()[module]}: no module {module}")
    parameters = re.findall(r"\bparameter\s+integer\s+(\w+)\s*=\s*([^,\n)]+)", head.group(1))
    ports = re.findall(r"\b(input|output)\s+(?:wire|reg)\s+(?:signed\s+)?(?:\[([^\]]*):0\])?\s*(\w+)", head.group(1))
    widths = [(name, direction, width_of(squeeze(top))) for direction, top, name in ports]
    return [(name, squeeze(value)) for name, value in parameters], widths


def width_of(top):
    """Width of the range [top:0]."""
    if not top:
        return "1"
    return str(int(top) + 1) if top.isdigit() else re.sub(r"-1$", "", top)


# ---- measurements


def simulate(bench, *options):
    with tempfile.TemporaryDirectory() as folder:
        program = f"{folder}/bench.vvp"
        files = [f"rtl/{name}" for name in rtl_files().values()]
        run("iverilog", "-g2005", "-Irtl/include", "-o", program, *options, *files, bench)
        return run("vvp", "-n", program)


def latency(module):
    """Clocks from a change of the inputs to the change of the output."""
    prepare, change, output = STIMULI[module]
    _, ports = parse(module)
    names = [name for name, _, _ in ports]
    # Ports are generous 1024-bit registers and wires: connections cut or extend them.
    declarations = "".join(f"  {'reg' if d == 'input' else 'wire'} [1023:0] {n};\n" for n, d, _ in ports if n != "clk")
    zero = "".join(f"    {n} = 0;\n" for n, d, _ in ports if d == "input")
    bench = f"""`default_nettype none
module bench;
  reg clk;
{declarations}  {module} dut ({", ".join(f".{n}({n})" for n in names)});
  task tick; begin #1 clk = 1; #1 clk = 0; #1; end endtask
  integer clocks;
  reg [1023:0] before;
  initial begin
{zero}    {"rst = 1; repeat (100) tick; rst = 0;" if "rst" in names else ""}
    {prepare}
    repeat (100) tick;
    before = {output};
    {change}
    #1;
    for (clocks = 0; {output} === before && clocks < 1000; clocks = clocks + 1) tick;
    $display("%0d", clocks);
  end
endmodule
"""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "latency.v"
        path.write_text(bench)
        return int(simulate(str(path)).split()[-1])


def stream(*settings):
    """Lines `key value...` printed by the bench of cchip_primtest_tri_tri."""
    return simulate("scripts/datasheet_stream.v", *(f"-Pbench.{s}" for s in settings))


def widths():
    return simulate("scripts/datasheet_widths.v")


def yosys(script):
    """A command that anybody can paste into a shell in rtl/."""
    return f'yosys -p "read_verilog -Iinclude $(grep \'[.]v$\' cchip.f | tr \'\\n\' \' \'); {script}"'


def leaves():
    """Lines `COORD_W relative absolute`: $mul cells of cchip_sat_pipeline, each one in a cchip_mul18."""
    text = "COORD_W relative absolute\n"
    for width in range(4, 21):
        counts = []
        for absolute in (0, 1):
            out = run("sh", "-c", yosys(
                f"hierarchy -top cchip_sat_pipeline -chparam COORD_W {width} -chparam ABSOLUTE_PROJECTION {absolute};"
                " proc; flatten; select -count t:$mul".replace("$", "\\$")), cwd=RTL)
            counts.append(re.findall(r"(\d+) objects", out)[-1])
        text += f"{width} {' '.join(counts)}\n"
    return text


TARGETS = {
    "Lattice ECP5": ("synth_ecp5", {
        "LUT": r"LUT4", "carry": r"CCU2C", "FF": r"TRELLIS_FF", "multiplier blocks": r"MULT18X18D",
        "block RAM": r"DP16KD", "distributed RAM": r"TRELLIS_DPR16X4", "shift register": r"(?!)"}),
    "Xilinx 7": ("synth_xilinx -family xc7 -flatten", {
        "LUT": r"LUT[1-6]", "carry": r"CARRY4", "FF": r"FD[RSCP]E", "multiplier blocks": r"DSP48E1",
        "block RAM": r"RAMB\w+", "distributed RAM": r"RAM\d+\w+", "shift register": r"SRL\w+"}),
}


def cells(script, module):
    """Cell counts of the last statistics that Yosys prints."""
    out = run("sh", "-c", yosys(f"{script} -top {module}"), cwd=RTL)
    last = out[out.rindex("Number of cells"):]
    return {name: int(count) for name, count in re.findall(r"^ +(\w+) +(\d+)$", last, re.M)}


# ---- pages


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows]) + "\n"


def text_table(text):
    rows = [line.split() for line in text.strip().splitlines()]
    return table([f"`{c}`" if c.isupper() else c.replace("_", " ") for c in rows[0]], rows[1:])


def values(text):
    return {line.split()[0]: line.split()[1:] for line in text.strip().splitlines() if line and not line.startswith("clock ")}


def speed_rows(module):
    if module != "cchip_primtest_tri_tri":
        yield "latency, clocks", latency(module), f"`scripts/datasheet.py --latency {module}`"
        return
    found = values(stream())
    command = "`scripts/datasheet.py --stream`"
    yield "latency of a lone pair, clocks", found["latency"][0], command
    yield "latency of a lone illegal request, clocks", found["illegal_latency"][0], command
    yield "clocks per pair, min / mean / max", " / ".join(found["clocks_per_pair"]), command
    yield "drain after CONTEXTS pairs, clocks", found["drain"][0], command
    yield "drain bound, clocks", found["drain_bound"][0], command


def datasheet_block(module):
    text = table(["quantity", "value", "command"], speed_rows(module))
    text += "\nFmax: not measured: no place and route in this version.\n\n"
    kinds = list(next(iter(TARGETS.values()))[1])
    rows = []
    for target, (script, patterns) in TARGETS.items():
        found = cells(script, module)
        count = lambda pattern: sum(n for cell, n in found.items() if re.fullmatch(pattern, cell))
        rows.append([target] + [count(patterns[kind]) for kind in kinds])
    text += table(["Yosys 0.23, default parameters"] + kinds, rows) + "\nCommands, in `rtl/`:\n\n"
    return text + "".join(f"    {yosys(f'{script} -top {module}')}\n" for script, _ in TARGETS.values())


def throughput():
    rows = [[f"SUBSTAGES={n}"] for n in (6, 8, 10, 12)]
    rows += [[f"CONTEXTS={n}"] for n in (1, 2, 3, 4, 5, 8)]
    rows += [["COORD_W=8", "SUBSTAGES=5"], ["COORD_W=18", "SUBSTAGES=8"], ["COORD_W=20", "SUBSTAGES=12"],
             ["ABSOLUTE_PROJECTION=1"]]
    body = []
    for settings in rows:
        found = values(stream(*settings))
        body.append([f"`{' '.join(settings)}`", found["latency"][0], " / ".join(found["clocks_per_pair"]),
                     found["drain"][0], found["drain_bound"][0], " + ".join(found["axis_registers"]),
                     " + ".join(found["project_registers"])])
    return table(["`scripts/datasheet.py --stream` with", "latency of a lone pair", "clocks per pair, min / mean / max",
                  "drain measured", "drain bound", "optional registers of axis: operand + product + result",
                  "the same of project"], body)


def clock_table():
    rows = [line.split(" ", 2)[1:] for line in stream().splitlines() if line.startswith("clock ")]
    return table(["clock", "what is valid"], rows)


BLOCKS = {"widths": lambda: text_table(widths()), "leaves": lambda: text_table(leaves()), "throughput": throughput,
          "clocks": clock_table}


def rewrite(path, name, block):
    text = path.read_text()
    pattern = re.compile(BLOCK.format(f" {name}" if name else ""), re.S)
    if not pattern.search(text):
        fail(f"{path.relative_to(ROOT)}: no lines '<!-- generated: begin{' ' + name if name else ''} -->' and"
             " '<!-- generated: end -->'; add them where the table belongs")
    path.write_text(pattern.sub(lambda m: f"{m.group(1)}{block}{m.group(2)}", text))
    print(f"wrote {path.relative_to(ROOT)} {name}".rstrip(), flush=True)


# ---- check


def listed(text, heading, columns):
    """The first columns of the table below a heading, backquotes and blanks removed."""
    section = re.search(rf"^## {heading}$(.*?)(?=^## |\Z)", text, re.M | re.S)
    rows = re.findall(r"^\|(.*)\|$", section.group(1), re.M)[2:] if section else []
    return [tuple(squeeze(c.replace("`", "")) for c in row.split("|")[:columns]) for row in rows]


def findings(module):
    path = MODULES / f"{module}.md"
    if not path.exists():
        yield f"{path.relative_to(ROOT)} is missing: write it like docs/modules/cchip_fifo.md"
        return
    text = path.read_text()
    parameters, ports = parse(module)
    for heading, expected, columns in (("Parameters", parameters, 2), ("Ports", ports, 3)):
        found = listed(text, heading, columns)
        if found == expected:
            continue
        yield from (f"{path.relative_to(ROOT)}: {heading}: {' '.join(e)} of the RTL is not listed so"
                    for e in expected if e not in found)
        yield from (f"{path.relative_to(ROOT)}: {heading}: {' '.join(f)} is not in the RTL" for f in found if f not in expected)
        if sorted(found) == sorted(expected):
            yield f"{path.relative_to(ROOT)}: {heading}: not in the order of the RTL"
    if not re.search(BLOCK.format(""), text, re.S):
        yield f"{path.relative_to(ROOT)}: no '<!-- generated: begin -->' with '<!-- generated: end -->' behind it"


def check():
    found = [finding for module in rtl_files() for finding in findings(module)]
    for path in sorted(MODULES.glob("*.md")):
        if path.stem not in rtl_files():
            found.append(f"{path.relative_to(ROOT)}: no such module in rtl/cchip.f")
    for path in [ARCHITECTURE, ROOT / "docs" / "README.md", *sorted(MODULES.glob("*.md"))]:
        for link in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", path.read_text()):
            if not (path.parent / link).exists():
                found.append(f"{path.relative_to(ROOT)}: link to {link}, which does not exist")
    print("\n".join(found) if found else f"{len(rtl_files())} datasheets agree with the RTL")
    return 1 if found else 0


def main():
    arguments = sys.argv[1:]
    option = arguments[0] if arguments and arguments[0].startswith("-") else None
    if option in ("-h", "--help"):
        print(__doc__)
    elif option == "--check" and len(arguments) == 1:
        return check()
    elif option == "--latency" and len(arguments) == 2 and arguments[1] in STIMULI:
        print(latency(arguments[1]))
    elif option == "--stream":
        print(stream(*arguments[1:]), end="")
    elif option == "--widths" and len(arguments) == 1:
        print(widths(), end="")
    elif option == "--leaves" and len(arguments) == 1:
        print(leaves(), end="")
    elif option or not set(arguments) <= {*rtl_files(), "architecture"}:
        print(__doc__, file=sys.stderr)
        return 2
    else:
        for page in arguments or [*rtl_files(), "architecture"]:
            if page == "architecture":
                for name, block in BLOCKS.items():
                    rewrite(ARCHITECTURE, name, block())
            else:
                rewrite(MODULES / f"{page}.md", "", datasheet_block(page))
    return 0


if __name__ == "__main__":
    sys.exit(main())
