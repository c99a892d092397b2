# SPDX-License-Identifier: Apache-2.0
"""The wheel in dist: what a stranger's computer needs for it, and the licences of what is inside."""
import io
import pathlib
import re
import zipfile

import pytest
from elftools.elf.elffile import ELFFile
from packaging.utils import parse_wheel_filename

ROOT = pathlib.Path(__file__).parents[3]

# PEP 513, without the libraries of X11 and Glib; zlib is on the lists of all manylinux tags since.
EVERYWHERE = {"libgcc_s.so.1", "libstdc++.so.6", "libm.so.6", "libdl.so.2", "librt.so.1", "libc.so.6",
              "libpthread.so.0",
              "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1", "libz.so.1"}

# A sentence of each licence that the texts must hold.
LICENCES = {
    "boost.txt": "Boost Software License - Version 1.0",
    "eigen.txt": "Mozilla Public License Version 2.0",
    "highway.txt": "Copyright 2019-2022 Google LLC",
    "nanobind.txt": "Redistributions in binary form must reproduce",
    "robin_map.txt": "MIT License",
    "three.txt": "Copyright (c) 2010-2019 three.js authors",
    "zlib.txt": "This software is provided 'as-is'",
    "LICENSE": "Apache License",
}


@pytest.fixture
def wheel():
    found = sorted((ROOT / "dist").glob("*.whl"))
    assert len(found) == 1, f"{found}: make wheel leaves one"
    return found[0]


def libraries(wheel):
    """Name and ELF file of each."""
    with zipfile.ZipFile(wheel) as archive:
        for name in archive.namelist():
            data = archive.read(name)
            if data.startswith(b"\x7fELF"):
                yield name, ELFFile(io.BytesIO(data))


def glibc_of(tags):
    versions = [tuple(map(int, found.groups())) for tag in tags
                if (found := re.match(r"manylinux_(\d+)_(\d+)_", tag.platform))]
    assert versions, f"no manylinux tag: {sorted(map(str, tags))}"
    return min(versions)


def test_tag(wheel):
    name, _, _, tags = parse_wheel_filename(wheel.name)
    assert name == "collisionchip"
    assert all(re.fullmatch(r"cp31[01]-cp31[01]|cp312-abi3", f"{tag.interpreter}-{tag.abi}") for tag in tags)
    tagged = glibc_of(tags)
    needed = [tuple(map(int, found.group(1).split(".")[:2])) for _, elf in libraries(wheel)
              for _, versions in elf.get_section_by_name(".gnu.version_r").iter_versions() for version in versions
              if (found := re.fullmatch(r"GLIBC_([\d.]+)", version.name))]
    assert needed and max(needed) <= tagged


def test_libraries_come_along(wheel):
    found = dict(libraries(wheel))
    assert sum("/_core" in name for name in found) == 1
    beside = {pathlib.PurePath(name).name for name in found}
    for name, elf in found.items():
        needed = {tag.needed for tag in elf.get_section_by_name(".dynamic").iter_tags("DT_NEEDED")}
        assert needed <= EVERYWHERE | beside, name
        assert not any("highway" in library or "hwy" in library for library in needed - beside), name


def test_licences(wheel):
    with zipfile.ZipFile(wheel) as archive:
        texts = {pathlib.PurePath(name).name: archive.read(name).decode()
                 for name in archive.namelist() if ".dist-info/licenses/" in name}
        metadata = next(archive.read(name).decode()
                        for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
    for name, sentence in LICENCES.items():
        assert sentence in texts[name], name
        assert re.search(rf"^License-File: .*{re.escape(name)}$", metadata, re.M), name
    assert re.search(r"^License-Expression: Apache-2.0 AND ", metadata, re.M)


def test_no_source_or_hardware_inside(wheel):
    with zipfile.ZipFile(wheel) as archive:
        assert not [name for name in archive.namelist() if re.search(r"\.(cpp|hpp|v|a)$", name)]
