#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Completion and man pages that scripts/shell_files.py makes: bash completes each command and each option of the help,
and the values and files of options; the pages have no error for man and mandoc. Skipped (77) without help2man or
mandoc, after the rest.

usage: shell_files.py CCHIP"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

CCHIP = pathlib.Path(sys.argv[1]).resolve()
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/shell_files.py"
wrong = []


def output(*command, **options):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def complete(folder, *words):
    """What bash offers for the last word, in this folder."""
    script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _cchip; printf "%s\\n" "${COMPREPLY[@]}"'
    return output("bash", "--norc", "-c", script, "bash", str(folder / "completion/cchip"), *words, cwd=folder).split()


def expect(found, wanted, what):
    if found != wanted:
        wrong.append(f"{what}: {found} instead of {wanted}")


with tempfile.TemporaryDirectory() as temporary:
    folder = pathlib.Path(temporary)
    help2man = shutil.which("help2man")
    output(sys.executable, "-B", SCRIPT, CCHIP, folder, *(["--help2man", help2man] if help2man else []))
    expect(complete(folder, "cchip", "col"), ["collide"], "col")
    expect(complete(folder, "cchip", "help", "mesh"), ["meshpairs"], "help mesh")
    names = re.findall(r"^  (\w+)  ", output(CCHIP, "--help").partition("Subcommands:\n")[2], re.M)
    expect(complete(folder, "cchip", "")[:len(names)], names, "commands")
    options = 0
    for name in names:
        text = output(CCHIP, name, "--help") if name not in ("help", "version") else ""
        for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.M):
            expect(option in complete(folder, "cchip", name, option[:4]), True, f"{name} {option}")
            options += 1
    expect(options > 20, True, "options in the help")
    expect(complete(folder, "cchip", "collide", "--contacts", ""), ["first", "all"], "values of --contacts")
    (folder / "bracket.obj").write_text("")
    expect(complete(folder, "cchip", "collide", "bra"), ["bracket.obj"], "a mesh")
    expect(complete(folder, "cchip", "collide", "--poses", "bra"), ["bracket.obj"], "a file of an option")
    expect(complete(folder, "cchip", "collide", "--most", ""), [], "a number")

    pages = sorted((folder / "man").glob("*.1"))
    if help2man:
        expect(sorted(page.stem for page in pages),
               sorted(["cchip", *(f"cchip-{name}" for name in names if name not in ("help", "version"))]), "pages")
    for page in pages:
        # comparing words: the page says each option of the help
        shown = re.sub(r"\\[-&]", "-", page.read_text())
        text = output(CCHIP, *page.stem.split("-")[1:], "--help")
        for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.M):
            expect(option in re.sub(r"\\f[BIRP]", "", shown), True, f"{page.name}: {option}")
        if shutil.which("man"):
            found = subprocess.run(["man", "--warnings", "-l", page], capture_output=True,
                                   text=True)
            expect((found.returncode, found.stderr), (0, ""), f"man {page.name}")
            expect("OPTIONS" in found.stdout, True, f"{page.name}: options")
        if shutil.which("mandoc"):
            found = subprocess.run(["mandoc", "-T", "lint", "-W", "error", page], stdout=subprocess.PIPE, text=True)
            expect((found.returncode, found.stdout), (0, ""), f"mandoc {page.name}")

print("\n".join(wrong) if wrong else f"commands={len(names)} options={options} pages={len(pages)}")
sys.exit(1 if wrong else 0 if help2man and shutil.which("mandoc") else 77)
