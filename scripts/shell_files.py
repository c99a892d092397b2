#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Completion for bash and man pages of a command, from what it prints for --help.

usage: shell_files.py CCHIP FOLDER [--help2man COMMAND]
Writes FOLDER/completion/cchip and, with Debian's help2man, FOLDER/man/cchip.1 and a page for each subcommand."""
import argparse
import pathlib
import re
import shlex
import subprocess
import tempfile

OWN = {"version", "help"}  # subcommands without options of their own


def help_of(program, *words):
    return subprocess.run([program, *words], check=True, stdout=subprocess.PIPE, text=True).stdout


def section(text, name):
    """Lines below a heading, up to the next empty line."""
    found = re.search(rf"^{name}:\n((?:.+\n)*)", text, re.M)
    return found[1] if found else ""


def subcommands(text):
    """Name and description."""
    return dict(re.findall(r"^  (\w+) +(.*)$", section(text, "Subcommands"), re.M))


def options(text):
    """Name of each option: the action of compgen for its value, such as "-f" for files, or None if it takes no
    value."""
    found = {}
    for names, rest in re.findall(r"^  (-[^ ]+)(.*\n(?:   .*\n)*)", section(text, "Options"), re.M):
        choices = re.match(r" [A-Z]+:\{(.*?)\}", rest)
        if choices:
            action = f'-W "{choices[1].replace(",", " ")}"'
        elif re.match(r" [A-Z]", rest):
            action = "-f" if re.search(r"\bfile\b|  write |: write ", rest) else '-W ""'
        else:
            action = None
        found.update({name: action for name in names.split(",")})
    return found


def completion(program):
    top = help_of(program, "--help")
    commands = subcommands(top)
    lines = ["# SPDX-License-Identifier: Apache-2.0",
             "# Completion of cchip for bash, made from what cchip --help prints.",
             "_cchip() {",
             "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command='' i",
             "  COMPREPLY=()",
             "  for ((i = 1; i < COMP_CWORD; i++)); do",
             "    [[ ${COMP_WORDS[i]} == -* ]] || { command=${COMP_WORDS[i]}; break; }",
             "  done",
             "  local options=''",
             '  case "$command" in',
             f'    "") COMPREPLY=($(compgen -W "{" ".join([*commands, *options(top)])}" -- "$word")); return ;;',
             f'    help) COMPREPLY=($(compgen -W "{" ".join(name for name in commands if name not in OWN)}" -- '
             '"$word")); return ;;']
    for name in commands:
        if name == "help":
            continue
        found = options(help_of(program, name, "--help"))
        lines.append(f"    {name})")
        lines.append(f'      options="{" ".join(found)}"')
        lines.append('      case "$before" in')
        lines += [f'        {option}) COMPREPLY=($(compgen {action} -- "$word")); return ;;'
                  for option, action in found.items() if action]
        lines += ["      esac ;;"]
    lines += ["  esac",
              '  if [[ $word == -* ]]; then',
              '    COMPREPLY=($(compgen -W "$options" -- "$word"))',
              "  else",
              "    compopt -o filenames 2> /dev/null",
              '    mapfile -t COMPREPLY < <(compgen -f -- "$word")',
              "  fi",
              "}",
              "complete -F _cchip cchip"]
    text = "\n".join(lines) + "\n"
    return re.sub(r"COMPREPLY=\(\$\((.*?)\)\)", r"mapfile -t COMPREPLY < <(\1)", text)


def for_help2man(text):
    """The help as help2man reads it: two blanks before what an option means, a paragraph for each line of the end."""
    if not text.startswith("Usage:"):
        description, usage, rest = re.match(r"(.*?)^(Usage: .*?\n)(.*)\Z", text, re.M | re.S).groups()
        text = usage + "\n" + description + rest
    text = re.sub(r"^  -(\w),--", r"  -\1, --", text, flags=re.M)
    text = re.sub(r"^(  -[^ ]+ [A-Z]+:\{\S*\}) (?! )", r"\1  ", text, flags=re.M)
    codes = re.search(r"^Exit codes: (.*?)\.$", text, re.M | re.S)
    listed = re.split(r",\s(?=\d )", codes[1])
    text = text.replace(codes[0], "Exit status:\n\n" + "".join(f"  {code[0]}    {code[2:]}\n" for code in listed))
    examples = re.search(r"^Examples:\n((?:  .*\n)*)", text, re.M)
    return text.replace(examples[0], "\nExamples:\n\n" + examples[1].replace("\n", "\n\n")) if examples else text


def man_page(help2man, name, text, about, version, folder):
    with tempfile.TemporaryDirectory() as temporary:  # a program of the page's name that prints the text
        pages = pathlib.Path(temporary)
        (pages / "help").write_text(for_help2man(text))
        program = pages / name
        program.write_text(f"#!/bin/sh\ncat {shlex.quote(str(pages / 'help'))}\n")
        program.chmod(0o755)
        subprocess.run([help2man, "--no-info", "--section=1", "--no-discard-stderr", f"--name={about}",
                        f"--version-string={version}",
                        "--source=collisionchip", "--manual=collisionchip", f"--output={folder / name}.1", program],
                       check=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--help2man")
    chosen = parser.parse_args()
    program = chosen.program.resolve()
    (chosen.folder / "completion").mkdir(parents=True, exist_ok=True)
    (chosen.folder / "completion/cchip").write_text(completion(program))
    (chosen.folder / "man").mkdir(exist_ok=True)
    if not chosen.help2man:
        return
    top = help_of(program, "--help")
    version = help_of(program, "--version").split()[-1]
    man_page(chosen.help2man, "cchip", top, "exact collision detection, by a library or on simulated hardware", version,
             chosen.folder / "man")
    for name, about in subcommands(top).items():
        if name not in OWN:
            man_page(chosen.help2man, f"cchip-{name}", help_of(program, name, "--help"), about, version,
                     chosen.folder / "man")


if __name__ == "__main__":
    main()
