# SPDX-License-Identifier: Apache-2.0
"""What the scripts share that write a page of docs/ with a generated block and a plot."""
import argparse
import csv
import io
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
VENV = ROOT / "build" / "venv"


def fail(text, code=1):
    """Ends the script with one line."""
    print(f"{pathlib.Path(sys.argv[0]).name}: {text}", file=sys.stderr)
    sys.exit(code)


def page_with(page, block, name=""):
    """Text of a page with another block between its two `generated` lines, those of a name if it has several blocks."""
    text = page.read_text()
    begin = f"<!-- generated: begin {name} -->" if name else "<!-- generated: begin -->"
    pattern = re.compile(rf"({begin}\n).*?(<!-- generated: end -->)", re.S)
    if not pattern.search(text):
        fail(f"{page.relative_to(ROOT)} has no lines '{begin}' and '<!-- generated: end -->'")
    return pattern.sub(lambda found: found[1] + block + found[2], text)


def compare(path, fresh, command):
    """1 if a checked-in file is not what it should be, and says which command writes it anew."""
    if path.is_file() and path.read_text() == fresh:
        return 0
    print(f"{path.relative_to(ROOT)} is stale, run: {command}", file=sys.stderr)
    return 1


def write(contents):
    """Writes the text of each path."""
    for path, text in contents.items():
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)


def notes_and_rows(text):
    """Of the text of a CSV file: its lines `# key: value` as a dictionary, and a dictionary for each row."""
    lines = text.splitlines()
    notes = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    return notes, list(csv.DictReader(line for line in lines if not line.startswith("# ")))


def start_plot(salt):
    """matplotlib's pyplot, from the tools of `make venv`, set so that the same figures give the same bytes.
    Exit code 77 if it is not there."""
    for folder in VENV.glob("lib/python3*/site-packages"):
        sys.path.append(str(folder))
    os.environ.setdefault("MPLCONFIGDIR", str(ROOT / "build" / "matplotlib"))  # its font cache
    try:
        import matplotlib
    except ImportError as error:
        fail(f"no plot ({error}); run: make venv", 77)
    matplotlib.use("svg")
    import matplotlib.pyplot as plt
    matplotlib.rcdefaults()
    matplotlib.rcParams.update({"svg.hashsalt": salt, "font.size": 9, "axes.spines.top": False,
                                "axes.spines.right": False})
    return plt


def plain_number(value, _):
    """Labels of a logarithmic axis, for matplotlib's FuncFormatter."""
    return f"{value:,.10g}"


def svg_text(figure):
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return re.sub(r" +$", "", text.getvalue(), flags=re.M)


def page_and_plots(usage, page, run, plots, producer, read, tables, block=""):
    """Command line of a script whose page and plots come from the CSV file of one run: --csv PATH, --check,
    --check-plot.

    run: the checked-in CSV; plots: path -> function that draws it; producer: what to say if there is no CSV; read: its
    text -> what tables and the functions of plots take; block: name of the page's generated block."""
    script = f"scripts/{pathlib.Path(sys.argv[0]).name}"
    parser = argparse.ArgumentParser(usage=usage, add_help=False)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--csv", type=pathlib.Path)
    what.add_argument("--check", action="store_true")
    what.add_argument("--check-plot", action="store_true")
    parser.add_argument("-h", "--help", action="store_true")
    arguments = parser.parse_args()
    if arguments.help:
        print(usage)
        return 0
    source = arguments.csv or run
    if not source.is_file():
        fail(f"{source} is not there; {producer}")
    text = source.read_text()
    found = read(text)
    if arguments.check:
        return compare(page, page_with(page, tables(found), block), script)
    if arguments.check_plot:
        return max((compare(plot, draw(found), script) for plot, draw in plots.items()), default=0)
    write({run: text, page: page_with(page, tables(found), block),
           **{plot: draw(found) for plot, draw in plots.items()}})
    return 0
