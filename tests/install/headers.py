#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: headers.py <compiler> <include folder>...
Headers for users, which are those of the table in docs/cpp/README.md: no other lies outside cchip/internal/, each
compiles alone and brings in no more of cchip/internal/ than is known, and texts for users name no other."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDES = [ROOT / "lib" / "include", ROOT / "cpp_ref" / "include"]
COMPILER, *FOLDERS = sys.argv[1:] or [None]
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror"]
PAGE = ROOT / "docs" / "cpp" / "README.md"

# Headers for users: what of cchip/internal/ they may bring in. Drivers speak the words of the hardware.
BROUGHT = {"cchip.hpp": {"exact/intersection.hpp"}, "intersection.hpp": {"exact/intersection.hpp"},
           "check.hpp": {"certificate/exact_points.hpp"},
           "driver": {"wire/axis.hpp", "wire/bitstream.hpp", "wire/definitions.hpp", "wire/line.hpp", "wire/pair.hpp",
                      "wire/query.hpp"}}


def listed():
    return re.findall(r"^\| `<(cchip/[\w/]+\.hpp)>` \|", PAGE.read_text(), re.M)


def text(names):
    return "".join(f"#include <{name}>\n" for name in names)


class Headers(unittest.TestCase):
    def compile(self, content):
        """Headers of this library that a file of that content includes, directly or not."""
        with tempfile.TemporaryDirectory() as folder:
            source, rule = pathlib.Path(folder, "alone.cpp"), pathlib.Path(folder, "alone.d")
            source.write_text(content)
            run = subprocess.run([COMPILER, "-std=c++17", *WARNINGS, "-fsyntax-only", "-MD", "-MF", rule,
                                  *(word for own in INCLUDES for word in ("-I", own)),
                                  *(word for other in FOLDERS for word in ("-idirafter", other)), source],
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            self.assertEqual(run.returncode, 0, run.stdout)
            return {name[len(f"{own}/"):] for name in rule.read_text().split()
                    for own in INCLUDES if name.startswith(f"{own}/")}

    def test_table_is_the_public_interface(self):
        found = sorted(str(path.relative_to(own)) for own in INCLUDES for path in own.rglob("*.hpp"))
        self.assertEqual(sorted(listed()), [name for name in found if not name.startswith("cchip/internal/")])

    def test_each_compiles_alone(self):
        names = listed()
        self.assertGreater(len(names), 20)
        for name in names:
            with self.subTest(name):
                brought = self.compile(text([name, name]))  # twice: its guard is its own
                self.assertIn(name, brought)
                internal = {other[len("cchip/internal/"):] for other in brought if other.startswith("cchip/internal/")}
                self.assertLessEqual(internal, BROUGHT.get(name.split("/")[1], set()))

    def test_all_compile_together(self):
        self.assertLessEqual(set(listed()), self.compile(text(reversed(listed()))))

    def test_one_header_brings_the_rows_below_it(self):
        names = listed()
        first, last = names.index("cchip/cchip.hpp"), names.index("cchip/point_file.hpp")
        brought = self.compile(text(["cchip/cchip.hpp"]))
        self.assertEqual({name for name in brought if "/internal/" not in name}, set(names[first:last + 1]))

    def test_texts_for_users_name_no_other(self):
        names = set(listed())
        places = [ROOT / "README.md", *(ROOT / "docs" / "cpp").glob("*.md"),
                  *(ROOT / "docs" / "hardware").glob("uio.md"),
                  *(ROOT / "examples").rglob("*.[ch]pp"), *(ROOT / "tests" / "install").rglob("*.cpp")]
        included = {name: place for place in places
                    for name in re.findall(r"^#include <(cchip/[^>]+)>", place.read_text(), re.M)
                    if not name.startswith("cchip/rc/")}
        self.assertGreater(len(included), 5)
        self.assertEqual({name: str(place) for name, place in included.items() if name not in names}, {})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
