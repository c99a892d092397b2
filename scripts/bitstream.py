#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes and checks the files that a swap reads from memory: a header of 16 bytes, then a partial bitstream.

usage: bitstream.py make RAW --slot N --module N -o FILE [--port 8|32] [--vendor xilinx|none]
       bitstream.py check FILE [--slot N] [--module N] [--port 8|32]

make   RAW: a partial bitstream without a header of its own, of Vivado the .bin of `write_bitstream -bin_file`, in the
       byte order of an 8-bit port. With --vendor xilinx (the default) its sync word AA 99 55 66 must be within its
       first 1,024 bytes; a .bit file, or one with bits or bytes swapped for a flash, is refused. Compressed and
       encrypted ones pass as they are: the device expands and decrypts them. --vendor none takes any bytes. --slot:
       0..3, --module: 0..4, as in docs/hardware/definitions.md. --port: width of the configuration port CFG_W (default
       32); for 32, zeros fill the last word. FILE must be stored at an address that is a multiple of 64
check  refuses what a swap would refuse, with the name of the code that it would report; prints module, slot, length and
       CRC. With --slot and --module it must be for these

Header, four words, little endian: magic; module in byte 0, slot in byte 1, zeros; length of what follows, byte; its
CRC-32 (that of zlib). Exit codes: 0 done, 1 refused, 2 bad arguments."""
import argparse
import json
import pathlib
import struct
import sys
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
DEFINITIONS = json.loads((ROOT / "scripts" / "definitions.json").read_text())
VALUES = {row["name"]: row["value"] for row in DEFINITIONS["constants"]}
MAGIC = int(str(VALUES["BITSTREAM_MAGIC"]), 0)
HEADER = VALUES["BITSTREAM_HEADER"]
LEAST = VALUES["BITSTREAM_PAYLOAD_MIN"]
MODULES = {row["value"]: row["name"].lower() for enum in DEFINITIONS["enums"] if enum["prefix"] == "RM"
           for row in enum["values"]}
SLOTS = 4
SYNC = bytes.fromhex("AA995566")
SYNC_WITHIN = 1024  # bus width detection and dummy words come before it
# what a sync word looks like in files for other ports
SWAPPED = {bytes.fromhex("5599AA66"): "the bits of each byte swapped, as for SelectMAP or a BPI flash",
           bytes.fromhex("665599AA"): "the bytes of each word in reverse",
           bytes.fromhex("66AA9955"): "all bits of each word in reverse"}


class Refused(Exception):
    pass


def payload_of(raw, vendor, port):
    """The bytes that pass the configuration port."""
    if vendor == "xilinx":
        head = raw[:SYNC_WITHIN]
        if raw[:2] == b"\0\x09" and raw[2:4] == b"\x0f\xf0":
            raise Refused("a .bit file, which has a text header; give the .bin of write_bitstream -bin_file")
        if raw[:4] == struct.pack("<I", MAGIC):
            raise Refused("it has the header already; give the vendor's .bin")
        if SYNC not in head:
            for sync, what in SWAPPED.items():
                if sync in head:
                    raise Refused(f"its sync word comes with {what}; give the .bin of write_bitstream -bin_file")
            raise Refused(f"no sync word AA 99 55 66 in its first {SYNC_WITHIN} bytes; give a .bin of Vivado, or "
                          "--vendor none for another device")
        if port == 32 and head.index(SYNC) % 4:
            raise Refused(f"its sync word is at byte {head.index(SYNC)}, which is no multiple of 4; a port of 32 bit "
                          "cannot align that")
    raw += bytes(-len(raw) % (port // 8))
    if len(raw) < LEAST:
        raise Refused(f"{len(raw)} bytes, {LEAST} at least; give a whole bitstream")
    if len(raw) + HEADER >= 1 << 32:
        raise Refused(f"{len(raw)} bytes do not fit into 4 GiB with the header")
    return raw


def make(raw, slot, module, port=32, vendor="xilinx"):
    payload = payload_of(raw, vendor, port)
    return struct.pack("<IBBHII", MAGIC, module, slot, 0, len(payload), zlib.crc32(payload)) + payload


def check(data, slot=None, module=None, port=32):
    """(slot, module, length, CRC) of a bitstream, after the checks of the configuration controller in its order."""
    if len(data) < HEADER:
        raise Refused(f"MAGIC: the file ends after {len(data)} bytes, the header has {HEADER}")
    magic, is_module, is_slot, zero, length, crc = struct.unpack("<IBBHII", data[:HEADER])
    if magic != MAGIC or zero:
        raise Refused(f"MAGIC: it begins with 0x{magic:08x} and bytes 6 and 7 are 0x{zero:04x}, not 0x{MAGIC:08x} "
                      "and 0; make it with bitstream.py make")
    if slot is not None and slot != is_slot:
        raise Refused(f"SLOT: it is for slot {is_slot}, not {slot}")
    if is_slot >= SLOTS:
        raise Refused(f"SLOT: there is no slot {is_slot}, the last is {SLOTS - 1}")
    if module is not None and module != is_module:
        raise Refused(f"MODULE: it is module {is_module}, not {module}")
    if is_module not in MODULES:
        raise Refused(f"MODULE: there is no module {is_module}, one of {', '.join(map(str, MODULES))}")
    payload = data[HEADER:]
    if length != len(payload) or length < LEAST or length % (port // 8):
        raise Refused(f"LENGTH: {length} bytes announced, {len(payload)} follow the header; they must be the same, "
                      f"{LEAST} or more, in whole words of a port of {port} bit")
    if zlib.crc32(payload) != crc:
        raise Refused(f"CRC: 0x{crc:08x} in the header, 0x{zlib.crc32(payload):08x} is that of the bytes; "
                      "copy it again")
    return is_slot, is_module, length, crc


def read(path):
    try:
        return pathlib.Path(path).read_bytes()
    except OSError as error:
        raise Refused(f"cannot be read: {error.strerror}") from None


def main():
    if {"-h", "--help"} & set(sys.argv[1:]):
        print(__doc__)
        return 0
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1], add_help=False)
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("make", "check"):
        command = commands.add_parser(name, add_help=False, usage=parser.usage)
        command.add_argument("file")
        command.add_argument("--slot", type=int, choices=range(SLOTS), required=name == "make")
        command.add_argument("--module", type=int, choices=sorted(MODULES), required=name == "make")
        command.add_argument("--port", type=int, choices=(8, 32), default=32)
        if name == "make":
            command.add_argument("-o", dest="out", required=True)
            command.add_argument("--vendor", choices=("xilinx", "none"), default="xilinx")
    options = parser.parse_args()
    try:
        data = read(options.file)
        if options.command == "make":
            data = make(data, options.slot, options.module, options.port, options.vendor)
            pathlib.Path(options.out).write_bytes(data)
        slot, module, length, crc = check(data, options.slot, options.module, options.port)
    except Refused as error:
        print(f"bitstream.py: {options.file}: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"bitstream.py: {options.out}: cannot be written: {error.strerror}", file=sys.stderr)
        return 1
    print(f"slot={slot} module={module} ({MODULES[module]}) length={length} crc=0x{crc:08x}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
