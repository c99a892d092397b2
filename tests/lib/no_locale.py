# SPDX-License-Identifier: Apache-2.0
"""no_locale.py <repository>: the sources of library and programs call nothing that reads or writes numbers with a
fraction as the locale of the host process says; read_decimal(), std::to_chars and fmt do not."""
import pathlib
import re
import sys

FORBIDDEN = re.compile(
    r"\b(strto(f|d|ld)|sto(f|d|ld)|atof|\w*scanf|setlocale)\b|std::locale\(\"|\bprintf\([^)]*%[^sdxXuzl%]*[aefgAEFG]")


def code(line):
    """The line without a comment."""
    return line.split("//")[0]


def main():
    root = pathlib.Path(sys.argv[1])
    files = sorted(p for folder in ("lib", "cpp_ref", "sim", "examples") for p in (root / folder).rglob("*.[ch]pp"))
    found = [f"{path.relative_to(root)}:{number}: {line.strip()}" for path in files
             for number, line in enumerate(path.read_text().splitlines(), 1) if FORBIDDEN.search(code(line))]
    for text in found:
        print(text)
    if len(files) < 50:
        print(f"only {len(files)} files below {root}")
    print(f"{len(files)} files, {len(found)} lines that depend on the locale")
    return 1 if found or len(files) < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
