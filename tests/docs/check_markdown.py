#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What Markdown would swallow in the pages, on GitHub or on the site: an asterisk of a formula that becomes an
emphasis, a table row whose number of cells is not that of its head (a `|` that is not escaped drops the rest), a <name>
that is taken for a tag. And sentences of more than 40 words, which readers give up. Prints how many words the pages
have.

usage: check_markdown.py ROOT
       check_markdown.py --self-test
Exit codes: 0 nothing, 1 findings, a line each."""
import pathlib
import re
import subprocess
import sys

TAGS = "a|b|br|code|details|em|h[1-6]|i|img|kbd|p|picture|source|sub|summary|sup|table|tbody|td|th|thead|tr"
# One character: code that Markdown leaves alone.
CODE = "\0"


def prose(text):
    """(number, line) of the lines that are no code, with their code spans replaced."""
    text = re.sub(r"<!--.*?-->", lambda found: "\n" * found[0].count("\n"), text, flags=re.S)
    fence, blank, indented = None, True, False
    for number, line in enumerate(text.split("\n"), 1):
        mark = re.match(r"\s*(```+|~~~+)", line)
        if fence:
            fence = None if mark and mark[1].startswith(fence) else fence
            continue
        if mark:
            fence = mark[1]
            continue
        indented = line.startswith("    ") and (blank or indented)  # a paragraph is not interrupted by indented code
        blank = not line.strip()
        if not indented and not blank:
            yield number, line


def findings(text):
    head = None
    lines = list(prose(text))
    for (number, line), (_, following) in zip(lines, lines[1:] + [(0, "")]):
        # GitHub separates cells at every `|` without a backslash, in code, too.
        cells = len(re.findall(r"(?<!\\)\|", line)) - 1
        if not line.startswith("|"):
            head = None
        elif re.fullmatch(r"\|(\s*:?-+:?\s*\|)+\s*", following):
            head = cells
        if line.startswith("|") and head is not None and cells != head:
            yield number, f"{cells} cells below a head of {head}; a | inside a cell is written \\|"
        bare = re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", CODE, line)
        bare = re.sub(r"\\[\\*_|<`]", CODE, bare)
        bare = re.sub(r"\]\([^)]*\)", "]", bare)
        for found in re.finditer(r"[\w)\]]\*[\w(\[]", bare):
            yield (number, f"'{bare[max(0, found.start() - 10):found.end() + 10]}': the asterisk becomes an emphasis; "
                           "put the formula into `...`")
        for found in re.finditer(rf"<(?!/?(?:{TAGS})\b|https?:)/?[A-Za-z][^<>]*>", bare):
            yield number, f"'{found[0]}' is taken for a tag; put it into `...`"


def sentences(text):
    """(number of the line where its paragraph begins, sentence) of what is written by hand and in no table or heading.
    Colons and semicolons end one, too."""
    text = re.sub(r"<!-- generated: begin.*?<!-- generated: end[^>]*-->", lambda found: "\n" * found[0].count("\n"),
                  text, flags=re.S)
    paragraphs, last = [], -1
    for number, line in prose(text):
        if line.startswith(("|", "#")):
            continue
        if number != last + 1 or re.match(r"\s*([-*]|\d+\.) ", line):
            paragraphs.append((number, []))
        paragraphs[-1][1].append(line.strip())
        last = number
    for number, lines in paragraphs:
        whole = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", " ".join(lines))
        yield from ((number, sentence) for sentence in re.split(r"(?<=[.!?:;])\s+", whole))


def words(text):
    return len(re.findall(r"[A-Za-z][A-Za-z'-]+", text))


def long_sentences(text):
    for number, sentence in sentences(text):
        if len(sentence.split()) > 40:
            yield number, f"a sentence of {len(sentence.split())} words: {' '.join(sentence.split()[:6])} ..."


def self_test():
    cases = [("a [3*W*i +: 3*W], x", 2), ("a `[3*W*i +: 3*W]`, *so* and **so**, 2 * 3 * 4", 0),
             ("```\na*b*c\n```\n\n    a*b*c", 0),
             ("| a | b |\n|---|---|\n| x | y |\n| x | |M| > 1 |", 1), ("| a | b |\n|---|---|\n| x | \\|M\\| > 1 |", 0),
             ("the <name> of <b>it</b>", 1),
             ("| a |\n|---|\n| `x | y` |", 1), ("a\n    b*c*d", 1)]
    wrong = [f"{text!r}: {len(list(findings(text)))} findings, {count} expected"
             for text, count in cases if len(list(findings(text))) != count]
    long = "word " * 41
    for text, count in ((f"{long}.", 1), (f"| {long} |", 0), (f"    {long}", 0),
                        ("word " * 39 + ": " + "word " * 39, 0), ("a\n" + "word " * 20 + "\n" + "word " * 20, 1),
                        ("word " * 30 + "\n- " + "word " * 30, 0),
                        (f"<!-- generated: begin x -->\n{long}\n<!-- generated: end -->", 0)):
        if len(list(long_sentences(text))) != count:
            wrong.append(f"{text[:20]!r}...: {len(list(long_sentences(text)))} long sentences, {count} expected")
    print("\n".join(wrong) if wrong else f"{len(cases)} cases")
    return bool(wrong)


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1])
    names = subprocess.run(["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard", "*.md"],
                           check=True,
                           stdout=subprocess.PIPE, text=True).stdout.split("\0")
    pages = [name for name in names if name and (root / name).is_file()]
    texts = {name: (root / name).read_text() for name in pages}
    wrong = [f"{name}:{number}: {what}" for name, text in texts.items()
             for number, what in [*findings(text), *long_sentences(text)]]
    of_prose = sum(words(sentence) for text in texts.values() for _, sentence in sentences(text))
    print("\n".join(wrong) if wrong else f"{len(pages)} pages, {sum(map(words, texts.values()))} words, {of_prose} of "
                                         "them in sentences")
    return bool(wrong) or not pages


if __name__ == "__main__":
    sys.exit(main())
